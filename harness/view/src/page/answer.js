"use strict";
// The answer at the top of a spot's story: which method is worse there, what explains it, and which view shows it.
(() => {
  const view = window.unshadeView;
  const SHADED = 0.25, INDIRECT = 0.2, GLOSSY = 0.3, DARK = 0.8, BRIGHT = 1.25, TELLING = 0.05;

  const total = ({ diffuse, specular }) => view.luminance(diffuse) + view.luminance(specular);
  const percent = (share) => (share < 0.095 ? (100 * share).toPrecision(1) : Math.round(100 * share)) + " %";
  const degrees = (cosine) => Math.round(Math.acos(Math.min(1, cosine)) * 180 / Math.PI) + "°";

  /// Where a normal points, as seen from the front.
  view.facing = ({ x, y, z }) => {
    if (Math.abs(y) > 0.7) return y > 0 ? "facing up" : "facing down";
    if (Math.abs(x) > 0.7) return x > 0 ? "right in the front view" : "left in the front view";
    return z < -0.5 ? "at the back" : "in front";
  };

  // The methods by their error, the worst first, with the luminance of their albedo as a multiple of the true one.
  const ranked = (panes, truth, factors) => panes.filter((each) => each !== truth && each.values.diffuse_albedo).map((each) => {
    const albedo = each.values.diffuse_albedo.map((x) => x * factors.get(each.pane.id)), exact = truth.values.diffuse_albedo;
    const ratio = view.luminance(albedo) / Math.max(1e-6, view.luminance(exact));
    return { each, ratio, error: view.ciede2000(view.lab(albedo), view.lab(exact)) };
  }).sort((a, b) => b.error - a.error);

  // The view in which a method's prediction is farthest from the reference; one that sees the spot at a slant shows it
  // smaller.
  const clearest = (gaps, cosines) => gaps.reduce((best, gap, i) =>
    Math.abs(gap) * cosines[i] > Math.abs(gaps[best]) * cosines[best] ? i : best, 0);

  /// The sentences, as plain text, and the index of the observation that shows the error best (null without one).
  /// `irradiance`: that of the direct light, as a share of the largest on the face's front; null without a light.
  view.answer = ({ panes, truth, factors, observations, predicted, views, irradiance }) => {
    const found = [], worst = truth && ranked(panes, truth, factors);
    if (worst?.length) {
      const each = worst.map(({ each: { pane }, ratio, error }) => `${pane.title} CIEDE2000 ${error.toFixed(1)} (${ratio.toFixed(2)} times the true luminance)`);
      found.push((worst.length > 1 ? "Diffuse albedo of this texel after one factor, worst first: " : "Diffuse albedo of this texel after one factor: ") + each.join(", ") + ".");
    }
    const cosines = observations.map(({ cosine }) => cosine);
    found.push(cosines.length ? `${cosines.length} of ${views} training views see it, the most frontal at ${degrees(Math.max(...cosines))}.`
      : "No training view sees it: its values are filled in or extrapolated.");
    if (irradiance !== null) found.push(`The direct light here is ${percent(irradiance)} of the largest on the front.`);
    if (!predicted.length || !observations.length) return { found, clearest: null };

    const observed = observations.map(({ radiance }) => view.luminance(radiance)), sum = (values) => values.reduce((a, b) => a + b, 0);
    const exact = predicted.find(({ pane }) => pane === truth?.pane), first = worst?.[0];
    if (exact) {
      const parts = exact.parts, rest = 1 - sum(parts.map(total)) / Math.max(1e-9, sum(observed));
      const gloss = sum(parts.map(({ specular }) => view.luminance(specular))) / Math.max(1e-9, sum(parts.map(total)));
      if (rest > INDIRECT) found.push(`Direct light on the true maps leaves ${percent(rest)} of the observed radiance unexplained: other parts of the face reflect it.`);
      if (gloss > GLOSSY) found.push(`The highlight is ${percent(gloss)} of the true direct light.`);
      const taken = (what) => found.push(`${first.each.pane.title}: perhaps ${what} taken for albedo.`);
      if (first?.ratio < DARK && irradiance < SHADED) taken("shade");
      else if (first?.ratio > BRIGHT && rest > INDIRECT) taken("light from other parts of the face");
      else if (first?.ratio > BRIGHT && gloss > GLOSSY) taken("highlights");
    }
    const methods = predicted.filter(({ pane }) => pane !== truth?.pane);
    const gapsOf = ({ parts }) => parts.map((part, i) => total(part) - (exact ? total(exact.parts[i]) : observed[i]));
    const size = (one) => Math.max(...gapsOf(one).map(Math.abs));
    const shown = methods.find(({ pane }) => pane === first?.each.pane) ?? methods.reduce((a, b) => size(b) > size(a) ? b : a);
    const gaps = gapsOf(shown), i = clearest(gaps, cosines), value = (x) => x.toPrecision(2);
    if (Math.abs(gaps[i]) < TELLING * Math.max(...observed)) {
      const frontal = cosines.indexOf(Math.max(...cosines));
      found.push(`Direct light does not show it in any view: predictions differ by at most ${value(Math.abs(gaps[i]))}, and ${value(Math.max(...observed))} is observed. View ${observations[frontal].camera.name} is the most frontal.`);
      return { found, clearest: frontal };
    }
    found.push(`View ${observations[i].camera.name} shows it best: ${shown.pane.title} predicts ${value(total(shown.parts[i]))}, `
      + (exact ? `the truth ${value(total(exact.parts[i]))}, ` : "") + `observed ${value(observed[i])}.`);
    return { found, clearest: i };
  };
})();

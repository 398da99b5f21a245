"use strict";
// A spot's story: what each view observed at a texel, what the maps predict for it, and what the maps say there.
(() => {
  const view = window.unshadeView;
  const CROP = 48;
  const MARKS = ["●", "▲", "■", "◆"];
  // The left edge of the plot.
  const LEFT = 50;
  /// The same marks as paths around a point.
  const SHAPES = [
    (x, y) => `M${x - 3} ${y}a3 3 0 1 0 6 0a3 3 0 1 0 -6 0z`,
    (x, y) => `M${x - 3.5} ${y + 3}h7l-3.5 -6.5z`,
    (x, y) => `M${x - 3} ${y - 3}h6v6h-6z`,
    (x, y) => `M${x - 4} ${y}l4 -4l4 4l-4 4z`,
  ];
  const INKS = ["#e6e8eb", "#e69f00", "#56b4e9", "#cc79a7"];

  const escaped = (text) => String(text).replace(/[&<>"]/g, (letter) => "&#" + letter.charCodeAt(0) + ";");
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const degrees = (a, b) => {
    const cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    return Math.atan2(Math.hypot(...cross), dot(a, b)) * 180 / Math.PI;
  };

  /// The texel of an array with these texture coordinates.
  view.texelOf = (array, [u, v]) => [u * array.width, (1 - v) * array.height].map((at, axis) =>
    Math.min((axis ? array.height : array.width) - 1, Math.max(0, Math.floor(at))));

  // The radiance at a place in pixels: bilinear over those of the four nearest pixels that show the head.
  const radianceAt = (picture, x, y) => {
    const [left, top] = [Math.floor(x - 0.5), Math.floor(y - 0.5)], sum = [0, 0, 0];
    let total = 0;
    for (const [column, row] of [[left, top], [left + 1, top], [left, top + 1], [left + 1, top + 1]]) {
      if (column < 0 || row < 0 || column >= picture.width || row >= picture.height) continue;
      const weight = (1 - Math.abs(x - 0.5 - column)) * (1 - Math.abs(y - 0.5 - row)), rgb = view.pixel(picture, column, row);
      if (!rgb.every(Number.isFinite)) continue;
      rgb.forEach((value, c) => { sum[c] += weight * value; });
      total += weight;
    }
    return total > 0 ? sum.map((value) => value / total) : null;
  };

  /// What the views observed at a place: for each that sees it, its pixel, the angle and the radiance.
  view.observations = async (scene, place) => {
    const seen = await view.load(scene.views.seen), [column, row] = view.texelOf(seen, place.uv);
    const from = (row * seen.width + column) * seen.channels, found = [];
    for (const [i, camera] of scene.views.list.entries()) {
      if (!((seen.codes[from + (i >> 3)] >> (i & 7)) & 1)) continue;
      const matrix = new THREE.Matrix4().fromArray(camera.camera_to_world);
      const eye = new THREE.Vector3().setFromMatrixPosition(matrix), local = place.position.clone().applyMatrix4(matrix.clone().invert());
      const x = camera.centre[0] - camera.focal[0] * local.x / local.z, y = camera.centre[1] + camera.focal[1] * local.y / local.z;
      const picture = await view.load(camera.picture), radiance = radianceAt(picture, x, y);
      const cosine = eye.clone().sub(place.position).normalize().dot(place.normal);
      if (radiance) found.push({ camera, picture, eye: eye.toArray(), x, y, radiance, cosine: Math.max(0, cosine) });
    }
    const total = found.reduce((sum, { cosine }) => sum + cosine, 0);
    for (const each of found) each.weight = each.cosine / total;
    return found;
  };

  /// The values of all maps of a pane at a place, by the maps' names, with the texel in its file.
  view.valuesAt = async (pane, uv) => {
    const values = {}, texels = {};
    await Promise.all(pane.maps.map(async ([name, stored]) => {
      const array = await view.load(stored), [x, y] = view.texelOf(array, uv);
      values[name] = view.pixel(array, x, y);
      texels[name] = [x, y];
    }));
    return { values, texels };
  };

  /// The material of a pane at a place, as the renderer reads it.
  view.materialAt = (values, place, factor) => {
    const unit = (vector) => {
      const size = vector ? Math.hypot(...vector) : 0;
      return size > 1e-4 ? vector.map((x) => x / size) : place.normal.toArray();
    };
    const [first, second, share] = values.roughness ?? [0.15, 0.35, 0.5];
    const alpha = (x) => Math.min(1, Math.max(0.02, x));
    return {
      albedo: values.diffuse_albedo.map((x) => x * factor),
      specular: values.specular_albedo?.[0] ?? 0,
      diffuseNormal: unit(values.diffuse_normal),
      specularNormal: unit(values.specular_normal),
      lobes: [alpha(first), alpha(second), Math.min(1, Math.max(0, share))],
      facing: place.facing.toArray(),
    };
  };

  const crop = (canvas, { picture, x, y }, exposure) => {
    const context = canvas.getContext("2d"), image = context.createImageData(CROP, CROP);
    const [left, top] = [Math.round(x) - CROP / 2, Math.round(y) - CROP / 2];
    canvas.width = canvas.height = CROP;
    for (let i = 0; i < CROP * CROP; i++) {
      const [column, row] = [left + i % CROP, top + Math.floor(i / CROP)];
      const inside = column >= 0 && row >= 0 && column < picture.width && row < picture.height;
      const rgb = inside ? view.pixel(picture, column, row) : [NaN];
      const shown = rgb.every(Number.isFinite) ? rgb.map((value) => 255 * view.srgb(value * exposure)) : [40, 42, 46];
      image.data.set([...shown, 255], 4 * i);
    }
    context.putImageData(image, 0, 0);
    context.strokeStyle = "#fff";
    context.strokeRect(x - left - 3.5, y - top - 3.5, 7, 7);
  };

  // Observed luminance as bars, each pane's prediction as marks: the diffuse part hollow, the sum filled.
  const plot = (observations, predicted) => {
    const [width, height, low] = [340, 170, 26], all = observations.map(({ radiance }) => view.luminance(radiance));
    const sums = predicted.flatMap(({ parts }) => parts.map(({ diffuse, specular }) => view.luminance(diffuse) + view.luminance(specular)));
    const top = 1.08 * Math.max(1e-6, ...all, ...sums), across = (degrees_) => LEFT + (width - LEFT - 12) * degrees_ / 90;
    const up = (value) => height - low - (height - low - 10) * value / top, lines = [];
    for (const tick of [0, 30, 60, 90]) lines.push(`<text x="${across(tick)}" y="${height - 8}" class="tick">${tick}°</text>`);
    for (const tick of [0, 0.5, 1]) {
      const value = tick * top / 1.08;
      lines.push(`<line x1="${LEFT}" x2="${width - 12}" y1="${up(value)}" y2="${up(value)}" class="grid"/>`,
        `<text x="${LEFT - 4}" y="${up(value) + 4}" class="tick end">${value.toPrecision(2)}</text>`);
    }
    observations.forEach(({ cosine, camera }, i) => {
      const x = across(Math.acos(Math.min(1, cosine)) * 180 / Math.PI);
      lines.push(`<line x1="${x - 6}" x2="${x + 6}" y1="${up(all[i])}" y2="${up(all[i])}" class="observed"><title>view ${escaped(camera.name)}, observed ${all[i].toPrecision(3)}</title></line>`);
      predicted.forEach(({ pane, parts, ink }, k) => {
        const d = view.luminance(parts[i].diffuse), s = d + view.luminance(parts[i].specular), at = x + 4 * (k - (predicted.length - 1) / 2);
        const title = `<title>view ${escaped(camera.name)}, ${escaped(pane.title)}: diffuse ${d.toPrecision(3)}, with specular ${s.toPrecision(3)}</title>`;
        lines.push(`<line x1="${at}" x2="${at}" y1="${up(d)}" y2="${up(s)}" stroke="${ink}"/>`,
          `<path d="${SHAPES[k](at, up(d))}" fill="none" stroke="${ink}">${title}</path>`,
          `<path d="${SHAPES[k](at, up(s))}" fill="${ink}">${title}</path>`);
      });
    });
    return `<svg viewBox="0 0 ${width} ${height}" role="img" aria-label="luminance against the angle between view and normal">${lines.join("")}</svg>`;
  };

  const row = (heading, cells) => `<tr><th scope="row">${heading}</th>${cells.map((cell) => `<td>${cell}</td>`).join("")}</tr>`;
  const listed = (values, digits) => values.map((value) => value.toFixed(digits)).join(" ");

  // Map values of every pane, its errors beside the truth, and what it states about them.
  const table = (panes, truth, factors) => {
    const rows = [], known = (name) => panes.some(({ values }) => values[name]);
    const each = (name, write) => panes.map((pane) => pane.values[name] ? write(pane.values[name], pane) : "–");
    const stated = (pane, name) => pane.values[name + "_std"] ? " ± " + pane.values[name + "_std"].map((x) => x.toPrecision(2)).join(" ") : "";
    rows.push(row("diffuse albedo, before the factor", each("diffuse_albedo", (rgb, pane) => listed(rgb, 4) + stated(pane, "diffuse_albedo"))));
    if (truth) {
      rows.push(row("CIEDE2000, after the factor", panes.map((pane) => pane === truth ? "" : view.ciede2000(
        view.lab(pane.values.diffuse_albedo.map((x) => x * factors.get(pane.pane.id))), view.lab(truth.values.diffuse_albedo)).toFixed(2))));
    }
    if (known("specular_albedo")) rows.push(row("specular albedo", each("specular_albedo", ([x], pane) => x.toFixed(5) + stated(pane, "specular_albedo"))));
    for (const name of ["diffuse_normal", "specular_normal"]) {
      if (!known(name)) continue;
      const title = name.replace("_", " ");
      rows.push(row(title, each(name, (n, pane) => listed(n, 3) + stated(pane, name))));
      if (truth?.values[name]) rows.push(row("degrees off", each(name, (n, pane) => pane === truth ? "" : degrees(n, truth.values[name]).toFixed(1))));
    }
    if (known("roughness")) rows.push(row("roughness: alphas, share", each("roughness", (x) => listed(x, 3))));
    if (known("confidence")) rows.push(row("confidence", each("confidence", ([x]) => x.toFixed(3))));
    const head = panes.map(({ pane }, i) => `<th scope="col"><span style="color:${INKS[i]}">${MARKS[i]}</span> ${escaped(pane.title)}</th>`);
    return `<div class="scroll"><table><thead><tr><td></td>${head.join("")}</tr></thead><tbody>${rows.join("")}</tbody></table></div>`;
  };

  /// Writes the story of a place into `element`. `light` is the capture's: `{title, model}`, or null where it is unknown.
  view.tell = async (element, { scene, head, place, light, exposure, jump }) => {
    const factors = new Map(scene.panes.map((pane) => [pane.id, pane.factor ?? 1]));
    const [observations, ...panes] = await Promise.all([
      view.observations(scene, place),
      ...scene.panes.map(async (pane) => ({ pane, ...await view.valuesAt(pane, place.uv) })),
    ]);
    const truth = panes.find(({ pane }) => pane.is_truth);
    const visible = light && view.visibleCells(head, light.model, place);
    const predicted = light ? panes.map(({ pane, values }, i) => {
      const material = view.materialAt(values, place, factors.get(pane.id));
      return { pane, ink: INKS[i], mark: MARKS[i], parts: observations.map(({ eye }) => view.predict(material, light.model, visible, place, eye)) };
    }) : [];
    const label = scene.labels && await view.load(scene.labels);
    const [lx, ly] = label ? view.texelOf(label, place.uv) : [];
    const region = label ? scene.label_names[label.codes[ly * label.width + lx]] ?? "no label" : "";
    const [x, y] = panes[0].texels.diffuse_albedo, size = panes[0].pane.maps.find(([name]) => name === "diffuse_albedo")[1].width;
    const step = panes[0].pane.step, mm = place.position.toArray().map((v) => (1000 * v).toFixed(1)).join(", ");
    const reaching = light && view.irradiance(light.model, visible, place);
    const share = reaching?.all > 0 ? `the head blocks ${Math.round(100 * (1 - reaching.open / reaching.all))} % of its light` : "";
    const irradiance = light && reaching.open * view.exposureOf(head, light.model.radiance) / Math.PI;
    const answer = view.answer({ panes, truth, factors, observations, predicted, views: scene.views.list.length, irradiance });
    const parts = [`<ul class="answer">${answer.found.map((line) => `<li>${escaped(line)}</li>`).join("")}</ul><p class="facts">texel ${x * step}, ${y * step} of ${size * step}², ${region ? escaped(region) + ", " : ""}${view.facing(place.normal)}, at (${mm}) mm${share ? ", " + share : ""}</p>`];
    parts.push(table(panes, truth, factors));
    if (observations.length) {
      const key = predicted.map(({ pane, ink, mark }) => `<span style="color:${ink}">${mark} ${escaped(pane.title)}</span>`).join(" ");
      parts.push(`<h3>Observed and predicted, by angle of view</h3>${plot(observations, predicted)}
        <p class="caption">Luminance against the angle between view and normal. Line: observed. ${key}: hollow, the diffuse part; filled, with the specular part. ${light
          ? `Predicted by this page: ${escaped(light.title)}, direct light only, albedo after its one factor.`
          : escaped(scene.moving_light ?? "no light is known") + "; nothing is predicted."}</p><div class="crops"></div>`);
    }
    element.innerHTML = parts.join("");
    const cards = element.querySelector(".crops");
    if (answer.clearest !== null) {
      const look = Object.assign(document.createElement("button"), { type: "button", textContent: "look from there" });
      look.addEventListener("click", () => jump(observations[answer.clearest].camera));
      element.querySelector(".answer").lastElementChild.append(" ", look);
    }
    observations.forEach((each, i) => {
      const { camera, cosine, weight, radiance } = each, seen = view.luminance(radiance);
      const card = document.createElement("button"), canvas = document.createElement("canvas");
      card.type = "button";
      card.className = i === answer.clearest ? "card clearest" : "card";
      crop(canvas, each, exposure);
      const residuals = predicted.map(({ parts: found, ink, mark }) => {
        const rest = seen - view.luminance(found[i].diffuse) - view.luminance(found[i].specular);
        return `<span style="color:${ink}">${mark} ${rest < 0 ? "−" : "+"}${Math.abs(rest).toFixed(3)}</span>`;
      });
      const text = document.createElement("span");
      text.innerHTML = `<strong>view ${escaped(camera.name)}</strong> pixel ${Math.floor(each.x * camera.step)}, ${Math.floor(each.y * camera.step)}<br>
        ${Math.round(Math.acos(Math.min(1, cosine)) * 180 / Math.PI)}°, weight ${Math.round(100 * weight)} %<br>observed ${seen.toFixed(3)}<br>residual ${residuals.join(" ") || "–"}`;
      card.title = `RGB ${radiance.map((value) => value.toPrecision(3)).join(" ")}; click: look from this view`;
      card.append(canvas, text);
      card.addEventListener("click", () => jump(camera));
      cards.append(card);
    });
    return { observations, predicted, panes, answer };
  };
})();

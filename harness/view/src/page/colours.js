"use strict";
// Colour: the sRGB curve, CIE L*a*b*, CIEDE2000, and the colours of quantities. In JavaScript for the numbers, in GLSL
// for the picture.
(() => {
  const view = window.unshadeView;

  view.srgb = (x) => {
    x = Math.min(1, Math.max(0, x));
    return x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
  };

  view.luminance = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

  /// CIE L*a*b* (D65) of linear Rec.709 clipped to 0 to 1.
  view.lab = (rgb) => {
    const [r, g, b] = rgb.map((x) => Math.min(1, Math.max(0, x)));
    const white = [0.3127 / 0.329, 1, (1 - 0.3127 - 0.329) / 0.329];
    const xyz = [0.4124 * r + 0.3576 * g + 0.1805 * b, view.luminance([r, g, b]), 0.0193 * r + 0.1192 * g + 0.9505 * b];
    const [x, y, z] = xyz.map((value, i) => {
      const t = value / white[i];
      return t > (6 / 29) ** 3 ? Math.cbrt(t) : t * 841 / 108 + 4 / 29;
    });
    return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
  };

  /// CIEDE2000 with unit weights (Sharma, Wu, Dalal 2005).
  view.ciede2000 = ([l1, a1, b1], [l2, a2, b2]) => {
    const power7 = (c) => Math.sqrt(c ** 7 / (c ** 7 + 25 ** 7)), radians = Math.PI / 180;
    const stretch = 1.5 - 0.5 * power7((Math.hypot(a1, b1) + Math.hypot(a2, b2)) / 2);
    const polar = (a, b) => {
      const hue = a === 0 && b === 0 ? 0 : Math.atan2(b, a * stretch) / radians;
      return [Math.hypot(a * stretch, b), hue < 0 ? hue + 360 : hue];
    };
    const [c1, h1] = polar(a1, b1), [c2, h2] = polar(a2, b2), grey = c1 * c2 === 0;
    let turn = grey ? 0 : h2 - h1;
    if (turn > 180) turn -= 360;
    if (turn < -180) turn += 360;
    let hue = h1 + h2;
    if (!grey) hue = Math.abs(h1 - h2) <= 180 ? hue / 2 : hue < 360 ? (hue + 360) / 2 : (hue - 360) / 2;
    const l = (l1 + l2) / 2, c = (c1 + c2) / 2, cosine = (degrees) => Math.cos(degrees * radians);
    const t = 1 - 0.17 * cosine(hue - 30) + 0.24 * cosine(2 * hue) + 0.32 * cosine(3 * hue + 6) - 0.2 * cosine(4 * hue - 63);
    const rotation = 60 * Math.exp(-(((hue - 275) / 25) ** 2));
    const dl = (l2 - l1) / (1 + 0.015 * (l - 50) ** 2 / Math.sqrt(20 + (l - 50) ** 2));
    const dc = (c2 - c1) / (1 + 0.045 * c);
    const dh = 2 * Math.sqrt(c1 * c2) * Math.sin(turn / 2 * radians) / (1 + 0.015 * c * t);
    const cross = -2 * power7(c) * Math.sin(rotation * radians);
    return Math.sqrt(Math.max(0, dl * dl + dc * dc + dh * dh + cross * dc * dh));
  };

  // Errors: magma, as in the report. Quantities: cividis, whose lightness rises evenly for all eyes.
  view.RAMPS = {
    error: [[0, 0, 4], [24, 15, 61], [68, 15, 118], [114, 31, 129], [158, 47, 127], [205, 64, 113], [241, 96, 93],
      [253, 150, 104], [254, 202, 141], [252, 253, 191]],
    quantity: [[0, 34, 78], [18, 53, 112], [59, 73, 108], [87, 93, 109], [112, 113, 115], [138, 134, 120],
      [165, 157, 117], [195, 182, 105], [225, 208, 84], [254, 232, 56]],
  };

  // Okabe and Ito (2008): eight colours that colour-blind people tell apart; 0 is no label.
  view.PALETTE = [[60, 60, 60], [230, 159, 0], [213, 94, 0], [0, 114, 178], [0, 158, 115], [204, 121, 167], [86, 180, 233],
    [240, 228, 66]];

  view.gradient = (ramp) => "linear-gradient(to right," + ramp.map((rgb) => "rgb(" + rgb + ")").join(",") + ")";

  view.GLSL_COLOURS = `
    vec3 srgb(vec3 x) {
      x = clamp(x, 0.0, 1.0);
      return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, vec3(lessThanEqual(x, vec3(0.0031308))));
    }
    vec3 lab(vec3 rgb) {
      rgb = clamp(rgb, 0.0, 1.0);
      vec3 xyz = vec3(dot(rgb, vec3(0.4124, 0.3576, 0.1805)), dot(rgb, vec3(0.2126, 0.7152, 0.0722)),
                      dot(rgb, vec3(0.0193, 0.1192, 0.9505)));
      vec3 t = xyz / vec3(0.95045593, 1.0, 1.08905775);
      vec3 f = mix(t * (841.0 / 108.0) + 4.0 / 29.0, pow(t, vec3(1.0 / 3.0)), vec3(greaterThan(t, vec3(0.00885645))));
      return vec3(116.0 * f.y - 16.0, 500.0 * (f.x - f.y), 200.0 * (f.y - f.z));
    }
    float power7(float c) { float r = pow(c / 25.0, 7.0); return sqrt(r / (r + 1.0)); }
    float hueOf(vec2 ab) { float h = dot(ab, ab) == 0.0 ? 0.0 : degrees(atan(ab.y, ab.x)); return h < 0.0 ? h + 360.0 : h; }
    float ciede2000(vec3 p, vec3 g) {
      float stretch = 1.5 - 0.5 * power7(0.5 * (length(p.yz) + length(g.yz)));
      vec2 ab1 = p.yz * vec2(stretch, 1.0), ab2 = g.yz * vec2(stretch, 1.0);
      float c1 = length(ab1), c2 = length(ab2), h1 = hueOf(ab1), h2 = hueOf(ab2);
      bool grey = c1 * c2 == 0.0;
      float turn = grey ? 0.0 : h2 - h1;
      turn += turn > 180.0 ? -360.0 : turn < -180.0 ? 360.0 : 0.0;
      float sum = h1 + h2;
      float hue = grey ? sum : abs(h1 - h2) <= 180.0 ? sum / 2.0 : sum < 360.0 ? sum / 2.0 + 180.0 : sum / 2.0 - 180.0;
      float l = 0.5 * (p.x + g.x) - 50.0, c = 0.5 * (c1 + c2);
      float t = 1.0 - 0.17 * cos(radians(hue - 30.0)) + 0.24 * cos(radians(2.0 * hue)) + 0.32 * cos(radians(3.0 * hue + 6.0))
              - 0.2 * cos(radians(4.0 * hue - 63.0));
      float offset = (hue - 275.0) / 25.0;
      float rotation = 60.0 * exp(-offset * offset);
      float dl = (g.x - p.x) / (1.0 + 0.015 * l * l / sqrt(20.0 + l * l));
      float dc = (c2 - c1) / (1.0 + 0.045 * c);
      float dh = 2.0 * sqrt(c1 * c2) * sin(radians(turn / 2.0)) / (1.0 + 0.015 * c * t);
      float cross_ = -2.0 * power7(c) * sin(radians(rotation));
      return sqrt(max(0.0, dl * dl + dc * dc + dh * dh + cross_ * dc * dh));
    }`;
})();

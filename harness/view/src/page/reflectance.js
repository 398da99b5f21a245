"use strict";
// The material as numbers, for the prediction of what a view sees at a texel: the same formula as the shader's.
(() => {
  const view = window.unshadeView;
  const F0 = 0.04;

  const density = (cosine, alpha) => {
    const a2 = alpha * alpha, d = cosine * cosine * (a2 - 1) + 1;
    return a2 / (Math.PI * d * d);
  };
  const masking = (cosine, alpha) => 2 / (1 + Math.sqrt(1 + alpha * alpha * (1 / (cosine * cosine) - 1)));
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

  /// Radiance per unit of light from `l` seen from `v`: `diffuse` (RGB) and `specular`; lobes are two alphas and the
  /// share of the first.
  view.reflect = ({ albedo, specular, diffuseNormal, specularNormal, lobes, facing }, v, l) => {
    if (dot(facing, v) <= 0 || dot(facing, l) <= 0) return { diffuse: [0, 0, 0], specular: 0 };
    const cosine = Math.max(0, dot(diffuseNormal, l)) / Math.PI, found = { diffuse: albedo.map((x) => x * cosine), specular: 0 };
    const nv = dot(specularNormal, v), nl = dot(specularNormal, l);
    if (nv <= 1e-4 || nl <= 0) return found;
    const sum = v.map((x, i) => x + l[i]), size = Math.hypot(...sum), h = sum.map((x) => x / size);
    const nh = dot(specularNormal, h), m = Math.min(1, Math.max(0, 1 - dot(v, h)));
    const fresnel = F0 + (1 - F0) * m ** 5;
    for (const [alpha, share] of [[lobes[0], lobes[2]], [lobes[1], 1 - lobes[2]]]) {
      found.specular += share * density(nh, alpha) * masking(nv, alpha) * masking(nl, alpha) / (4 * nv);
    }
    found.specular *= specular / F0 * fresnel;
    return found;
  };

  /// The visible share of each of the light's cells at a place, by the nearest traced direction.
  view.visibleCells = (head, light, place) => Float32Array.from(light.nearest, (direction) =>
    place.vertices.reduce((sum, vertex, i) => sum + place.weights[i] * head.sees(vertex, direction), 0));

  /// Direct light at a place as `eye` sees it: mean radiance of the `diffuse` and the `specular` part, RGB.
  view.predict = (material, light, visible, place, eye) => {
    const away = eye.map((x, i) => x - place.position.getComponent(i)), size = Math.hypot(...away);
    const v = away.map((x) => x / size), sums = { diffuse: [0, 0, 0], specular: [0, 0, 0] };
    for (let cell = 0; cell < light.cells.length; cell++) {
      const { direction, solid } = light.cells[cell];
      if (!visible[cell]) continue;
      const part = view.reflect(material, v, direction);
      for (let c = 0; c < 3; c++) {
        const energy = light.radiance[3 * cell + c] * solid * visible[cell];
        sums.diffuse[c] += part.diffuse[c] * energy;
        sums.specular[c] += part.specular * energy;
      }
    }
    return sums;
  };

  /// The irradiance at a place, by luminance: `all`, as if nothing blocked the light, and the unblocked part of it.
  view.irradiance = (light, visible, place) => {
    const n = place.normal.toArray();
    let open = 0, all = 0;
    light.cells.forEach(({ direction, solid }, cell) => {
      const e = Math.max(0, dot(n, direction)) * solid * view.luminance(light.radiance.subarray(3 * cell, 3 * cell + 3));
      all += e;
      open += e * visible[cell];
    });
    return { open, all };
  };
})();

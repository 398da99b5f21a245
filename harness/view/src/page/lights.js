"use strict";
// Lights: a lamp, and surroundings as lat-long pictures. Directions as in docs/conventions.md: d = (sin t sin p, cos t,
// -sin t cos p), p = 2 pi u, t = pi v, rows from the top.
(() => {
  const view = window.unshadeView;
  const { width: COLUMNS, height: ROWS } = view.PREFILTERED;

  const toward = (p, t) => [Math.sin(t) * Math.sin(p), Math.cos(t), -Math.sin(t) * Math.cos(p)];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

  const CELLS = Array.from({ length: COLUMNS * ROWS }, (_, i) => {
    const row = Math.floor(i / COLUMNS), edge = (at) => Math.cos(Math.PI * at / ROWS);
    return {
      direction: toward(2 * Math.PI * (i % COLUMNS + 0.5) / COLUMNS, Math.PI * (row + 0.5) / ROWS),
      solid: 2 * Math.PI / COLUMNS * (edge(row) - edge(row + 1)),
    };
  });

  // Mean radiance in each cell of a lat-long picture that is turned about the vertical axis; `poles`: the first and the
  // last row lie on the poles.
  const inCells = ({ width, height, numbers, channels, poles }, turn) => {
    const fine = Math.max(1, Math.ceil(2 * COLUMNS / width)), sums = new Float64Array(4 * CELLS.length);
    for (let y = 0; y < height * fine; y++) {
      const place = (at) => poles ? Math.min(1, Math.max(0, (at / fine - 0.5) / (height - 1))) : at / fine / height;
      const [top, below] = [place(y) * Math.PI, place(y + 1) * Math.PI], solid = Math.cos(top) - Math.cos(below);
      const row = Math.min(ROWS - 1, Math.floor((top + below) / 2 / Math.PI * ROWS));
      for (let x = 0; x < width * fine; x++) {
        const u = (((x + 0.5) / fine / width + turn / 360) % 1 + 1) % 1;
        const cell = 4 * (row * COLUMNS + Math.min(COLUMNS - 1, Math.floor(u * COLUMNS)));
        const from = (Math.floor(y / fine) * width + Math.floor(x / fine)) * channels;
        for (let c = 0; c < 3; c++) sums[cell + c] += solid * numbers[from + c];
        sums[cell + 3] += solid;
      }
    }
    const radiance = new Float32Array(3 * CELLS.length);
    for (let i = 0; i < CELLS.length; i++) {
      for (let c = 0; c < 3; c++) radiance[3 * i + c] = sums[4 * i + 3] > 0 ? sums[4 * i + c] / sums[4 * i + 3] : 0;
    }
    return radiance;
  };

  const nearestOf = (directions) => Uint8Array.from(CELLS, ({ direction }) => {
    let best = 0;
    directions.forEach((other, i) => { if (dot(direction, other) > dot(direction, directions[best])) best = i; });
    return best;
  });

  // The vertices whose irradiance sets the exposure: those of the front.
  const front = (head, most) => {
    const normals = head.geometry.attributes.normal.array, step = Math.max(1, Math.floor(head.vertices / most));
    return Array.from({ length: Math.ceil(head.vertices / step) }, (_, i) => i * step).filter((i) => normals[3 * i + 2] > 0);
  };

  /// The factor that makes the largest unblocked irradiance over the face's front pi.
  view.exposureOf = (head, radiance) => {
    const normals = head.geometry.attributes.normal.array;
    const energy = CELLS.map(({ solid }, i) => solid * view.luminance(radiance.subarray(3 * i, 3 * i + 3)));
    let largest = 0;
    for (const i of front(head, 400)) {
      const n = normals.subarray(3 * i, 3 * i + 3);
      let sum = 0;
      CELLS.forEach(({ direction }, cell) => { sum += energy[cell] * Math.max(0, dot(n, direction)); });
      largest = Math.max(largest, sum);
    }
    return largest > 0 ? Math.PI / largest : 1;
  };

  /// The surroundings that a lat-long picture shows: `exposed` scales it as the project's lights are.
  view.surroundings = (head, picture, turn, exposed) => {
    head.nearest ??= nearestOf(head.directions);
    const radiance = inCells(picture, turn);
    if (exposed) {
      const factor = view.exposureOf(head, radiance);
      radiance.forEach((value, i) => { radiance[i] = value * factor; });
    }
    return { radiance, cells: CELLS, nearest: head.nearest };
  };

  // A compact source: cells within this angle of its centre, with this share of all the light.
  const SOURCE = Math.cos(8 * Math.PI / 180), AROUND = Math.cos(16 * Math.PI / 180), SHARE = 0.25;

  /// Surroundings as a compact source and the rest, for sharp shadows: `source` has its `direction` and the `irradiance`
  /// (RGB) that it adds to the radiance around it; null if no small part of the sphere has a quarter of the light.
  view.split = (light) => {
    const energy = light.cells.map(({ solid }, i) => solid * view.luminance(light.radiance.subarray(3 * i, 3 * i + 3)));
    const all = energy.reduce((sum, e) => sum + e, 0), brightest = energy.reduce((best, e, i) => e / light.cells[i].solid > energy[best] / light.cells[best].solid ? i : best, 0);
    const within = (centre, cosine) => light.cells.flatMap(({ direction }, i) => dot(direction, centre) >= cosine ? [i] : []);
    const middle = new THREE.Vector3();
    for (const i of within(light.cells[brightest].direction, SOURCE)) middle.addScaledVector(new THREE.Vector3(...light.cells[i].direction), energy[i]);
    const direction = middle.normalize().toArray(), members = within(direction, SOURCE);
    if (members.reduce((sum, i) => sum + energy[i], 0) < SHARE * all) return { source: null, rest: light };
    const ring = within(direction, AROUND).filter((i) => !members.includes(i)), irradiance = [0, 0, 0], radiance = light.radiance.slice();
    for (let c = 0; c < 3; c++) {
      const mean = ring.reduce((sum, i) => sum + light.radiance[3 * i + c], 0) / ring.length;
      for (const i of members) {
        irradiance[c] += (light.radiance[3 * i + c] - mean) * light.cells[i].solid;
        radiance[3 * i + c] = mean;
      }
    }
    return { source: { direction, irradiance }, rest: { ...light, radiance } };
  };

  /// Radiance 1 from everywhere.
  view.EVEN = { width: 1, height: 1, channels: 3, numbers: [1, 1, 1], poles: false };

  // Real spherical harmonics up to the second order.
  const basis = ([x, y, z]) => [0.282095, 0.488603 * y, 0.488603 * z, 0.488603 * x, 1.092548 * x * y, 1.092548 * y * z,
    0.315392 * (3 * z * z - 1), 1.092548 * x * z, 0.546274 * (x * x - y * y)];

  /// For each vertex the harmonics of the light that it sees (27 numbers) and its ambient visibility.
  view.visibleHarmonics = (head, light) => {
    const count = head.directions.length, terms = new Float32Array(27 * count);
    light.cells.forEach(({ solid }, cell) => {
      const direction = light.nearest[cell];
      for (let c = 0; c < 3; c++) terms[27 * direction + c] += light.radiance[3 * cell + c] * solid;
    });
    head.directions.forEach((direction, i) => {
      const flux = [...terms.subarray(27 * i, 27 * i + 3)];
      basis(direction).forEach((value, k) => flux.forEach((energy, c) => { terms[27 * i + 3 * k + c] = value * energy; }));
    });
    const normals = head.geometry.attributes.normal.array, found = new Float32Array(28 * head.vertices);
    for (let vertex = 0; vertex < head.vertices; vertex++) {
      const n = normals.subarray(3 * vertex, 3 * vertex + 3), to = 28 * vertex;
      let open = 0, all = 0;
      for (let i = 0; i < count; i++) {
        const cosine = Math.max(0, dot(n, head.directions[i]));
        all += cosine;
        if (!head.sees(vertex, i)) continue;
        open += cosine;
        for (let k = 0; k < 27; k++) found[to + k] += terms[27 * i + k];
      }
      found[to + 27] = all > 0 ? open / all : 0;
    }
    return found;
  };

  /// A lamp around the head: its `position`, and the `intensity` (W/sr, RGB) that exposes the face as the project does.
  view.lampAt = (head, { azimuth, elevation, distance }) => {
    const [a, e] = [azimuth, elevation].map((degrees) => degrees * Math.PI / 180);
    const way = new THREE.Vector3(Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e));
    return view.lampFrom(head, way.multiplyScalar(distance).add(head.centre));
  };
  view.lampFrom = (head, position) => {
    const { position: places, normal } = head.geometry.attributes;
    let largest = 0;
    for (const i of front(head, Infinity)) {
      const x = position.x - places.getX(i), y = position.y - places.getY(i), z = position.z - places.getZ(i);
      const d = Math.hypot(x, y, z);
      largest = Math.max(largest, (x * normal.getX(i) + y * normal.getY(i) + z * normal.getZ(i)) / d ** 3);
    }
    return { position, intensity: Array(3).fill(largest > 0 ? Math.PI / largest : 0) };
  };

  /// A lat-long picture from a dropped .hdr or .exr file. Throws an `Error` for what is none.
  view.readSurroundings = async (file) => {
    const bytes = await file.arrayBuffer(), isExr = file.name.toLowerCase().endsWith(".exr");
    const loader = isExr ? new THREE.EXRLoader() : new THREE.HDRLoader();
    loader.setDataType?.(THREE.FloatType);
    loader.type = THREE.FloatType;
    let found;
    try {
      found = loader.parse(bytes);
    } catch (error) {
      throw new Error(file.name + " cannot be read as a " + (isExr ? "OpenEXR" : "Radiance") + " picture: " + (error.message ?? error));
    }
    const { width, height, data } = found, channels = data.length / width / height;
    if (Math.abs(width - 2 * height) > Math.max(2, width / 100)) {
      throw new Error(file.name + " is " + width + " x " + height + "; drop a lat-long picture of 2 : 1");
    }
    // EXR data start at the bottom row, Radiance data at the top.
    const numbers = new Float32Array(3 * width * height), flipped = isExr;
    for (let i = 0; i < width * height; i++) {
      const row = Math.floor(i / width), from = ((flipped ? height - 1 - row : row) * width + i % width) * channels;
      for (let c = 0; c < 3; c++) numbers[3 * i + c] = Math.max(0, data[from + Math.min(c, channels - 1)]) || 0;
    }
    return { width, height, channels: 3, numbers, poles: false };
  };
})();

"use strict";
// The head's mesh: decoded, picked, with the directions that each vertex sees.
(() => {
  const view = window.unshadeView;

  // The spiral of equal solid angles in which visibility was traced.
  const spiral = (count) => Array.from({ length: count }, (_, i) => {
    const y = 1 - (2 * i + 1) / count, angle = Math.PI * (3 - Math.sqrt(5)) * i, radius = Math.sqrt(1 - y * y);
    return [radius * Math.cos(angle), y, radius * Math.sin(angle)];
  });

  const scaled = (array, low, high) => {
    const values = new Float32Array(array.codes.length);
    for (let i = 0; i < values.length; i++) {
      const c = i % array.channels;
      values[i] = low[c] + (high[c] - low[c]) * array.codes[i] / 65535;
    }
    return values;
  };

  /// Loads the mesh of the manifest: a three.js geometry with its `bits` of visible `directions` per vertex.
  view.loadHead = async (mesh) => {
    const names = ["positions", "normals", "uvs", "triangles", "visibility"];
    const [positions, normals, uvs, triangles, visibility] = await Promise.all(names.map((name) => view.load(mesh[name])));
    const geometry = new THREE.BufferGeometry();
    const attribute = (values, size) => new THREE.BufferAttribute(values, size);
    geometry.setAttribute("position", attribute(scaled(positions, mesh.low, mesh.high), 3));
    geometry.setAttribute("normal", attribute(scaled(normals, [-1, -1, -1], [1, 1, 1]), 3));
    geometry.setAttribute("uv", attribute(scaled(uvs, [0, 0], [1, 1]), 2));
    geometry.setIndex(attribute(triangles.codes, 1));
    geometry.computeBoundingSphere();
    const head = {
      geometry,
      vertices: positions.width,
      directions: spiral(8 * visibility.channels),
      bits: visibility.codes,
      bytes: visibility.channels,
      centre: geometry.boundingSphere.center,
      radius: geometry.boundingSphere.radius,
    };
    head.sees = (vertex, direction) => (head.bits[vertex * head.bytes + (direction >> 3)] >> (direction & 7)) & 1;
    return head;
  };

  const corner = (attribute, index) => new THREE.Vector3().fromBufferAttribute(attribute, index);

  const blend = (attribute, place) => {
    const sum = new THREE.Vector3();
    place.vertices.forEach((vertex, i) => sum.addScaledVector(corner(attribute, vertex), place.weights[i]));
    return sum;
  };

  const placed = (head, vertices, weights) => {
    const place = { vertices, weights }, { position, normal, uv } = head.geometry.attributes;
    const [a, b, c] = vertices.map((vertex) => corner(position, vertex));
    place.position = blend(position, place);
    place.normal = blend(normal, place).normalize();
    place.facing = b.clone().sub(a).cross(c.clone().sub(a)).normalize();
    place.uv = [0, 1].map((axis) => weights.reduce((sum, w, i) => sum + w * uv.array[2 * vertices[i] + axis], 0));
    return place;
  };

  /// The place where a ray meets the head first: vertices and weights, position, normals and texture coordinates.
  view.pick = (head, mesh, raycaster) => {
    const hit = raycaster.intersectObject(mesh, false)[0];
    if (!hit) return null;
    const vertices = [hit.face.a, hit.face.b, hit.face.c];
    const [a, b, c] = vertices.map((vertex) => corner(head.geometry.attributes.position, vertex));
    const area = new THREE.Vector3().crossVectors(b.clone().sub(a), c.clone().sub(a));
    const weight = (p, q) => p.clone().sub(hit.point).cross(q.clone().sub(hit.point)).dot(area) / area.lengthSq();
    const first = weight(b, c), second = weight(c, a);
    return placed(head, vertices, [first, second, 1 - first - second]);
  };

  /// The place with these texture coordinates, or null outside the chart.
  view.placeAt = (head, u, v) => {
    const uv = head.geometry.attributes.uv.array, index = head.geometry.index.array;
    for (let i = 0; i < index.length; i += 3) {
      const [a, b, c] = [2 * index[i], 2 * index[i + 1], 2 * index[i + 2]];
      const [x1, y1, x2, y2] = [uv[b] - uv[a], uv[b + 1] - uv[a + 1], uv[c] - uv[a], uv[c + 1] - uv[a + 1]];
      const [x, y, area] = [u - uv[a], v - uv[a + 1], x1 * y2 - x2 * y1];
      if (area === 0) continue;
      const second = (x * y2 - x2 * y) / area, third = (x1 * y - x * y1) / area;
      if (second >= -1e-6 && third >= -1e-6 && second + third <= 1 + 1e-6) {
        return placed(head, [index[i], index[i + 1], index[i + 2]], [1 - second - third, second, third]);
      }
    }
    return null;
  };
})();

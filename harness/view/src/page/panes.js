"use strict";
// The panes: one renderer, one camera, one mesh; each pane has its own material and its own part of the canvas.
(() => {
  const view = window.unshadeView;
  const SHADOW = 2048;

  // An array of half floats as a texture with mip levels; channels are repeated or filled with ones.
  const halfTexture = (renderer, array, fourth) => {
    const count = array.width * array.height, codes = new Uint16Array(4 * count), last = array.channels - 1;
    const from = view.halves(array), alpha = fourth && view.halves(fourth);
    for (let i = 0; i < count; i++) {
      for (let c = 0; c < 3; c++) codes[4 * i + c] = from[i * array.channels + Math.min(c, last)];
      codes[4 * i + 3] = alpha ? alpha[i] : 0;
    }
    const texture = new THREE.DataTexture(codes, array.width, array.height, THREE.RGBAFormat, THREE.HalfFloatType);
    texture.magFilter = THREE.LinearFilter;
    texture.minFilter = THREE.LinearMipmapLinearFilter;
    texture.generateMipmaps = true;
    texture.anisotropy = Math.min(8, renderer.capabilities.getMaxAnisotropy());
    texture.needsUpdate = true;
    return texture;
  };

  const byteTexture = (array, value) => {
    const count = array.width * array.height, codes = new Uint8Array(4 * count);
    for (let i = 0; i < count; i++) codes[4 * i] = value(i);
    const texture = new THREE.DataTexture(codes, array.width, array.height, THREE.RGBAFormat, THREE.UnsignedByteType);
    texture.needsUpdate = true;
    return texture;
  };

  const floatTexture = (values, width, height) => {
    const texture = new THREE.DataTexture(values, width, height, THREE.RGBAFormat, THREE.FloatType);
    texture.needsUpdate = true;
    return texture;
  };

  const constant = (values) => floatTexture(new Float32Array(values), 1, 1);

  /// The stage: draws panes of the manifest `scene` with `head`. Throws an `Error` without WebGL 2.
  view.Stage = class {
    constructor(canvas, scene, head) {
      this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
      this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
      this.renderer.autoClear = false;
      Object.assign(this, { scene, head, textures: new Map(), blank: constant([0, 0, 0, 0]) });
      this.standardLobes = constant([0.15, 0.35, 0.5, 0]);
      this.world = new THREE.Scene();
      this.mesh = new THREE.Mesh(head.geometry, null);
      this.mesh.frustumCulled = false;
      this.world.add(this.mesh);
      this.camera = new THREE.PerspectiveCamera(25, 1, 0.1 * head.radius, 100 * head.radius);
      this.fov = 25;
      this.materials = new Map(scene.panes.map((pane) => [pane.id, view.paneMaterial(this.blank)]));
      this.shadow = new THREE.WebGLRenderTarget(SHADOW, SHADOW, {
        type: THREE.FloatType, minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter,
      });
      this.depth = view.depthMaterial();
      const { width, height, levels } = view.PREFILTERED;
      this.prefiltered = new THREE.WebGLRenderTarget(width, height * levels, {
        type: THREE.HalfFloatType, wrapS: THREE.RepeatWrapping, depthBuffer: false,
      });
      this.setHarmonics(new Float32Array(28 * head.vertices));
    }

    setHarmonics(numbers) {
      const { geometry } = this.head;
      if (this.harmonics) {
        this.harmonics.array.set(numbers);
        this.harmonics.needsUpdate = true;
        return;
      }
      this.harmonics = new THREE.InterleavedBuffer(numbers, 28);
      for (let i = 0; i < 7; i++) {
        geometry.setAttribute("sh" + i, new THREE.InterleavedBufferAttribute(this.harmonics, 4, 4 * i));
      }
    }

    /// Lights the head by surroundings; a compact source in them shines as a lamp does.
    setSurroundings(surroundings) {
      const { source, rest: light } = view.split(surroundings), far = 1000 * this.head.radius;
      this.lamp = null;
      // So far away that its irradiance is the same all over the head.
      if (source) {
        const position = new THREE.Vector3(...source.direction).multiplyScalar(far).add(this.head.centre);
        this.setLamp({ position, intensity: source.irradiance.map((e) => e * far * far) });
      }
      this.surroundings = light;
      this.setHarmonics(view.visibleHarmonics(this.head, light));
      const { width, height } = view.PREFILTERED, values = new Float32Array(4 * width * height);
      for (let i = 0; i < width * height; i++) values.set(light.radiance.subarray(3 * i, 3 * i + 3), 4 * i);
      const material = view.prefilterMaterial(floatTexture(values, width, height));
      const quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), material), flat = new THREE.Scene();
      quad.frustumCulled = false;
      flat.add(quad);
      this.renderer.setRenderTarget(this.prefiltered);
      this.renderer.render(flat, this.camera);
      this.renderer.setRenderTarget(null);
      material.uniforms.light.value.dispose();
      material.dispose();
      quad.geometry.dispose();
    }

    /// Lights the head by a lamp alone, and draws its depth map.
    setLamp(lamp) {
      this.lamp = lamp;
      this.surroundings = null;
      const { centre, radius } = this.head, distance = lamp.position.distanceTo(centre);
      // The narrowest cone around the head; from inside its sphere, a wide one.
      const tangent = distance > 1.05 * radius ? radius / Math.sqrt(distance * distance - radius * radius) : 3;
      const near = Math.max(0.02 * radius, distance - radius), eye = new THREE.PerspectiveCamera(
        2 * Math.atan(tangent) * 180 / Math.PI, 1, 0.9 * near, distance + 1.1 * radius);
      eye.position.copy(lamp.position);
      if (Math.abs(lamp.position.x - centre.x) + Math.abs(lamp.position.z - centre.z) < 1e-3 * distance) eye.up.set(0, 0, 1);
      eye.lookAt(centre);
      eye.updateMatrixWorld();
      this.depth.uniforms.lamp.value.copy(lamp.position);
      this.mesh.material = this.depth;
      this.renderer.setRenderTarget(this.shadow);
      // No distance: nothing is in the way.
      this.renderer.setClearColor(0, 0);
      this.renderer.clear();
      this.renderer.render(this.world, eye);
      this.renderer.setRenderTarget(null);
      const [right, up, back] = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
      eye.matrixWorld.extractBasis(right, up, back);
      this.cone = { tangent, right, up, forward: back.negate(), texel: 2 * tangent / SHADOW };
    }

    map(pane, name) {
      const stored = pane.maps.find(([own]) => own === name);
      return stored ? view.load(stored[1]) : null;
    }

    async texture(key, make) {
      if (!this.textures.has(key)) {
        const texture = await make();
        this.textures.set(key, texture);
      }
      return this.textures.get(key);
    }

    async mapTexture(pane, name) {
      const found = this.map(pane, name);
      return found && this.texture(pane.id + "/" + name, async () => halfTexture(this.renderer, await found));
    }

    /// Loads what a pane needs for a layer and sets its material; returns a sentence where the pane lacks it.
    async prepare(pane, layer, oneFactor) {
      const material = this.materials.get(pane.id), { uniforms } = material, shown = view.layerOf(layer, pane);
      uniforms.factor.value = oneFactor && pane.factor ? pane.factor : 1;
      const value = await this.valueOf(pane, shown);
      if (value === null) return "no " + layer.title.replace("error of the ", "");
      const mode = view.MODES[shown.mode];
      if (mode <= 2) {
        const names = ["diffuse_normal", "specular_normal", "roughness"];
        const [albedo, ...rest] = await Promise.all([
          this.texture(pane.id + "/surface", async () => {
            const [colour, specular] = await Promise.all([this.map(pane, "diffuse_albedo"), this.map(pane, "specular_albedo")]);
            return halfTexture(this.renderer, colour, specular);
          }),
          ...names.map((name) => this.mapTexture(pane, name)),
        ]);
        uniforms.albedoMap.value = albedo;
        uniforms.diffuseNormalMap.value = rest[0] ?? this.blank;
        uniforms.specularNormalMap.value = rest[1] ?? this.blank;
        uniforms.roughnessMap.value = rest[2] ?? this.standardLobes;
      } else {
        uniforms.valueMap.value = value;
        const truth = this.scene.panes.find((other) => other.is_truth);
        if (shown.mode.startsWith("error")) uniforms.truthMap.value = await this.mapTexture(truth, shown.id);
      }
      uniforms.mode.value = mode;
      uniforms.channel.value = shown.channel ?? 0;
      uniforms.top.value = shown.top ?? 1;
      uniforms.ramp.value = view.rampUniform(layer.group === "errors" && shown === layer ? "error" : "quantity");
      return "";
    }

    // The texture of a layer of maps; undefined where the layer needs none, null where the pane lacks it.
    async valueOf(pane, shown) {
      if (view.MODES[shown.mode] <= 2) return undefined;
      if (shown.mode === "label") {
        return this.texture("labels", async () => {
          const labels = await view.load(this.scene.labels);
          return byteTexture(labels, (i) => labels.codes[i]);
        });
      }
      if (shown.mode === "views") {
        return this.texture("views", async () => {
          const seen = await view.load(this.scene.views.seen);
          const ones = (byte) => { let sum = 0; for (; byte; byte >>= 1) sum += byte & 1; return sum; };
          return byteTexture(seen, (i) => {
            let sum = 0;
            for (let c = 0; c < seen.channels; c++) sum += ones(seen.codes[i * seen.channels + c]);
            return sum;
          });
        });
      }
      return this.mapTexture(pane, shown.id);
    }

    light(material, exposure) {
      const { uniforms } = material;
      uniforms.exposure.value = exposure;
      uniforms.bright.value = Boolean(this.lamp);
      uniforms.ambient.value = Boolean(this.surroundings);
      uniforms.prefiltered.value = this.prefiltered.texture;
      uniforms.shadowMap.value = this.shadow.texture;
      if (!this.lamp) return;
      uniforms.lamp.value.copy(this.lamp.position);
      uniforms.lampIntensity.value.set(...this.lamp.intensity);
      uniforms.lampForward.value.copy(this.cone.forward);
      uniforms.lampRight.value.copy(this.cone.right);
      uniforms.lampUp.value.copy(this.cone.up);
      uniforms.lampTangent.value = this.cone.tangent;
      uniforms.shadowTexel.value = this.cone.texel;
    }

    aim(width, height) {
      const aspect = width / height, half = Math.tan(this.fov * Math.PI / 360) / Math.min(1, aspect / 0.75);
      this.camera.aspect = aspect;
      this.camera.fov = 360 / Math.PI * Math.atan(half);
      this.camera.updateProjectionMatrix();
      this.camera.updateMatrixWorld();
    }

    /// Draws panes into cells of the canvas: `{pane, x, y, width, height, left, right}`, CSS pixels from the top left;
    /// `left` and `right` cut the cell.
    draw(cells, exposure) {
      const { renderer } = this, height = renderer.domElement.clientHeight;
      renderer.setScissorTest(false);
      renderer.setClearColor(0x14161a, 1);
      renderer.clear();
      renderer.setScissorTest(true);
      for (const cell of cells) {
        const material = this.materials.get(cell.pane.id), bottom = height - cell.y - cell.height;
        this.light(material, exposure);
        material.uniforms.linear.value = false;
        this.mesh.material = material;
        this.aim(cell.width, cell.height);
        renderer.setViewport(cell.x, bottom, cell.width, cell.height);
        renderer.setScissor(cell.left, bottom, cell.right - cell.left, cell.height);
        renderer.render(this.world, this.camera);
      }
      renderer.setScissorTest(false);
    }

    /// Linear values of a pane, RGBA, the top row first: radiance of the light's layers, else the quantity or the error.
    linear(pane, width, height) {
      const target = new THREE.WebGLRenderTarget(width, height, { type: THREE.FloatType, samples: 0 });
      const material = this.materials.get(pane.id), values = new Float32Array(4 * width * height);
      this.light(material, 1);
      material.uniforms.linear.value = true;
      this.mesh.material = material;
      this.aim(width, height);
      this.renderer.setRenderTarget(target);
      this.renderer.setClearColor(0, 0);
      this.renderer.clear();
      this.renderer.render(this.world, this.camera);
      this.renderer.readRenderTargetPixels(target, 0, 0, width, height, values);
      this.renderer.setRenderTarget(null);
      target.dispose();
      const rows = Array.from({ length: height }, (_, y) => values.subarray(4 * width * (height - 1 - y), 4 * width * (height - y)));
      return Float32Array.from(rows.flatMap((row) => [...row]));
    }
  };
})();

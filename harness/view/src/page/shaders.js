"use strict";
// The material in GLSL: the project's formula under a lamp with its shadow and under ambient light with the visibility
// of each vertex; maps and errors in false colour.
(() => {
  const view = window.unshadeView;

  view.MODES = {
    shaded: 0, diffuse: 1, specular: 2, colour: 3, normal: 4, quantity: 5, label: 6, views: 7,
    "error-colour": 8, "error-normal": 9, "error-quantity": 10,
  };
  view.PREFILTERED = { width: 64, height: 32, levels: 8 };

  const VERTEX = `
    in vec4 sh0, sh1, sh2, sh3, sh4, sh5, sh6;
    out vec3 place, meshNormal;
    out vec2 texel;
    out vec4 light0, light1, light2, light3, light4, light5, light6;
    void main() {
      place = position;
      meshNormal = normal;
      texel = vec2(uv.x, 1.0 - uv.y);
      light0 = sh0; light1 = sh1; light2 = sh2; light3 = sh3; light4 = sh4; light5 = sh5; light6 = sh6;
      gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
    }`;

  const FRAGMENT = `
    precision highp float;
    in vec3 place, meshNormal;
    in vec2 texel;
    in vec4 light0, light1, light2, light3, light4, light5, light6;
    out vec4 result;
    uniform sampler2D albedoMap, diffuseNormalMap, specularNormalMap, roughnessMap, valueMap, truthMap, shadowMap, prefiltered;
    uniform int mode, channel;
    uniform bool linear, bright, ambient;
    uniform float exposure, factor, bottom, top, shadowTexel;
    uniform vec3 lamp, lampIntensity, lampForward, lampRight, lampUp, ramp[10], palette[8];
    uniform float lampTangent;
    const float PI = 3.14159265358979, F0 = 0.04;
    {colours}

    vec3 direction(sampler2D map, vec3 mesh) {
      vec3 n = texture(map, texel).xyz;
      float size = dot(n, n);
      return size > 1e-8 ? n * inversesqrt(size) : mesh;
    }
    float schlick(float cosine) {
      float m = clamp(1.0 - cosine, 0.0, 1.0);
      return F0 + (1.0 - F0) * m * m * m * m * m;
    }
    float density(float cosine, float alpha) {
      float a2 = alpha * alpha, d = cosine * cosine * (a2 - 1.0) + 1.0;
      return a2 / (PI * d * d);
    }
    float masking(float cosine, float alpha) {
      return 2.0 / (1.0 + sqrt(1.0 + alpha * alpha * (1.0 / (cosine * cosine) - 1.0)));
    }
    // Reflected radiance per irradiance, times the cosine; as synth/unshade/render/skin_bsdf.py.
    float highlight(vec3 n, vec3 v, vec3 l, vec3 lobes) {
      float nv = dot(n, v), nl = dot(n, l);
      if (nv <= 1e-4 || nl <= 0.0) return 0.0;
      vec3 h = normalize(v + l);
      float nh = dot(n, h);
      float first = density(nh, lobes.x) * masking(nv, lobes.x) * masking(nl, lobes.x);
      float second = density(nh, lobes.y) * masking(nv, lobes.y) * masking(nl, lobes.y);
      return mix(second, first, lobes.z) / (4.0 * nv) / F0 * schlick(dot(v, h));
    }
    float lit(vec3 facing, vec3 toLamp, float distance_) {
      vec3 from = place - lamp;
      float depth = dot(from, lampForward);
      vec2 at = vec2(dot(from, lampRight), dot(from, lampUp)) / (depth * lampTangent) * 0.5 + 0.5;
      float cosine = max(dot(facing, toLamp), 0.05);
      // A texel of the depth map spans this much along the surface, seen from the lamp.
      float bias = 2e-4 + 1.5 * shadowTexel * depth * sqrt(1.0 - cosine * cosine) / cosine;
      vec2 size = vec2(textureSize(shadowMap, 0)), pixel = at * size - 0.5, base = floor(pixel), part = pixel - base;
      float sum = 0.0;
      for (int i = 0; i < 4; i++) {
        vec2 corner = vec2(i & 1, i >> 1);
        float near_ = texelFetch(shadowMap, ivec2(clamp(base + corner, vec2(0.0), size - 1.0)), 0).r;
        vec2 weight = mix(1.0 - part, part, corner);
        sum += weight.x * weight.y * (near_ == 0.0 || distance_ - bias < near_ ? 1.0 : 0.0);
      }
      return sum;
    }
    // Irradiance of the visible light over pi: second order spherical harmonics (Ramamoorthi and Hanrahan 2001).
    vec3 ambientDiffuse(vec3 n) {
      vec3 l00 = light0.xyz, l1m = vec3(light0.w, light1.xy), l10 = vec3(light1.zw, light2.x), l11 = light2.yzw;
      vec3 l2m2 = light3.xyz, l2m1 = vec3(light3.w, light4.xy), l20 = vec3(light4.zw, light5.x), l21 = light5.yzw;
      vec3 l22 = light6.xyz;
      vec3 e = 0.886227 * l00 + 1.023328 * (l1m * n.y + l10 * n.z + l11 * n.x)
             + 0.858086 * (l2m2 * n.x * n.y + l2m1 * n.y * n.z + l21 * n.x * n.z)
             + 0.247708 * l20 * (3.0 * n.z * n.z - 1.0) + 0.429043 * l22 * (n.x * n.x - n.y * n.y);
      return max(e, vec3(0.0)) / PI;
    }
    vec3 filtered(vec3 d, float alpha) {
      float level = clamp(sqrt(alpha), 0.0, 1.0) * float(LEVELS - 1), base = min(floor(level), float(LEVELS - 2));
      float u = atan(d.x, -d.z) / (2.0 * PI);
      float v = clamp(acos(clamp(d.y, -1.0, 1.0)) / PI, 0.5 / float(ROWS), 1.0 - 0.5 / float(ROWS));
      vec3 sharp = textureLod(prefiltered, vec2(u, (base + v) / float(LEVELS)), 0.0).rgb;
      vec3 soft = textureLod(prefiltered, vec2(u, (base + 1.0 + v) / float(LEVELS)), 0.0).rgb;
      return mix(sharp, soft, level - base);
    }
    // The lobe's reflectance in even light, per F0: the fit of Lazarov (2013) as given by Karis (2014).
    float reflectance(float nv, float alpha) {
      vec4 r = sqrt(alpha) * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
      float a = min(r.x * r.x, exp2(-9.28 * nv)) * r.x + r.y;
      vec2 scale = vec2(-1.04, 1.04) * a + r.zw;
      return scale.x + scale.y / F0;
    }
    // Specular occlusion from ambient occlusion (Lagarde and de Rousiers 2014).
    float unblocked(float nv, float open, float alpha) {
      return clamp(pow(nv + open, exp2(-16.0 * sqrt(alpha) - 1.0)) - 1.0 + open, 0.0, 1.0);
    }
    vec3 ramped(float value) {
      float at = clamp(value, 0.0, 1.0) * 9.0;
      int low = min(int(at), 8);
      return mix(ramp[low], ramp[low + 1], at - float(low));
    }
    float angle(vec3 a, vec3 b) { return degrees(atan(length(cross(a, b)), dot(a, b))); }

    void main() {
      vec3 mesh = normalize(meshNormal), facing = normalize(cross(dFdx(place), dFdy(place)));
      vec3 v = normalize(cameraPosition - place);
      vec4 value = texture(valueMap, texel), truth = texture(truthMap, texel);
      if (mode <= 2) {
        vec4 albedo = texture(albedoMap, texel);
        vec3 nd = direction(diffuseNormalMap, mesh), ns = direction(specularNormalMap, mesh);
        vec3 lobes = texture(roughnessMap, texel).xyz;
        lobes = vec3(clamp(lobes.xy, 0.02, 1.0), clamp(lobes.z, 0.0, 1.0));
        vec3 diffuse = vec3(0.0), specular = vec3(0.0);
        if (bright) {
          vec3 toLamp = lamp - place;
          float distance_ = length(toLamp);
          vec3 l = toLamp / distance_;
          if (dot(facing, v) > 0.0 && dot(facing, l) > 0.0) {
            vec3 e = lampIntensity / (distance_ * distance_) * lit(facing, l, distance_);
            diffuse += max(dot(nd, l), 0.0) / PI * e;
            specular += highlight(ns, v, l, lobes) * e;
          }
        }
        if (ambient) {
          float nv = clamp(dot(ns, v), 0.0, 1.0), open = light6.w;
          vec3 r = reflect(-v, ns);
          diffuse += ambientDiffuse(nd);
          for (int k = 0; k < 2; k++) {
            float alpha = k == 0 ? lobes.x : lobes.y, share = k == 0 ? lobes.z : 1.0 - lobes.z;
            specular += share * filtered(r, alpha) * reflectance(nv, alpha) * unblocked(nv, open, alpha);
          }
        }
        vec3 radiance = (mode == 2 ? vec3(0.0) : diffuse * albedo.rgb * factor) + (mode == 1 ? vec3(0.0) : specular * albedo.a);
        result = vec4(linear ? radiance : srgb(radiance * exposure), 1.0);
        return;
      }
      float scalar = 0.0;
      if (mode == 3) { result = vec4(srgb(value.rgb * factor), 1.0); return; }
      if (mode == 4) { result = vec4(direction(valueMap, mesh) * 0.5 + 0.5, 1.0); return; }
      if (mode == 5) scalar = channel == 0 ? value.r : channel == 1 ? value.g : value.b;
      if (mode == 6 || mode == 7) {
        ivec2 size = textureSize(valueMap, 0);
        vec4 code = texelFetch(valueMap, clamp(ivec2(texel * vec2(size)), ivec2(0), size - 1), 0);
        if (mode == 6) { result = vec4(palette[min(int(code.r * 255.0 + 0.5), 7)], 1.0); return; }
        scalar = code.r * 255.0;
      }
      if (mode == 8) scalar = ciede2000(lab(value.rgb * factor), lab(truth.rgb));
      if (mode == 9) scalar = angle(direction(valueMap, mesh), direction(truthMap, mesh));
      if (mode == 10) scalar = abs(value.r - truth.r);
      result = linear ? vec4(scalar, 0.0, 0.0, 1.0) : vec4(ramped((scalar - bottom) / (top - bottom)), 1.0);
    }`;

  const colours = (list) => list.map(([r, g, b]) => new THREE.Vector3(r / 255, g / 255, b / 255));

  /// The material of a pane; its uniforms are set before it is drawn.
  view.paneMaterial = (blank) => new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3,
    defines: { LEVELS: view.PREFILTERED.levels, ROWS: view.PREFILTERED.height },
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT.replace("{colours}", view.GLSL_COLOURS),
    blending: THREE.NoBlending,
    uniforms: Object.fromEntries(Object.entries({
      albedoMap: blank, diffuseNormalMap: blank, specularNormalMap: blank, roughnessMap: blank, valueMap: blank,
      truthMap: blank, shadowMap: blank, prefiltered: blank, mode: 0, channel: 0, linear: false, bright: true, ambient: false,
      exposure: 1, factor: 1, bottom: 0, top: 1, shadowTexel: 0, lampTangent: 1,
      lamp: new THREE.Vector3(), lampIntensity: new THREE.Vector3(), lampForward: new THREE.Vector3(),
      lampRight: new THREE.Vector3(), lampUp: new THREE.Vector3(),
      ramp: colours(view.RAMPS.error), palette: colours(view.PALETTE),
    }).map(([name, value]) => [name, { value }])),
  });
  view.rampUniform = (name) => colours(view.RAMPS[name]);

  /// Distances from the lamp, for its shadows: the whole mesh, both sides.
  view.depthMaterial = () => new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3,
    side: 2,
    uniforms: { lamp: { value: new THREE.Vector3() } },
    vertexShader: `
      out vec3 place;
      void main() { place = position; gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0); }`,
    fragmentShader: `
      precision highp float;
      in vec3 place;
      out vec4 result;
      uniform vec3 lamp;
      void main() { result = vec4(distance(place, lamp), 0.0, 0.0, 1.0); }`,
  });

  /// The light as lobes of each roughness see it, one lat-long picture below the other.
  view.prefilterMaterial = (light) => new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3,
    defines: { LEVELS: view.PREFILTERED.levels, ROWS: view.PREFILTERED.height, COLUMNS: view.PREFILTERED.width },
    uniforms: { light: { value: light } },
    vertexShader: "out vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }",
    fragmentShader: `
      precision highp float;
      in vec2 at;
      out vec4 result;
      uniform sampler2D light;
      const float PI = 3.14159265358979;
      vec3 toward(float u, float v) {
        float p = 2.0 * PI * u, t = PI * v;
        return vec3(sin(t) * sin(p), cos(t), -sin(t) * cos(p));
      }
      void main() {
        float level = floor(at.y * float(LEVELS)), root = level / float(LEVELS - 1), alpha = max(root * root, 0.02);
        vec3 r = toward(at.x, at.y * float(LEVELS) - level);
        // Cells near the reflected direction are met by more half vectors than their centre: average over the cell.
        float spread = PI / float(ROWS) / 4.0, a = sqrt(alpha * alpha + spread * spread), a2 = a * a;
        vec3 sum = vec3(0.0);
        float total = 0.0;
        for (int y = 0; y < ROWS; y++) {
          float solid = cos(PI * float(y) / float(ROWS)) - cos(PI * float(y + 1) / float(ROWS));
          for (int x = 0; x < COLUMNS; x++) {
            vec3 l = toward((float(x) + 0.5) / float(COLUMNS), (float(y) + 0.5) / float(ROWS));
            float cosine = dot(r, l);
            if (cosine <= 0.0) continue;
            // Seen along the normal, the half vector lies midway.
            float half2 = 0.5 * (1.0 + cosine), d = half2 * (a2 - 1.0) + 1.0;
            float weight = a2 / (d * d) * cosine * solid;
            sum += weight * texelFetch(light, ivec2(x, y), 0).rgb;
            total += weight;
          }
        }
        result = vec4(sum / total, 1.0);
      }`,
  });
})();

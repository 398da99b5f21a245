"use strict";
// The layers of the page: what is shown of a pane, by which shader mode, in which unit and on which scale.
(() => {
  const view = window.unshadeView;

  const MAPS = [
    { id: "diffuse_albedo", title: "diffuse albedo", mode: "colour" },
    { id: "specular_albedo", title: "specular albedo", mode: "quantity", top: 0.05, unit: "reflectance" },
    { id: "diffuse_normal", title: "diffuse normal", mode: "normal" },
    { id: "specular_normal", title: "specular normal", mode: "normal" },
    { id: "roughness", title: "roughness, lobe 1", mode: "quantity", top: 0.5, unit: "GGX alpha" },
    { id: "roughness", key: "roughness-2", title: "roughness, lobe 2", mode: "quantity", top: 0.5, unit: "GGX alpha", channel: 1 },
    { id: "roughness", key: "roughness-weight", title: "share of lobe 1", mode: "quantity", top: 1, unit: "0 to 1", channel: 2 },
    { id: "confidence", title: "confidence", mode: "quantity", top: 1, unit: "0 to 1" },
    { id: "diffuse_albedo_std", title: "stated deviation, diffuse albedo", mode: "quantity", channel: 1, unit: "reflectance" },
    { id: "specular_albedo_std", title: "stated deviation, specular albedo", mode: "quantity", unit: "reflectance" },
    { id: "diffuse_normal_std", title: "stated deviation, diffuse normal", mode: "quantity", unit: "radians" },
    { id: "specular_normal_std", title: "stated deviation, specular normal", mode: "quantity", unit: "radians" },
  ];

  const ERRORS = [
    { id: "diffuse_albedo", title: "error of the diffuse albedo", mode: "error-colour", unit: "CIEDE2000" },
    { id: "specular_albedo", title: "error of the specular albedo", mode: "error-quantity", unit: "reflectance" },
    { id: "diffuse_normal", title: "error of the diffuse normal", mode: "error-normal", unit: "degrees" },
    { id: "specular_normal", title: "error of the specular normal", mode: "error-normal", unit: "degrees" },
  ];

  /// The layers that a manifest has data for, in groups.
  view.layersOf = (scene) => {
    const maps = (id) => scene.panes.some((pane) => pane.maps.some(([name]) => name === id));
    const rendered = ["shaded", "diffuse", "specular"].map((id) => ({
      key: id, id, mode: id, group: "light", title: { shaded: "shaded", diffuse: "diffuse part", specular: "specular part" }[id],
    }));
    const shown = MAPS.filter(({ id }) => maps(id))
      .map((layer) => ({ key: layer.key ?? layer.id, group: "maps", top: scene.tops[layer.id] || 1, ...layer }));
    if (scene.labels) shown.push({ key: "labels", id: "labels", group: "maps", title: "labels", mode: "label" });
    shown.push({
      key: "views", id: "views", group: "maps", title: "views that see a texel", mode: "views", unit: "training views",
      top: scene.views.list.length,
    });
    const errors = ERRORS.filter(({ id }) => scene.tops[id] > 0)
      .map((layer) => ({ ...layer, key: "error-" + layer.id, group: "errors", top: scene.tops[layer.id] }));
    return [...rendered, ...shown, ...errors];
  };

  /// How a pane shows a layer: that of the truth's map where an error is shown of the others.
  view.layerOf = (layer, pane) => {
    if (layer.group !== "errors" || !pane.is_truth) return layer;
    return MAPS.find(({ id }) => id === layer.id);
  };

  /// A quantity with as many digits as the scale needs.
  view.written = (value, top) => {
    if (!Number.isFinite(value)) return "–";
    const digits = Math.min(4, Math.max(0, 2 - Math.floor(Math.log10(Math.abs(top) || 1))));
    return value.toFixed(digits);
  };
})();

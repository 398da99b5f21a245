"use strict";
// The worst patches of the methods, a click away.
(() => {
  const view = window.unshadeView;

  /// Fills `list` with the ten worst patches of a measure; `go` gets the texture coordinates of one.
  view.listWorst = (list, heading, scene, layer, go) => {
    const measure = layer?.group === "errors" ? layer.id : "diffuse_albedo";
    const errors = view.layersOf(scene).find(({ key }) => key === "error-" + measure);
    const patches = scene.panes.flatMap((pane) => pane.worst.filter((patch) => patch.measure === measure)
      .map((patch) => ({ ...patch, pane })));
    const stated = patches.some(({ over_stated }) => over_stated !== null);
    const rank = (patch) => stated ? patch.over_stated ?? -1 : patch.value;
    patches.sort((a, b) => rank(b) - rank(a));
    heading.hidden = list.hidden = !patches.length;
    if (!patches.length) return;
    heading.textContent = "Worst spots: " + errors.title.replace("error of the ", "") + (stated ? ", error over stated deviation" : "");
    list.replaceChildren(...patches.slice(0, 10).map((patch) => {
      const item = document.createElement("li"), button = document.createElement("button");
      button.type = "button";
      const region = scene.label_names[patch.label];
      const over = patch.over_stated === null ? "" : `, ${patch.over_stated.toFixed(1)} × stated`;
      button.textContent = `${patch.pane.title}: ${view.written(patch.value, errors.top)} ${errors.unit}${over}${region ? ", " + region : ""}`;
      button.addEventListener("click", () => go(patch.uv, errors));
      item.append(button);
      return item;
    }));
  };
})();

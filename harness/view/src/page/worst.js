"use strict";
// The worst patches of the methods, a click away.
(() => {
  const view = window.unshadeView;

  /// Fills `list` with the ten worst patches of a measure, of the method that `choice` names; `go` gets the texture
  /// coordinates of one.
  view.listWorst = ({ section, choice, list }, scene, head, layer, go) => {
    const measure = layer?.group === "errors" ? layer.id : "diffuse_albedo";
    const errors = view.layersOf(scene).find(({ key }) => key === "error-" + measure);
    const pane = scene.panes.find(({ id }) => id === choice.value);
    const patches = (pane?.worst ?? []).filter((patch) => patch.measure === measure);
    section.hidden = !scene.panes.some(({ worst }) => worst.length);
    section.querySelector(".measure").textContent = errors ? errors.title.replace("error of the ", "") : "";
    list.replaceChildren(...patches.map((patch) => {
      const item = document.createElement("li"), button = document.createElement("button");
      button.type = "button";
      const region = scene.label_names[patch.label], place = view.placeAt(head, ...patch.uv);
      const over = patch.over_stated === null ? "" : `, ${patch.over_stated.toFixed(1)} times what the method states`;
      button.textContent = `${view.written(patch.value, errors.top)} ${errors.unit}${over}${region ? ", " + region : ""}${place ? ", " + view.facing(place.normal) : ""}`;
      button.addEventListener("click", () => go(patch.uv, errors));
      item.append(button);
      return item;
    }));
    if (!patches.length && pane) list.replaceChildren(Object.assign(document.createElement("p"), { className: "caption", textContent: "The method has no such map." }));
  };
})();

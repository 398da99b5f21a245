"use strict";
// The worst patches of the methods, a click away.
(() => {
  const view = window.unshadeView;

  const MOST_TIMES = 100;

  /// Fills `list` with the ten worst patches of a measure, of the method that `choice` names; `go` gets the texture
  /// coordinates of one. The patch at `spot` is marked.
  view.listWorst = ({ section, choice, list }, scene, head, layer, spot, go) => {
    const measure = layer?.group === "errors" ? layer.id : "diffuse_albedo";
    const errors = view.layersOf(scene).find(({ key }) => key === "error-" + measure);
    const pane = scene.panes.find(({ id }) => id === choice.value);
    const patches = (pane?.worst ?? []).filter((patch) => patch.measure === measure);
    section.hidden = !scene.panes.some(({ worst }) => worst.length);
    section.querySelector(".measure").textContent = errors
      ? `${errors.title.replace("error of the ", "")}: mean ${errors.unit} of a patch of the texture` : "";
    list.replaceChildren(...patches.map((patch) => {
      const item = document.createElement("li"), button = document.createElement("button");
      button.type = "button";
      const region = scene.label_names[patch.label], place = view.placeAt(head, ...patch.uv);
      const times = patch.over_stated > MOST_TIMES ? `over ${MOST_TIMES}` : patch.over_stated?.toFixed(1);
      const over = patch.over_stated === null ? "" : `, ${times} times what the method states`;
      if (spot?.every((x, k) => Math.abs(x - patch.uv[k]) < 1e-4)) button.setAttribute("aria-current", "true");
      button.textContent = `${view.written(patch.value, errors.top)} ${errors.unit}${over}${region ? ", " + region : ""}${place ? ", " + view.facing(place.normal) : ""}`;
      button.addEventListener("click", () => go(patch.uv, errors));
      item.append(button);
      return item;
    }));
    if (!patches.length && pane) list.replaceChildren(Object.assign(document.createElement("p"), { className: "caption", textContent: "The method has no such map." }));
  };
})();

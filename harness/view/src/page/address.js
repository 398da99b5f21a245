"use strict";
// The state of the page in its address: a link shows another reader the same picture.
(() => {
  const view = window.unshadeView;
  const short = (numbers, digits) => numbers.map((value) => Number(value.toFixed(digits))).join(",");

  /// The part of an address that restores `state`.
  view.toAddress = (state) => {
    const parts = {
      camera: short(state.camera.slice(0, 2), 2) + "," + short(state.camera.slice(2), 4),
      lens: short([state.lens], 3),
      light: state.light,
      lamp: short([state.lamp.azimuth, state.lamp.elevation, state.lamp.distance], 2),
      turn: short([state.turn], 1),
      layer: state.layer,
      exposure: String(state.exposure),
      factor: state.factor ? "1" : "0",
      panes: state.shown.join(","),
      swipe: state.swipe === null ? "" : short([state.swipe], 3),
      spot: state.spot ? short(state.spot, 6) : "",
    };
    return "#" + Object.entries(parts).filter(([, value]) => value !== "").map(([key, value]) => key + "=" + encodeURIComponent(value)).join("&");
  };

  /// Changes `state` to what an address states; what it does not state, or states wrongly, stays.
  view.fromAddress = (hash, state, known) => {
    const given = new URLSearchParams(hash.replace(/^#/, ""));
    const numbers = (key, count) => {
      const found = (given.get(key) ?? "").split(",").map(Number);
      return given.has(key) && found.length === count && found.every(Number.isFinite) ? found : null;
    };
    const one = (key) => numbers(key, 1)?.[0];
    state.camera = numbers("camera", 6) ?? state.camera;
    state.lens = one("lens") ?? state.lens;
    if (known.lights.includes(given.get("light"))) state.light = given.get("light");
    const lamp = numbers("lamp", 3);
    if (lamp) [state.lamp.azimuth, state.lamp.elevation, state.lamp.distance] = lamp;
    state.turn = one("turn") ?? state.turn;
    if (known.layers.includes(given.get("layer"))) state.layer = given.get("layer");
    state.exposure = one("exposure") ?? state.exposure;
    if (given.has("factor")) state.factor = given.get("factor") !== "0";
    const shown = (given.get("panes") ?? "").split(",").filter((id) => known.panes.includes(id));
    if (shown.length) state.shown = shown;
    if (given.has("layer")) state.swipe = one("swipe") ?? null;
    state.spot = numbers("spot", 2) ?? state.spot;
  };
})();

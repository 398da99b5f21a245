"use strict";
// The round pad with the lamp: the middle is in front of the face, the rim behind the head. Drag it, or use arrow keys.
(() => {
  const view = window.unshadeView;
  const DEGREES = Math.PI / 180;

  const toAngles = (x, y) => {
    const polar = Math.min(1, Math.hypot(x, y)) * Math.PI, around = Math.atan2(y, x);
    const d = [Math.sin(polar) * Math.cos(around), Math.sin(polar) * Math.sin(around), Math.cos(polar)];
    return { azimuth: Math.atan2(d[0], d[2]) / DEGREES, elevation: Math.asin(d[1]) / DEGREES };
  };

  const toPlace = ({ azimuth, elevation }) => {
    const [a, e] = [azimuth * DEGREES, elevation * DEGREES];
    const d = [Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e)];
    const polar = Math.acos(Math.min(1, Math.max(-1, d[2]))) / Math.PI, size = Math.hypot(d[0], d[1]) || 1;
    return [polar * d[0] / size, polar * d[1] / size];
  };

  /// Wires the pad: `changed` gets the new azimuth and elevation, degrees; returns a function that shows a lamp.
  view.wirePad = (pad, lamp, changed) => {
    const knob = pad.querySelector(".knob");
    const show = () => {
      const [x, y] = toPlace(lamp);
      knob.style.left = 50 + 50 * x + "%";
      knob.style.top = 50 - 50 * y + "%";
      pad.setAttribute("aria-valuetext", `azimuth ${Math.round(lamp.azimuth)}°, elevation ${Math.round(lamp.elevation)}°`);
      pad.setAttribute("aria-valuenow", Math.round(lamp.azimuth));
    };
    const drag = (event) => {
      const box = pad.getBoundingClientRect();
      changed(toAngles((event.clientX - box.left) / box.width * 2 - 1, 1 - (event.clientY - box.top) / box.height * 2));
      show();
    };
    pad.addEventListener("pointerdown", (event) => {
      pad.setPointerCapture(event.pointerId);
      drag(event);
    });
    pad.addEventListener("pointermove", (event) => { if (pad.hasPointerCapture(event.pointerId)) drag(event); });
    pad.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [-5, 0], ArrowRight: [5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5] }[event.key];
      if (!step) return;
      event.preventDefault();
      event.stopPropagation();
      const azimuth = ((lamp.azimuth + step[0] + 540) % 360) - 180;
      changed({ azimuth, elevation: Math.min(89, Math.max(-89, lamp.elevation + step[1])) });
      show();
    });
    show();
    return show;
  };
})();

"use strict";
// Without WebGL 2: the training views and the maps as still pictures.
(() => {
  const view = window.unshadeView;

  const draw = async (stored, write) => {
    const array = await view.load(stored), canvas = document.createElement("canvas");
    canvas.width = array.width;
    canvas.height = array.height;
    const context = canvas.getContext("2d"), image = context.createImageData(array.width, array.height);
    for (let i = 0; i < array.width * array.height; i++) {
      const numbers = view.pixel(array, i % array.width, Math.floor(i / array.width));
      image.data.set([...(numbers.every(Number.isFinite) ? write(numbers) : [40, 42, 46]).map((x) => Math.round(x)), 255], 4 * i);
    }
    context.putImageData(image, 0, 0);
    return canvas;
  };

  const colour = (rgb) => rgb.map((x) => 255 * view.srgb(x));
  const WRITERS = {
    diffuse_albedo: colour,
    specular_albedo: ([x]) => Array(3).fill(255 * Math.min(1, x / 0.05)),
    specular_normal: (n) => n.map((x) => 127.5 + 127.5 * x),
  };

  /// Fills `element` with still pictures of the manifest.
  view.showStills = async (element, scene) => {
    const add = async (title, stored, write) => {
      const figure = document.createElement("figure"), caption = document.createElement("figcaption");
      caption.textContent = title;
      figure.append(await draw(stored, write), caption);
      element.append(figure);
    };
    for (const pane of scene.panes) {
      for (const [name, stored] of pane.maps) {
        if (WRITERS[name]) await add(pane.title + ": " + name.replace("_", " "), stored, WRITERS[name]);
      }
    }
    for (const camera of scene.views.list) await add("view " + camera.name, camera.picture, colour);
  };
})();

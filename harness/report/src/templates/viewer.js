"use strict";
// Key pictures with their values: exposure, zoom, linear numbers under the pointer. The values come from a script
// beside the picture, which is loaded when the picture is opened.
(() => {
  const waiting = new Map();
  const loaded = new Map();

  // The sixteen bits of a half float as a number.
  const half = (bits) => {
    const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, part = bits & 1023;
    if (exponent === 0) return sign * part * 2 ** -24;
    if (exponent === 31) return part ? NaN : sign * Infinity;
    return sign * (1 + part / 1024) * 2 ** (exponent - 15);
  };

  const decode = async (width, height, channels, text) => {
    const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
    const count = width * height, data = new Float32Array(count * channels);
    for (let channel = 0; channel < channels; channel++) {
      const low = 2 * channel * count, high = low + count;
      for (let i = 0, bits = 0; i < count; i++) {
        bits = ((i % width ? bits : 0) + bytes[low + i] + 256 * bytes[high + i]) & 0xffff;
        data[i * channels + channel] = half(bits);
      }
    }
    return { width, height, channels, data };
  };

  window.unshadeFloat = (name, ...packed) => waiting.get(name)(decode(...packed));

  const load = (name) => {
    if (!loaded.has(name)) {
      loaded.set(name, new Promise((done, failed) => {
        waiting.set(name, done);
        const script = document.createElement("script");
        script.src = name;
        script.onerror = () => { loaded.delete(name); failed(new Error(name + " is missing beside this page")); };
        document.head.append(script);
      }));
    }
    return loaded.get(name);
  };

  const srgb = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);

  const draw = (canvas, picture, tone, white, stops) => {
    canvas.width = picture.width;
    canvas.height = picture.height;
    const context = canvas.getContext("2d"), image = context.createImageData(picture.width, picture.height);
    const gain = 2 ** stops / white, last = picture.channels - 1;
    for (let i = 0; i < picture.width * picture.height; i++) {
      for (let c = 0; c < 3; c++) {
        const x = picture.data[i * picture.channels + Math.min(c, last)];
        const shown = tone === "normal" ? x * 0.5 + 0.5 : tone === "grey" ? x * gain : srgb(Math.max(0, x * gain));
        image.data[4 * i + c] = 255 * shown;
      }
      image.data[4 * i + 3] = 255;
    }
    context.putImageData(image, 0, 0);
  };

  const dialog = document.querySelector("dialog.viewer");
  const part = (name) => dialog.querySelector("." + name);
  const canvas = part("canvas"), exposure = part("exposure"), output = part("values"), room = part("room");
  let row = [], at = 0, zoom = 1, picture = null;

  const scale = (factor, x, y) => {
    const box = canvas.getBoundingClientRect();
    const [u, v] = [((x ?? box.left + room.clientWidth / 2) - box.left) / box.width, ((y ?? box.top + room.clientHeight / 2) - box.top) / box.height];
    zoom = Math.min(32, Math.max(0.25, zoom * factor));
    canvas.style.width = zoom * picture.width + "px";
    const now = canvas.getBoundingClientRect();
    room.scrollLeft += u * (now.width - box.width);
    room.scrollTop += v * (now.height - box.height);
    part("zoom").textContent = Math.round(100 * zoom) + " %";
  };

  const redraw = () => {
    const { tone, white } = row[at].dataset;
    draw(canvas, picture, tone, Number(white), Number(exposure.value));
    part("stops").textContent = (exposure.value > 0 ? "+" : "") + exposure.value + " EV";
    exposure.disabled = tone === "normal";
  };

  const show = async (index) => {
    at = (index + row.length) % row.length;
    const shown = row[at];
    part("name").textContent = shown.dataset.title;
    try {
      const found = await load(shown.dataset.values);
      if (row[at] !== shown) return;
      picture = found;
    } catch (error) {
      output.textContent = error.message;
      return;
    }
    redraw();
    scale(1);
    output.textContent = "linear values under the pointer";
  };

  for (const button of document.querySelectorAll("button[data-values]")) {
    button.addEventListener("click", async () => {
      row = [...button.closest(".cards").querySelectorAll("button[data-values]")];
      dialog.showModal();
      exposure.value = 0;
      zoom = 1;
      await show(row.indexOf(button));
      if (!picture) return;
      const fits = Math.min(room.clientWidth / picture.width, room.clientHeight / picture.height);
      scale(Math.min(8, Math.floor(fits) || fits));
    });
  }
  exposure.addEventListener("input", redraw);
  part("closer").addEventListener("click", () => scale(1.5));
  part("farther").addEventListener("click", () => scale(1 / 1.5));
  part("previous").addEventListener("click", () => show(at - 1));
  part("next").addEventListener("click", () => show(at + 1));
  part("close").addEventListener("click", () => dialog.close());
  dialog.addEventListener("keydown", (event) => {
    if (event.target === exposure) return;
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (step) { event.preventDefault(); show(at + step); }
  });
  room.addEventListener("wheel", (event) => {
    event.preventDefault();
    scale(event.deltaY < 0 ? 1.25 : 0.8, event.clientX, event.clientY);
  }, { passive: false });
  canvas.addEventListener("pointermove", (event) => {
    if (!picture) return;
    const box = canvas.getBoundingClientRect();
    const x = Math.floor((event.clientX - box.left) / box.width * picture.width);
    const y = Math.floor((event.clientY - box.top) / box.height * picture.height);
    if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
    const pixel = picture.data.subarray((y * picture.width + x) * picture.channels, (y * picture.width + x + 1) * picture.channels);
    output.textContent = "column " + x + ", row " + y + ": " + [...pixel].map((v) => v.toPrecision(4)).join("  ");
  });
})();

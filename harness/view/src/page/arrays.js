"use strict";
// Arrays beside the page, each a script that is loaded when it is shown: a page from disk may neither fetch a file nor
// read the pixels of a picture.
window.unshadeView = {};
(() => {
  const view = window.unshadeView;
  const waiting = new Map(), early = new Map(), loaded = new Map();

  view.arrive = (name, size, text) => {
    const give = waiting.get(name);
    if (give) give([size, text]);
    else early.set(name, [size, text]);
  };

  const arrived = (name) => new Promise((done, failed) => {
    if (early.has(name)) {
      done(early.get(name));
      early.delete(name);
      return;
    }
    waiting.set(name, done);
    const script = document.createElement("script");
    script.src = "data/" + name + ".js";
    script.onerror = () => failed(new Error(script.src + " is missing beside this page"));
    script.onload = () => script.remove();
    document.head.append(script);
  });

  // Fifteen bits per code unit, the least significant bit first.
  const bytesOf = (size, text) => {
    const bytes = new Uint8Array(size);
    let held = 0, bits = 0, at = 0;
    for (let i = 0; i < text.length; i++) {
      held |= (text.charCodeAt(i) - 0x3000) << bits;
      bits += 15;
      while (bits >= 8 && at < size) {
        bytes[at++] = held & 255;
        held >>>= 8;
        bits -= 8;
      }
    }
    return bytes;
  };

  const ELEMENTS = { u8: Uint8Array, u16: Uint16Array, u32: Uint32Array, half: Uint16Array, i16: Int16Array, octahedral: Int16Array, root: Int16Array };

  // Directions and colours as numbers: three for each element.
  const UNPACKED = {
    octahedral: (codes, scale) => {
      const values = new Float32Array(codes.length / 2 * 3);
      for (let i = 0, to = 0; i < codes.length; i += 2, to += 3) {
        if (codes[i] === 0x7fff) continue;
        let x = codes[i] / scale, y = codes[i + 1] / scale;
        const z = 1 - Math.abs(x) - Math.abs(y), fold = Math.max(0, -z);
        x -= x < 0 ? -fold : fold;
        y -= y < 0 ? -fold : fold;
        const size = Math.hypot(x, y, z);
        values[to] = x / size;
        values[to + 1] = y / size;
        values[to + 2] = z / size;
      }
      return values;
    },
    root: (codes, scale) => {
      const values = new Float32Array(codes.length);
      for (let i = 0; i < codes.length; i++) values[i] = ((codes[i] + (i % 3 === 1 ? 0 : codes[i - i % 3 + 1])) / scale) ** 2;
      return values;
    },
  };

  const decode = async ({ width, height, channels, element, scale }, [size, text]) => {
    const stream = new Blob([bytesOf(size, text)]).stream().pipeThrough(new DecompressionStream("deflate"));
    const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
    const count = width * height, codes = new ELEMENTS[element](count * channels), parts = codes.BYTES_PER_ELEMENT;
    const line = width * channels;
    for (let channel = 0; channel < channels; channel++) {
      const from = channel * count * parts;
      for (let i = 0, x = 0, at = channel; i < count; i++, at += channels) {
        let folded = 0;
        for (let part = 0; part < parts; part++) folded |= bytes[from + part * count + i] << (8 * part);
        const left = x > 0 ? codes[at - channels] : 0, up = i >= width ? codes[at - line] : 0;
        const corner = x > 0 && i >= width ? codes[at - line - channels] : 0, middle = left + up - corner;
        const predicted = left < up ? Math.min(up, Math.max(left, middle)) : Math.min(left, Math.max(up, middle));
        codes[at] = predicted + ((folded >>> 1) ^ -(folded & 1));
        x = x + 1 === width ? 0 : x + 1;
      }
    }
    const unpack = UNPACKED[element];
    if (unpack) return { width, height, channels: 3, codes: unpack(codes, scale), element: "float", scale };
    return { width, height, channels, codes, element, scale };
  };

  /// The array that the manifest names: `width`, `height`, `channels` and interleaved `codes`; decoded once.
  view.load = (stored) => {
    if (!loaded.has(stored.name)) {
      const found = arrived(stored.name).then((packed) => decode(stored, packed));
      found.catch(() => loaded.delete(stored.name));
      loaded.set(stored.name, found);
    }
    return loaded.get(stored.name);
  };

  /// The sixteen bits of a half float as a number.
  view.half = (bits) => {
    const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, part = bits & 1023;
    if (exponent === 0) return sign * part * 2 ** -24;
    if (exponent === 31) return part ? NaN : sign * Infinity;
    return sign * (1 + part / 1024) * 2 ** (exponent - 15);
  };

  const number = ({ element, scale }) => element === "half" ? view.half : element === "float" ? (value) => value : (code) => code / scale;

  /// The numbers of one pixel of an array.
  view.pixel = (array, x, y) => {
    const from = (y * array.width + x) * array.channels;
    return Array.from(array.codes.subarray(from, from + array.channels), number(array));
  };

  /// All numbers of an array.
  view.numbers = (array) => Float32Array.from(array.codes, number(array));

  // The half float next to a number of moderate size.
  const bits = (x) => {
    const size = Math.abs(x), sign = x < 0 ? 0x8000 : 0;
    if (size < 2 ** -14) return sign | Math.round(size * 2 ** 24);
    const exponent = Math.floor(Math.log2(size)), part = Math.round((size / 2 ** exponent - 1) * 1024);
    return sign + ((exponent + 15) << 10) + part;
  };
  const tables = new Map();

  /// The codes of an array as half floats, which a texture takes.
  view.halves = (array) => {
    if (array.element === "half") return array.codes;
    if (array.element === "float") return Uint16Array.from(array.codes, bits);
    if (!tables.has(array.scale)) {
      tables.set(array.scale, Uint16Array.from({ length: 65536 }, (_, code) => bits((code < 32768 ? code : code - 65536) / array.scale)));
    }
    const table = tables.get(array.scale);
    return Uint16Array.from(array.codes, (code) => table[code & 0xffff]);
  };
})();

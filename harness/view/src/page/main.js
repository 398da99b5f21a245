"use strict";
// The page: its state, its controls, and what redraws.
(() => {
  const view = window.unshadeView;
  const part = (id) => document.getElementById(id);
  const DEGREES = Math.PI / 180;

  const say = (text) => {
    part("notice").textContent = text;
    part("notice").hidden = !text;
  };

  const option = (value, text) => Object.assign(document.createElement("option"), { value, textContent: text });

  // The lights that the page has: lamps, and surroundings with a way to read their pictures.
  const lightsOf = (scene) => {
    const read = (light) => async () => {
      const array = await view.load(light.picture);
      return { width: array.width, height: array.height, channels: array.channels, numbers: view.numbers(array), poles: light.poles };
    };
    const found = [{ id: "lamp", title: "lamp" }, { id: "flash", title: "lamp at the camera" }];
    for (const pane of scene.panes) {
      if (!pane.light) continue;
      const title = pane.is_truth ? "the capture's light" : "as recovered by " + pane.title;
      found.push({ id: pane.id, title, read: read(pane.light) });
    }
    scene.lights.forEach(([name, light], i) => found.push({ id: "light" + i, title: name, read: read(light) }));
    if (!scene.lights.some(([name]) => name === "uniform")) found.push({ id: "even", title: "uniform", read: async () => view.EVEN });
    return found;
  };

  // Cells of the panes in the stage: those in which a head is largest, or all of it for each with an edge.
  const arrange = (shown, width, height, swipe) => {
    if (swipe !== null && shown.length > 1) {
      const edge = Math.round(swipe * width);
      return [[0, edge], [edge, width]].map(([left, right], i) => ({ pane: shown[i], x: 0, y: 0, width, height, left, right }));
    }
    const size = (columns) => Math.min(width / columns / 0.75, height / Math.ceil(shown.length / columns));
    const columns = shown.reduce((best, _, i) => size(i + 1) > size(best) * 1.001 ? i + 1 : best, 1);
    const rows = Math.ceil(shown.length / columns);
    return shown.map((pane, i) => {
      const [x, y] = [Math.floor(i % columns * width / columns), Math.floor(Math.floor(i / columns) * height / rows)];
      const cell = { pane, x, y, width: Math.floor(width / columns), height: Math.floor(height / rows) };
      return { ...cell, left: x, right: x + cell.width };
    });
  };

  const start = async (scene) => {
    const head = await view.loadHead(scene.mesh), stage = new view.Stage(part("canvas"), scene, head);
    const layers = view.layersOf(scene), lights = lightsOf(scene), element = part("stage");
    const front = { camera: [0, 0, head.radius / Math.sin(12.5 * DEGREES) * 1.06, ...head.centre.toArray()], lens: 25 };
    const state = {
      camera: [...front.camera], lens: front.lens,
      light: lights.length > 3 ? lights[2].id : "lamp", lamp: { azimuth: 35, elevation: 30, distance: 1 }, turn: 0,
      layer: "shaded", exposure: 0, factor: true, shown: scene.panes.map(({ id }) => id), swipe: null, spot: null,
    };
    const known = { lights: lights.map(({ id }) => id), layers: layers.map(({ key }) => key), panes: state.shown.slice() };
    view.fromAddress(location.hash, state, known);
    const controls = new THREE.OrbitControls(stage.camera, part("canvas"));
    controls.enableDamping = false;
    let place = null, cells = [], lacks = new Map(), pending = false, round = 0, lit = "", dropped = 0;

    const shownPanes = () => state.shown.map((id) => scene.panes.find((pane) => pane.id === id));
    const layerNow = () => layers.find(({ key }) => key === state.layer);
    const lightNow = () => lights.find(({ id }) => id === state.light);

    const placeCamera = () => {
      const [azimuth, elevation, distance, ...target] = state.camera, [a, e] = [azimuth * DEGREES, elevation * DEGREES];
      controls.target.fromArray(target);
      stage.fov = state.lens;
      stage.camera.position.set(Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e)).multiplyScalar(distance).add(controls.target);
      stage.camera.lookAt(controls.target);
    };
    const readCamera = () => {
      const way = stage.camera.position.clone().sub(controls.target), distance = way.length();
      state.camera = [Math.atan2(way.x, way.z) / DEGREES, Math.asin(way.y / distance) / DEGREES, distance, ...controls.target.toArray()];
    };

    const relight = async () => {
      const light = lightNow();
      if (light.read) {
        const wanted = light.id + " " + state.turn;
        if (lit === wanted) return;
        light.picture ??= await light.read();
        stage.setSurroundings(view.surroundings(head, light.picture, state.turn, light.exposed));
        lit = wanted;
        return;
      }
      stage.setLamp(light.id === "lamp" ? view.lampAt(head, state.lamp) : view.lampFrom(head, stage.camera.position.clone()));
      lit = "";
    };

    const overlay = () => {
      const nodes = [];
      const add = (kind, text, left, top) => {
        const node = Object.assign(document.createElement("div"), { className: kind, textContent: text });
        node.style.left = left + "px";
        node.style.top = top + "px";
        nodes.push(node);
      };
      for (const cell of cells) {
        const last = state.swipe !== null && cell.right === cell.width && cell.left > 0;
        add("name", cell.pane.title, cell.left + (last ? 4 : 0), cell.y);
        if (lacks.get(cell.pane.id)) add("lacks", cell.pane.title + ": " + lacks.get(cell.pane.id), (cell.left + cell.right) / 2, cell.y + cell.height / 2);
        if (!place) continue;
        stage.aim(cell.width, cell.height);
        const at = place.position.clone().project(stage.camera);
        const [x, y] = [cell.x + (at.x + 1) / 2 * cell.width, cell.y + (1 - at.y) / 2 * cell.height];
        if (x > cell.left && x < cell.right && at.z < 1) add("mark", "", x, y);
      }
      part("overlays").replaceChildren(...nodes);
      const layer = layerNow(), measured = layer.unit !== undefined;
      part("scale").hidden = !measured;
      part("edge").hidden = state.swipe === null || state.shown.length < 2;
      if (!measured) return;
      part("bottom").textContent = "0";
      part("top").textContent = (layer.group === "errors" ? "≥ " : "") + view.written(layer.top ?? 1, layer.top ?? 1) + " " + layer.unit;
      part("ramp").style.background = view.gradient(view.RAMPS[layer.group === "errors" ? "error" : "quantity"]);
    };

    const paint = () => {
      const [width, height] = [element.clientWidth, element.clientHeight];
      stage.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
      const size = stage.renderer.getSize(new THREE.Vector2());
      if (size.x !== width || size.y !== height) stage.renderer.setSize(width, height, false);
      cells = arrange(shownPanes(), width, height, state.swipe);
      if (state.light === "flash") stage.setLamp(view.lampFrom(head, stage.camera.position.clone()));
      stage.draw(cells.filter(({ pane }) => !lacks.get(pane.id)), 2 ** state.exposure);
      overlay();
    };

    /// Redraws soon; once for all changes of a frame.
    const redraw = () => {
      if (pending) return;
      pending = true;
      requestAnimationFrame(() => {
        pending = false;
        paint();
        // A page inside a notebook's frame has no address of its own.
        if (location.protocol !== "about:") history.replaceState(null, "", view.toAddress(state));
      });
    };

    /// Loads what is shown, then redraws. Newer calls end older ones.
    const refresh = async () => {
      const mine = ++round;
      try {
        const layer = layerNow(), panes = shownPanes();
        await relight();
        const found = await Promise.all(panes.map((pane) => stage.prepare(pane, layer, state.factor)));
        if (mine !== round) return;
        lacks = new Map(panes.map((pane, i) => [pane.id, found[i]]));
        redraw();
      } catch (error) {
        say(error.message);
      }
    };

    const isNarrow = () => window.innerWidth <= 760;
    const tell = async (scroll) => {
      if (!place) return;
      const truth = scene.panes.find((pane) => pane.is_truth && pane.light) ?? scene.panes.find((pane) => pane.light);
      const light = !scene.moving_light && truth && lights.find(({ id }) => id === truth.id);
      if (light) light.picture ??= await light.read();
      const model = light && view.surroundings(head, light.picture, 0, false);
      view.told = await view.tell(part("story"), {
        scene, head, place, exposure: 2 ** state.exposure, light: light ? { title: light.title, model } : null,
        jump: (camera) => {
          jump(camera);
          refresh();
          if (isNarrow()) part("stage").scrollIntoView({ behavior: "smooth" });
        },
      });
      const section = part("story").parentElement, aside = section.parentElement;
      if (!isNarrow()) aside.scrollTop += section.getBoundingClientRect().top - aside.getBoundingClientRect().top;
      else if (scroll) part("story").scrollIntoView({ behavior: "smooth" });
    };

    // Looks at the head as a training view does, but for the place of its principal point.
    const jump = ({ camera_to_world, focal, height }) => {
      const matrix = new THREE.Matrix4().fromArray(camera_to_world), eye = new THREE.Vector3().setFromMatrixPosition(matrix);
      const forward = new THREE.Vector3(0, 0, -1).transformDirection(matrix), depth = head.centre.clone().sub(eye).dot(forward);
      controls.target.copy(eye).addScaledVector(forward, depth);
      stage.camera.position.copy(eye);
      state.lens = 2 * Math.atan(height / 2 / focal[1]) / DEGREES;
      readCamera();
      placeCamera();
    };

    const choose = (uv, scroll) => {
      place = view.placeAt(head, ...uv);
      if (!place) return;
      state.spot = uv;
      worst();
      redraw();
      tell(scroll).catch((error) => say(error.message));
    };

    const pickAt = (x, y) => {
      const cell = cells.find((each) => x >= each.left && x < each.right && y >= each.y && y < each.y + each.height);
      if (!cell) return;
      stage.aim(cell.width, cell.height);
      const raycaster = new THREE.Raycaster();
      raycaster.setFromCamera(new THREE.Vector2((x - cell.x) / cell.width * 2 - 1, 1 - (y - cell.y) / cell.height * 2), stage.camera);
      stage.mesh.material = stage.materials.get(cell.pane.id);
      const found = view.pick(head, stage.mesh, raycaster);
      if (found) choose(found.uv, true);
    };

    const face = (uv) => {
      const found = view.placeAt(head, ...uv);
      if (!found) return;
      const distance = stage.camera.position.distanceTo(controls.target);
      controls.target.copy(head.centre);
      stage.camera.position.copy(found.normal).multiplyScalar(distance).add(head.centre);
      readCamera();
      state.camera[1] = Math.min(85, Math.max(-85, state.camera[1]));
      placeCamera();
      choose(uv, false);
      refresh();
    };

    const worst = () => view.listWorst({ section: part("worst"), choice: part("worst-of"), list: part("patches") }, scene, head, layerNow(), state.spot, (uv, errors) => {
      state.layer = errors.key;
      show();
      face(uv);
    });

    // Puts the state into the controls.
    const show = () => {
      part("layer").value = state.layer;
      part("light").value = state.light;
      part("exposure").value = state.exposure;
      part("stops").textContent = (state.exposure > 0 ? "+" : "") + state.exposure + " EV";
      part("factor").checked = state.factor;
      part("swipe").checked = state.swipe !== null;
      part("edge").value = state.swipe ?? 0.5;
      part("distance").value = state.lamp.distance;
      part("metres").textContent = state.lamp.distance.toFixed(2) + " m";
      for (const box of part("shown").querySelectorAll("input")) box.checked = state.shown.includes(box.value);
      showPad();
      worst();
    };

    for (const [group, title] of [["light", "in light"], ["maps", "maps"], ["errors", "errors against the truth"]]) {
      const members = layers.filter((layer) => layer.group === group), list = document.createElement("optgroup");
      list.label = title;
      list.append(...members.map(({ key, title: text }) => option(key, text)));
      if (members.length) part("layer").append(list);
    }
    part("light").append(...lights.map(({ id, title }) => option(id, title)));
    part("worst-of").append(...scene.panes.filter((pane) => !pane.is_truth).map(({ id, title }) => option(id, title)));
    part("worst-of").addEventListener("change", worst);
    part("factor").closest("label").hidden = !scene.panes.some((pane) => pane.factor);
    for (const pane of scene.panes) {
      const label = document.createElement("label"), box = Object.assign(document.createElement("input"), { type: "checkbox", value: pane.id });
      box.addEventListener("change", () => {
        const wanted = scene.panes.map(({ id }) => id).filter((id) => id === pane.id ? box.checked : state.shown.includes(id));
        if (wanted.length) state.shown = wanted;
        show();
        refresh();
      });
      label.append(box, pane.title);
      part("shown").append(label);
    }
    const showPad = view.wirePad(part("pad"), state.lamp, (angles) => moveLight(angles));
    const moveLight = ({ azimuth, elevation }) => {
      if (state.light === "flash") state.light = part("light").value = "lamp";
      if (lightNow().read) state.turn = Math.round(state.turn + ((azimuth - state.lamp.azimuth + 540) % 360) - 180);
      Object.assign(state.lamp, { azimuth, elevation });
      refresh();
    };

    const wire = (id, event, change) => part(id).addEventListener(event, () => {
      change(part(id));
      show();
      refresh();
    });
    wire("layer", "change", ({ value }) => { state.layer = value; });
    wire("light", "change", ({ value }) => { state.light = value; });
    wire("exposure", "input", ({ value }) => { state.exposure = Number(value); });
    wire("factor", "change", ({ checked }) => { state.factor = checked; });
    wire("swipe", "change", ({ checked }) => { state.swipe = checked ? 0.5 : null; });
    wire("edge", "input", ({ value }) => { state.swipe = Number(value); });
    wire("distance", "input", ({ value }) => {
      state.lamp.distance = Number(value);
      if (lightNow().read || state.light === "flash") state.light = "lamp";
    });
    part("front").addEventListener("click", () => {
      Object.assign(state, { camera: [...front.camera], lens: front.lens });
      placeCamera();
      refresh();
    });
    part("copy").addEventListener("click", async () => {
      try {
        await navigator.clipboard.writeText(location.href);
        part("copy").textContent = "Copied";
      } catch {
        say("This browser does not let a page from disk copy; the link is in the address bar.");
      }
    });

    const light = async (file) => {
      if (!file) return;
      say("");
      try {
        const picture = await view.readSurroundings(file), id = "file" + dropped++;
        lights.push({ id, title: file.name, picture, exposed: true, read: async () => picture });
        part("light").append(option(id, file.name));
        state.light = id;
        show();
        await refresh();
      } catch (error) {
        say(error.message);
      }
    };
    document.addEventListener("dragover", (event) => event.preventDefault());
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      light(event.dataTransfer.files[0]);
    });
    part("file").addEventListener("change", () => light(part("file").files[0]));

    controls.addEventListener("change", () => {
      readCamera();
      redraw();
    });
    let pressed = null;
    const inStage = (event) => {
      const box = element.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    // Before the controls hear of it.
    element.addEventListener("pointerdown", (event) => {
      if (event.target !== part("canvas")) return;
      pressed = { at: inStage(event), last: inStage(event), lamp: event.altKey };
      controls.enabled = !event.altKey;
    }, true);
    element.addEventListener("pointermove", (event) => {
      if (!pressed?.lamp) return;
      const [x, y] = inStage(event), elevation = Math.min(89, Math.max(-89, state.lamp.elevation - (y - pressed.last[1]) / 2));
      moveLight({ azimuth: state.lamp.azimuth + (x - pressed.last[0]) / 2, elevation });
      pressed.last = [x, y];
      showPad();
    }, true);
    window.addEventListener("pointerup", (event) => {
      const was = pressed;
      pressed = null;
      controls.enabled = true;
      if (!was || was.lamp || event.target !== part("canvas")) return;
      const [x, y] = inStage(event);
      if (Math.hypot(x - was.at[0], y - was.at[1]) < 4) pickAt(x, y);
    });
    element.addEventListener("keydown", (event) => {
      if (event.target !== element) return;
      const [azimuth, elevation, distance] = state.camera, turn = { ArrowLeft: [-5, 0], ArrowRight: [5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5] }[event.key];
      const layer = { "[": -1, "]": 1 }[event.key], zoom = { "+": 1 / 1.15, "=": 1 / 1.15, "-": 1.15 }[event.key];
      if (turn && event.altKey) moveLight({ azimuth: state.lamp.azimuth + turn[0], elevation: Math.min(89, Math.max(-89, state.lamp.elevation + turn[1])) });
      else if (turn && event.shiftKey) {
        const right = new THREE.Vector3(1, 0, 0).transformDirection(stage.camera.matrixWorld), up = new THREE.Vector3(0, 1, 0).transformDirection(stage.camera.matrixWorld);
        controls.target.addScaledVector(right, turn[0] * distance / 300).addScaledVector(up, turn[1] * distance / 300);
        state.camera.splice(3, 3, ...controls.target.toArray());
      } else if (turn) state.camera.splice(0, 2, azimuth + turn[0], Math.min(89, Math.max(-89, elevation + turn[1])));
      else if (zoom) state.camera[2] = distance * zoom;
      else if (layer) state.layer = layers[(layers.indexOf(layerNow()) + layer + layers.length) % layers.length].key;
      else if (event.key === "Enter") pickAt(cells[0].x + cells[0].width / 2, cells[0].y + cells[0].height / 2);
      else return;
      event.preventDefault();
      placeCamera();
      show();
      refresh();
    });
    window.addEventListener("hashchange", () => {
      view.fromAddress(location.hash, state, known);
      placeCamera();
      show();
      if (state.spot) choose(state.spot, false);
      refresh();
    });
    new ResizeObserver(redraw).observe(element);

    placeCamera();
    show();
    await refresh();
    if (state.spot) choose(state.spot, false);
    Object.assign(view, { scene, stage, head, state, refresh, lights, jump, cells: () => cells });
  };

  /// Opens the page of a manifest; the promise `ready` is kept when the first picture is drawn.
  view.open = (scene) => {
    const probe = document.createElement("canvas").getContext("webgl2");
    const failed = async (reason) => {
      say(reason + " These are still pictures.");
      document.querySelector("main").hidden = document.querySelector(".tools").hidden = true;
      part("stills").hidden = false;
      await view.showStills(part("stills"), scene);
    };
    view.ready = probe ? start(scene).catch((error) => failed(error.message + ".")) : failed("This browser has no WebGL 2, so the head cannot be turned.");
  };
})();

"use strict";
const board = JSON.parse(document.getElementById("data").textContent);
const captures = board.captures;
const total = captures.case.length;
const withValues = board.figures.findIndex((_, at) => board.entries.some((entry) => entry.values[at].some((value) => value !== null)));
const state = { figure: Math.max(0, withValues), down: true, light: "", face: "", variant: "", run: "", page: 0, by: -1, casesDown: true };
const PAGE = 50;
const byId = (id) => document.getElementById(id);
const element = (name, text, set) => Object.assign(document.createElement(name), { textContent: text ?? "" }, set);

function value(entry, figure, capture) {
  const whole = entry.values[figure][capture];
  return whole === null ? null : whole / 10 ** board.figures[figure].decimals;
}

function shown(number, figure, sign) {
  if (number === null) return "–";
  return (sign ?? "") + number.toFixed(Math.min(board.figures[figure].decimals, number >= 10 ? 1 : 4));
}

// Captures that the filters leave.
function chosen() {
  const list = [];
  for (let i = 0; i < total; i++) {
    if (["light", "face", "variant"].every((key) => !state[key] || captures[key][i] === state[key])) list.push(i);
  }
  return list;
}

// Entries with a figure, ranked on the captures that all have who have at least half of the most.
function standing(figure, list) {
  const entries = board.entries.filter((entry) => !state.run || board.runs[entry.run].name === state.run);
  const counts = entries.map((entry) => list.filter((i) => entry.values[figure][i] !== null).length);
  const most = Math.max(0, ...counts.filter((_, at) => entries[at].ranked));
  const takes = entries.map((entry, at) => entry.ranked && counts[at] > 0 && counts[at] * 2 >= most);
  const common = list.filter((i) => entries.every((entry, at) => !takes[at] || entry.values[figure][i] !== null));
  const faces = common.map((i) => captures.face[i]);
  const ranked = entries.filter((_, at) => takes[at]);
  const columns = ranked.map((entry) => common.map((i) => value(entry, figure, i)));
  const order = ranks(columns, faces, board.figures[figure].higher);
  const rows = entries.map((entry, at) => {
    const place = ranked.indexOf(entry);
    const own = place >= 0 ? common : list;
    const values = own.map((i) => value(entry, figure, i));
    const [mean, half] = meanAndHalf(groupMeans(values, own.map((i) => captures.face[i])));
    return { entry, rank: place >= 0 ? order[place] : null, mean, half, count: counts[at] };
  });
  return { rows, common };
}

// Sorting changes nothing of it.
let standings = { of: null, list: [], figures: [] };
function chosenStandings() {
  const of = JSON.stringify([state.light, state.face, state.variant, state.run]);
  if (standings.of !== of) {
    const list = chosen();
    standings = { of, list, figures: board.figures.map((_, figure) => standing(figure, list)) };
  }
  return standings;
}

function choices(key, label) {
  const names = [...new Set(key === "run" ? board.runs.map((run) => run.name) : captures[key])].filter(Boolean).sort();
  if (names.length < 2) return;
  const select = element("select", "", { id: key });
  select.append(element("option", "all", { value: "" }), ...names.map((name) => element("option", name, { value: name })));
  select.addEventListener("change", () => { state[key] = select.value; state.page = 0; draw(); });
  const field = element("label", label);
  field.append(select);
  byId("filters").append(field);
}

function heading(text, unit, sorted, act) {
  const cell = element("th");
  const button = element("button", text);
  if (unit) button.append(" ", element("small", unit));
  if (sorted !== null) cell.setAttribute("aria-sort", sorted ? "descending" : "ascending");
  button.addEventListener("click", act);
  cell.append(button);
  return cell;
}

function drawMethods({ list, figures }) {
  const head = element("tr");
  head.append(element("th", "rank"), element("th", "method"));
  board.figures.forEach((figure, at) => head.append(
    heading(figure.name, `${figure.unit} ${figure.higher ? "↑" : "↓"}`, at === state.figure ? state.down : null, () => {
      state.down = at === state.figure ? !state.down : true;
      state.figure = at;
      draw();
    })));
  const { rows, common } = figures[state.figure];
  const sign = (board.figures[state.figure].higher ? -1 : 1) * (state.down ? 1 : -1);
  const order = rows.map((_, at) => at).sort((a, b) =>
    (rows[a].mean === null) - (rows[b].mean === null) || sign * (rows[a].mean - rows[b].mean));
  const body = order.map((at) => {
    const { entry, rank } = rows[at];
    const row = element("tr", "", { className: rank === null ? "aside" : "" });
    const tied = rank !== null && rows.filter((other) => other.rank === rank).length > 1;
    row.append(element("td", rank === null ? "" : `${rank}${tied ? "=" : ""}`));
    const name = element("th", entry.name, { scope: "row" });
    const run = board.runs[entry.run];
    const detail = element("small", entry.title === entry.name ? entry.role : `${entry.title}, ${entry.role}`);
    if (run.report) detail.append(" · ", element("a", "report", { href: run.report }));
    name.append(detail);
    row.append(name);
    figures.forEach((standing, figure) => {
      const { mean, half, rank: own } = standing.rows[at];
      const cell = element("td", shown(mean, figure), { className: own === 1 ? "first" : "" });
      if (half !== null && mean !== null) cell.append(element("small", shown(half, figure, "± ")));
      row.append(cell);
    });
    return row;
  });
  byId("methods").tHead.replaceChildren(head);
  byId("methods").tBodies[0].replaceChildren(...body);
  const faces = new Set(common.map((i) => captures.face[i])).size;
  byId("basis").textContent = `Ranked by ${board.figures[state.figure].name} on ${common.length} of ${list.length} captures, ` +
    `${faces} ${faces === 1 ? "face: one face cannot tell methods apart, so all are first" : "faces"}.`;
}

function drawCases(list) {
  const figure = state.figure;
  const entries = board.entries.filter((entry) => !state.run || board.runs[entry.run].name === state.run);
  const key = (i) => (state.by < 0 ? i : value(entries[state.by], figure, i));
  const sign = state.casesDown ? -1 : 1;
  const sorted = state.by < 0 ? list : [...list].sort((a, b) =>
    (key(a) === null) - (key(b) === null) || sign * (key(a) - key(b)));
  const pages = Math.max(1, Math.ceil(sorted.length / PAGE));
  state.page = Math.min(state.page, pages - 1);
  const head = element("tr");
  head.append(element("th", ""), heading("capture", "", state.by < 0 ? false : null, () => { state.by = -1; draw(); }));
  entries.forEach((entry, at) => head.append(heading(entry.name, "", state.by === at ? state.casesDown : null, () => {
    state.casesDown = state.by === at ? !state.casesDown : true;
    state.by = at;
    draw();
  })));
  const best = (i) => {
    const values = entries.filter((entry) => entry.ranked).map((entry) => value(entry, figure, i)).filter((v) => v !== null);
    return board.figures[figure].higher ? Math.max(...values) : Math.min(...values);
  };
  const rows = sorted.slice(state.page * PAGE, (state.page + 1) * PAGE).map((i) => {
    const row = element("tr");
    const picture = element("td");
    if (captures.picture[i]) picture.append(element("img", "", { src: captures.picture[i], alt: "", loading: "lazy", width: 48, height: 48 }));
    const name = element("th", captures.case[i], { scope: "row" });
    name.append(element("small", captures.hash[i], { className: "hash" }));
    if (captures.head[i]) name.append(element("a", "head in 3D", { href: captures.head[i] }));
    row.append(picture, name);
    const first = best(i);
    entries.forEach((entry) => {
      const number = value(entry, figure, i);
      row.append(element("td", shown(number, figure), { className: entry.ranked && number === first ? "first" : "" }));
    });
    return row;
  });
  byId("cases").tHead.replaceChildren(head);
  byId("cases").tBodies[0].replaceChildren(...rows);
  byId("of").textContent = `${board.figures[figure].name}, ${board.figures[figure].unit}`;
  byId("page").textContent = `${state.page + 1} of ${pages}`;
  byId("back").disabled = state.page === 0;
  byId("on").disabled = state.page === pages - 1;
}

function draw() {
  const standings = chosenStandings();
  drawMethods(standings);
  drawCases(standings.list);
}

choices("light", "light");
choices("face", "face");
choices("variant", "variant");
choices("run", "run");
byId("back").addEventListener("click", () => { state.page -= 1; draw(); });
byId("on").addEventListener("click", () => { state.page += 1; draw(); });
byId("runs").append(...board.runs.map((run) => {
  const line = element("li", `${run.name}: ${run.suite}`);
  if (run.report) line.append(" · ", element("a", "report", { href: run.report }));
  return line;
}));
if (new Set(board.runs.map((run) => run.scoring)).size > 1) {
  byId("warning").textContent = "These runs were scored by different versions; their figures may differ for that alone.";
}
const counted = (number, word) => `${number} ${word}${number === 1 ? "" : "s"}`;
byId("counts").textContent = [counted(board.entries.length, "method"), counted(total, "capture"),
  counted(new Set(captures.face).size, "face"), counted(board.runs.length, "run")].join(", ");
draw();

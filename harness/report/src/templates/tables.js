"use strict";
// Tables of scores sort by a column and show the rows that a text names. Without this script they stand as they are.
(() => {
  const value = (row, column) => {
    // An interval stands behind the number, as an element of its own.
    const text = (row.cells[column].firstChild?.textContent ?? "").trim() || row.cells[column].textContent.trim();
    const number = parseFloat(text.replace("\u2212", "-"));
    return /^[-\u2212]?[\d.]/.test(text) ? number : ["\u2013", "failed", ""].includes(text) ? NaN : text;
  };
  // What has no value comes last, whichever way the others go.
  const compare = (a, b, sign) => {
    const missing = (x) => typeof x === "number" && isNaN(x);
    if (missing(a) || missing(b)) return missing(a) - missing(b);
    if (typeof a === "number" && typeof b === "number") return sign * (a - b);
    return sign * String(a).localeCompare(String(b));
  };

  for (const table of document.querySelectorAll("table[data-sorts]")) {
    const headings = [...table.tHead.rows[0].cells];
    const rows = (body) => [...body.rows].filter((row) => !row.classList.contains("group"));
    const original = new Map([...table.tBodies].map((body) => [body, rows(body)]));
    headings.forEach((heading, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.className = "sort";
      button.append(...heading.childNodes);
      heading.append(button);
      button.addEventListener("click", () => {
        const next = { ascending: "descending", descending: "none" }[heading.getAttribute("aria-sort")] || "ascending";
        for (const other of headings) other.removeAttribute("aria-sort");
        if (next !== "none") heading.setAttribute("aria-sort", next);
        const sign = next === "ascending" ? 1 : -1;
        for (const body of table.tBodies) {
          const sorted = [...original.get(body)];
          if (next !== "none") sorted.sort((a, b) => compare(value(a, column), value(b, column), sign));
          body.append(...sorted);
        }
      });
    });

    const filter = document.createElement("input");
    filter.type = "search";
    filter.className = "filter";
    filter.placeholder = "show rows with \u2026";
    filter.setAttribute("aria-label", "show rows with these words");
    table.closest(".scroll").before(filter);
    filter.addEventListener("input", () => {
      const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
      for (const body of table.tBodies) {
        const group = body.querySelector(".group");
        const titled = group ? group.textContent : "";
        let shown = 0;
        for (const row of rows(body)) {
          const text = (titled + " " + row.textContent).toLowerCase();
          row.hidden = !words.every((word) => text.includes(word));
          shown += !row.hidden;
        }
        if (group) group.hidden = shown === 0;
      }
    });
  }

  // A link leads into what is folded.
  const reveal = () => {
    const target = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    for (let box = target; box; box = box.parentElement) if (box.tagName === "DETAILS") box.open = true;
    const first = target && target.querySelector(":scope > details");
    if (first && !target.classList.contains("case")) first.open = true;
    if (target) target.scrollIntoView();
  };
  addEventListener("hashchange", reveal);
  if (location.hash) reveal();
})();

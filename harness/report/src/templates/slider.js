"use strict";
// Without this script every picture is still on the page; it only moves the edge between
// reference and recovered, and puts the chosen picture on the stage.
for (const plate of document.querySelectorAll(".plate")) {
  const stage = plate.querySelector(".stage");
  if (!stage) continue;
  const range = stage.querySelector("input");
  const frames = stage.querySelector(".frames");
  const place = () => stage.style.setProperty("--at", range.value + "%");
  range.addEventListener("input", place);

  const drag = (event) => {
    const box = frames.getBoundingClientRect();
    range.value = 100 * (event.clientX - box.left) / box.width;
    place();
  };
  frames.addEventListener("pointerdown", (event) => {
    event.preventDefault();
    frames.setPointerCapture(event.pointerId);
    drag(event);
  });
  frames.addEventListener("pointermove", (event) => {
    if (frames.hasPointerCapture(event.pointerId)) drag(event);
  });

  const buttons = plate.querySelectorAll(".tiles button");
  const choose = (button) => {
    stage.querySelector(".truth").src = button.dataset.truth;
    stage.querySelector(".made").src = button.dataset.picture;
    stage.querySelector("output").textContent = button.dataset.title;
    for (const other of buttons) other.setAttribute("aria-pressed", other === button);
  };
  for (const button of buttons) {
    button.addEventListener("click", () => choose(button));
    const shown = button.dataset.picture === stage.querySelector(".made").getAttribute("src");
    button.setAttribute("aria-pressed", shown);
  }
  place();
}

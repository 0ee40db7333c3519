"use strict";
document.documentElement.classList.add("scripted");

const value = cell => {
  const text = cell ? cell.textContent.trim().replace("\u2212", "-") : "";
  const number = parseFloat(text);
  return Number.isNaN(number) ? text.toLowerCase() : number;
};

function sort(table, column, heading) {
  const falling = heading.getAttribute("aria-sort") === "ascending";
  for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
  heading.setAttribute("aria-sort", falling ? "descending" : "ascending");
  const sign = falling ? -1 : 1, body = table.tBodies[0];
  const rows = [...body.rows].map(row => [value(row.cells[column]), row]);
  rows.sort(([a], [b]) => sign * (typeof a === typeof b ? (a < b ? -1 : a > b ? 1 : 0) : typeof a === "number" ? -1 : 1));
  body.append(...rows.map(([, row]) => row));
}

// What is folded is printed.
addEventListener("beforeprint", () => document.querySelectorAll("details").forEach(fold => fold.open = true));

function makeSortable(table) {
  [...table.tHead.rows[0].cells].forEach((heading, column) => {
    if (!heading.textContent.trim()) return;
    const button = document.createElement("button");
    button.type = "button";
    button.append(...heading.childNodes);
    heading.append(button);
    button.addEventListener("click", () => sort(table, column, heading));
  });
}

function makeFilter(table) {
  const label = document.createElement("label"), field = document.createElement("input");
  const count = document.createElement("output");
  label.className = "filter";
  field.type = "search";
  field.placeholder = "text in a row";
  label.append("Filter ", field, " ", count);
  table.closest(".table").querySelector(".scroll").before(label);
  const rows = [...table.tBodies[0].rows];
  table.filter = text => {
    field.value = text;
    const words = text.toLowerCase().split(/\s+/).filter(word => word);
    let left = 0;
    for (const row of rows) {
      const content = row.textContent.toLowerCase();
      row.hidden = !words.every(word => content.includes(word));
      left += row.hidden ? 0 : 1;
    }
    count.textContent = words.length ? `${left} of ${rows.length}` : "";
  };
  field.addEventListener("input", () => table.filter(field.value));
}

for (const table of document.querySelectorAll(".table table:not(.matrix)")) {
  const rows = table.tBodies[0] ? table.tBodies[0].rows.length : 0;
  if (rows < 3 || table.querySelector("tr.group, tr.sum")) continue;
  makeSortable(table);
  if (rows > 12) makeFilter(table);
}

function showTarget() {
  const target = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (!target) return;
  const table = target.closest("table");
  if (target.hidden && table && table.filter) table.filter("");
  target.scrollIntoView({ block: "center" });
  if (target.matches("tr")) {
    target.tabIndex = -1;
    target.focus({ preventScroll: true });
  }
}
addEventListener("hashchange", showTarget);
showTarget();

for (const drawing of document.querySelectorAll(".panels svg")) {
  const points = [...drawing.querySelectorAll(".point a")];
  if (!points.length) continue;
  drawing.addEventListener("click", event => {
    if (event.target.closest("a")) return;
    let nearest = null, least = 24;
    for (const point of points) {
      const box = point.getBoundingClientRect();
      const distance = Math.hypot(box.x + box.width / 2 - event.clientX, box.y + box.height / 2 - event.clientY);
      if (distance < least) [nearest, least] = [point, distance];
    }
    if (nearest) location.hash = nearest.getAttribute("href");
  });
}

const dark = document.createElement("button");
dark.type = "button";
dark.className = "theme";
const isDark = () => (document.documentElement.dataset.theme
  || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
const name = () => { dark.textContent = isDark() ? "Light page" : "Dark page"; };
dark.addEventListener("click", () => {
  document.documentElement.dataset.theme = isDark() ? "light" : "dark";
  name();
});
name();
document.querySelector("header").prepend(dark);

// A plot in SVG: axes with units, what its maker draws between them, a cursor for mouse and keys with
// the values it is at, and its data as CSV.
import { readable } from "./data.js";
import { linesOf } from "./labels.js";
import { download, element } from "./page.js";
import { tickTexts, ticks } from "./ticks.js";

const LETTER = 6.3, LINE = 13; // width and height of what stands at an axis
const HEIGHT = 240, LEAST = 170, MOST = 420, RIGHT = 14, TOP = 14, BOTTOM = 42;

export function svg(tag, attributes = {}, ...children) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes))
    if (name === "style") node.style = value; // the page's policy forbids the attribute
    else node.setAttribute(name, value);
  node.append(...children);
  return node;
}

// What is drawn of the series `index` takes its colour from this: of a few those of the style sheet, of more
// ones that follow each other.
const FEW = 8;
let all = 1;
export const countSeries = (count) => { all = count; };
export const colourOf = (index) =>
  `--series: ${all > FEW ? `hsl(${(300 * index) / (all - 1)} var(--strength))` : `var(--curve${index})`}`;

// A path through points; a point with a value missing is a gap.
export function pathThrough(points) {
  let pen = "M";
  return points.map(([x, y]) => {
    const step = Number.isFinite(x) && Number.isFinite(y) ? `${pen}${x.toFixed(1)} ${y.toFixed(1)}` : "";
    pen = step ? "L" : "M";
    return step;
  }).join("");
}

// Least and greatest of the numbers among values, with room around them.
export function rangeOf(values, room = 0.05) {
  let low = Infinity, high = -Infinity;
  for (const v of values) if (Number.isFinite(v)) { low = Math.min(low, v); high = Math.max(high, v); }
  if (!(high >= low)) return [0, 1];
  const more = (high - low) * room || Math.abs(high) * 0.1 || 1;
  return [low - more, high + more];
}

function logTicks(low, high) {
  const steps = high / low < 100 ? [1, 2, 5] : [1], out = [];
  for (let power = 10 ** Math.floor(Math.log10(low)); power <= high; power *= 10)
    out.push(...steps.map((f) => f * power));
  return out.filter((v) => v >= low && v <= high);
}

// Where values lie on an axis; pixels from `from` to `to`.
function scale({ range, log }, from, to) {
  const f = log ? Math.log10 : (v) => v;
  const low = f(range[0]), high = f(range[1]);
  return (v) => from + ((f(v) - low) / (high - low)) * (to - from);
}

function drawAxes(spec, place) {
  const { x, y } = spec, { left, right, bottom } = place, nodes = [];
  const line = (x1, y1, x2, y2) => nodes.push(svg("line", { x1, y1, x2, y2, class: "grid-line" }));
  const text = (content, at, anchor, more = {}) =>
    nodes.push(svg("text", { x: at[0], y: at[1], "text-anchor": anchor, ...more }, content));
  if (x.names) {
    const each = (right - left) / x.names.length;
    const fits = x.names.every((name) => name.length * 6.5 < each);
    x.names.forEach((name, i) => text(fits ? name : String(i + 1), [place.x(i), bottom + 15], "middle"));
  } else {
    const steps = x.log ? logTicks(...x.range) : ticks(...x.range, Math.max(2, (right - left) / 48));
    const texts = tickTexts(steps);
    for (const [i, v] of steps.entries()) {
      line(place.x(v), TOP, place.x(v), bottom);
      const end = place.x(v) > right - 12;
      text(x.log ? readable(v) : texts[i], [place.x(v) + (end ? 12 : 0), bottom + 15], end ? "end" : "middle");
    }
  }
  const steps = y.names ? [] : ticks(...y.range, 5);
  const texts = tickTexts(steps);
  for (const [i, v] of steps.entries()) {
    line(left, place.y(v), right, place.y(v));
    text(texts[i], [left - 5, place.y(v) + 4], "end");
  }
  const fit = (label, room) => (LETTER * label.length > room ? { textLength: room.toFixed(0), lengthAdjust: "spacingAndGlyphs" } : {});
  text(x.label, [(left + right) / 2, place.height - 8], "middle", { class: "axis", ...fit(x.label, right - left + 20) });
  place.names.forEach((line, i) => text(line, [-(TOP + bottom) / 2, 12 + LINE * i], "middle",
    { class: "axis", transform: "rotate(-90)", ...fit(line, TOP + bottom - 4) }));
  return nodes;
}

const span = ({ range }) => range[1] - range[0];

// Equal units on both axes: the range of one grows about its middle.
function square(spec, width, height) {
  const unit = Math.max(span(spec.x) / width, span(spec.y) / height);
  for (const [axis, pixels] of [[spec.x, width], [spec.y, height]]) {
    const middle = (axis.range[0] + axis.range[1]) / 2;
    axis.shown = [middle - (unit * pixels) / 2, middle + (unit * pixels) / 2];
  }
}

function placeOf(spec, width) {
  const right = width - RIGHT, wanted = TOP + BOTTOM + ((right - 62) * span(spec.y)) / span(spec.x);
  const height = spec.equal ? Math.min(MOST, Math.max(LEAST, wanted)) : spec.height ?? HEIGHT;
  const bottom = height - BOTTOM, names = linesOf(spec.y.label, (TOP + bottom - 4) / LETTER);
  const left = spec.down ? 10 : 62 + LINE * (names.length - 1);
  if (spec.equal) square(spec, right - left, bottom - TOP);
  const shown = (axis) => ({ ...axis, range: axis.shown ?? axis.range });
  const place = { names, width, height, left, right, top: TOP, bottom, x: scale(shown(spec.x), left, right),
    y: scale(shown(spec.y), bottom, TOP) };
  place.axes = drawAxes({ x: shown(spec.x), y: shown(spec.y) }, place);
  return place;
}

// What is drawn between the axes, and cut off there.
function inside(place, nodes) {
  const width = place.right - place.left, height = place.bottom - place.top;
  return svg("svg", { class: "marks", x: place.left, y: place.top, width, height,
    viewBox: `${place.left} ${place.top} ${width} ${height}` }, ...nodes);
}

// A card with a plot. `spec`: title; x, y: {label, range, log, names}; equal: same unit on both; down: its
// things stand below each other; wide; height; draw(place): nodes; note below; for the cursor count, at(i): [x, y]
// as values, reading(i): text; csv(): text.
export function chart(spec) {
  const drawing = svg("svg", { tabindex: 0, role: "figure", "aria-label": [spec.title, spec.y.label, spec.x.label].join(", ") });
  const reading = element("output", { className: "reading" }, " ");
  const host = element("div", { className: "plot" }, drawing, reading);
  const cursor = svg("g", { class: "cursor" });
  let place, pointed = -1;

  const point = (index) => {
    pointed = index;
    cursor.replaceChildren();
    if (index >= 0) {
      const [x, y] = spec.at(index), left = place.x(x), top = place.y(y);
      if (!spec.equal && !spec.down) cursor.append(svg("line", { x1: left, x2: left, y1: place.top, y2: place.bottom }));
      if (Number.isFinite(top)) cursor.append(svg("circle", { cx: left, cy: top, r: 4 }));
    }
    reading.textContent = index >= 0 ? spec.reading(index) : " ";
  };
  const draw = () => {
    const width = host.clientWidth;
    if (width === 0 || width === place?.width) return;
    place = placeOf(spec, width);
    drawing.setAttribute("viewBox", `0 0 ${width} ${place.height}`);
    drawing.replaceChildren(...place.axes, inside(place, spec.draw(place)), cursor);
    point(pointed);
  };
  const nearest = (left, top) => {
    let best = Infinity, found = -1;
    for (let i = 0; i < spec.count; i++) {
      const [x, y] = spec.at(i);
      const d = (spec.down ? 0 : (place.x(x) - left) ** 2) + (spec.equal || spec.down ? (place.y(y) - top) ** 2 : 0);
      if (d < best) { best = d; found = i; }
    }
    return found;
  };
  drawing.addEventListener("pointermove", (event) => {
    const box = drawing.getBoundingClientRect(), unit = place.width / box.width;
    point(nearest((event.clientX - box.left) * unit, (event.clientY - box.top) * unit));
  });
  drawing.addEventListener("pointerleave", () => point(-1));
  drawing.addEventListener("keydown", (event) => {
    const step = event.shiftKey ? 10 : 1, last = spec.count - 1;
    const next = Math.min(last, pointed + step), before = Math.max(0, pointed - step);
    const to = { ArrowRight: next, ArrowDown: next, ArrowLeft: before, ArrowUp: before,
      Home: 0, End: last, Escape: -1 }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    point(to);
  });
  new ResizeObserver(draw).observe(host);
  return element("section", { className: `card panel${spec.wide ? " wide" : ""}`, "data-title": spec.title },
    element("h3", {}, spec.title,
      element("button", { type: "button", className: "csv", title: "Download these data as CSV",
        onclick: () => download(`${spec.title}.csv`.replace(/[^\w.-]+/g, "-").toLowerCase(), spec.csv()) }, "CSV")),
    host, spec.note ? element("p", { className: "shown" }, spec.note) : null);
}

// Lines of CSV; text in quotes.
export function csvOf(heads, rows) {
  const cell = (v) => (typeof v === "string" ? `"${v.replaceAll('"', '""')}"` : v ?? "");
  return [heads, ...rows].map((row) => row.map(cell).join(",")).join("\n") + "\n";
}

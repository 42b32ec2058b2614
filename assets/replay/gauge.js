// What the eye measures by, drawn over the picture: the axes of I, a length and a force, both as long as they are at the
// place that is viewed.
import { placeBeside } from "../report/labels.js";

const MARGIN = 12, AXIS = 24, HEAD = 34, LINE = 15, RING = 8, FORCE_COLOUR = "#17a05d", DOT_COLOUR = "#1f78d1";

// The largest of 1, 2, 5 times a power of ten that is not above a value.
export function roundBelow(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [5, 2, 1].map((f) => f * power).find((v) => v <= value * (1 + 1e-9));
}

const said = (value, sizes) => {
  const [unit, factor] = sizes.find(([, f]) => value * f >= 0.9995) ?? sizes.at(-1);
  return `${Number((value * factor).toPrecision(3))} ${unit}`;
};
const LENGTHS = [["km", 1e-3], ["m", 1], ["cm", 1e2], ["mm", 1e3]], FORCES = [["MN", 1e-6], ["kN", 1e-3], ["N", 1]];

// A length and a force with the pixels that they take: about `wanted` of them, or fewer.
export function measures({ perMetre, perNewton }, wanted = 120) {
  const length = roundBelow(wanted / perMetre), force = perNewton > 0 ? roundBelow((0.6 * wanted) / perNewton) : 0;
  return { length: { value: length, pixels: length * perMetre, text: said(length, LENGTHS) },
    force: force > 0 ? { value: force, pixels: force * perNewton, text: said(force, FORCES) } : null };
}

function drawAxes(ctx, axes, x, y, ink, paper) {
  axes.forEach(([right, up], i) => {
    const [dx, dy] = [AXIS * right, -AXIS * up], far = Math.hypot(dx, dy);
    ctx.beginPath();
    ctx.moveTo(x, y);
    ctx.lineTo(x + dx, y + dy);
    ctx.strokeStyle = ctx.fillStyle = ink;
    ctx.stroke();
    if (far > 6) write(ctx, "xyz"[i], x + dx * (1 + 8 / far), y + dy * (1 + 8 / far), paper);
  });
}

// A text that is read on whatever is below it.
function write(ctx, text, x, y, paper) {
  const ink = ctx.strokeStyle, width = ctx.lineWidth;
  Object.assign(ctx, { strokeStyle: paper, lineWidth: 3, lineJoin: "round" });
  ctx.strokeText(text, x, y);
  Object.assign(ctx, { strokeStyle: ink, lineWidth: width });
  ctx.fillText(text, x, y);
}

function drawBar(ctx, x, y, { pixels, text }, arrow, paper) {
  ctx.beginPath();
  ctx.moveTo(x, y);
  ctx.lineTo(x + pixels, y);
  if (!arrow) for (const end of [x, x + pixels]) { ctx.moveTo(end, y - 4); ctx.lineTo(end, y + 4); }
  ctx.stroke();
  if (arrow) {
    ctx.beginPath();
    ctx.moveTo(x + pixels, y);
    ctx.lineTo(x + pixels - 8, y - 4);
    ctx.lineTo(x + pixels - 8, y + 4);
    ctx.fill();
  }
  write(ctx, text, x + pixels / 2, y - 10, paper);
}

// Places of which the rings would meet share one, and have one name.
export function together(names) {
  return names.reduce((list, one) => {
    const near = list.find(({ x, y }) => Math.hypot(one.x - x, one.y - y) < RING);
    if (!near) return [...list, one];
    return list.map((other) => (other === near ? { ...near, name: `${near.name}, ${one.name}` } : other));
  }, []);
}

// The instants of a flight: a ring at each, its name beside it and off the path where there is room.
function drawNames(ctx, { names: all = [], way }, width, height, ink, paper) {
  const names = together(all), boxes = placeBeside(names.map(({ x, y, name }) => ({ x, y, width: ctx.measureText(name).width + 4 })), LINE,
    { left: 2, right: width - 2, top: HEAD, bottom: height - 2 }, way);
  ctx.strokeStyle = ctx.fillStyle = ink;
  names.forEach(({ name, x, y }, i) => {
    ctx.beginPath();
    ctx.arc(x, y, 3, 0, 2 * Math.PI);
    ctx.fillStyle = paper;
    ctx.fill();
    ctx.stroke();
    ctx.fillStyle = ink;
    if (boxes[i]) write(ctx, name, 0.5 * (boxes[i].left + boxes[i].right), 0.5 * (boxes[i].top + boxes[i].bottom), paper);
  });
}

// What was measured of a path.
function drawDots(ctx, dots) {
  ctx.fillStyle = DOT_COLOUR;
  for (const [x, y] of dots) {
    ctx.beginPath();
    ctx.arc(x, y, 2.5, 0, 2 * Math.PI);
    ctx.fill();
  }
}

// `seen`: axes as [right, up] of the picture, pixels a metre and a newton, names of places in it, dots; `ink`, `paper`: colours of lines and
// of what is about their texts.
export function drawGauge(canvas, seen, { ink, paper }, scale) {
  const ctx = canvas.getContext("2d"), width = canvas.width / scale, height = canvas.height / scale;
  ctx.setTransform(scale, 0, 0, scale, 0, 0);
  ctx.clearRect(0, 0, width, height);
  ctx.font = "12px sans-serif";
  ctx.textAlign = "center";
  ctx.textBaseline = "middle";
  ctx.lineWidth = 1.5;
  ctx.lineCap = "round";
  drawDots(ctx, seen.dots ?? []);
  drawNames(ctx, seen, width, height, ink, paper);
  drawAxes(ctx, seen.axes, MARGIN + 30, height - MARGIN - 28, ink, paper);
  const { length, force } = measures(seen, Math.min(120, 0.25 * width));
  ctx.strokeStyle = ctx.fillStyle = ink;
  drawBar(ctx, MARGIN + 90, height - MARGIN - 4, length, false, paper);
  if (!force) return;
  ctx.strokeStyle = ctx.fillStyle = FORCE_COLOUR;
  drawBar(ctx, MARGIN + 90 + length.pixels + 36, height - MARGIN - 4, force, true, paper);
}

// Curves over time, by uPlot.
import uPlot from "uplot";
import { filled, readable, rowAt } from "./data.js";
import { placeOnLine } from "./labels.js";
import { colour, curveColour, life, onColours } from "./page.js";
import { tickTexts } from "./ticks.js";

const NAMES = 20; // height above the plot for the names of instants [px]
const PAPER = 680; // width of a plot that fills a row of paper [px]
// Of a run's curves in one panel, and their signs below it.
const DASHES = [[], [7, 4], [2, 3], [9, 3, 2, 3]], BORDERS = ["solid", "dashed", "dotted", "double"];

// The value at a time between rows, on a straight line.
function valueBetween(t, value, time) {
  const i = rowAt(t, time);
  if (i < 0 || time > t[t.length - 1]) return NaN;
  return t[i] === time ? value[i] : value[i] + ((value[i + 1] - value[i]) * (time - t[i])) / (t[i + 1] - t[i]);
}

// Curves of several runs at all the times at which one of them has a row.
function dataOver({ panel, curves }) {
  const rows = curves.map(({ column, table, zero }) => table.t.filter((_, i) => column.value[i] !== undefined).map((t) => t - zero));
  const times = [...new Set(rows.flat())].sort((a, b) => a - b);
  return [times, ...curves.map(({ column, table, zero, shift }) => {
    const t = table.t.map((time) => time - zero), value = filled(column.value, t);
    return times.map((time) => {
      const v = valueBetween(t, value, time);
      return Number.isNaN(v) ? null : (v - shift) * panel.y.factor;
    });
  })];
}

// Times from `zero` and, for each curve, values in the unit shown, at the rows that some curve needs.
function alignedData(shown) {
  const { table, panel, curves, zero } = shown;
  if (curves[0].table) return dataOver(shown);
  const rows = [];
  for (let i = 0; i < table.t.length; i++)
    if (curves.some((curve) => curve.column.value[i] !== undefined)) rows.push(i);
  return [rows.map((i) => table.t[i] - zero), ...curves.map(({ column, shift }) => {
    const value = filled(column.value, table.t);
    return rows.map((i) => (Number.isNaN(value[i]) ? null : (value[i] - shift) * panel.y.factor));
  })];
}

// The instants in the window that have names, with the places of those above the plot.
function placeNames(u, marks) {
  const { ctx, bbox } = u, scale = devicePixelRatio;
  const named = marks.filter(({ name }) => name).map((mark) => ({ mark, at: u.valToPos(mark.t, "x", true), rank: mark.rank,
    width: ctx.measureText(mark.name).width })).filter(({ at }) => at >= bbox.left - 1 && at <= bbox.left + bbox.width + 1);
  const lefts = placeOnLine(named, 0.5 * bbox.left, bbox.left + bbox.width + 10 * scale, 6 * scale);
  return new Map(named.map(({ mark, width }, i) => [mark, lefts[i] === null ? null : { left: lefts[i], width }]));
}

// Lines at the key instants, from their names above the plot, which never meet; a name that has no room is left out.
function drawInstants(u, marks) {
  const { ctx, bbox } = u, scale = devicePixelRatio, bottom = bbox.top + bbox.height;
  ctx.save();
  ctx.font = `${11 * scale}px sans-serif`;
  ctx.textBaseline = "bottom";
  ctx.textAlign = "left";
  ctx.lineWidth = scale;
  const names = placeNames(u, marks);
  for (const mark of marks) {
    const x = Math.round(u.valToPos(mark.t, "x", true)), name = names.get(mark);
    if (x < bbox.left - 1 || x > bbox.left + bbox.width + 1) continue;
    ctx.strokeStyle = ctx.fillStyle = mark.run ? curveColour(mark.run) : colour("mark");
    ctx.globalAlpha = mark.name ? 1 : 0.5; // without a name it is one of another run than the first
    ctx.setLineDash([4 * scale, 3 * scale]);
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bottom);
    ctx.stroke();
    if (!name) continue;
    const foot = bbox.top - 7 * scale;
    ctx.fillText(mark.name, name.left, foot);
    ctx.setLineDash([]);
    ctx.beginPath();
    ctx.moveTo(Math.min(name.left + name.width, Math.max(name.left, x)), foot);
    ctx.lineTo(x, bbox.top);
    ctx.stroke();
  }
  ctx.restore();
}

// Something to see even where all values are the same.
function roomAround(u, low, high) {
  if (low === null) return [null, null];
  if (high - low > 1e-12 * Math.abs(high)) return uPlot.rangeNum(low, high, 0.1, true);
  const room = Math.abs(high) * 0.1 || 1;
  return [low - room, high + room];
}

function axis(label, grid) {
  return {
    label, labelSize: 18, labelFont: "12px sans-serif", font: "11px sans-serif",
    stroke: () => colour("ink"), grid: { stroke: () => colour("grid"), width: 1, show: grid },
    ticks: { stroke: () => colour("grid"), width: 1, size: 4 },
    values: (u, values) => tickTexts(values),
  };
}

function options(shown, group, marks, width) {
  const { panel, curves } = shown;
  return {
    width, height: shown.height, pxAlign: 0, padding: [NAMES, null, null, null],
    scales: { x: { time: false }, y: { range: roomAround } },
    axes: [{ ...axis("time from ignition [s]", true), size: 30 },
      { ...axis(panel.y.text, true), size: 56 }],
    series: [{ label: "t [s]", value: (u, v) => readable(v) },
      ...curves.map((curve, i) => ({
        label: curve.label || shown.title, stroke: () => curveColour(curve.run ?? i), width: 1.25, pxAlign: 0,
        dash: DASHES[(curve.dash ?? 0) % DASHES.length],
        points: { show: false }, value: (u, v) => readable(v),
      }))],
    legend: { markers: { dash: (u, i) => BORDERS[(curves[i - 1]?.dash ?? 0) % BORDERS.length] } },
    cursor: {
      y: false,
      sync: { key: group.cursorKey, scales: ["x", null], setSeries: false,
        filters: { pub: (type) => type === "mousemove" || type === "mouseleave" } },
      drag: { x: true, y: false },
      bind: { dblclick: () => () => { group.reset(); return null; } },
    },
    hooks: {
      draw: [(u) => drawInstants(u, marks)],
      setScale: [(u, key) => key === "x" && group.zoomed(u.scales.x.min, u.scales.x.max)],
      setCursor: [(u) => u.cursor.idx !== null && u.cursor.left >= 0 &&
        group.pointed(u.posToVal(u.cursor.left, "x"))],
    },
  };
}

// Arrows move the cursor from row to row, + and - zoom about it, Escape shows all.
function listenToKeys(u, data, group) {
  const point = (row) => u.setCursor(
    { left: u.valToPos(data[0][row], "x"), top: u.over.clientHeight / 2 }, true, true);
  const zoom = (factor) => {
    const { min, max } = u.scales.x;
    const center = u.cursor.left >= 0 ? u.posToVal(u.cursor.left, "x") : (min + max) / 2;
    group.show(center + (min - center) * factor, center + (max - center) * factor);
  };
  u.root.tabIndex = 0;
  u.root.addEventListener("keydown", (event) => {
    const row = u.cursor.idx ?? Math.max(0, rowAt(data[0], u.scales.x.min) + 1);
    const last = data[0].length - 1, step = event.shiftKey ? 10 : 1;
    const actions = {
      ArrowLeft: () => point(Math.max(0, row - step)),
      ArrowRight: () => point(Math.min(last, row + step)),
      "+": () => zoom(0.5), "-": () => zoom(2), Escape: () => group.reset(),
    };
    if (!actions[event.key]) return;
    event.preventDefault();
    actions[event.key]();
  });
}

// A plot that fills its row on paper alone is drawn as wide as two there, for its letters to be as large as theirs.
function drawWideOnPaper(u, host, height) {
  const alone = ".of5 > :nth-child(3) *, .grid > :last-child:nth-child(odd) *";
  addEventListener("beforeprint", () => host.matches(alone) && u.setSize({ width: Math.max(PAPER, u.width), height }), { signal: life() });
  addEventListener("afterprint", () => u.setSize({ width: host.clientWidth || u.width, height }), { signal: life() });
}

export function timePlot(shown, group, marks, host) {
  const data = alignedData(shown);
  const u = new uPlot(options(shown, group, marks, host.clientWidth || 600), data, host);
  u.root.setAttribute("role", "figure");
  u.root.setAttribute("aria-label", `${shown.title}, ${shown.panel.y.text}, over time`);
  listenToKeys(u, data, group);
  new ResizeObserver(() => {
    if (host.clientWidth !== u.width) u.setSize({ width: host.clientWidth, height: shown.height });
  }).observe(host);
  onColours(() => u.redraw(false, true));
  drawWideOnPaper(u, host, shown.height);
  life().addEventListener("abort", () => u.destroy());
  return {
    uplot: u,
    window: (min, max) => u.setScale("x", { min, max }),
    extent: [data[0][0], data[0][data[0].length - 1]],
  };
}

// One column against another, as a path on a canvas, or the paths of several runs; their points follow
// the window of time and the cursor of the plots over time.
import { filled, readable, rowAt } from "./data.js";
import { placeBeside } from "./labels.js";
import { colour, curveColour, element, onColours } from "./page.js";
import { tickTexts, ticks } from "./ticks.js";

const LEFT = 74, RIGHT = 14, TOP = 12, BOTTOM = 46;

function widened(values) {
  let low = Infinity, high = -Infinity;
  for (const v of values) if (Number.isFinite(v)) { low = Math.min(low, v); high = Math.max(high, v); }
  if (!(high >= low)) return [0, 1];
  const room = (high - low) * 0.05 || Math.abs(high) * 0.1 || 1;
  return [low - room, high + room];
}

// A run's way: where it is at its times from ignition, and which rows are in the window.
function wayOf({ panel }, { column, against, table, zero, run = 0, label }) {
  const t = table.t.map((time) => time - zero);
  return {
    t, run, label, first: 0, last: t.length - 1, pointed: -1,
    x: filled(against.value, t).map((v) => v * panel.x.factor),
    y: filled(column.value, t).map((v) => v * panel.y.factor),
  };
}

const isAt = (way, row) => Number.isFinite(way.x[row]) && Number.isFinite(way.y[row]);

// The row of a way that is next to a time.
function rowNext({ t }, time) {
  const row = Math.max(0, rowAt(t, time));
  return row + 1 < t.length && t[row + 1] - time < time - t[row] ? row + 1 : row;
}

export function pathPlot(shown, group, marks, host) {
  const { table, panel, curves, against, zero } = shown, several = curves[0].table !== undefined;
  const ways = several ? curves.map((curve) => wayOf(shown, curve))
    : [wayOf(shown, { column: curves[0].column, against, table, zero, label: "" })];
  const canvas = element("canvas", { tabIndex: 0 });
  const reading = element("output", { className: "reading" });
  canvas.setAttribute("role", "figure");
  canvas.setAttribute("aria-label", `${shown.title}: ${panel.y.text} against ${panel.x.text}`);
  canvas.style.height = `${shown.height}px`;
  host.append(canvas, reading);
  let place;

  const inWindow = (of) => ways.flatMap((way) => [...way[of].subarray(way.first, way.last + 1)]);
  const measure = () => {
    const range = [widened(inWindow("x")), widened(inWindow("y"))];
    const w = canvas.clientWidth - LEFT - RIGHT, h = shown.height - TOP - BOTTOM;
    place = {
      range,
      x: (v) => LEFT + ((v - range[0][0]) / (range[0][1] - range[0][0])) * w,
      y: (v) => TOP + h - ((v - range[1][0]) / (range[1][1] - range[1][0])) * h,
    };
  };

  const drawAxes = (ctx) => {
    const right = canvas.clientWidth - RIGHT, bottom = shown.height - BOTTOM;
    ctx.strokeStyle = colour("grid");
    ctx.fillStyle = colour("ink");
    ctx.font = "11px sans-serif";
    ctx.textAlign = "center";
    ctx.textBaseline = "top";
    const across = ticks(...place.range[0], Math.max(3, (right - LEFT) / 80)), up = ticks(...place.range[1], 5);
    tickTexts(across).forEach((text, i) => {
      const v = across[i];
      ctx.strokeRect(place.x(v), TOP, 0, bottom - TOP);
      ctx.fillText(text, place.x(v), bottom + 5);
    });
    ctx.textAlign = "right";
    ctx.textBaseline = "middle";
    tickTexts(up).forEach((text, i) => {
      const v = up[i];
      ctx.strokeRect(LEFT, place.y(v), right - LEFT, 0);
      ctx.fillText(text, LEFT - 6, place.y(v));
    });
    ctx.font = "12px sans-serif";
    ctx.textAlign = "center";
    ctx.fillText(panel.x.text, (LEFT + right) / 2, shown.height - 12);
    ctx.save();
    ctx.translate(12, (TOP + bottom) / 2);
    ctx.rotate(-Math.PI / 2);
    ctx.fillText(panel.y.text, 0, 0);
    ctx.restore();
  };

  const dot = (ctx, way, row, fill) => {
    if (row < 0 || !isAt(way, row)) return;
    ctx.fillStyle = fill;
    ctx.beginPath();
    ctx.arc(place.x(way.x[row]), place.y(way.y[row]), 3.5, 0, 7);
    ctx.fill();
  };

  // Some hundred points of the ways, as they are drawn.
  const someOf = (all) => all.flatMap(({ x, y, first, last }) => Array.from({ length: 200 }, (_, i) => {
    const row = Math.round(first + ((last - first) * i) / 199);
    return [place.x(x[row]), place.y(y[row])];
  }));

  // A dot at each instant, its name beside it where there is room.
  const drawMarks = (ctx) => {
    const named = [];
    for (const mark of marks) {
      const way = ways.find(({ run }) => run === (mark.run ?? 0)), row = way ? rowNext(way, mark.t) : -1;
      if (!way || row < way.first || row > way.last || !isAt(way, row)) continue;
      dot(ctx, way, row, mark.run ? curveColour(mark.run) : colour("mark"));
      if (mark.name) named.push({ mark, x: place.x(way.x[row]), y: place.y(way.y[row]), width: ctx.measureText(mark.name).width });
    }
    ctx.fillStyle = colour("mark");
    ctx.textAlign = "left";
    ctx.textBaseline = "middle";
    const bounds = { left: LEFT, right: canvas.clientWidth, top: 0, bottom: shown.height - BOTTOM };
    named.sort((a, b) => a.mark.rank - b.mark.rank);
    placeBeside(named, 13, bounds, someOf(ways)).forEach((box, i) => box && ctx.fillText(named[i].mark.name, box.left, (box.top + box.bottom) / 2));
  };

  const draw = () => {
    const scale = devicePixelRatio, ctx = canvas.getContext("2d");
    if (canvas.clientWidth === 0) return;
    canvas.width = canvas.clientWidth * scale;
    canvas.height = shown.height * scale;
    ctx.scale(scale, scale);
    measure();
    drawAxes(ctx);
    for (const way of ways) {
      ctx.beginPath();
      for (let i = way.first, pen = false; i <= way.last; i++) {
        const has = isAt(way, i);
        if (has) ctx[pen ? "lineTo" : "moveTo"](place.x(way.x[i]), place.y(way.y[i]));
        pen = has;
      }
      ctx.strokeStyle = curveColour(way.run);
      ctx.lineWidth = 1.25;
      ctx.stroke();
    }
    drawMarks(ctx);
    for (const way of ways) dot(ctx, way, way.pointed, colour("ink"));
    reading.textContent = ways.filter(({ pointed }) => pointed >= 0).map(({ t, x, y, label, pointed }) =>
      `${several ? `${label}: ` : ""}t ${readable(t[pointed])} s   x ${readable(x[pointed])}   y ${readable(y[pointed])}`)
      .join("\n") || " ";
  };

  // The point of the path nearest to the mouse leads the other plots.
  canvas.addEventListener("mousemove", (event) => {
    let best = Infinity, found;
    for (const { t, x, y, first, last } of ways)
      for (let i = first; i <= last; i++) {
        const d = (place.x(x[i]) - event.offsetX) ** 2 + (place.y(y[i]) - event.offsetY) ** 2;
        if (d < best) { best = d; found = t[i]; }
      }
    if (found !== undefined) group.pointAt(found);
  });
  canvas.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const { t, first, last, pointed } = ways[0];
    group.pointAt(t[Math.min(last, Math.max(first, (pointed < 0 ? first : pointed) + step))]);
  });
  new ResizeObserver(draw).observe(canvas);
  onColours(draw);
  return {
    window: (min, max) => {
      for (const way of ways) {
        way.first = Math.max(0, rowAt(way.t, min));
        way.last = Math.max(way.first, rowAt(way.t, max));
      }
      draw();
    },
    point: (time) => {
      const rows = ways.map((way) => rowNext(way, time));
      if (rows.every((row, i) => row === ways[i].pointed)) return;
      ways.forEach((way, i) => { way.pointed = rows[i]; });
      draw();
    },
    extent: [ways[0].t[0], ways[0].t[ways[0].t.length - 1]],
  };
}

// What a figure's panels show of a table: curves ready to be drawn.
import { filled, matching, rowAt } from "./data.js";

const OPEN = 186, FOLDED = 240; // heights of plots [px]

const hasValues = (column) => column.value.some((v) => typeof v === "number");

// Value of a column at a time, of the row kept there or before.
function valueAt(column, t, time) {
  let row = Math.max(0, rowAt(t, time));
  while (row > 0 && typeof column.value[row] !== "number") row--;
  return column.value[row] ?? 0;
}

function curvesOf(table, panel, zero) {
  const curves = [];
  for (const [pattern, label] of panel.curves)
    for (const [column, text] of matching(table, pattern))
      if (hasValues(column))
        curves.push({
          column, label: text || label || "",
          shift: panel.since ? valueAt(column, table.t, zero) : 0,
        });
  return curves;
}

// The panels with something to show. One for each curve where the panel says so; its unit and
// axes are those of the figure.
export function panelsOf(table, figure, zero) {
  const shown = [];
  for (const panel of figure.panels) {
    const against = panel.x && table.column.get(panel.x.column);
    const curves = curvesOf(table, panel, zero);
    if (curves.length === 0 || (panel.x && !against)) continue;
    const base = { figure, panel, table, zero, against, height: figure.open ? OPEN : FOLDED };
    if (panel.each)
      for (const curve of curves)
        shown.push({ ...base, title: panel.title.replace("%s", () => curve.label), curves: [curve] });
    else shown.push({ ...base, title: panel.title, curves });
  }
  return shown;
}

// The panels of several runs, each {table, zero, label, index}, laid over each other: a curve knows its own
// run, whose colour it has; curves of one run in one panel differ by their dashes.
export function panelsOver(runs, figure) {
  const found = new Map();
  runs.forEach(({ table, zero, label, index: run }) => {
    for (const shown of panelsOf(table, figure, zero)) {
      const key = `${figure.panels.indexOf(shown.panel)} ${shown.title}`, named = shown.curves.length > 1;
      const curves = shown.curves.map((curve, dash) => ({ ...curve, table, zero, against: shown.against, run, dash,
        of: label, label: named && curve.label ? `${label}, ${curve.label}` : label }));
      if (!found.has(key)) found.set(key, { ...shown, curves: [] });
      found.get(key).curves.push(...curves);
    }
  });
  return [...found.values()];
}

const quoted = (text) => `"${text.replaceAll('"', '""')}"`;

// Of several runs: each run's rows one after the other, with its name.
function csvOver(curves) {
  const lines = [["run", "column", "time [s]", "value", "against"].map(quoted).join(",")];
  for (const { column, against, table, zero, of } of curves)
    table.t.forEach((t, i) => {
      if (column.value[i] === undefined) return;
      lines.push([quoted(of), quoted(`${column.name} [${column.unit}]`), t - zero, column.value[i] ?? "",
        against?.value[i] ?? ""].join(","));
    });
  return lines.join("\n") + "\n";
}

// The data of a panel as CSV, in SI: the rows kept by one of its curves.
export function csvOf(shown) {
  const { table, curves, zero, against } = shown;
  if (curves[0].table) return csvOver(curves);
  const columns = [...(against ? [against] : []), ...curves.map((curve) => curve.column)];
  const lines = [["time [s]", ...columns.map((c) => `${c.name} [${c.unit}]`)].map(quoted).join(",")];
  table.t.forEach((t, i) => {
    if (columns.every((c) => c.value[i] === undefined)) return;
    lines.push([t - zero, ...columns.map((c) => c.value[i] ?? "")].join(","));
  });
  return lines.join("\n") + "\n";
}

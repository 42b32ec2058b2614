// A run beside a log: verdicts in a table, each series as measured over the simulated one, below that their difference
// between twice its standard uncertainties.
import { element } from "./page.js";
import { addFigures, PlotGroup } from "./plot_group.js";
import { rounded } from "./rounded.js";

const said = (value, unit) => (Number.isFinite(value) ? `${rounded(value)}${unit ? `\u00a0${unit}` : ""}` : "–");

// One curve of a series, as panels have them.
const curve = (name, label, value, colour) => ({ column: { name, unit: "", value }, shift: 0, label, run: colour });

function panelsOf(series) {
  const { name, unit, t, measured, simulated, u } = series;
  const table = { t, column: new Map() }, text = (what) => `${what}${unit ? ` [${unit}]` : ""}`;
  const panel = (title, label, curves) => ({ figure: { name: "compared", open: true }, table, zero: 0, height: 186, title, curves,
    panel: { y: { text: text(label), factor: 1 }, wide: false } });
  return [
    panel(name, name, [curve("measured", "measured", measured), curve("simulated", "simulated", simulated)]),
    panel(`${name}: simulated less measured`, "E", [curve("E", "E", simulated.map((v, i) => v - measured[i])),
      curve("2 u_val", "+2 u_val", u.map((v) => 2 * v), 1), curve("-2 u_val", "−2 u_val", u.map((v) => -2 * v), 1)]),
  ];
}

function verdicts({ series, results }) {
  const head = ["", "measured", "simulated", "E", "u_val", "verdict"].map((word) => element("th", { scope: "col" }, word));
  const row = (name, cells) => element("tr", {}, element("th", { scope: "row" }, name), ...cells.map((cell) => element("td", {}, cell)));
  return element("table", { className: "compared" }, element("thead", {}, element("tr", {}, ...head)), element("tbody", {},
    ...series.map((s) => row(`${s.name}, ${s.count} samples`, ["", "", `${said(s.error, s.unit)} rms`, said(s.uVal, s.unit), s.verdict])),
    ...results.map((r) => row(r.name, [said(r.measured, r.unit), said(r.simulated, r.unit), said(r.error, r.unit),
      said(r.uVal, r.unit), r.verdict]))));
}

// Where the log says that the rocket was: how far from the computed mass centre, in I [m], at its instants from ignition.
export function measuredPath(compared) {
  const axes = ["center.x", "center.y", "center.z"], at = new Map();
  for (const { column, factor, t, measured, simulated } of compared?.series ?? []) {
    const axis = axes.indexOf(column);
    if (axis < 0) continue;
    t.forEach((time, i) => {
      if (!at.has(time)) at.set(time, [0, 0, 0]);
      at.get(time)[axis] = (measured[i] - simulated[i]) * factor;
    });
  }
  return [...at].sort(([a], [b]) => a - b).map(([t, off]) => ({ t, off }));
}

// The lines of the answer: of each series how far off it is.
export const comparedLines = (compared) => (compared?.series ?? []).map(({ name, unit, error, uVal, verdict }) =>
  ({ label: `Measured ${name}`, said: verdict, note: `${compared.log}: E ${said(error, unit)} rms, u_val ${said(uVal, unit)}` }));

export function showCompared(host, nav, compared) {
  if (!compared) return;
  nav.append(element("a", { href: "#compared" }, "Measured"));
  host.append(element("h2", { id: "compared" }, `Compared with ${compared.log}`), element("section", { className: "card scroll" }, verdicts(compared)));
  compared.series.forEach((series, i) => {
    const group = new PlotGroup(`compared${i}`, [series.t[0], series.t[series.t.length - 1]]);
    addFigures(host, `compared${i}`, [{ name: "compared", title: series.name, open: true, time: "flight" }], () => panelsOf(series),
      { launch: group, vehicle: new PlotGroup(`compared${i}`, group.home) }, []);
  });
}

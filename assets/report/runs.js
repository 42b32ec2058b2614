// The report of several runs laid over each other: in what they differ, their summaries side by side,
// each figure with the curves of all.
import { readable } from "./data.js";
import { decodeTable } from "./decode.js";
import { originBlock } from "./origin.js";
import { element, themeSwitch } from "./page.js";
import { panelsOver } from "./panels.js";
import { addFigures, homeOf, launchChoice, launchWindow, PlotGroup } from "./plot_group.js";
import { differences, labelsOf, shownValue } from "./runs_differ.js";
import { showSummaries } from "./summary.js";

const MOST_KEYS = 40;
const host = document.getElementById("report");
const data = JSON.parse(document.getElementById("data").textContent);

// What a tag of that name holds, or nothing where there is none or it makes no sense.
function read(name) {
  try {
    return JSON.parse(document.getElementById(name).textContent);
  } catch {
    return null;
  }
}

const runs = data.runs.map((run, i) => {
  const summary = read(`summary-${i}`);
  return { ...run, summary, origin: read(`origin-${i}`), title: String(summary?.title || run.title),
    tables: run.tables.map(decodeTable) };
});
const keys = differences(runs.map(({ origin }) => origin?.scenario));
labelsOf(runs, keys).forEach((label, i) => { runs[i].label = label; });

// A swatch of the run's colour before its name.
const seriesName = ({ label }, i) =>
  element("span", { className: "series" }, element("i", { style: `--series: var(--curve${i})` }), label);

// ---- in what they differ

function stateOf({ summary, complete, stopped }) {
  if (summary ? summary.complete : complete) return "complete";
  return `ended early: ${summary?.stopped || stopped || "it was stopped, or its results are incomplete"}`;
}

function showDifferences() {
  const row = (name, cells) => element("tr", {}, element("th", { scope: "row" }, name),
    ...cells.map((cell) => element("td", { className: "text" }, cell)));
  const shown = keys.slice(0, MOST_KEYS).map(([path, values]) => row(path, values.map(shownValue)));
  const left = keys.length - shown.length;
  return element("section", { className: "card" }, element("h3", {}, "What was run"),
    element("div", { className: "scroll", tabIndex: 0, role: "region", ariaLabel: "What was run" }, element("table", {},
      element("tr", {}, element("th", {}, ""), ...runs.map((run, i) => element("th", { scope: "col" }, seriesName(run, i)))),
      row("title", runs.map(({ title }) => title.slice(0, 200))), row("folder", runs.map(({ folder }) => folder)),
      row("state", runs.map(stateOf)), ...shown)),
    left > 0 ? element("p", {}, `${left} more keys differ.`) : null);
}

function summaries() {
  const some = runs.filter(({ summary }) => summary);
  try {
    return some.length ? showSummaries(some) : element("div", { id: "tables" });
  } catch {
    data.notes.push("No summaries: a summary.json does not belong to a run.");
    return element("div", { id: "tables" });
  }
}

// ---- figures

// The tables of all runs that are laid over each other: those of the launch, or of one rocket's flight.
function laidOver(kind, rocket) {
  return runs.flatMap((run, index) => {
    const table = run.tables.find((one) => one.kind === kind && (kind === "launch" || one.rocket === rocket) && one.t.length > 0);
    const zero = run.rockets[Math.max(0, rocket - 1)]?.ignition ?? 0;
    return table ? [{ run, index, table, zero, label: run.label }] : [];
  });
}

function marksOf(over) {
  return over.flatMap(({ index, table }, i) =>
    table.marks.map((mark) => ({ ...mark, run: index, name: i === 0 ? mark.name : "" })));
}

const widest = (over, all) => over.map(({ table, zero }) => homeOf(table, zero, all))
  .reduce(([low, high], [from, to]) => [Math.min(low, from), Math.max(high, to)]);

function showOver(kind, rocket, heading, nav) {
  const over = laidOver(kind, rocket), id = `${kind}${rocket || ""}`;
  if (over.length === 0) return;
  const marks = marksOf(over);
  const groups = {
    launch: new PlotGroup(id, widest(over, kind === "flight")),
    vehicle: new PlotGroup(id, widest(over, true)),
  };
  host.append(element("h2", { id }, heading));
  nav.append(element("a", { href: `#${id}` }, heading));
  const { rockets } = over[0].run, several = kind === "launch" && rockets.length > 1;
  const choice = several ? launchChoice(rockets.length, (rocket) => {
    choice.show(rocket);
    groups.launch.show(...(launchWindow(rockets[rocket], over[0].zero) ?? groups.launch.home));
  }) : null;
  if (choice) host.append(choice.node);
  const figures = data.figures.filter(({ time }) => (time === "flight") === (kind === "flight"));
  addFigures(host, id, figures, (figure) => panelsOver(over, figure), groups, marks);
  choice?.node.querySelector("button").click();
}

// ---- the page

const tables = summaries();
const nav = element("nav", {}, element("a", { href: "#summary-tables" }, "Summary"));
const titles = new Set(runs.map(({ title }) => title));
host.replaceChildren(element("header", {}, element("h1", {}, titles.size === 1 ? [...titles][0] : "Runs overlaid"), nav,
  themeSwitch(), element("p", { className: "legend" }, ...runs.map(seriesName))));
tables.prepend(showDifferences());
host.append(element("h2", { id: "summary-tables" }, "Summary"),
  ...data.notes.map((note) => element("p", { className: "warning" }, note)),
  ...runs.flatMap(({ label, summary }) => (summary?.notes ?? []).map((note) => element("p", { className: "warning" }, `${label}: ${note}`))),
  tables);
showOver("launch", 0, "Launch", nav);
const rockets = Math.max(...runs.map((run) => run.rockets.length), 1);
for (let i = 0; i <= rockets; i++)
  showOver("flight", i, i > 0 && rockets > 1 ? `Flight of rocket ${i}` : "Flight", nav);
if (runs.some(({ origin }) => origin)) {
  host.append(element("section", { className: "together" }, element("h2", { id: "origin-heading" }, "Origin"),
    ...runs.filter(({ origin }) => origin).flatMap(({ label, origin }) => [element("h3", {}, label), originBlock(origin, "run --again")])));
  nav.append(element("a", { href: "#origin-heading" }, "Origin"));
}
const rows = runs.reduce((sum, run) => sum + run.tables.reduce((part, table) => part + table.full, 0), 0), { pixels, overAll } = runs[0];
host.append(element("footer", {}, element("p", {},
  `launchdyn ${data.version}. Colours are runs; curves of one run in one plot differ by their dashes. Times count from each run's own ` +
  "ignition; lines at its key instants have its colour, those of the first run their names. Drag over a plot to zoom, double-click to see all; " +
  "with the keyboard: Tab to a plot, arrows move the cursor, + and - zoom, Escape shows all. " +
  (pixels === 0 ? `The report has all ${rows} rows of the results, ` : `Of ${rows} rows the report has those that curves require (error at most ` +
    `${readable(pixels)} of 4000 pixels of the curve's height in ${overAll ? "all" : "each phase"} of the run), `) + "to 7 digits.")));
document.documentElement.dataset.ready = "yes";

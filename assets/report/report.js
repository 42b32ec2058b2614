// The report of a run: replay, launcher and answer first, then the plots of each table of numbers, then all numbers.
import { answerCard } from "./answer.js";
import { comparedLines, measuredPath, showCompared } from "./compared.js";
import { filled, readable, rowAt } from "./data.js";
import { decodeTable, inflated } from "./decode.js";
import { colour, download, element, life, onColours, renew, themeSwitch } from "./page.js";
import { drawingCard } from "./drawing.js";
import { originBlock } from "./origin.js";
import { namedFigures, namingOf } from "./naming.js";
import { panelsOf, panelsOver } from "./panels.js";
import { addFigures, homeOf, launchChoice, launchWindow, PlotGroup } from "./plot_group.js";
import { fixed, playing } from "./rounded.js";
import { showSummary } from "./summary.js";

// What is shown, one run at a time: `given` by the page that a report is, or by the page that simulates, run after run.
let host, given, data, named, choice, shown, tables, launch, otherFlights;

// The summary and its tables; neither where there is none, or one that makes no sense: then a warning says so.
function readSummary() {
  if (!given.summary) return {};
  try {
    const summary = JSON.parse(given.summary);
    return { summary, tables: showSummary(summary, named), notes: (summary.notes ?? []).map(String) };
  } catch {
    data.notes.push("No summary: summary.json does not belong to a run.");
    return {};
  }
}

// Of several flights the first shows its path, and folds the rest; the others are folded as a whole, side by side.
function figuresOf(table) {
  const flight = table.kind === "flight", figures = data.figures.filter(({ time }) => (time === "flight") === flight);
  const several = flight && table.rocket === 1 && data.rockets.length > 1;
  return figures.map((figure, i) => (several ? { ...figure, open: figure.open && i === 0 } : figure));
}

// The same table of runs before, whose curves are laid below: each {label, rockets, tables}.
function earlierOf({ kind, rocket }) {
  return given.earlier.flatMap(({ label, rockets, tables: before }, i) => {
    const table = before.find((one) => one.kind === kind && one.rocket === rocket && one.t.length > 0);
    return table ? [{ table, zero: rockets[Math.max(0, rocket - 1)]?.ignition ?? 0, label, index: i + 1 }] : [];
  });
}

function showTable(table, index, nav) {
  const heading = table.kind === "launch" ? "Launch"
    : data.rockets.length > 1 ? `Flight of rocket ${table.rocket || 1}` : "Flight";
  const ignition = data.rockets[Math.max(0, table.rocket - 1)]?.ignition ?? 0;
  const { marks } = table;
  const groups = {
    launch: new PlotGroup(`table${index}`, homeOf(table, ignition, table.kind === "flight")),
    vehicle: new PlotGroup(`table${index}`, homeOf(table, ignition, true)),
  };
  const id = `table${index}`, figures = figuresOf(table);
  const over = earlierOf(table);
  const panels = (figure) => (over.length > 0 ? panelsOver([{ table, zero: ignition, label: given.label, index: 0 }, ...over], figure)
    : panelsOf(table, figure, ignition));
  const fill = (host) => addFigures(host, id, figures, panels, groups, marks);
  if (table.kind === "flight" && table.rocket > 1) {
    const folded = element("details", { className: "flight", id }, element("summary", {}, heading));
    folded.addEventListener("toggle", () => fill(folded), { once: true });
    otherFlights.append(folded);
    host.append(otherFlights);
  } else {
    nav.append(element("a", { href: `#${id}` }, heading));
    host.append(element("h2", { id }, heading));
    if (table.kind === "launch" && choice) host.append(choice.node);
    fill(host);
  }
  return { table, marks, zero: ignition, group: groups.launch };
}

function hasWebGL() {
  try {
    return Boolean(document.createElement("canvas").getContext("webgl2"));
  } catch {
    return false;
  }
}

// Of several launches the plots and the replay show one, the first at first, or all of them.
function chooseLaunch(rocket) {
  const { group, zero } = shown[tables.indexOf(launch)];
  choice.show(rocket);
  group.show(...(launchWindow(data.rockets[rocket], zero) ?? group.home));
  const replay = window.launchdyn?.current;
  if (replay) requestAnimationFrame(() => replay.choose(rocket)); // when the plots have their window
}

// Why there is no replay, or nothing.
function missing() {
  if (!document.getElementById("replay"))
    return "No replay: these results do not have the launcher's geometry. The plots below show the run.";
  if (!hasWebGL())
    return "No replay: this browser has no WebGL. The plots below show the same run.";
  return null;
}

// Takes the replay's own script out of the page and starts it; the page's policy knows that script.
function startReplay(place, shown, flights) {
  if (!window.launchdyn.replay) {
    const code = new TextDecoder().decode(inflated(document.getElementById("replay").textContent));
    document.head.append(element("script", { textContent: code }));
  }
  const { table, marks, zero, group } = shown;
  let leading = false, last = 0, wanted = null;
  const replay = window.launchdyn.replay(place, {
    table, marks, zero, flights, geometry: data.geometry, rockets: data.rockets, measured: measuredPath(data.compared),
    chose: chooseLaunch, tools: { colour, download, element, filled, fixed, life, onColours, playing, readable, rowAt }, version: data.version,
    shown: (time) => {
      const now = performance.now();
      if (now - last < 400 && replay?.playing) return;
      last = now;
      leading = true;
      group.pointAt(time - zero);
      leading = false;
    },
  });
  // every plot says where the shared cursor is: one picture for all of them
  const follow = () => {
    if (wanted !== null && !replay.playing) replay.show(zero + wanted, true);
    wanted = null;
  };
  group.followers.push({ point: (time) => {
    if (leading) {
      wanted = null;
      return;
    }
    if (wanted === null) requestAnimationFrame(follow);
    wanted = time;
  } });
  window.launchdyn.current = replay; // for tests, and for whoever looks into the page
}

function showReplay(place, shown, flights) {
  const why = missing();
  try {
    if (!why) startReplay(place, shown, flights);
    else place.append(element("p", { className: "warning" }, why));
  } catch (error) {
    place.replaceChildren(element("p", { className: "warning" },
      `No replay: ${error.message}. The plots below show the run.`));
  }
}

function state(summary) {
  const complete = summary ? summary.complete : data.complete;
  if (complete) return element("p", { className: "state" }, "The run is complete.");
  const why = summary?.stopped || data.stopped || "it was stopped, or its results are incomplete";
  return element("p", { className: "state warning" }, `The run ended early: ${why}`);
}

// A flight alone has a replay, too.
const replayed = () => launch ?? tables.find((table) => table.kind === "flight" && table.t.length > 0);

// The first screen: replay, drawing, answer.
function overview({ summary, notes }, place) {
  const ignition = data.rockets[0]?.ignition ?? launch?.t[0] ?? 0;
  const answer = answerCard({ summary, state: state(summary), notes: [...data.notes, ...notes], table: launch, ignition, named,
    compared: comparedLines(data.compared) });
  return element("div", { className: `overview${replayed() ? "" : " alone"}` }, replayed() ? place : null, answer, launch ? drawing() : null);
}

// Nothing where an earlier version has kept no geometry.
function drawing() {
  try {
    return drawingCard({ geometry: data.geometry, table: launch, rockets: data.rockets, named });
  } catch {
    return null;
  }
}

function showOrigin(nav) {
  if (!given.origin) return;
  host.append(element("section", { className: "together" }, element("h2", { id: "origin-heading" }, "Origin"),
    originBlock(given.origin, "run --again")));
  nav.append(element("a", { href: "#origin-heading" }, "Origin"));
}

function foot() {
  const rows = tables.reduce((sum, table) => sum + table.full, 0);
  return element("footer", {}, element("p", {},
    `launchdyn ${data.version}. Drag over a plot to zoom, double-click to see all; with the keyboard: ` +
    "Tab to a plot, arrows move the cursor, + and - zoom, Escape shows all. " +
    (data.pixels === 0 ? `The report has all ${rows} rows of the results, `
      : `Of ${rows} rows the report has those that curves require (error at most ` +
        `${readable(data.pixels)} of 4000 pixels of the curve's height in ${data.overAll ? "all" : "each phase"} ` +
        "of the run), ") + "to 7 digits."));
}

// Shows a run in place of the one before: its data and the text of its summary, its origin or null; `theme`: the switch of
// the page; `earlier` runs and its own `label` among them. Returns its tables, for it to be an earlier run.
function show(more) {
  window.launchdyn.current?.end();
  delete window.launchdyn.current;
  renew();
  given = more;
  data = { ...given.data, notes: [...given.data.notes] };
  named = namingOf(data.geometry);
  data.figures = namedFigures(data.figures, named);
  otherFlights = element("div", { className: "rest flights" });
  choice = data.rockets.length > 1 ? launchChoice(data.rockets.length, (rocket) => chooseLaunch(rocket)) : null;
  const { summary, tables: summaryTables, notes = [] } = readSummary();
  tables = data.tables.map(decodeTable);
  launch = tables.find((table) => table.kind === "launch" && table.t.length > 0);
  const place = element("section", { className: "card replay", id: "replay-card" });
  const nav = element("nav", {}, element("a", { href: "#answer" }, "Answer"));
  host.replaceChildren(element("header", {}, element("h1", {}, summary?.title || data.title), nav, given.theme),
    overview({ summary, notes }, place));
  showCompared(host, nav, data.compared);
  shown = tables.map((table, i) => table.t.length > 0 && showTable(table, i, nav));
  if (launch && choice) chooseLaunch(0);
  if (replayed())
    showReplay(place, shown[tables.indexOf(replayed())],
      data.rockets.map((_, i) => tables.find((table) => table.kind === "flight" && (!launch || table.rocket === i + 1) && table.t.length > 0)));
  if (summary) {
    host.append(element("h2", { id: "summary-tables" }, "All numbers"), summaryTables);
    nav.append(element("a", { href: "#summary-tables" }, "Numbers"));
  }
  showOrigin(nav);
  host.append(foot());
  document.documentElement.dataset.ready = "yes";
  return { rockets: data.rockets, tables };
}

host = document.getElementById("report");
window.launchdyn = { show, element, download, inflated, themeSwitch };
const read = (name) => document.getElementById(name)?.textContent;
if (read("data")) {
  const origin = read("origin");
  show({ data: JSON.parse(read("data")), summary: read("summary"), origin: origin ? JSON.parse(origin) : null, theme: themeSwitch(),
    earlier: [] });
}

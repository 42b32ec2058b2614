// Plots that share cursor and window of time, each in its card.
import { download, element } from "./page.js";
import { csvOf } from "./panels.js";
import { pathPlot } from "./path_plot.js";
import { timePlot } from "./time_plot.js";

// Plots of one table that share the cursor, and of one kind that share the window of time.
export class PlotGroup {
  constructor(cursorKey, home) {
    this.cursorKey = cursorKey;
    this.home = home;
    this.plots = [];
    this.followers = this.plots; // what shows the cursor; the table's other groups too
    this.busy = true;
  }
  // A plot more, which shows what the others do.
  add(plot) {
    this.plots.push(plot);
    if (this.shown) this.show(...this.shown);
    return plot;
  }
  show(min, max) {
    this.shown = [min, max];
    this.busy = true;
    for (const plot of this.plots) plot.window(min, max);
    this.busy = false;
  }
  reset() {
    this.show(...this.home);
  }
  zoomed(min, max) {
    if (!this.busy && Number.isFinite(min)) this.show(min, max);
  }
  pointed(time) {
    for (const plot of this.followers) plot.point?.(time);
  }
  pointAt(time) {
    const plot = this.followers.find((p) => p.uplot);
    plot?.uplot.setCursor({ left: plot.uplot.valToPos(time, "x"), top: 1 }, true, true);
    this.pointed(time);
  }
}

const fileName = (shown) =>
  `${shown.figure.name}-${shown.title}`.replace(/[^\w-]+/g, "-").toLowerCase() + ".csv";

function addPanel(grid, shown, group, marks) {
  const canvas = element("div", { className: "plot" });
  const card = element("section", { className: `card panel${shown.panel.wide ? " wide" : ""}` },
    element("h3", {}, shown.title,
      element("button", { type: "button", className: "csv", title: "Download these data as CSV",
        onclick: () => download(fileName(shown), csvOf(shown)) }, "CSV")),
    canvas);
  grid.append(card);
  return group.add((shown.panel.x ? pathPlot : timePlot)(shown, group, marks, canvas));
}

// A figure of the story, or one that is folded and drawn when it is unfolded; `draw` fills its grid.
function figureOf(id, { open, title }, count, draw) {
  const grid = element("div", { className: `grid of${count}` });
  if (open) return { node: element("section", { className: "figure", id }, element("h3", { className: "heading" }, title), grid), draw: () => draw(grid) };
  const node = element("details", { className: "figure", id }, element("summary", {}, title), grid);
  node.addEventListener("toggle", () => draw(grid), { once: true });
  return { node, draw: null };
}

// Each figure that has panels, those of the story first, the others folded below them. Their plots are in the
// groups, of which all show one cursor.
export function addFigures(host, id, figures, panelsOf, groups, marks) {
  const followers = [], rest = element("div", { className: "rest" });
  groups.launch.followers = groups.vehicle.followers = followers;
  for (const figure of figures) {
    const panels = panelsOf(figure), group = figure.time === "vehicle" ? groups.vehicle : groups.launch;
    if (panels.length === 0) continue;
    const { node, draw } = figureOf(`${id}-${figure.name}`, figure, panels.length, (grid) => {
      const here = marks.filter(({ figures }) => figures.includes(figure.time));
      for (const shown of panels) followers.push(addPanel(grid, shown, group, here));
    });
    (figure.open ? host : rest).append(node);
    draw?.();
  }
  if (rest.children.length > 0) host.append(rest);
  for (const group of Object.values(groups)) group.reset();
}

// Times from ignition: all of them, or from a little before it on.
export function homeOf(table, ignition, all) {
  const first = table.t[0] - ignition, last = table.t[table.t.length - 1] - ignition;
  return [all ? first : Math.max(first, -0.005), last];
}

// Of several launches, buttons that show one of them or all; `choose` gets the rocket, from 0, or null. One choice
// leads all that shows launches.
export function launchChoice(count, choose) {
  const button = (text, rocket) => element("button", { type: "button", value: rocket ?? "all", onclick: () => choose(rocket) }, text);
  const buttons = [...Array.from({ length: count }, (_, i) => button(`Rocket ${i + 1}`, i)), button("All", null)];
  return {
    node: element("p", { className: "windows" }, "Show ", ...buttons),
    show: (rocket) => { for (const one of buttons) one.setAttribute("aria-pressed", one.value === String(rocket ?? "all")); },
  };
}

// The window of a rocket's launch, in seconds from `zero`; null where it has not left, or for all.
export function launchWindow(rocket, zero) {
  if (!rocket || rocket.ignition === null || rocket.rear === null) return null;
  const from = rocket.ignition - zero;
  return [from - 0.005, from + rocket.rear + 0.02];
}

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
  show(min, max) {
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
  group.plots.push((shown.panel.x ? pathPlot : timePlot)(shown, group, marks, canvas));
}

// A section of each figure that has panels, their plots in the groups, of which all show one cursor.
export function addFigures(host, id, figures, panelsOf, groups, marks) {
  const followers = [];
  groups.launch.followers = groups.vehicle.followers = followers;
  for (const figure of figures) {
    const panels = panelsOf(figure);
    if (panels.length === 0) continue;
    const grid = element("div", { className: "grid" });
    host.append(element("section", { className: "figure", id: `${id}-${figure.name}` },
      element("h3", { className: "heading" }, figure.title), grid));
    for (const shown of panels) {
      const group = figure.time === "vehicle" ? groups.vehicle : groups.launch;
      addPanel(grid, shown, group, marks);
      followers.push(group.plots[group.plots.length - 1]);
    }
  }
  for (const group of Object.values(groups)) group.reset();
}

// Times from ignition: all of them, or from a little before it on.
export function homeOf(table, ignition, all) {
  const first = table.t[0] - ignition, last = table.t[table.t.length - 1] - ignition;
  return [all ? first : Math.max(first, -0.005), last];
}

export function windowButtons(groups, marks, count) {
  if (count < 2) return null;
  const buttons = [];
  for (let i = 1; i <= count; i++) {
    const from = marks.find((m) => m.name === `ignition ${i}`), to = marks.find((m) => m.name === `rear ${i}`);
    if (from && to)
      buttons.push(element("button", { type: "button",
        onclick: () => groups.launch.show(from.t - 0.005, to.t + 0.02) }, `Rocket ${i}`));
  }
  buttons.push(element("button", { type: "button", onclick: () => groups.launch.reset() }, "All"));
  return element("p", { className: "windows" }, "Show ", ...buttons);
}

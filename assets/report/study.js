// The report of a study, or of several beside each other.
import { element, themeSwitch } from "./page.js";
import { convergence, distribution, scatter, sensitivity } from "./study_plots.js";
import { describe, partCount, partName } from "./study_results.js";
import { counts, ellipses, failures, seriesName, statistics } from "./study_tables.js";

const host = document.getElementById("report");
const data = JSON.parse(document.getElementById("data").textContent);
const results = data.results.map(describe);
const nav = element("nav");

function section(id, title, ...children) {
  const content = children.filter(Boolean);
  if (content.length === 0) return;
  nav.append(element("a", { href: `#${id}` }, title.split(" ")[0]));
  host.append(element("h2", { id }, title), ...content);
}

// Two cards in a row, or three where there are more; wide ones have a row of their own.
const grid = (children) => {
  const shown = children.filter(Boolean), narrow = shown.filter((card) => !card.classList.contains("wide"));
  return shown.length ? element("div", { className: `grid${narrow.length > 2 ? " three" : ""}` }, ...shown) : null;
};

// Whether a result differs between rockets at all.
const scatters = ({ series }) => series.some((own) => own && own.greatest - own.least > 1e-12 * Math.abs(own.greatest));

function partOf(part) {
  const own = results.filter((result) => result.part === part && scatters(result));
  if (own.length === 0) return null;
  return element("section", { className: "figure" }, element("h3", { className: "heading" }, partName(part)),
    grid(own.flatMap((result) => [distribution(data, result),
      convergence(data, result, "mean", "mean"), convergence(data, result, "deviation", "standard deviation")])));
}

function sameEverywhere() {
  const same = results.filter((result) => !scatters(result)).map((result) => result.label.toLowerCase());
  return same.length && results.length > same.length
    ? element("p", { className: "shown" }, `The same for all rockets, and without a plot: ${same.join("; ")}.`) : null;
}

function state(series) {
  const left = series.samples - series.done, name = data.series.length > 1 ? `${series.label}: ` : "";
  if (series.done === 0) return element("p", { className: "warning" }, `${name}no sample is there yet.`);
  const lines = [];
  if (left > 0) lines.push(`${left} of ${series.samples} samples are still to be run; the numbers are of those that are there.`);
  if (series.failed === series.done) lines.push("All samples failed: there is nothing to draw.");
  return lines.length ? element("p", { className: "warning" }, name + lines.join(" ")) : null;
}

const titles = new Set(data.series.map((series) => series.title || series.label));
const title = titles.size === 1 ? [...titles][0] : "Studies beside each other";
host.classList.toggle("several", data.series.length > 1);
host.replaceChildren(element("header", {}, element("h1", {}, title), nav, themeSwitch(),
  data.series.length > 1 ? element("p", { className: "legend" }, ...data.series.map(seriesName)) : null));
section("summary", "Summary", ...data.notes.map((note) => element("p", { className: "warning" }, note)),
  ...data.series.map(state), data.series.length > 0 ? counts(data) : null);
section("scatter", "Scatter", grid(data.pairs.map((pair) => scatter(data, pair))), ellipses(data));
section("statistics", "Statistics", ...(results.length ? statistics(data, results) : []));
section("distributions", "Distributions and convergence", sameEverywhere(),
  ...Array.from({ length: partCount }, (_, part) => partOf(part)), partOf(-1));
section("sensitivities", "Sensitivities", grid(data.sensitivities.map((item) => sensitivity(data, item))));
section("failed", "Failed samples", failures(data));
host.append(element("footer", {}, element("p", {},
  `launchdyn ${data.version}. Values stand below a plot where the mouse is; with the keyboard: Tab to a plot, arrows, with ` +
  "Shift by ten, Home and End move the cursor, Escape takes it away. Intervals hold 95 % and count independent groups of " +
  "samples. study.db in the study's folder keeps everything.")));
// the plots draw themselves once they have a size
requestAnimationFrame(() => requestAnimationFrame(() => { document.documentElement.dataset.ready = "yes"; }));

// The report of a study, or of several beside each other.
import { element, themeSwitch } from "./page.js";
import { countSeries } from "./chart.js";
import { originBlock } from "./origin.js";
import { beside, convergence, distributions, scatter, sensitivity } from "./study_plots.js";
import { describe, partCount, partName } from "./study_results.js";
import { counts, ellipses, failures, measured, plans, seriesName, statistics } from "./study_tables.js";

const host = document.getElementById("report");
const data = JSON.parse(document.getElementById("data").textContent);
const MOST_NAMED = 8; // series in the legend; the table of the summary names them all
countSeries(data.series.length);
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
  return shown.length ? element("div", { className: `grid${narrow.length > 2 && data.series.length <= 4 ? " three" : ""}` }, ...shown) : null;
};

// Whether a result differs between rockets at all.
const scatters = ({ series }) => series.some((own) => own && own.greatest - own.least > 1e-12 * Math.abs(own.greatest));

function partOf(part) {
  const own = results.filter((result) => result.part === part && scatters(result));
  if (own.length === 0) return null;
  return element("section", { className: "figure" }, element("h3", { className: "heading" }, partName(part)),
    grid(own.flatMap((result) => [...distributions(data, result),
      convergence(data, result, "mean", "mean"), convergence(data, result, "deviation", "standard deviation")])));
}

function sameEverywhere() {
  const same = results.filter((result) => !scatters(result)).map((result) => result.label.toLowerCase());
  return same.length && results.length > same.length
    ? element("p", { className: "shown" }, `The same for all rockets, and without a plot: ${same.join("; ")}.`) : null;
}

// What is missing: a line for each series, or one for many of a kind.
function states() {
  const some = (what, list) => {
    if (list.length === 0) return null;
    const which = data.series.length === 1 ? "" : list.length > 3 ? `${list.length} of ${data.series.length} series: ` : `${list.map(({ label }) => label).join(", ")}: `;
    return element("p", { className: "warning" }, which + what);
  };
  return [
    some("no sample is there yet.", data.series.filter((series) => series.done === 0)),
    some("not all samples have been run; the numbers are of those that are there.",
      data.series.filter((series) => series.done > 0 && series.done < series.samples)),
    some("all samples failed: there is nothing to draw.", data.series.filter((series) => series.done > 0 && series.failed === series.done)),
  ];
}

const titles = new Set(data.series.map((series) => series.title || series.label));
const title = titles.size === 1 ? [...titles][0] : "Studies beside each other";
host.classList.toggle("several", data.series.length > 1);
host.replaceChildren(element("header", {}, element("h1", {}, title), nav, themeSwitch(),
  data.series.length > 1 && data.series.length <= MOST_NAMED
    ? element("p", { className: "legend" }, ...data.series.map(seriesName)) : null));
section("summary", "Summary", ...data.notes.map((note) => element("p", { className: "warning" }, note)),
  ...states(), data.series.length > 0 ? counts(data) : null);
const shots = data.measured?.results.map(describe) ?? [];
section("measured", "Measured beside simulated", shots.length ? measured(data, shots) : null,
  shots.length ? element("p", { className: "shown" }, "Difference: mean measured less mean simulated; ratio: how many times as far measured values lie from " +
    "their median as simulated ones. p: how often chance alone makes so much where nothing differs; * below 5\u00a0%, as one in twenty is then.") : null,
  grid(shots.map((result) => beside(data, result))));
section("scatter", "Scatter", grid(data.pairs.map((pair) => scatter(data, pair))), ellipses(data));
section("statistics", "Statistics", ...(results.length ? statistics(data, results) : []));
section("distributions", "Distributions and convergence", sameEverywhere(),
  ...Array.from({ length: partCount }, (_, part) => partOf(part)), partOf(-1));
section("sensitivities", "Sensitivities", grid(data.sensitivities.map((item) => sensitivity(data, item))));
section("failed", "Failed samples", failures(data));
section("plan", "Plan and factors", ...plans(data));
section("origin", "Origin", ...data.studies.filter((study) => study.origin).flatMap((study) => [
  data.studies.length > 1 ? element("h3", {}, study.label) : null, originBlock(study.origin, "study --again")]));
host.append(element("footer", {}, element("p", {},
  `launchdyn ${data.version}. Values stand below a plot where the mouse is; with the keyboard: Tab to a plot, arrows, with ` +
  "Shift by ten, Home and End move the cursor, Escape takes it away. Intervals hold 95 % and count independent groups of " +
  "samples. study.db in the study's folder keeps everything.")));
// the plots draw themselves once they have a size
requestAnimationFrame(() => requestAnimationFrame(() => { document.documentElement.dataset.ready = "yes"; }));

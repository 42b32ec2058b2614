// The report of a study, or of several beside each other.
import { element, themeSwitch } from "./page.js";
import { countSeries } from "./chart.js";
import { originBlock } from "./origin.js";
import { beside, convergence, distribution, scatter, sensitivity, spread, statedOf } from "./study_plots.js";
import { isSteep, marked } from "./results.js";
import { describe, foremost, partCount, partName } from "./study_results.js";
import { allOver, leading, overKey, sentence } from "./study_sweep.js";
import { answer, counts, ellipses, failures, footprints, measured, plans, seriesName, statistics } from "./study_tables.js";

const host = document.getElementById("report");
const data = JSON.parse(document.getElementById("data").textContent);
const MOST_NAMED = 8; // series in the legend; the table of the summary names them all
countSeries(data.series.length);
// Series whose rockets leave near the vertical, on average.
const steep = data.series.filter((_, s) => isSteep(data.results.find(({ name }) => name === "pitch")?.series[s]?.mean[0]));
const results = data.results.map((result) => describe(result, steep.length > 0));
const nav = element("nav");

function section(id, title, ...children) {
  const content = children.filter(Boolean);
  if (content.length === 0) return;
  nav.append(element("a", { href: `#${id}` }, title.split(" ")[0]));
  host.append(element("h2", { id }, title), ...content);
}

// Two cards in a row, or three or four where there are more.
const grid = (children) => {
  const shown = children.filter(Boolean), several = data.series.length <= 4 ? ["", "", "", " three", " four"] : [];
  const columns = shown.length === 4 || shown.length > 6 ? 4 : Math.min(3, shown.length);
  return shown.length ? element("div", { className: `grid${several[columns] ?? ""}` }, ...shown) : null;
};

// Whether a result differs between rockets at all.
const scatters = ({ series }) => series.some((own) => own && own.greatest - own.least > 1e-12 * Math.abs(own.greatest));

const MOST_FIRST = 8, MOST_SENSITIVITIES = 4; // results with a plot that is not folded
const MOST_BESIDE = 4; // plots beside the answer

// Something folded, or nothing where there is nothing in it.
function folded(title, ...children) {
  const content = children.filter(Boolean);
  return content.length ? element("details", {}, element("summary", {}, title), ...content) : null;
}

function rest(...children) {
  const content = children.filter(Boolean);
  return content.length ? element("div", { className: "rest" }, ...content) : null;
}

const varied = results.filter(scatters), first = foremost(varied, MOST_FIRST);

// Of a sweep of single runs: the foremost results that differ from point to point.
function swept() {
  const differs = ({ series }) => new Set(series.map((own) => own?.mean[0])).size > 1;
  return varied.length ? [] : foremost(results.filter(differs), MOST_FIRST);
}

// What is not said of a part's results at first: plots of those that are not the foremost, how estimates settle.
function partOf(part) {
  const own = varied.filter((result) => result.part === part), other = own.filter((result) => !first.includes(result));
  return [
    folded(partName(part), grid(other.map((result) => distribution(data, result)))),
    folded(`${partName(part)}: how estimates settle`, grid(own.flatMap((result) => [spread(data, result),
      convergence(data, result, "mean", "mean"), convergence(data, result, "deviation", "standard deviation")]))),
  ];
}

function sensitivities() {
  const all = data.sensitivities.map((item) => [item, sensitivity(data, item)]).filter(([, card]) => card);
  const open = foremost(all.map(([item]) => item), MOST_SENSITIVITIES), cards = (wanted) =>
    wanted.map((item) => all.find(([one]) => one === item)[1]);
  return [grid(cards(open)), rest(folded("Sensitivities of other results", grid(cards(all.map(([item]) => item).filter((item) => !open.includes(item))))))];
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
    some("rockets leave near the vertical: yaw and rates of the ground frame are not meaningful, those of the launcher's axes at ignition are.", steep),
    some("no samples yet.", data.series.filter((series) => series.done === 0)),
    some("not all samples have been run; the numbers are of those that have.",
      data.series.filter((series) => series.done > 0 && series.done < series.samples)),
    some("all samples failed: nothing to draw.", data.series.filter((series) => series.done > 0 && series.failed === series.done)),
  ];
}

const titles = new Set(data.series.map((series) => series.title || series.label));
const title = titles.size === 1 ? [...titles][0] : "Studies compared";
host.classList.toggle("several", data.series.length > 1);
host.replaceChildren(element("header", {}, element("h1", {}, title), nav, themeSwitch(),
  data.series.length > 1 && data.series.length <= MOST_NAMED
    ? element("p", { className: "legend" }, ...data.series.map(seriesName)) : null));
const notes = data.notes.map((note) => element("p", { className: "warning" }, note));
const launches = data.measured?.results.map((result) => describe(result)) ?? [], parts = [...Array.from({ length: partCount }, (_, part) => part), -1];
const listed = first.length ? first : swept(), told = listed.length ? answer(data, listed) : null, [shares, otherShares] = sensitivities();
const one = data.series.length === 1 && told, clouds = data.pairs.map((pair) => scatter(data, { ...pair, title: marked(pair.y, pair.title, steep.length > 0) })).filter(Boolean);
const words = foremost(data.sensitivities.filter(({ says }) => says), 1).map(({ says }) => element("p", { className: "sentence" }, says))[0];
const said = words ?? sentence(data, listed), swing = leading(data), picture = swing ? overKey(data, ...swing) : null;
const lead = (title, plots, others) => // beside each other
  section("summary", title, ...notes, ...states(), said, element("div", { className: "lead" }, told, plots), others);
const besides = one && !shares ? clouds.length > 0 ? "scatter" : "results" : "";
const distributions = first.map((result) => distribution(data, result));
if (one && shares) lead("Answer and sensitivities", shares, otherShares);
else if (besides === "scatter") lead("Answer and scatter", grid(clouds.slice(0, MOST_BESIDE)), rest(folded("Scatter of other results", grid(clouds.slice(MOST_BESIDE)))));
else if (besides === "results") lead("Answer and results", grid(distributions.splice(0, MOST_BESIDE)));
else {
  section("summary", "Answer", ...notes, ...states(), said, picture, told);
  section("swept", "Swept keys", rest(...(data.over?.keys ?? []).map(({ name }, k) => folded(`Results over ${name}`, grid(allOver(data, k))))));
  section("sensitivities", "Sensitivities", shares, otherShares);
}
section("measured", "Measured and simulated", launches.length ? measured(data, launches) : null,
  launches.length ? element("p", { className: "shown" }, "Difference: mean measured less mean simulated; ratio: spread of measured values about " +
    "their median over that of simulated ones. p: probability of such a difference by chance; * below 5\u00a0%, as in one of twenty tests by chance.") : null,
  grid(launches.map((result) => beside(data, result))));
section("scatter", "Scatter", besides === "scatter" ? null : grid(clouds));
const openly = data.series.length === 1 && data.pairs.some(({ series: [own] }) => own && statedOf(own).length > 0); // else folded
section("footprints", "Footprints (range safety)", ...(openly ? footprints(data) : []));
section("distributions", "Results", grid(distributions), sameEverywhere(),
  rest(...parts.flatMap(partOf)));
section("numbers", "Numbers", rest(data.series.length > 0 ? folded("What was run", counts(data)) : null,
  folded("Statistics", ...(results.length ? statistics(data, results) : [])), folded("Ellipses", ellipses(data)),
  openly ? null : folded("Footprints (range safety)", ...footprints(data)),
  folded("Failed samples", failures(data)), folded("Plan and factors", ...plans(data))));
section("origin", "Origin", ...data.studies.filter((study) => study.origin).flatMap((study) => [
  data.studies.length > 1 ? element("h3", {}, study.label) : null, originBlock(study.origin, "study --again")]));
host.append(element("footer", {}, element("p", {},
  `launchdyn ${data.version}. Values at the mouse are below a plot; with the keyboard: Tab to a plot, arrows, with ` +
  "Shift by ten, Home and End move the cursor, Escape removes it. Intervals are 95 % intervals over independent groups of " +
  "samples. study.db in the study's folder has everything.")));
// the plots draw themselves once they have a size
requestAnimationFrame(() => requestAnimationFrame(() => { document.documentElement.dataset.ready = "yes"; }));

// The tables of a study: what was run, statistics with a column for each series, failed samples.
import { readable } from "./data.js";
import { element } from "./page.js";

const cell = (content, className = "") => element("td", { className }, content);
const head = (content, scope = "col", more = {}) => element("th", { scope, ...more }, content);

function card(title, table) {
  return element("section", { className: "card table" }, element("h3", {}, title),
    element("div", { className: "scroll", tabIndex: 0, role: "region", ariaLabel: title }, table));
}

// A swatch of the series' colour before its name.
export function seriesName(series, index) {
  return element("span", { className: "series" }, element("i", { style: `background: var(--curve${index % 8})` }), series.label);
}

const COUNTS = [
  ["title", (s) => s.title],
  ["samples kept", (s) => `${s.done} of ${s.samples}`],
  ["failed", (s) => String(s.failed)],
  ["plan", (s) => (s.strata > 1 ? `Latin hypercubes of ${s.strata} samples` : "random")],
  ["version", (s) => s.version],
];

export function counts(data) {
  const several = data.series.length > 1;
  const most = (key) => data.series.map((_, i) => Math.max(0, ...data.results.map(({ series }) => series[i]?.[key] ?? 0)));
  const rockets = most("count"), groups = most("groups");
  const rows = [...COUNTS, ["rockets of good samples", (s, i) => String(rockets[i])], ["independent groups", (s, i) => String(groups[i])]];
  return card("What was run", element("table", {},
    several ? element("tr", {}, head(""), ...data.series.map((s, i) => element("th", { scope: "col" }, seriesName(s, i)))) : null,
    ...rows.map(([name, of]) => element("tr", {}, head(name, "row"),
      ...data.series.map((s, i) => cell(of(s, i), name === "title" ? "text" : ""))))));
}

// A value with its interval below.
function estimate([value, low, high], factor) {
  return element("td", {}, readable(value * factor),
    low === null ? null : element("small", {}, `${readable(low * factor)} … ${readable(high * factor)}`));
}

const statistic = {
  mean: (own, f) => estimate(own.mean, f),
  "standard deviation": (own, f) => estimate(own.deviation, f),
  skewness: (own) => cell(readable(own.skewness, 3)),
  "5 %": (own, f) => estimate(own.quantiles[0], f),
  median: (own, f) => estimate(own.quantiles[1], f),
  "95 %": (own, f) => estimate(own.quantiles[2], f),
  least: (own, f) => cell(readable(own.least * f)),
  greatest: (own, f) => cell(readable(own.greatest * f)),
};

function statisticsTable(data, results, title, names) {
  const several = data.series.length > 1;
  const edge = (k) => ({ className: several && k === 0 ? "first" : "" });
  const series = several && element("tr", {}, head(""), head(""), ...data.series.map((s, i) =>
    element("th", { scope: "colgroup", colSpan: names.length, className: "first" }, seriesName(s, i))));
  const heads = element("tr", {}, head(""), head(""),
    ...data.series.flatMap(() => names.map((name, k) => head(name, "col", edge(k)))));
  const rows = results.map((result) => element("tr", { title: result.name },
    head(result.label, "row"), cell(result.unit, "unit"),
    ...result.series.flatMap((own) => names.map((name) =>
      (own ? statistic[name](own, result.factor) : cell("–"))))));
  return card(title, element("table", { className: "statistics" },
    element("thead", {}, series || null, heads), element("tbody", {}, ...rows)));
}

export function statistics(data, results) {
  return [statisticsTable(data, results, "Mean and standard deviation, with 95 % intervals", ["mean", "standard deviation", "skewness"]),
    statisticsTable(data, results, "Quantiles and extremes", ["5 %", "median", "95 %", "least", "greatest"])];
}

export function failures(data) {
  const several = data.series.length > 1;
  const rows = data.series.flatMap((series, i) => series.failures.map(([sample, status, reason]) =>
    element("tr", {}, several ? element("td", {}, seriesName(series, i)) : null, head(String(sample), "row"),
      cell(status), cell(reason, "text"))));
  if (rows.length === 0) return null;
  const left = data.series.reduce((sum, s) => sum + s.failed - s.failures.length, 0);
  const table = card(left ? `Failed samples, ${left} more are not listed` : "Failed samples", element("table", { className: "failures" },
    element("tr", {}, several ? head("series") : null, head("sample"), head("status"), head("reason")), ...rows));
  table.id = "failures";
  return table;
}

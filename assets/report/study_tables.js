// The tables of a study: what was run, statistics with a column for each series, failed samples.
import { colourOf } from "./chart.js";
import { readable } from "./data.js";
import { element } from "./page.js";
import { isLine, isNormal } from "./study_plots.js";
import { describe } from "./study_results.js";

const cell = (content, className = "") => element("td", { className }, content);
const head = (content, scope = "col", more = {}) => element("th", { scope, ...more }, content);

function card(title, table) {
  return element("section", { className: "card table" }, element("h3", {}, title),
    element("div", { className: "scroll", tabIndex: 0, role: "region", ariaLabel: title }, table));
}

// A swatch of the series' colour before its name.
export function seriesName(series, index) {
  return element("span", { className: "series" }, element("i", { style: colourOf(index) }), series.label);
}

// ---- the answer

// How a result's numbers are said: to two digits of its deviation.
function digitsOf(own, f) {
  const deviation = (own.deviation[0] ?? NaN) * f;
  if (!(deviation > 0)) return (v) => readable(v * f, 4).replace(/^-/, "−");
  const decimals = Math.min(8, Math.max(0, 1 - Math.floor(Math.log10(deviation))));
  return (v) => fixed(v * f, decimals).replace("-", "−");
}

function meanAndDeviation(own, f) {
  if (!own) return "–";
  const said = digitsOf(own, f), [deviation] = own.deviation;
  return deviation > 0 ? `${said(own.mean[0])} ± ${said(deviation)}` : said(own.mean[0]);
}

// The swept keys of all studies, and what a series has of one.
const sweptKeys = (data) => [...new Set(data.series.flatMap(({ swept }) => swept.map(([key]) => key)))];
const valueOf = ({ swept }, key) => swept.find(([own]) => own === key)?.[1] ?? "";

// How much of what was requested is there.
function keptLine({ series }) {
  const sum = (of) => series.reduce((total, one) => total + of(one), 0), failed = sum((s) => s.failed);
  const asked = sum((s) => Math.max(s.samples, s.done));
  return `${sum((s) => s.done)} of ${asked} samples, ${failed === 0 ? "none" : failed} failed${series.length > 1 ? `, in ${series.length} series` : ""}.`;
}

// Mean and deviation of the foremost results: of one series a row for each, with what 90 % lie between; of several a
// row for each series.
export function answer(data, results) {
  const unit = (result) => element("span", { className: "unit" }, result.unit ? `\u00a0${result.unit}` : "");
  const one = () => [element("tr", {}, head(""), head("mean ± deviation"), head("90 % lie between")), ...results.map((result) => {
    const [own] = result.series, [low, , high] = own.quantiles.map(([v]) => digitsOf(own, result.factor)(v));
    return element("tr", {}, head(result.label, "row"), element("td", {}, meanAndDeviation(own, result.factor), unit(result)), cell(`${low} … ${high}`));
  })];
  const keys = sweptKeys(data), named = keys.length === 0 || data.studies.length > 1;
  const first = (series, i) => head(named ? seriesName(series, i) : seriesName({ label: valueOf(series, keys[0]) }, i), "row");
  const rest = named ? keys : keys.slice(1);
  const several = () => [element("tr", {}, head(named ? "" : keys[0]), ...rest.map((key) => head(key, "col", { className: "text" })), ...results.map((result) => head(`${result.label}${result.unit ? ` [${result.unit}]` : ""}`))),
    ...data.series.map((series, i) => element("tr", {}, first(series, i), ...rest.map((key) => cell(valueOf(series, key), "text")),
      ...results.map((result) => cell(meanAndDeviation(result.series[i], result.factor)))))];
  const single = results.every(({ series }) => series.every((own) => !(own?.deviation[0] > 0)));
  const made = card(single ? "Results" : "Mean and standard deviation", element("table", data.series.length === 1 ? { className: "one" } : {},
    ...(data.series.length === 1 ? one() : several())));
  made.classList.add("answer");
  made.append(element("p", { className: "shown" }, keptLine(data)));
  return made;
}

const distinct = (data, of) => new Set(data.series.map(of)).size > 1;

// A row for each series: what was run, and how much of it.
export function counts(data) {
  const most = (i, key) => Math.max(0, ...data.results.map(({ series }) => series[i]?.[key] ?? 0));
  const columns = [
    ...(distinct(data, (s) => s.title) ? [["title", (s) => s.title, "text"]] : []),
    ...sweptKeys(data).map((key) => [key, (s) => valueOf(s, key), "text"]),
    ["samples kept", (s) => (s.done > s.samples ? `${s.done}, ${s.samples} asked for` : `${s.done} of ${s.samples}`)],
    ["failed", (s) => String(s.failed)],
    ["rockets of good samples", (s, i) => String(most(i, "count"))],
    ["independent groups", (s, i) => String(most(i, "groups"))],
    ["plan", (s) => (s.strata > 1 ? `Latin hypercubes of ${s.strata} samples` : "random")],
    ["version", (s) => s.version],
  ];
  return card("What was run", element("table", { className: "statistics" },
    element("tr", {}, head(""), ...columns.map(([name, , className]) => head(name, "col", { className: className ?? "" }))),
    ...data.series.map((s, i) => element("tr", {}, head(seriesName(s, i), "row"),
      ...columns.map(([, of, className]) => cell(of(s, i), className))))));
}

// What each study was asked to do: its plan, and its factors with their distributions.
export function plans(data) {
  const title = (study, what) => (data.studies.length > 1 ? `${what} of ${study.label}` : what);
  const rows = (lines) => lines.map(([name, ...texts]) =>
    element("tr", {}, head(name, "row"), ...texts.map((text) => cell(text, "text"))));
  return data.studies.filter((study) => study.plan).flatMap((study) => [
    card(title(study, "Plan"), element("table", { className: "statistics" }, ...rows(study.plan),
      ...rows(study.correlated.map((group) => ["correlated", group.join(", ")])))),
    study.factors.length ? card(title(study, "Factors"), element("table", { className: "statistics" },
      element("tr", {}, head(""), head("distribution", "col", { className: "text" }), head("sampled for", "col", { className: "text" })),
      ...rows(study.factors))) : null,
  ]);
}

// Without the sign of a negative that rounds to nothing.
const fixed = (value, decimals) => value.toFixed(decimals).replace(/^-(?=[0.]*$)/, "");

// A value with its interval below, both to two digits of the interval's half; a dash where it cannot be stated.
function estimate([value, low, high], factor) {
  if (value === null) return cell("–");
  if (low === null) return element("td", {}, readable(value * factor));
  const half = Math.abs((high - low) * factor) / 2, scale = Math.floor(Math.log10(half));
  const text = (v) => {
    if (half === 0 || Math.abs(v * factor) >= 1e7) return readable(v * factor);
    return Math.abs(value * factor) < 1e-4 ? (v * factor).toExponential(2) : fixed(v * factor, Math.max(0, 1 - scale));
  };
  return element("td", {}, text(value), element("small", {}, `${text(low)} … ${text(high)}`));
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

// A row for each result, a column for each statistic and series.
function statisticsTable(data, results, title, names) {
  const several = data.series.length > 1;
  const edge = (i) => ({ className: several && i === 0 ? "first" : "" });
  const heads = names.map((name) => element("th", { scope: "colgroup", colSpan: data.series.length, ...edge(0) }, name));
  const series = several && element("tr", {}, head(""), head(""), ...names.flatMap(() =>
    data.series.map((s, i) => element("th", { scope: "col", ...edge(i) }, seriesName(s, i)))));
  const rows = results.map((result) => element("tr", { title: result.name },
    head(result.label, "row"), cell(result.unit, "unit"),
    ...names.flatMap((name) => result.series.map((own) => (own ? statistic[name](own, result.factor) : cell("–"))))));
  return card(title, element("table", { className: "statistics" },
    element("thead", {}, element("tr", {}, head(""), head(""), ...heads), series || null),
    element("tbody", {}, ...rows)));
}

export function statistics(data, results) {
  const moments = ["mean", "standard deviation"], quantiles = ["5 %", "median", "95 %"];
  if (data.series.length === 1)
    return [statisticsTable(data, results, "Results, with 95 % intervals",
      [...moments, "skewness", ...quantiles, "least", "greatest"])];
  return [statisticsTable(data, results, "Mean and standard deviation, with 95 % intervals", moments),
    statisticsTable(data, results, "Quantiles", quantiles)];
}

// p, with a star where it is below 5 %.
const chance = (p) => cell(p === null ? "–" : `${p < 5e-4 ? "<\u00a00.001" : readable(p, 2)}${p < 0.05 ? " *" : ""}`);

// Two rows a result: means and their difference, deviations and their ratio.
export function measured(data, results) {
  const several = data.series.length > 1;
  const part = (result, what, own, compared) => element("tr", { title: result.name },
    head(what === "mean" ? result.label : "", "row"), cell(result.unit, "unit"), cell(what, "text"), cell(String(result.own.count)),
    estimate(own(result.own), result.factor),
    ...result.series.flatMap((series) => (series ? [estimate(own(series), result.factor), ...compared(series, result.factor)]
      : [cell("–"), cell("–"), cell("–")])));
  const rows = results.flatMap((result) => [
    part(result, "mean", (of) => of.mean, (of, f) => [estimate(of.difference, f), chance(of.difference_chance)]),
    part(result, "deviation", (of) => of.deviation, (of) => [estimate(of.ratio, 1), chance(of.ratio_chance)])]);
  const { file, launches, salvos } = data.measured;
  return card(`Measured in ${file}: ${launches} launches${salvos ? ` of ${salvos} salvos` : ""}`, element("table", { className: "statistics" },
    several ? element("tr", {}, ...Array.from({ length: 5 }, () => head("")), ...data.series.map((series, i) =>
      head(seriesName(series, i), "colgroup", { colSpan: 3 }))) : null,
    element("tr", {}, ...["", "", "", "launches", "measured", ...data.series.flatMap(() => ["simulated", "difference, ratio", "p"])].map((name) => head(name))),
    ...rows));
}

// Centre, semi-axes and direction of each ellipse.
export function ellipses(data) {
  const several = data.series.length > 1;
  const rows = data.pairs.flatMap((pair) => pair.series.flatMap((own, s) => {
    if (!own?.ellipse || !isNormal(own)) return [];
    const { mean, semi_axis: axes, angle } = own.ellipse, { unit, factor } = describe({ name: pair.x, unit: pair.unit });
    return [element("tr", {}, head(pair.title, "row"), several ? element("td", {}, seriesName(data.series[s], s)) : null,
      ...mean.map((v) => cell(readable(v * factor))), ...axes.map((v) => estimate(v, factor)),
      ...axes.map((v) => cell(readable(v[0] * factor * pair.radius, 4))), cell(unit, "unit"),
      cell(`${readable((angle * 180) / Math.PI, 4)}°`))];
  }));
  if (rows.length === 0) return null;
  const heads = ["", ...(several ? [""] : []), "centre, across", "up", "one deviation, long", "short", "95 %, long", "short", "", "long axis, from across to up"];
  return card("Ellipses", element("table", {}, element("tr", {}, ...heads.map((name) => head(name))), ...rows));
}

// Within which landings or lines lie, on what that rests; where there are too few, how many it takes.
export const footprints = (data) => data.pairs.map((pair) => footprintsOf(data, pair)).filter(Boolean);

function footprintsOf(data, pair) {
  const several = data.series.length > 1, places = isLine(pair) ? "places" : "landings";
  const large = pair.series.some((own) => own?.footprint?.regions.some(({ estimates }) => estimates[1][0] > 1e5));
  const rows = pair.series.flatMap((own, s) => (own?.footprint?.regions ?? []).map((region) => {
    const { share, needed, independent, stated, estimates: [content, area, distance] } = region, many = Math.round(independent);
    const front = [several ? element("td", {}, seriesName(data.series[s], s)) : null, head(`${readable(100 * share, 4)}\u00a0%`, "row"), cell(`${many}`), cell(`${needed}`)];
    if (stated !== 1) return element("tr", {}, ...front, element("td", { colSpan: 3, className: "text" }, many < needed ? `too few ${places}` : `${places} too far apart: more are needed`));
    return element("tr", {}, ...front, estimate(content, 100), estimate(area, large ? 1e-6 : 1), estimate(distance, 1));
  }));
  if (rows.length === 0) return null;
  const [what, from] = isLine(pair) ? ["the line lies", "the origin of I"] : ["landings lie", "the launch point"];
  return card(`Footprints: where ${what}, with 95\u00a0% intervals`, element("table", { className: "statistics footprints" },
    element("tr", {}, ...(several ? [head("")] : []), ...["share", `independent ${places}`, "needed", "lie within [%]", `area [${large ? "km²" : "m²"}]`, `farthest from ${from} [m]`].map((name) => head(name))), ...rows));
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

// What a study says in one sentence, with its interval, and of a sweep the one picture: a result over a swept key,
// pooled over the others.
import { chart, csvOf, pathThrough, rangeOf, svg } from "./chart.js";
import { readable } from "./data.js";
import { element } from "./page.js";
import { describe } from "./study_results.js";

const LONG = 12; // letters of a value that may not stand below an axis of several
const BLUE = "--series: var(--curve0)";

// ---- numbers in words

const signed = (text) => text.replace("-", "−");

// Numbers to two digits of half their interval; without one to four.
function saying([value, low, high], factor) {
  const half = low === null ? NaN : Math.abs((high - low) * factor) / 2;
  if (!(half > 0)) return (v) => signed(readable(v * factor, 4));
  const decimals = Math.min(8, Math.max(0, 1 - Math.floor(Math.log10(half))));
  return Math.abs(value * factor) < 1e7 ? (v) => signed((v * factor).toFixed(decimals)) : (v) => signed(readable(v * factor, 4));
}

// "−246.9 mrad/s [−249.7, −244.0]"
function estimateText(estimate, factor, unit) {
  const said = saying(estimate, factor), [value, low, high] = estimate;
  return `${said(value)}${unit ? `\u00a0${unit}` : ""}${low === null ? "" : ` [${said(low)}, ${said(high)}]`}`;
}

// "−17.3 mrad/s (95 % interval −19.6 to −15.1)", with `more` behind the unit.
function stated(estimate, factor, unit, more = "") {
  const said = saying(estimate, factor), [value, low, high] = estimate;
  return `${said(value)}${unit ? `\u00a0${unit}` : ""}${more}${low === null ? "" : ` (95\u00a0% interval ${said(low)} to ${said(high)})`}`;
}

const others = (over, k) => over.keys.filter((_, i) => i !== k).map(({ name }) => name);
const pooledText = (over, k) => {
  const names = others(over, k);
  return names.length ? `pooled over ${names.length > 1 ? `${names.slice(0, -1).join(", ")} and ${names.at(-1)}` : names[0]}` : "";
};

// ---- one sentence

const lower = ({ label }) => (label[0].toLowerCase() + label.slice(1)).replace(", launcher's axes", " in the launcher's axes").replace(", ground frame", " in the ground frame");

function ofSweep(data) {
  const { over } = data, { result: r, key: k, value: i, deviation, sure } = over.lead;
  if (r < 0) return null;
  const result = describe(over.results[r]), key = over.keys[k], cells = over.results[r].keys[k], cell = cells[i];
  const from = cells[key.texts.indexOf(key.reference)], place = pooledText(over, k), where = `${key.name} ${key.texts[i]} against ${key.reference}`;
  const f = result.factor, unit = result.unit, scattered = from.deviation[0] > 0;
  const value = (e) => saying(deviation ? cell.deviation : cell.difference, f)(e[0]);
  const moved = deviation
    ? `the standard deviation of the ${lower(result)} is ${stated(cell.ratio, 1, "", " times as large")}: ${value(cell.deviation)} in place of ${value(from.deviation)}\u00a0${unit}`
    : `the mean of the ${lower(result)} changes by ${stated(cell.difference, f, unit)}: ${value(cell.mean)} in place of ${value(from.mean)}\u00a0${unit}`;
  const tail = place ? `, ${place}` : "";
  if (!scattered && cell.difference[1] === null)
    return `With ${where} the ${lower(result)} changes by ${stated(cell.difference, f, unit)}: ${value(cell.mean)} in place of ${value(from.mean)}\u00a0${unit}${tail}. Single launches: no interval.`;
  return sure ? `With ${where} ${moved}${tail}.`
    : `No swept key moves the rates at the exit significantly. Most does ${key.name}: with ${key.texts[i]} against ${key.reference} ${moved}${tail}.`;
}

const ANSWERS = [/^since_ignition\.pitch_rate$/, /^downrange$/];

function ofOne(data, results) {
  const result = ANSWERS.map((name) => results.find((one) => name.test(one.name))).find(Boolean) ?? results[0];
  const own = result?.series[0];
  if (!own) return null;
  const f = result.factor, spread = own.deviation[0] > 0 ? `, standard deviation ${stated(own.deviation, f, result.unit)}` : "";
  return `${result.label}: mean ${stated(own.mean, f, result.unit)}${spread}; ${own.count} rockets in ${own.groups} independent groups.`;
}

// What the study says, with its 95 % interval; nothing of several studies.
export function sentence(data, results) {
  const text = data.over ? ofSweep(data) : data.series.length === 1 ? ofOne(data, results) : null;
  return text ? element("p", { className: "sentence" }, text) : null;
}

// ---- the picture

const axisOf = (key) => (key.numbers.length
  ? { label: key.unit ? `${key.name} [${key.unit}]` : key.name, range: rangeOf(key.numbers, 0.04) }
  : { label: key.name, range: [-0.5, key.texts.length - 0.5], names: key.texts });

// Long words stand below the picture, by their numbers at the axis.
const namesText = (key) => (key.numbers.length === 0 && key.texts.some((text) => text.length > LONG)
  ? key.texts.map((text, i) => `${i + 1}: ${text}`).join("; ") : "");

// A result over a key: means, or standard deviations.
export function overKey(data, r, k, which) {
  const { over } = data, key = over.keys[k], result = describe(over.results[r]), f = result.factor;
  const order = key.texts.map((_, i) => i).sort((a, b) => (key.numbers.length ? key.numbers[a] - key.numbers[b] : a - b));
  const cells = order.map((i) => ({ text: key.texts[i], x: key.numbers[i] ?? i, own: over.results[r].keys[k][i] }));
  const shown = cells.map(({ own }) => own[which].map((v) => (v === null ? NaN : v * f)));
  if (!shown.some(([v]) => Number.isFinite(v))) return null;
  const what = which === "mean" ? "mean" : "standard deviation", title = `${result.label}: ${what} over ${key.name}`;
  const note = [pooledText(over, k), namesText(key)].filter(Boolean).join(". ");
  return chart({
    title, x: axisOf(key), y: { label: result.unit ? `${what} [${result.unit}]` : what, range: rangeOf(shown.flat()) }, wide: false,
    draw: (place) => [
      ...(key.numbers.length ? [svg("path", { class: "curve", style: BLUE, d: pathThrough(cells.map(({ x }, i) => [place.x(x), place.y(shown[i][0])])) })] : []),
      ...shown.flatMap(([value, low, high], i) => {
        const x = place.x(cells[i].x);
        return [...(Number.isFinite(low) ? [svg("line", { x1: x, x2: x, y1: place.y(low), y2: place.y(high), class: "span", style: BLUE })] : []),
          ...(Number.isFinite(value) ? [svg("circle", { cx: x, cy: place.y(value), r: 4, class: "dot", style: BLUE })] : [])];
      })],
    count: cells.length,
    at: (i) => [cells[i].x, shown[i][0]],
    reading: (i) => `${cells[i].text}: ${estimateText(cells[i].own[which], f, result.unit)}, ${cells[i].own.count} rockets in ${cells[i].own.groups} groups`,
    note: note ? `${note}.` : "",
    csv: () => csvOf([key.name, ...["", ", low", ", high"].map((end) => `${what} of ${result.name}${end} [${result.si}]`), "rockets", "groups"],
      cells.map(({ text, own }) => [text, ...own[which], own.count, own.groups])),
  });
}

// That of the sentence.
export const leading = ({ over }) => (over && over.lead.result >= 0 ? [over.lead.result, over.lead.key, over.lead.deviation ? "deviation" : "mean"] : null);

// Every other result over a key.
export function allOver(data, k) {
  const first = leading(data) ?? [];
  return data.over.results.flatMap((_, r) => ["mean", "deviation"].map((which) =>
    (r === first[0] && k === first[1] && which === first[2] ? null : overKey(data, r, k, which))));
}

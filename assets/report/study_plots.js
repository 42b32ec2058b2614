// The plots of a study, of one series of samples or of several laid over each other.
import { chart, colourOf, csvOf, pathThrough, rangeOf, svg } from "./chart.js";
import { readable } from "./data.js";
import { describe } from "./study_results.js";

const MOST_OVERLAID = 4; // distributions of more series stand in columns
const LEVELS = ["5 %", "median", "95 %"];

const percent = (share) => `${readable(100 * share, 3)} %`;
const between = (low, high) => (low === null ? "" : ` [${readable(low)}, ${readable(high)}]`);
export const withInterval = ([value, low, high], factor = 1) =>
  readable(value * factor) + (low === null ? "" : between(low * factor, high * factor));

// Series that have statistics of this result.
const having = (data, list) => data.series.map((series, s) => ({ series, s, own: list[s] })).filter(({ own }) => own);
const named = (list, series, text) => (list.length > 1 ? `${series.label}: ${text}` : text);

// Text beside a line, turned away from the plot's edge.
function lineLabel(place, x, y, text) {
  const near = x > place.right - 50;
  return svg("text", { x: near ? x - 3 : x + 3, y, "text-anchor": near ? "end" : "start", class: "note" }, text);
}

// ---- distributions ----

function histogram(data, result) {
  const list = having(data, result.series), { from, width, count: bins } = result.bins, f = result.factor;
  const edge = (i) => (from + i * width) * f;
  const share = (own, i) => own.bins[i] / own.count;
  const top = Math.max(...list.flatMap(({ own }) => own.bins.map((n) => n / own.count)));
  const one = list.length === 1;
  const outline = (own, place) => {
    const points = [[place.x(edge(0)), place.bottom]];
    for (let i = 0; i < bins; i++)
      points.push([place.x(edge(i)), place.y(100 * share(own, i))], [place.x(edge(i + 1)), place.y(100 * share(own, i))]);
    points.push([place.x(edge(bins)), place.bottom]);
    return pathThrough(points);
  };
  const quantiles = (own, s, place) => own.quantiles.flatMap(([value], k) => {
    const x = place.x(value * f);
    return [svg("line", { x1: x, x2: x, y1: place.top, y2: place.bottom, class: "quantile", style: colourOf(s) }),
      ...(one ? [lineLabel(place, x, place.top + 10 + 11 * k, LEVELS[k])] : [])];
  });
  return chart({
    title: `${result.label}: distribution`,
    x: { label: result.axis, range: rangeOf([edge(0), edge(bins)], 0.03) },
    y: { label: "share of rockets [%]", range: [0, (one ? 130 : 108) * top] },
    draw: (place) => list.flatMap(({ own, s }) => [
      svg("path", { d: outline(own, place), class: "area", style: colourOf(s) }), ...quantiles(own, s, place)]),
    count: bins,
    at: (i) => [edge(i + 0.5), 100 * Math.max(...list.map(({ own }) => share(own, i)))],
    reading: (i) => `${readable(edge(i))} to ${readable(edge(i + 1))}: ` + list.map(({ own, series }) =>
      named(list, series, `${own.bins[i]} of ${own.count} (${percent(share(own, i))})`)).join(", "),
    csv: () => csvOf([`${result.name} from [${result.si}]`, `to [${result.si}]`, ...list.map(({ series }) => `rockets, ${series.label}`)],
      Array.from({ length: bins }, (_, i) => [from + i * width, from + (i + 1) * width, ...list.map(({ own }) => own.bins[i])])),
  });
}

// Series beside each other on an axis, by their names; points of a sweep over one number by its values.
function seriesAxis(list) {
  const names = list.map(({ series }) => series.label), parts = names.map((name) => /^(.+) = (-?[\d.e+-]+) ?(\S*)$/.exec(name) ?? []);
  const [, key, , unit] = parts[0], range = [-0.5, list.length - 0.5];
  if (!key || parts.some((part) => part[1] !== key || part[3] !== unit)) return { label: "studies or points of a sweep", range, names };
  return { label: unit ? `${key} [${unit}]` : key, range, names: parts.map(([, , value]) => value) };
}

// Many series: a column each, from 5 to 95 %, with the median and the mean.
function columns(data, result) {
  const list = having(data, result.series), f = result.factor;
  const half = (place) => Math.min(14, ((place.right - place.left) / list.length) * 0.35);
  return chart({
    title: `${result.label}: distribution`,
    x: seriesAxis(list),
    y: { label: result.axis, range: rangeOf(list.flatMap(({ own }) => [own.quantiles[0][0] * f, own.quantiles[2][0] * f])) },
    draw: (place) => list.flatMap(({ own, s }, i) => {
      const [low, middle, high] = own.quantiles.map(([v]) => place.y(v * f)), x = place.x(i), w = half(place);
      return [svg("rect", { x: x - w, width: 2 * w, y: high, height: Math.max(1, low - high), class: "area", style: colourOf(s) }),
        svg("line", { x1: x - w, x2: x + w, y1: middle, y2: middle, class: "quantile", style: colourOf(s) }),
        svg("circle", { cx: x, cy: place.y(own.mean[0] * f), r: 3, class: "dot", style: colourOf(s) })];
    }),
    count: list.length,
    at: (i) => [i, list[i].own.mean[0] * f],
    reading: (i) => `${list[i].series.label}: mean ${withInterval(list[i].own.mean, f)}, ` +
      list[i].own.quantiles.map(([v], k) => `${LEVELS[k]} ${readable(v * f)}`).join(", "),
    csv: () => csvOf(["series", ...["mean", ...LEVELS].map((name) => `${name} [${result.si}]`)],
      list.map(({ series, own }) => [series.label, own.mean[0], ...own.quantiles.map(([v]) => v)])),
  });
}

// Many series: the standard deviation of each with its interval.
function deviations(data, result) {
  const list = having(data, result.series), f = result.factor;
  const shown = list.map(({ own }) => own.deviation.map((v) => (v === null ? NaN : v * f)));
  return chart({
    title: `${result.label}: deviations`,
    x: seriesAxis(list),
    y: { label: result.unit ? `standard deviation [${result.unit}]` : "standard deviation", range: rangeOf(shown.flat()) },
    draw: (place) => shown.flatMap(([value, low, high], i) => {
      const x = place.x(i);
      return [svg("circle", { cx: x, cy: place.y(value), r: 4, class: "dot", style: colourOf(list[i].s) }),
        ...(Number.isFinite(low) ? [svg("line", { x1: x, x2: x, y1: place.y(low), y2: place.y(high), class: "span", style: colourOf(list[i].s) })] : [])];
    }),
    count: list.length,
    at: (i) => [i, shown[i][0]],
    reading: (i) => `${list[i].series.label}: ${withInterval(list[i].own.deviation, f)}`,
    csv: () => csvOf(["series", ...["", ", low", ", high"].map((end) => `standard deviation of ${result.name}${end} [${result.si}]`)],
      list.map(({ series, own }) => [series.label, ...own.deviation])),
  });
}

// The one plot of a result; what is beside it.
export const distribution = (data, result) => (data.series.length > MOST_OVERLAID ? columns : histogram)(data, result);
export const spread = (data, result) => (data.series.length > MOST_OVERLAID ? deviations(data, result) : null);

// ---- convergence ----

// Running estimate of `which` (mean or deviation) with its interval against the number of samples.
export function convergence(data, result, which, what) {
  const list = having(data, result.running).filter(({ own }) => own.samples.length > 1), f = result.factor;
  if (list.length === 0) return null;
  const tracks = list.map(({ own, s, series }) => ({ s, series, n: own.samples,
    value: own[which].map(([v, low, high]) => [v, low, high].map((u) => (u === null ? NaN : u * f))) }));
  const places = tracks.flatMap((track) => track.n.map((n, i) => ({ track, i, n }))).sort((a, b) => a.n - b.n);
  // the first intervals are far wider than all that follow: the axis leaves them out
  const settled = places.filter(({ n }) => n * n >= 2 * places[places.length - 1].n)
    .flatMap(({ track, i }) => track.value[i]);
  const band = (track, place) => {
    const side = (k) => track.n.map((n, i) => [place.x(n), place.y(track.value[i][k])])
      .filter(([, y]) => Number.isFinite(y));
    const points = [...side(1), ...side(2).reverse()];
    return points.length ? pathThrough(points) + "Z" : "";
  };
  return chart({
    title: `${result.label}: running ${what}`,
    x: { label: "samples", log: true, range: [places[0].n, Math.max(places[places.length - 1].n, places[0].n + 1)] },
    y: { label: result.unit ? `${what} [${result.unit}]` : what, range: rangeOf(settled) },
    draw: (place) => tracks.flatMap((track) => [
      ...(tracks.length > MOST_OVERLAID ? [] : [svg("path", { d: band(track, place), class: "band", style: colourOf(track.s) })]),
      svg("path", { class: "curve", style: colourOf(track.s),
        d: pathThrough(track.n.map((n, i) => [place.x(n), place.y(track.value[i][0])])) })]),
    count: places.length,
    at: (i) => [places[i].n, places[i].track.value[places[i].i][0]],
    reading: (i) => {
      const { track, n } = places[i], [v, low, high] = track.value[places[i].i];
      return named(list, track.series, `${n} samples: ${readable(v)}${Number.isFinite(low) ? between(low, high) : ""}`);
    },
    csv: () => csvOf(["series", "samples", ...["", ", low", ", high"].map((end) => `${what} of ${result.name}${end} [${result.si}]`)],
      list.flatMap(({ series, own }) => own.samples.map((n, i) => [series.label, n, ...own[which][i]]))),
  });
}

// ---- two results against each other ----

// Points of an ellipse of so many deviations.
function outlineOf({ mean, semi_axis: [[a], [b]], angle }, deviations) {
  return Array.from({ length: 97 }, (_, i) => {
    const u = deviations * a * Math.cos((i * Math.PI) / 48), v = deviations * b * Math.sin((i * Math.PI) / 48);
    return [mean[0] + u * Math.cos(angle) - v * Math.sin(angle), mean[1] + u * Math.sin(angle) + v * Math.cos(angle)];
  });
}

// Closed lines, in hundredths of a cell of a density's grid.
function linesOf({ origin, step: [ax, ay, bx, by] }, lines, f) {
  const at = (i, j) => [f * (origin[0] + (i * ax + j * bx) / 100), f * (origin[1] + (i * ay + j * by) / 100)];
  return lines.map((line) => Array.from({ length: line.length / 2 }, (_, k) => at(line[2 * k], line[2 * k + 1])));
}

// Footprints that are stated: of a series that has some they stand for its form.
export const statedOf = (own) => (own.footprint?.regions ?? []).filter(({ stated }) => stated === 1);
const hasFootprint = (own) => statedOf(own).length > 0;

// What is drawn about a cloud: footprints of landing points, else contours of the density.
function contoursOf(own, f) {
  if (hasFootprint(own)) return statedOf(own).map(({ share, lines }) => ({ name: percent(share), kind: "footprint", lines: linesOf(own.footprint, lines, f) }));
  return (own.contours?.levels ?? []).map(([share, lines]) => ({ name: percent(share), kind: "contour", lines: linesOf(own.contours, lines, f) }));
}

// What stands for the form of a cloud: ellipses where it may be normal, else contours; nothing where those are left out.
export const isNormal = ({ normality }) => Boolean(normality) && (!normality.tested || normality.normal === 1);

// Whether a pair is of where lines lie: its points are places, twelve of each.
export const isLine = ({ x }) => x === "line x";

// What the clouds are, as a line below their plot.
function formOf(list, line) {
  const safe = list.filter(({ own }) => hasFootprint(own)), rest = list.filter(({ own }) => !hasFootprint(own));
  const normal = rest.filter(({ own }) => own.ellipse && isNormal(own)), drawn = rest.filter(({ own }) => own.contours);
  const refused = rest.filter(({ own }) => own.normality && !isNormal(own)), untested = normal.filter(({ own }) => !own.normality.tested);
  const level = percent(list.find(({ own }) => own.normality)?.own.normality.level ?? 0.05).replace(" ", "\u00a0");
  const who = (some) => (list.length === 1 || some.length === list.length ? "" : ` of ${some.length > 3 ? `${some.length} series` : some.map(({ series }) => series.label).join(", ")}`);
  const shares = [...new Set(safe.flatMap(({ own }) => statedOf(own).map(({ share }) => percent(share).replace(" ", "\u00a0"))))];
  const chance = list.length === 1 && list[0].own.normality?.tested ? `, p ${list[0].own.normality.chance.map((p) => readable(p, 2)).join(" and ")}` : "";
  return [
    safe.length ? `footprints${who(safe)}: ${shares.join(", ")} of ${line ? "the line lies" : "landings lie"} within` : "",
    normal.length ? `ellipses${who(normal)}: one standard deviation and 95\u00a0%` : "",
    untested.length ? "too few points for a test of normality" : normal.length ? `normal by Mardia's test at ${level}${chance}` : "",
    drawn.length ? `contours${who(drawn)}: 50\u00a0% and 95\u00a0% of the points lie within` : "",
    refused.length ? `not normal${drawn.length ? "" : who(refused)} by Mardia's test at ${level}${normal.length ? "" : chance}` : "",
  ].filter(Boolean).join("; ");
}

// The share that lies within, beside the outline: the first at its top, the next ones on the way down its right side.
function outlineName(place, { name, lines }, k) {
  const angle = (Math.PI / 180) * (90 - 55 * k), away = ([x, y]) => x * Math.cos(angle) - y * Math.sin(angle);
  const [x, y] = lines.flat().map(([u, v]) => [place.x(u), place.y(v)]).reduce((a, b) => (away(b) > away(a) ? b : a));
  const near = x > place.right - 40;
  return svg("text", { x: near ? x - 4 : x + 4, y: y - 3, "text-anchor": near ? "end" : "start", class: "note outline-name" }, name);
}

export function scatter(data, pair) {
  const list = having(data, pair.series);
  if (list.length === 0) return null;
  const [across, up] = [pair.x, pair.y].map((name) => describe({ name, unit: pair.unit })), f = across.factor;
  const points = list.flatMap(({ own, series, s }) => own.points.map(([sample, rocket, x, y]) =>
    ({ sample, rocket, at: [x * f, y * f], si: [x, y], series, s }))).sort((a, b) => a.at[0] - b.at[0]);
  const ellipses = list.filter(({ own }) => own.ellipse && isNormal(own) && !hasFootprint(own)).flatMap(({ own, s }) =>
    [[1, "one deviation"], [pair.radius, "95 %"]].map(([r, name]) =>
      ({ s, name, points: outlineOf(own.ellipse, r).map(([x, y]) => [x * f, y * f]) })));
  const contours = list.flatMap(({ own, s }) => contoursOf(own, f).map((one) => ({ ...one, s })));
  const all = [...points.map((p) => p.at), ...ellipses.flatMap((e) => e.points), ...contours.flatMap(({ lines }) => lines.flat())];
  const salvo = data.series.some((series) => series.rockets > series.done - series.failed);
  const total = (of) => list.reduce((sum, { own }) => sum + of(own), 0);
  const [drawn, there] = [total((own) => own.points.length), total((own) => own.count)];
  const shown = drawn < there ? `${drawn} of ${there} points shown` : `${there} points`;
  const x = { label: across.axis, range: rangeOf(all.map(([v]) => v)) };
  const y = { label: up.axis, range: rangeOf(all.map(([, v]) => v)) };
  const outline = ({ s, name }, kind, d) => svg("path", { class: `ellipse ${kind}`, style: colourOf(s), "data-name": name, d });
  return chart({
    title: pair.title, equal: true, x, y,
    draw: (place) => [
      ...list.map(({ s }) => svg("path", { class: "points", style: colourOf(s), d: points.filter((p) => p.s === s)
        .map(({ at: [x, y] }) => `M${place.x(x).toFixed(1)} ${place.y(y).toFixed(1)}h0`).join("") })),
      ...ellipses.map((e) => outline(e, "normal", pathThrough(e.points.map(([x, y]) => [place.x(x), place.y(y)])) + "Z")),
      ...contours.map((c) => outline(c, c.kind, c.lines.map((line) => pathThrough(line.map(([x, y]) => [place.x(x), place.y(y)])) + "Z").join(""))),
      ...contours.filter(({ kind }) => kind === "footprint" && list.length === 1).map((c, k) => outlineName(place, c, k))],
    count: points.length,
    at: (i) => points[i].at,
    reading: (i) => {
      const { sample, rocket, at, series } = points[i];
      return named(list, series, `sample ${sample}${salvo ? `, rocket ${rocket}` : ""}: ${at.map((v) => readable(v)).join(", ")} ${across.unit}`);
    },
    csv: () => csvOf(["series", "sample", "rocket", `${pair.x} [${pair.unit}]`, `${pair.y} [${pair.unit}]`],
      points.map((p) => [p.series.label, p.sample, p.rocket, ...p.si])),
    note: [shown, formOf(list, isLine(pair))].filter(Boolean).join("; "),
  });
}

// ---- sensitivities ----

const MOST_FACTORS = 8, MOST_OF_MANY = 6;

// A bar for each factor and series: the share of the result's variance that it makes alone; none where the
// estimate is below zero. Of total indices a pale bar above it, of Morris's effects mu* alone.
export function sensitivity(data, { name, series, effects = false, unit = "" }) {
  const result = describe({ name, unit }), list = having(data, series), many = list.length > MOST_OVERLAID;
  const factor = effects ? result.factor : 100, sign = effects ? ` ${result.unit}` : " %";
  const greatest = new Map(), totals = list.some(({ own }) => own.some((entry) => entry.length > 2));
  for (const { own } of list)
    for (const [path, [value], total] of own) greatest.set(path, Math.max(total ? total[0] : value, greatest.get(path) ?? -Infinity));
  const factors = [...greatest.keys()].sort((a, b) => greatest.get(b) - greatest.get(a)).slice(0, many ? MOST_OF_MANY : MOST_FACTORS);
  if (factors.length === 0) return null;
  const left = greatest.size - factors.length, thick = many ? 5 : 9, kinds = totals ? ["total", "first order"] : [""];
  const row = 17 + thick * list.length * kinds.length;
  const bars = factors.flatMap((path, i) => list.flatMap(({ own, series: of, s }, k) => kinds.flatMap((kind, n) => {
    const found = own.find(([one]) => one === path)?.[kind === "total" ? 2 : 1];
    return found ? [{ path, of, s, kind, y: i + (17 + thick * (k * kinds.length + n)) / row, shares: found.map((v) => (v === null ? null : factor * v)) }] : [];
  })));
  const known = bars.flatMap(({ shares }) => shares).filter((v) => v !== null), what = effects ? "mu*" : "share of the variance";
  return chart({
    title: `${result.label}: factors`, down: true, height: 60 + row * factors.length,
    x: { label: `${what} [${sign.trim()}]`, range: [0, Math.max(effects ? 0 : 5, ...known) * 1.02] },
    y: { label: "", range: [factors.length, 0], names: [] },
    draw: (place) => [
      ...factors.map((path, i) => svg("text", { x: place.left + 2, y: place.y(i) + 13 }, path)),
      ...bars.flatMap(({ s, y, kind, shares: [value, low, high] }) => {
        const top = place.y(y), middle = top + thick / 2 - 1, length = Math.max(0.5, place.x(value) - place.x(0));
        return [svg("rect", { x: place.x(0), width: length, y: top, height: thick - 2, class: kind === "total" ? "bar pale" : "bar", style: colourOf(s) }),
          ...(low === null ? [] : [svg("line", { x1: place.x(Math.max(0, low)), x2: place.x(high), y1: middle, y2: middle, class: "whisker" })])];
      })],
    count: bars.length,
    at: (i) => [bars[i].shares[0], bars[i].y + thick / 2 / row],
    reading: (i) => `${named(list, bars[i].of, bars[i].path)}: ${bars[i].kind ? `${bars[i].kind} ` : ""}${withInterval(bars[i].shares)}${sign}`,
    note: [totals ? "pale: total, full: first order" : "",
      left > 0 ? `${left} ${left === 1 ? "factor with a smaller share is" : "factors with smaller shares are"} not drawn` : ""].filter(Boolean).join("; "),
    csv: () => csvOf(["series", "factor", ...(totals ? ["first order", "total", "total less first"] : [`${what} of ${name}`])
      .flatMap((head) => ["", ", low", ", high"].map((end) => head + end))],
    list.flatMap(({ own, series: of }) => own.map(([path, ...values]) => [of.label, path, ...values.flat()]))),
  });
}

// ---- measured launches ----

// Launches and each series as dots in a row of their own, the mean with its interval above them.
export function beside(data, result) {
  const sides = [{ label: "measured", style: "--series: var(--ink)", own: result.own },
    ...having(data, result.series).map(({ series, s, own }) => ({ label: series.label, style: colourOf(s), own }))];
  const f = result.factor, row = 44;
  const places = sides.flatMap(({ label, own, style }, i) => own.points.map((v, k) => ({ label, style, side: i,
    at: [v * f, i + 0.62 + 0.3 * ((k * 0.618034) % 1)] })));
  return chart({
    title: `${result.label}: measured and simulated`, down: true, height: 60 + row * sides.length,
    x: { label: result.axis, range: rangeOf([...places.map(({ at }) => at[0]), ...sides.flatMap(({ own }) => own.mean.map((v) => (v === null ? NaN : v * f)))]) },
    y: { label: "", range: [sides.length, 0], names: [] },
    draw: (place) => sides.flatMap(({ label, own, style }, i) => {
      const [mean, low, high] = own.mean.map((v) => (v === null ? NaN : place.x(v * f))), y = place.y(i + 0.45);
      return [svg("text", { x: place.left + 2, y: place.y(i) + 12 }, label),
        svg("path", { class: "points", style, d: places.filter(({ side }) => side === i)
          .map(({ at: [x, down] }) => `M${place.x(x).toFixed(1)} ${place.y(down).toFixed(1)}h0`).join("") }),
        ...(Number.isFinite(low) ? [svg("line", { x1: low, x2: high, y1: y, y2: y, class: "span", style })] : []),
        svg("circle", { cx: mean, cy: y, r: 4, class: "dot", style })];
    }),
    count: sides.length,
    at: (i) => [sides[i].own.mean[0] * f, i + 0.45],
    reading: (i) => `${sides[i].label}: mean ${withInterval(sides[i].own.mean, f)}, deviation ${withInterval(sides[i].own.deviation, f)} ${result.unit}`,
    note: sides.some(({ own }) => own.points.length < own.count)
      ? sides.map(({ label, own }) => `${label}: ${own.points.length} of ${own.count} points shown`).join("; ") : "",
    csv: () => csvOf(["side", `${result.name} [${result.si}]`], sides.flatMap(({ label, own }) => own.points.map((v) => [label, v]))),
  });
}

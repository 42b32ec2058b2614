// A labelled drawing of the launcher, to scale: the guide from its side with its supports and the rocket as it stands
// before ignition, and how the whole stands on its base. What the results do not say is drawn dashed.
import { hingesOf, rowsOf } from "../replay/geometry.js";
import { guideOf } from "../replay/guide.js";
import { cornersOf, frameOf, mechanismOf, meshOf, nearestOf, outlineOf as pointsOf, placesOf } from "../replay/mechanism.js";
import { finCorners, outlineOf } from "../replay/outline.js";
import { add, apply, pose } from "../replay/vector.js";
import { svg } from "./chart.js";
import { filled } from "./data.js";
import { placeOnLine } from "./labels.js";
import { element } from "./page.js";
import { inUnit } from "./rounded.js";

const LETTER = 5.9, LINE = 14; // width and height of text [px]
// A length that somebody chose: without the zeros at its end.
const length = (v, like) => inUnit(v, "m", like).join("\u00a0").replace(/(\.\d*?)0+(?=\D*$)/, "$1").replace(/\.(?=\D*$)/, "");

// ---- parts of a drawing

const line = (x1, y1, x2, y2, kind = "thin") => svg("line", { x1, y1, x2, y2, class: kind });
const text = (content, x, y, anchor = "start", kind = "") => svg("text", { x, y, "text-anchor": anchor, class: kind }, content);
const shape = (points, kind) => svg("polygon", { points: points.map(([x, y]) => `${x.toFixed(1)},${y.toFixed(1)}`).join(" "), class: kind });
const circle = (cx, cy, r, kind) => svg("circle", { cx, cy, r, class: kind });

// A length between two places of a line, with an arrow at each end.
function dimension(x1, x2, y, content) {
  const tip = (x, d) => shape([[x, y], [x + 6 * d, y - 2.5], [x + 6 * d, y + 2.5]], "arrow"), middle = (x1 + x2) / 2;
  return [line(x1, y - 5, x1, y + 5), line(x2, y - 5, x2, y + 5), line(x1, y, x2, y), tip(x1, 1), tip(x2, -1),
    svg("rect", { x: middle - (LETTER * content.length) / 2 - 4, y: y - 8, width: LETTER * content.length + 8, height: 16, class: "back" }),
    text(content, middle, y + 4, "middle")];
}

// Names in a row at `y`, each joined to its point { x, y, name }; none through another.
function named(points, y, low, high) {
  const wide = points.map(({ name, x, rank = 0 }) => ({ at: x, width: LETTER * name.length, rank }));
  return placeOnLine(wide, low, high, 10).flatMap((left, i) => {
    if (left === null) return [];
    const { x, y: end, name } = points[i], from = Math.min(left + wide[i].width, Math.max(left, x)), above = y < end;
    return [line(from, above ? y + 3 : y - 11, x, end), text(name, left, y, "start", "name")];
  });
}

// Mass centre: a circle with two dark quarters.
function centreSign(x, y, r) {
  const quarter = (a) => svg("path", { class: "sign",
    d: `M${x} ${y}l${r * Math.cos(a)} ${r * Math.sin(a)}A${r} ${r} 0 0 1 ${x + r * Math.cos(a + Math.PI / 2)} ${y + r * Math.sin(a + Math.PI / 2)}Z` });
  return [circle(x, y, r, "centre"), quarter(0), quarter(Math.PI)];
}

// ---- the launcher in numbers

// What the drawing is of; `table`: of the launch. Heights y are from the line along which the rocket is guided.
function launcherOf(geometry, table, rockets) {
  const rows = (name) => rowsOf(geometry, name), stations = rows("tube.station").map(([x]) => x), end = stations.at(-1);
  const guide = guideOf(rows, end), first = (name) => {
    const column = table.column.get(name);
    return column ? filled(column.value, table.t).find(Number.isFinite) : undefined;
  };
  // As the launcher stands when its first rocket is ignited.
  const ready = Math.max(0, Array.from(table.t).filter((t) => t <= (rockets[0]?.ignition ?? table.t[0])).length - 1);
  const then = (name) => {
    const column = table.column.get(name);
    return column ? filled(column.value, table.t)[ready] : undefined;
  };
  const mechanism = mechanismOf(rows, [...table.column.keys()]);
  const names = [...table.column.keys()].filter((name) => /^contact\..*\.force$/.test(name)).map((name) => name.slice(8, -6));
  return {
    guide, end, names, stations, rows,
    supports: rows("tube.support").map(([x], i) => ({ x, clamped: rows("tube.clamped")[i]?.some((held) => held === 1) })),
    adaptors: rows("rocket.adaptor").map(([x]) => x), clearances: guide.clearances[0] ?? [],
    outline: outlineOf(rows), centre: rows("rocket.center")[0] ?? [], diameter: rows("rocket.diameter")[0]?.[0],
    travel: first("rocket.s") ?? 0, pitch: (mechanism ? then : first)("base.pitch") ?? 0, mount: rows("base.mount")[0],
    places: rows("tubes.rear_end"), tube: rockets[0]?.tube ?? 1, closed: table.column.has("pressure.force"),
    wheels: rows("wheel.mount"), wheelRadius: rows("wheel.radius")[0]?.[0] ?? 0,
    azimuth: hingesOf(rows)[0], elevation: hingesOf(rows)[1],
    mechanism, then,
  };
}

// Heights of the guide's parts: of a bore its walls, else its beams; from the guide line.
function partsOf({ guide }) {
  if (guide.kind === "bore") {
    const walls = guide.sections.map(([x, inner, outer]) => ({ x, inner, outer: outer ?? 1.03 * inner }));
    return { walls, top: Math.max(...walls.map(({ outer }) => outer)), beams: [] };
  }
  const span = (profile) => [Math.min(...profile.map(([y]) => y)), Math.max(...profile.map(([y]) => y))];
  const beams = [...guide.solid.map((p) => ({ y: span(p), kind: "beam" })), ...guide.seenThrough.map((p) => ({ y: span(p), kind: "thin-beam" }))];
  return { walls: [], beams, top: Math.max(guide.body, ...beams.flatMap(({ y }) => y.map(Math.abs))) };
}

// ---- the guide and the rocket

function drawGuide(it, parts, X, Y) {
  const out = parts.beams.map(({ y: [low, high], kind }) => shape([[X(0), Y(low)], [X(it.end), Y(low)], [X(it.end), Y(high)], [X(0), Y(high)]], kind));
  for (const side of [-1, 1]) {
    if (parts.walls.length === 0) break;
    const along = parts.walls.flatMap((wall, i) => [[wall.x, wall], [parts.walls[i + 1]?.x ?? it.end, wall]]);
    out.push(shape([...along.map(([x, w]) => [X(x), Y(side * w.inner)]), ...[...along].reverse().map(([x, w]) => [X(x), Y(side * w.outer)])], "beam"));
  }
  if (it.closed) out.push(shape([[X(-0.03 * it.end), Y(parts.top)], [X(0), Y(parts.top)], [X(0), Y(-parts.top)], [X(-0.03 * it.end), Y(-parts.top)]], "beam"));
  return out;
}

// Triangles below the guide, blocks where it is clamped.
function drawSupports(it, low, X, Y) {
  return it.supports.map(({ x, clamped }) => {
    const [a, b] = [X(x), Y(low)];
    return clamped ? shape([[a - 8, b], [a + 8, b], [a + 8, b + 13], [a - 8, b + 13]], "held")
      : shape([[a, b], [a - 7, b + 13], [a + 7, b + 13]], "support");
  });
}

const radiusOf = (it) => (it.outline ? it.outline.widest : it.diameter > 0 ? it.diameter / 2 : it.guide.body);

// Where the fins stand about the axis: the guide, below, between two of them; those that a bore has no room for are not
// drawn. Shares of their distance from the axis that one sees from the side.
function seenFins({ outline, guide }) {
  const fits = ({ radius, span }) => guide.kind !== "bore" || radius + span <= guide.radius;
  return (outline?.fins ?? []).filter(fits).flatMap((of) => Array.from({ length: of.count }, (_, k) => -Math.cos((2 * Math.PI * (k + 0.5)) / of.count))
    .map((share) => finCorners(of).map(([x, r]) => [x, share * r])));
}

// From where to where the rocket reaches along the guide, and how high above its axis.
function reachOf(it) {
  const { travel: s, outline } = it, radius = radiusOf(it), high = Math.max(radius, ...seenFins(it).flat().map(([, y]) => y));
  if (outline) return { rear: s + outline.rear, tip: s + outline.tip, high };
  return { rear: s - 0.5 * radius, tip: s + Math.max(...it.adaptors) + 5 * radius, high };
}

// The body as it is given; else of the size that is known, and where that ends made up, and dashed.
function drawBody(it, X, Y) {
  const { travel: s, outline } = it, radius = radiusOf(it), { rear, tip } = reachOf(it), shoulder = tip - 4 * radius;
  if (outline) return [...seenFins(it).map((corners) => shape(corners.map(([x, y]) => [X(s + x), Y(y)]), "rocket fin")),
    shape([1, -1].flatMap((side) => (side > 0 ? outline.body : [...outline.body].reverse()).map(([x, r]) => [X(s + x), Y(side * r)])), "rocket body")];
  return [shape([[X(rear), Y(radius)], [X(shoulder), Y(radius)], [X(shoulder), Y(-radius)], [X(rear), Y(-radius)]], it.diameter > 0 ? "rocket" : "rocket made-up"),
    shape([[X(shoulder), Y(radius)], [X(tip), Y(0)], [X(shoulder), Y(-radius)]], "rocket made-up")];
}

function drawRocket(it, X, Y) {
  const { travel: s, adaptors } = it, radius = radiusOf(it), out = drawBody(it, X, Y);
  adaptors.forEach((l, i) => {
    const half = Math.max(2.5, 0.006 * (X(it.end) - X(0)));
    for (const [low, high] of adaptorHeights(it, i))
      out.push(shape([[X(s + l) - half, Y(low)], [X(s + l) + half, Y(low)], [X(s + l) + half, Y(high)], [X(s + l) - half, Y(high)]], "adaptor"));
  });
  const at = X(s + (it.centre[0] ?? 0));
  return [...out, ...(it.centre.length ? centreSign(at, Y(0), Math.min(7, Math.max(4, Y(0) - Y(radius)))) : [])];
}

// From and to which heights an adaptor is seen, a ring about the body; shoes stand on it.
function adaptorHeights({ guide, clearances }, i) {
  const ring = guide.ring(clearances[i] ?? 0, 1);
  if (ring) return [[-ring, ring]];
  return guide.pads(clearances[i] ?? 0, 1).map((profile) => [Math.min(...profile.map(([y]) => y)), Math.max(...profile.map(([y]) => y))]);
}

// `words`: puts the right ones for the guide into a text.
function guideDrawing(it, words, left, width, top) {
  const parts = partsOf(it), low = it.guide.kind === "bore" ? -parts.top : Math.min(...parts.beams.map(({ y }) => y[0]), -it.guide.body);
  const radius = radiusOf(it), reach = reachOf(it), from = Math.min(-0.04 * it.end, reach.rear - 0.02 * it.end), to = Math.max(it.end, reach.tip);
  const scale = (width - 24) / (to - from), X = (x) => left + 12 + scale * (x - from), high = Math.max(parts.top, reach.high);
  const middle = top + 62 + scale * high, Y = (y) => middle - scale * y, under = Y(low);
  const adaptors = it.adaptors.map((l, i) => ({ x: X(it.travel + l), y: Y(radius), rank: 1,
    name: `${it.names[i] ?? ""}${it.clearances[i] > 0 ? `, gap ${length(it.clearances[i])}` : ""}` }));
  const centre = it.centre.length ? [{ x: X(it.travel + it.centre[0]), y: Y(0) - 5, name: "mass centre", rank: 0 }] : [];
  const supports = it.supports.map(({ x, clamped }, i) => ({ x: X(x), y: under + 14, rank: i,
    name: `${i === 0 ? (clamped ? "clamp at " : "support at ") : ""}${length(x, it.end)}` }));
  const thick = it.outline ? 2 * radius : it.diameter, long = it.outline ? ` ${length(it.outline.tip - it.outline.rear)} long` : "";
  const rocket = [long, it.guide.kind !== "bore" && thick > 0 ? ` ${length(thick)} thick` : ""].filter(Boolean).join(",");
  const bore = `${it.guide.kind === "bore" ? `, bore ${length(2 * it.guide.radius)}` : ""}${rocket && `, rocket${rocket}`}`;
  return {
    nodes: [...dimension(X(0), X(it.end), top + 10, words(`tube ${length(it.end)}`) + bore), ...drawGuide(it, parts, X, Y),
      ...drawSupports(it, low, X, Y), ...drawRocket(it, X, Y),
      ...named([...adaptors, ...centre].sort((a, b) => a.x - b.x), top + 36, left, left + width), ...named(supports, under + 34, left, left + width)],
    bottom: under + 34 + 6, scale,
  };
}

// ---- how it stands

// Points of the side view in a frame with x forwards and y up, and what is drawn of them.
function sideOf(it) {
  const turn = (angle) => ([x, y]) => [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle)];
  if (it.wheels.length === 0) {
    const angle = (it.mount?.[1] ?? 0) + it.pitch, end = turn(angle)([it.end, 0]);
    return { tubes: [[[0, 0], end]], angle, wheels: [], pivot: [0, 0], ground: Math.min(0, end[1]) - 0.12 * it.end, body: null };
  }
  const pivot = [it.azimuth[0] + it.elevation[0], it.azimuth[1] + it.elevation[1]], turned = turn(it.pitch);
  const shift = ([x, y]) => { const [a, b] = turned([x, y]); return [a + pivot[0], b + pivot[1]]; };
  const tubes = it.places.map(([x, y]) => [shift([x, y]), shift([x + it.end, y])]);
  const xs = it.wheels.map(([x]) => x), y = Math.max(...it.wheels.map(([, height]) => height));
  const body = [Math.min(...xs) - 1.2 * it.wheelRadius, Math.max(...xs) + 1.2 * it.wheelRadius, y + 0.4 * it.wheelRadius, Math.max(it.azimuth[1], y + 0.7 * it.wheelRadius)];
  return { tubes, angle: it.pitch, wheels: it.wheels, pivot, ground: Math.min(...it.wheels.map(([, height]) => height)) - it.wheelRadius, body };
}

// Bodies, joints and what else carries the tubes, in the vertical plane of the tube: points along it and up.
function mechanismSide(it) {
  const { mechanism, then } = it, three = (head, ...names) => names.map((name) => then(head + name));
  const poseOf = (head) => ({ r: three(head, "x", "y", "z"), A: pose(...three(head, "yaw", "pitch", "roll")) });
  const places = placesOf(mechanism, poseOf, then), base = poseOf("base."), yaw = Math.abs(it.pitch) < 1.4 ? then("base.yaw") : 0;
  const flat = ([x, y, z]) => [x * Math.cos(yaw) - z * Math.sin(yaw), y], at = (thing, point) => flat(frameOf(mechanism, places, thing, point).r);
  const rear = it.places[it.tube - 1] ?? it.places[0];
  const tubes = it.places.map((place) => [0, it.end].map((x) => flat(add(base.r, apply(base.A, [place[0] - rear[0] + x, place[1] - rear[1], place[2] - rear[2]])))));
  const ties = mechanism.joints.flatMap((joint) => [[joint.parent, joint.at], ...(joint.closes ? [] : [[joint.body, [0, 0, 0]]])]).flatMap(([thing, point]) => {
    const near = mechanism.bodies[thing] && nearestOf(mechanism.bodies[thing], point);
    return near ? [[at(thing, point), at(thing, near)]] : [];
  });
  return {
    tubes, angle: it.pitch, pivot: tubes[it.tube - 1]?.[0] ?? tubes[0][0], ties,
    bodies: mechanism.bodies.flatMap((body, i) => (body.shape === "mesh" ? [] : [hull(cornersOf(body).map((corner) => at(i, corner)))])).filter((corners) => corners.length > 2),
    meshes: mechanism.bodies.flatMap((body, i) => (body.shape === "mesh" ? [meshOf(body).map((corners) => corners.map((corner) => at(i, corner)))] : [])),
    beams: mechanism.beams.map(({ shapes }, i) => shapes.stations.map((x) => at(mechanism.bodies.length + i, [x, 0, 0]))),
    struts: mechanism.struts.map(({ ends, at: points }) => ends.map((thing, i) => at(thing, points[i]))),
    joints: mechanism.joints.filter(({ kind }) => kind !== "free" && kind !== "fixed").map(({ parent, at: point }) => at(parent, point)),
    feet: mechanism.feet.map(({ on, at: point }) => at(on, point)), wheels: places.wheels.map(flat), wheelRadius: mechanism.wheelRadius,
    outline: [...tubes.flat(), ...pointsOf(mechanism, places).map(flat)],
    stands: mechanism.wheels.length > 0 || mechanism.feet.length > 0 || mechanism.carried || mechanism.joints.some(({ parent, kind }) => parent === -1 && kind !== "free"),
  };
}

// The area that triangles cover: its outline, then a face over the outline's inner half. All are turned one way: none cancels another.
function silhouette(triangles) {
  const facing = triangles.map(([a, b, c]) => ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) < 0 ? [a, c, b] : [a, b, c]));
  const d = facing.map((corners) => `M${corners.map(([x, y]) => `${x.toFixed(1)} ${y.toFixed(1)}`).join("L")}Z`).join("");
  return ["contour", "back", "part face"].map((kind) => svg("path", { d, class: kind }));
}

// Convex hull of points in a plane, in order.
function hull(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]), turn = (o, a, b) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
  const half = (list) => list.reduce((chain, p) => {
    while (chain.length > 1 && turn(chain.at(-2), chain.at(-1), p) <= 0) chain.pop();
    return [...chain, p];
  }, []).slice(0, -1);
  return [...half(sorted), ...half(sorted.reverse())];
}

// How it stands, in words; in two lines where one is too wide.
function standingWords(it, width) {
  const turned = it.mount?.[0] ?? 0, up = it.wheels.length === 0 ? (it.mount?.[1] ?? 0) + it.pitch : it.pitch;
  const degrees = (v) => `${Number(((Math.abs(v) * 180) / Math.PI).toPrecision(3))}°`;
  const count = it.places.length > 1 ? `${it.places.length} in the pack` : "";
  const aside = Math.abs(turned) > 1e-6 ? `, ${degrees(turned)} to the ${turned > 0 ? "left" : "right"}` : "";
  const stands = `${degrees(up)} ${up >= 0 ? "up" : "down"}${aside}`, all = count ? `${stands}, ${count}` : stands;
  return LETTER * all.length > width && count ? [stands, count] : [all];
}

function standing(it, left, width, top, height) {
  if (it.mechanism) return mechanismStanding(it, left, width, top, height);
  const lines = standingWords(it, width), foot = 6 + LINE * lines.length;
  const side = sideOf(it), xs = [...side.tubes.flat().map(([x]) => x), ...(side.body ? side.body.slice(0, 2) : [])];
  const ys = [...side.tubes.flat().map(([, y]) => y), side.ground], w = Math.max(...xs) - Math.min(...xs), h = Math.max(...ys) - side.ground;
  const scale = Math.min((width - 20) / (1.1 * w), (height - foot - 4) / (1.05 * h)), x0 = Math.min(...xs);
  const X = (x) => left + 10 + (width - 20 - scale * w) / 2 + scale * (x - x0), Y = (y) => top + height - foot - scale * (y - side.ground);
  const out = [line(left, Y(side.ground), left + width, Y(side.ground), "ground")];
  if (side.body) out.push(shape([[X(side.body[0]), Y(side.body[2])], [X(side.body[1]), Y(side.body[2])], [X(side.body[1]), Y(side.body[3])], [X(side.body[0]), Y(side.body[3])]], "made-up"));
  if (side.body) out.push(shape([[X(side.pivot[0] - 0.2), Y(side.body[3])], [X(side.pivot[0] + 0.2), Y(side.body[3])], [X(side.pivot[0]), Y(side.pivot[1])]], "made-up"));
  for (const [x, y] of new Map(side.wheels.map((mount) => [mount[0], mount])).values()) out.push(circle(X(x), Y(y), scale * it.wheelRadius, "wheel"));
  for (const [[a, b], [c, d]] of side.tubes) out.push(line(X(a), Y(b), X(c), Y(d), "tube"));
  const [px, py] = [X(side.pivot[0]), Y(side.pivot[1])], reach = Math.min(0.5 * scale * it.end, 46), up = side.angle;
  out.push(circle(px, py, 2.5, "pivot"), line(px, py, px + 1.25 * reach, py, "level"),
    svg("path", { class: "thin", d: `M${px + reach} ${py}A${reach} ${reach} 0 0 ${up > 0 ? 0 : 1} ${px + reach * Math.cos(up)} ${py - reach * Math.sin(up)}` }));
  return [...out, ...captions(lines, left, width, top, height)];
}

const captions = (lines, left, width, top, height) =>
  lines.map((words, i) => text(words, left + width / 2, top + height - 4 - LINE * (lines.length - 1 - i), "middle"));

// The same with all that carries the tubes.
function mechanismStanding(it, left, width, top, height) {
  const lines = standingWords(it, width), foot = 6 + LINE * lines.length, side = mechanismSide(it);
  const xs = side.outline.map(([x]) => x), ys = side.outline.map(([, y]) => y), x0 = Math.min(...xs), y0 = Math.min(...ys);
  const w = Math.max(...xs) - x0, h = Math.max(...ys) - y0, scale = Math.min((width - 20) / w, (height - foot - 14) / h);
  const X = (x) => left + 10 + (width - 20 - scale * w) / 2 + scale * (x - x0), Y = (y) => top + height - foot - 4 - scale * (y - y0);
  const on = ([x, y]) => [X(x), Y(y)], joined = ([a, b], kind) => line(...on(a), ...on(b), kind), out = [];
  if (side.stands) out.push(line(left, Y(y0) + 1, left + width, Y(y0) + 1, "ground"));
  out.push(...side.meshes.flatMap((triangles) => silhouette(triangles.map((corners) => corners.map(on)))));
  out.push(...side.bodies.map((corners) => shape(corners.map(on), "part")), ...side.ties.map((ends) => joined(ends, "thin")));
  for (const points of side.beams) out.push(svg("polyline", { points: points.map((p) => on(p).map((v) => v.toFixed(1)).join(",")).join(" "), class: "mast" }));
  out.push(...side.struts.map((ends) => joined(ends, "strut")), ...side.wheels.map((r) => circle(...on(r), scale * side.wheelRadius, "wheel")));
  for (const [x, y] of side.feet.map(on)) out.push(shape([[x - 4, y], [x + 4, y], [x, y - 7]], "support"));
  for (const [a, b] of side.tubes) out.push(line(...on(a), ...on(b), "tube"));
  out.push(...side.joints.map((r) => circle(...on(r), 2.5, "joint")));
  return [...out, ...captions(lines, left, width, top, height)];
}

// ---- the card

export function drawingCard({ geometry, table, rockets, named: words }) {
  const it = launcherOf(geometry, table, rockets), picture = svg("svg", { role: "img" });
  const label = words(`The launcher to scale: tube ${length(it.end)}, supports at ${it.supports.map(({ x }) => length(x, it.end)).join(", ")}, ` +
    `adaptors at ${it.adaptors.map((l) => length(l, it.end)).join(", ")} of the rocket`);
  picture.setAttribute("aria-label", label);
  const host = element("div", { className: "plan" }, picture);
  let before = 0;
  const draw = () => {
    const width = host.clientWidth;
    if (width === 0 || width === before) return;
    before = width;
    const beside = width > 560, inset = beside ? Math.min(it.mechanism ? 300 : 230, 0.28 * width) : 0, high = it.mechanism ? 190 : 110;
    const main = guideDrawing(it, words, inset, width - inset, 4), tall = beside ? Math.max(main.bottom, high) : main.bottom + high + 20;
    const other = beside ? standing(it, 0, inset - 10, 4, tall - 4) : standing(it, 0, width, main.bottom + 10, high + 10);
    picture.setAttribute("viewBox", `0 0 ${width} ${tall.toFixed(0)}`);
    picture.dataset.scale = main.scale;
    picture.replaceChildren(...other, ...main.nodes);
  };
  new ResizeObserver(draw).observe(host);
  return element("section", { className: "card drawing" },
    element("h3", {}, "This launcher, to scale ", element("small", {}, "before ignition; dashed: assumed")), host);
}

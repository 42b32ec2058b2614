// What summary.json says, as tables.
import { element } from "./page.js";
import { readable } from "./data.js";
import { isSteep, marked, MM, MRAD, ROCKET } from "./results.js";

const EQUILIBRIUM = [
  ["lock_force", "force of the lock", "N", 1],
  ["breech_force", "force of the breech", "N", 1],
  ["slot_force", "force of the slot", "N", 1],
  ["contact_force.*", "contact force, %s", "N", 1],
  ["tip_sag.y", "sag of the tip, y", ...MM],
  ["tip_sag.z", "sag of the tip, z", ...MM],
  ["chassis.y", "height of the chassis", ...MM],
  ["chassis.pitch", "pitch of the chassis", ...MRAD],
  ["chassis.roll", "roll of the chassis", ...MRAD],
  ["azimuth.torque", "azimuth torque", "N m", 1],
  ["elevation.torque", "elevation torque", "N m", 1],
  ["residual", "largest residual acceleration", "m/s²", 1],
];

const ENERGY = [
  ["kinetic", "kinetic energy", "J", 1],
  ["potential", "potential energy", "J", 1],
  ["elastic", "elastic energy", "J", 1],
  ["work.*", "work: %s", "J", 1],
  ["residual", "energy residual", "J", 1],
  ["residual_relative", "over the largest work", "", 1],
];

const STATISTICS = [
  ["steps", "steps", "", 1],
  ["rhs_evaluations", "evaluations of the equations", "", 1],
  ["cpu_seconds", "CPU time of the run", "s", 1],
  ["cpu_seconds_setup", "CPU time of the set-up", "s", 1],
];

function at(object, path) {
  return path.split(".").reduce((part, key) => (part == null ? undefined : part[key]), object);
}

// " ± error" in the unit of the row; nothing where it is not known.
const withError = (error, factor) => (typeof error === "number" ? ` ± ${readable(error * factor, 2)}` : "");

// Rows of the list that some of the objects has, with '*' for every key that is there; a function finds the number itself.
function rowsOf(objects, list) {
  const rows = [];
  for (const [path, label, unit, factor, error] of list) {
    const find = typeof path === "function" ? path : (o) => at(o, path);
    const [head, star] = typeof path === "function" ? [] : path.split(".*");
    const keys = star === undefined ? [null] : [...new Set(objects.flatMap((o) => Object.keys(at(o, head) ?? {})))];
    for (const key of keys) {
      const read = (o) => (key === null ? find(o) : at(o, head)?.[key]);
      const cells = objects.map(read);
      if (cells.every((cell) => typeof cell !== "number")) continue;
      rows.push([label.replace("%s", () => key.replaceAll("_", " ")), unit,
        cells.map((cell, i) => (typeof cell === "number" ? readable(cell * factor) + withError(error && at(objects[i], error), factor) : "–"))]);
    }
  }
  return rows;
}

// The rows of rockets, marked where one of them leaves near the vertical.
const rowsMarked = (rockets) => ROCKET.map(([key, label, ...more]) => [key, marked(key, label, rockets.some(({ pitch }) => isSteep(pitch))), ...more]);

function tableOf(heading, rows, heads) {
  if (rows.length === 0) return null;
  const body = rows.map(([label, unit, cells]) =>
    element("tr", {}, element("th", { scope: "row" }, label),
      ...cells.map((cell) => element("td", {}, cell)), element("td", { className: "unit" }, unit)));
  const head = heads && element("tr", {}, element("th", {}, ""),
    ...heads.map((name) => element("th", { scope: "col" }, name)), element("th", {}, ""));
  return element("details", { className: "card" }, element("summary", {}, heading),
    element("div", { className: "scroll" }, element("table", {}, head, ...body)));
}

// What the scenario's measures are, each with its own unit; of several runs a row for each that any of them has, and where two
// give one name to measures of different units, one for each unit.
function measures(summaries) {
  const rows = new Map();
  for (const { measures: list, rockets } of summaries)
    for (const { name, unit } of list ?? []) {
      const row = rows.get(`${name} ${unit}`) ?? { name, unit, of: new Map() };
      rows.set(`${name} ${unit}`, row);
      (rockets ?? []).forEach((rocket) => row.of.set(rocket, rocket.measure?.[name]));
    }
  return [...rows.values()].map(({ name, unit, of }) => [(rocket) => of.get(rocket), name.replaceAll("_", " "), unit === "1" ? "" : unit, 1]);
}

function modes(list, named) {
  const rows = (list ?? []).map((mode, i) => [String(mode.shape), "",
    [readable(mode.frequency), readable(100 * mode.damping)]]);
  return tableOf(named("Natural frequencies of the tube on its supports"), rows, ["Hz", "damping, %"]);
}

// `named`: puts words for its guide into a text.
export function showSummary(summary, named) {
  const rockets = summary.rockets ?? [], rocket = rowsMarked(rockets).map(([path, label, ...more]) => [path, named(label), ...more]);
  return element("div", { id: "tables" },
    tableOf(rockets.length > 1 ? "Rockets" : "Rocket", rowsOf(rockets, [...rocket, ...measures([summary])]),
      rockets.length > 1 ? rockets.map((_, i) => String(i + 1)) : null),
    tableOf("Energy balance at the end", rowsOf([summary.energy ?? {}], ENERGY)),
    tableOf("Equilibrium at the start", rowsOf([summary.equilibrium ?? {}], EQUILIBRIUM)),
    modes(summary.modes, named),
    tableOf("Computation", rowsOf([summary.statistics ?? {}], STATISTICS)));
}

// Those of several runs side by side, each {label, summary}.
export function showSummaries(runs) {
  const labels = runs.map(({ label }) => label), all = runs.map(({ summary }) => summary);
  const rockets = all.flatMap((summary) => summary.rockets ?? []);
  const heads = runs.flatMap(({ label, summary }) => (summary.rockets ?? []).map((_, i, { length }) =>
    (length > 1 ? `${label}, ${i + 1}` : label)));
  const part = (name, list) => rowsOf(all.map((summary) => summary[name] ?? {}), list);
  const most = Math.max(...all.map(({ modes: list }) => list?.length ?? 0), 0);
  const frequencies = Array.from({ length: most }, (_, i) => {
    const each = all.map(({ modes: list }) => list?.[i]);
    return [[...new Set(each.filter(Boolean).map(({ shape }) => String(shape)))].join(" / "), "Hz", each.map((mode) => readable(mode?.frequency))];
  });
  return element("div", { id: "tables" },
    tableOf(rockets.length > runs.length ? "Rockets" : "Rocket", rowsOf(rockets, [...rowsMarked(rockets), ...measures(all)]), heads),
    tableOf("Energy balance at the end", part("energy", ENERGY), labels),
    tableOf("Equilibrium at the start", part("equilibrium", EQUILIBRIUM), labels),
    tableOf("Natural frequencies of the tube on its supports", frequencies, labels),
    tableOf("Computation", part("statistics", STATISTICS), labels));
}

// The answer of a run on one card: how fast and how straight the rocket leaves, what moved most, whether the energy
// balances, warnings. Rounded as people say it; the tables have all digits.
import { filled, matching } from "./data.js";
import { element } from "./page.js";
import { inUnit, rounded } from "./rounded.js";

const MOST_NOTES = 2, MOST_MEASURES = 4;

// The numbers among those that all rockets have.
const finite = (values) => values.filter((v) => typeof v === "number" && Number.isFinite(v));

// What one rocket has, or the least and the greatest of several.
function saidOf(values, unit) {
  const known = finite(values);
  if (known.length === 0) return null;
  const low = Math.min(...known), high = Math.max(...known), like = Math.max(Math.abs(low), Math.abs(high));
  const [least, name] = inUnit(low, unit, like), [greatest] = inUnit(high, unit, like);
  return [least === greatest ? least : `${least} to ${greatest}`, name];
}

function row(label, said, note = "") {
  if (!said) return null;
  return element("tr", {}, element("th", { scope: "row" }, label, note ? element("small", {}, note) : null),
    element("td", {}, said[0], element("span", { className: "unit" }, said[1] ? `\u00a0${said[1]}` : "")));
}

// ---- what moved most

// The farthest that columns together come from where they were at ignition, and when, on the run's clock.
function farthest(table, names, from) {
  const columns = names.map((name) => table.column.get(name)).filter(Boolean);
  if (columns.length === 0) return null;
  const values = columns.map(({ value }) => filled(value, table.t)), first = table.t.findIndex((t) => t >= from);
  const start = values.map((value) => value[Math.max(0, first)]);
  let most = 0, when = NaN;
  for (let i = Math.max(0, first); i < table.t.length; i++) {
    const d = Math.hypot(...values.map((value, k) => value[i] - start[k]));
    if (d > most) { most = d; when = table.t[i]; }
  }
  return { most, when };
}

// What can move, as one says it, with its columns.
function movers(table) {
  const slides = matching(table, "recoil.*.travel").map(([{ name }, text]) => [`tube on its slides, ${text}`, [name]]);
  return [["tip of the tube", ["tip.y", "tip.z"]], ["rear adaptor across the tube", ["rocket.y", "rocket.z"]],
    ["chassis, up and down", ["chassis.y"]], ...slides];
}

// Parts that moved since the first ignition, by how far.
export const motions = (table, ignition) => movers(table).map(([label, names]) => ({ label, ...farthest(table, names, ignition) }))
  .filter(({ most }) => most > 0).sort((a, b) => b.most - a.most);

// The part that moved farthest, the next one below it.
function moved(table, ignition, named) {
  const found = motions(table, ignition).map((part) => ({ ...part, label: named(part.label) }));
  if (found.length === 0) return [];
  const [first, second] = found, when = inUnit(first.when - ignition, "s").join("\u00a0");
  const next = second ? `, then the ${second.label} ${inUnit(second.most, "m").join("\u00a0")}` : "";
  return [row("Moved most", inUnit(first.most, "m"), `${first.label}, at ${when}${next}`)];
}

// ---- the rest

function contact(rockets) {
  const all = rockets.flatMap((rocket) => Object.entries(rocket.max_contact_force ?? {})).filter(([, force]) => force > 0);
  if (all.length === 0) return null;
  const [name, force] = all.reduce((best, one) => (one[1] > best[1] ? one : best));
  return row("Largest contact force", inUnit(force, "N"), name);
}

const mrad = (v) => (typeof v === "number" ? 1e3 * v : null);
const time = (rocket) => (typeof rocket.t_rear === "number" ? rocket.t_rear - (rocket.t_release ?? 0) : null);

function launchRows(rockets, named) {
  const each = (find) => rockets.map(find), off = finite(each((r) => mrad(r.exit_error?.rates)));
  const error = off.length ? `± ${Number(Math.max(...off).toPrecision(2))}\u00a0mrad/s; ` : "";
  const rates = (name) => saidOf(each((r) => mrad(r.tip_off?.[name])), "mrad/s");
  const relative = (said) => (said ? `${error}relative rate ${said.join("\u00a0")}` : "");
  return [
    row("Tip-off pitch rate", rates("pitch_rate"), relative(rates("pitch_rate_relative"))),
    row("Tip-off yaw rate", rates("yaw_rate"), relative(rates("yaw_rate_relative"))),
    row("Spin at the exit", saidOf(each((r) => r.spin_rate), "rad/s")),
    row("From release to exit", saidOf(each(time), "s")),
    contact(rockets),
  ];
}

function flightRows(rockets) {
  const each = (name) => rockets.map(({ flight }) => flight?.[name]);
  const above = saidOf(each("apogee_altitude"), "m");
  return [
    row("Apogee", saidOf(each("apogee"), "m"), above ? `above ground; ${above.join("\u00a0")} above sea level` : ""), row("Range", saidOf(each("range"), "m")),
    row("Time of flight", saidOf(each("time_of_flight"), "s")),
    row("Largest Mach number", saidOf(each("max_mach"), "")),
    row("Speed at landing", saidOf(each("impact_speed"), "m/s")),
  ];
}

function measureRows({ measures, rockets }) {
  return (measures ?? []).slice(0, MOST_MEASURES).map(({ name, unit }) =>
    row(String(name).replaceAll("_", " "), saidOf(rockets.map(({ measure }) => measure?.[name]), unit === "1" ? "" : String(unit)), "as requested"));
}

function energy({ energy: found }) {
  const missing = found?.residual_relative;
  if (typeof missing !== "number") return null;
  return row("Energy residual", [rounded(Math.abs(missing)), ""], "of the largest work");
}

function notesBlock(notes) {
  const list = (some) => some.map((note) => element("li", {}, note));
  if (notes.length === 0) return element("p", { className: "shown" }, "No warnings.");
  const [first, rest] = [notes.slice(0, MOST_NOTES), notes.slice(MOST_NOTES)];
  return element("div", { className: "warning" }, element("ul", {}, ...list(first)),
    rest.length ? element("details", {}, element("summary", {}, `${rest.length} more`), element("ul", {}, ...list(rest))) : null);
}

// The large number: the speed along the tube at the exit, or of a flight alone how far it goes.
function headline(rockets, named) {
  const speed = saidOf(rockets.map(({ exit_speed: v }) => v), "m/s");
  const [said, label] = speed ? [speed, named("along the tube at the exit")]
    : [saidOf(rockets.map(({ flight }) => flight?.range), "m"), "range"];
  if (!said) return null;
  return element("p", { className: "headline" }, element("strong", {}, said[0]), ` ${said[1]} `, element("span", {}, label));
}

// `state`: how the run ended, as a paragraph; `table`: of the launch, if there is one; `compared`: lines on a log.
export function answerCard({ summary, state, notes, table, ignition, named, compared = [] }) {
  const rockets = summary?.rockets ?? [], flies = rockets.some(({ flight }) => flight);
  const count = rockets.length > 1 ? element("p", { className: "shown" }, `Smallest and largest value of ${rockets.length} rockets.`) : null;
  const rows = !summary ? [] : [...launchRows(rockets, named), ...(table ? moved(table, ignition, named) : []),
    ...(flies ? flightRows(rockets) : []), ...measureRows(summary), energy(summary),
    ...compared.map(({ label, said, note }) => row(label, [said, ""], note))];
  return element("section", { className: "card answer", id: "answer" }, element("h2", {}, "The answer"),
    headline(rockets, named), count, element("table", {}, ...rows.filter(Boolean)), state, notesBlock(notes));
}

// The results of a study as a person reads them: label, unit, factor from SI, and where they belong.
import { DEG, marked, MM, MRAD, ROCKET } from "./results.js";

const MORE = [
  ["exit.x", "position at the exit, x", "m", 1],
  ["exit.y", "position at the exit, y", "m", 1],
  ["exit.z", "position at the exit, z", "m", 1],
  ["exit.vx", "velocity at the exit, x", "m/s", 1],
  ["exit.vy", "velocity at the exit, y", "m/s", 1],
  ["exit.vz", "velocity at the exit, z", "m/s", 1],
  ["tip.vy", "tip of the tube, velocity y", "mm/s", 1e3],
  ["tip.vz", "tip of the tube, velocity z", "mm/s", 1e3],
  ["tip.pitch_rate", "tip of the tube, pitch rate", "mrad/s", 1e3],
  ["tip.yaw_rate", "tip of the tube, yaw rate", "mrad/s", 1e3],
  ["downrange", "downrange", "m", 1],
  ["t_impact", "landing, from ignition", "s", 1],
  ["t_max_acceleration", "largest acceleration, from ignition", "s", 1],
  ["t_max_dynamic_pressure", "largest dynamic pressure, from ignition", "s", 1],
  ["measure.*", "%s", null, 1],
];

const PARTS = [
  ["Measures of the scenario", /^measure\./],
  ["Attitude and rates at the exit, launcher's axes", /^(since_ignition|tip_off)\./],
  ["Speeds at the exit", /speed$|^spin/],
  ["Flight", /^(apogee|t_apogee|t_max|stability|downrange|drift|range|t_impact|time_of_flight|impact|max_mach|max_dynamic|max_acceleration|max_angle)/],
  ["Attitude and rates at the exit, ground frame", /^(pitch|yaw)/],
  ["Tip of the tube", /^tip\./],
  ["Position and velocity at the exit", /^exit\./],
  ["Instants", /^t_/],
  ["Greatest forces in the tube", /^max_/],
  ["Hinges from ignition to exit", /^(azimuth|elevation)\./],
];

// Whether a key of the lists is that of a result; key.* is that of one result an adaptor.
const isOf = (key, name) => key === name || key === `flight.${name}` ||
  (key.endsWith("*") && name.startsWith(key.slice(0, -1)));

// A result of the study's data with all that; `steep`: rockets leave near the vertical.
export function describe({ name, unit, ...rest }, steep = false) {
  const row = [...ROCKET, ...MORE].find(([key]) => isOf(key, name));
  const [key, pattern, shown, factor] = row ?? [name, name, unit, 1];
  const label = pattern.replace("%s", () => name.slice(key.length - 1).replaceAll("_", " "));
  const own = shown ?? unit;
  const text = marked(name, label[0].toUpperCase() + label.slice(1), steep);
  const part = /^(impact|t_impact)/.test(name) ? 3 : PARTS.findIndex(([, pattern]) => pattern.test(name));
  return { ...rest, name, si: unit, label: text, unit: own, factor, part, axis: own ? `${label} [${own}]` : label };
}

export const partName = (index) => (index < 0 ? "Other results" : PARTS[index][0]);
export const partCount = PARTS.length;

// What one asks a study first, in this order: of it the first that there are.
const FIRST = [/^measure\./, /^exit_speed$/, /^since_ignition\.(pitch|yaw)_rate$/, /^downrange$/, /^drift$/, /^apogee$/, /^spin_rate$/,
  /^since_ignition\.(pitch|yaw)$/, /^tip_off\.(pitch|yaw)_rate_relative$/, /^tip_off\.(pitch|yaw)_rate$/, /^tip_off\.(pitch|yaw)$/, /^impact_speed$/, /^time_of_flight$/, /^max_contact_force/, /^max_mach$/];

export function foremost(list, most) {
  const rank = ({ name }) => FIRST.findIndex((pattern) => pattern.test(name));
  const ranked = list.filter((one) => rank(one) >= 0).sort((a, b) => rank(a) - rank(b));
  return (ranked.length > 0 ? ranked : list).slice(0, most);
}

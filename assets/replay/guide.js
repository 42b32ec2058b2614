// What guides the rocket, from the geometry of the results: a bore, a rail with a T-slot, a tower of
// rails, or plain surfaces. All of it across the guide line, [y, z]. Gaps are what the results say;
// thicknesses, which they do not, are made up.

const FORMS = ["bore", "surfaces", "t-slot", "tower"]; // by the geometry's guide.form

// `rows`: an array of the geometry by its name, as a list of rows; `length`: of the guide [m].
export function guideOf(rows, length) {
  const kind = FORMS[rows("guide.form")[0]?.[0] ?? 0], line = rows("guide.line")[0] ?? [0, 0];
  const surfaces = rows("guide.surface").map((at, k) => ({
    at, normal: rows("guide.normal")[k][0], gap: rows("guide.gap")[k][0], round: rows("guide.round")[k][0] === 1 }));
  const given = { kind, line, surfaces, length, diameter: rows("rocket.diameter")[0]?.[0] ?? 0,
    outline: rows("guide.outline"), sections: rows("tube.section"), clearances: clearancesOf(rows) };
  const made = { bore, surfaces: plain, "t-slot": slotted, tower }[kind](given);
  const words = kind === "bore" ? { guide: "tube", shoes: "adaptors" } : { guide: kind === "tower" ? "tower" : "rail", shoes: "shoes" };
  return { ...given, ...made, words, envelope: envelopeOf(made, line) };
}

const clearancesOf = (rows) => rows("rocket.clearance").map((row) => row.map((c) => c ?? 0));

// Corners of a rectangle from y0, z0 to y1, z1.
const rectangle = (y0, y1, z0, z1) => [[y0, z0], [y1, z0], [y1, z1], [y0, z1]];

// A rectangle that reaches from `near` to `far` along a direction from a point, `half` to both sides of it.
function plate([y, z], angle, near, far, half) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return [[near, -half], [far, -half], [far, half], [near, half]]
    .map(([n, t]) => [y + n * c - t * s, z + n * s + t * c]);
}

const largest = (lists) => Math.max(0, ...lists.flat());

// All corners' least and largest y and z, against the axis of the tube's frame.
function envelopeOf({ solid, seenThrough, outer }, [oy, oz]) {
  const corners = [...solid, ...seenThrough].flat(), ys = corners.map(([y]) => y), zs = corners.map(([, z]) => z);
  return { low: [oy + Math.min(-outer, ...ys), oz + Math.min(-outer, ...zs)],
    high: [oy + Math.max(outer, ...ys), oz + Math.max(outer, ...zs)] };
}

// ---- kinds ----
// Each gives the radius of the rocket's body as drawn and that of all around the line, the room that
// there is for the largest gap as drawn, and the largest gap; the profiles of its beams, solid and seen
// through; and of a shoe with its clearance, gaps times `gap`, the radius of its ring or the profiles of
// its pads. A profile is four corners.

function bore({ sections, clearances }) {
  const [, radius, outer] = sections[0];
  return {
    radius, outer: outer ?? 1.03 * radius, body: 0.56 * radius, room: 0.3 * radius,
    mostGap: largest(clearances), solid: [], seenThrough: [],
    ring: (clearance, gap) => radius - gap * clearance, pads: () => [],
  };
}

// Half height and half width of the beam, whose axis is the elastic one.
function beamOf({ outline, length }) {
  const [y, z] = outline[0] ?? [null, null];
  return [y ?? 0.015 * length, z ?? 0.015 * length];
}

// A rail whose slot holds the shoes' flanges under two lips.
function slotted(given) {
  const { surfaces, line, diameter, clearances } = given, level = surfaces.filter(({ at, normal }) => Math.abs(Math.cos(normal)) > 0.5);
  const zs = level.map(({ at }) => at[1]), y = level[0].at[0], z = 0.5 * (Math.min(...zs) + Math.max(...zs));
  const lips = Math.max(...zs) - Math.min(...zs), half = 0.15 * lips, wall = 0.75 * lips, neck = 0.25 * lips, lip = 0.12 * lips;
  const side = surfaces.find(({ normal }) => Math.abs(Math.sin(normal)) > 0.5), gapAcross = side?.gap ?? 0, up = y > 0 ? -1 : 1;
  const [beamHeight, beamWidth] = beamOf(given), out = Math.max(wall + lip, Math.min(beamWidth, 3 * wall));
  const floor = -half - Math.max(2 * lip, Math.min(2 * beamHeight, Math.abs(y) + 4 * lips) - 2 * half - lip);
  const across = (y0, y1, z0, z1) => rectangle(y + up * y0, y + up * y1, z + z0, z + z1);
  const free = Math.abs(y) - half - lip, body = Math.min(diameter > 0 ? diameter / 2 : Infinity, 0.9 * free);
  return {
    body, outer: body, room: 0.75 * half, mostGap: Math.max(level[0].gap, gapAcross) + largest(clearances),
    solid: [across(floor, -half, -out, out)],
    seenThrough: [across(-half, half, wall, out), across(-half, half, -out, -wall),
      across(half, half + lip, neck, out), across(half, half + lip, -out, -neck)],
    ring: () => null,
    pads: (clearance, gap) => {
      const high = half - gap * (level[0].gap + clearance), wide = wall - gap * (gapAcross + clearance);
      return [across(-high, high, -wide, wide), across(high, Math.abs(y) - 0.7 * body, -0.5 * neck, 0.5 * neck)];
    },
  };
}

// Rails around a round body.
function tower({ surfaces, diameter, clearances, length }) {
  const told = Math.hypot(...surfaces[0].at), radius = told > 0 ? told : diameter > 0 ? 0.62 * diameter : 0.015 * length;
  const body = Math.min(diameter > 0 ? diameter / 2 : Infinity, 0.8 * radius), thick = 0.3 * radius;
  return {
    radius, body, outer: radius + thick, room: 0.5 * (radius - body), mostGap: surfaces[0].gap + largest(clearances),
    solid: surfaces.map(({ normal }) => plate([0, 0], normal, radius, radius + thick, 0.16 * radius)), seenThrough: [],
    ring: (clearance, gap) => radius - gap * (surfaces[0].gap + clearance), pads: () => [],
  };
}

// Strips beside the shoes' pads; a beam where the elastic axis is away from the guide line.
function plain(given) {
  const { surfaces, line, diameter, clearances, length } = given;
  const far = Math.max(0.012 * length, ...surfaces.map(({ at }) => Math.hypot(...at))), half = 0.15 * far;
  const body = Math.min(diameter > 0 ? diameter / 2 : Infinity, 0.8 * far), [beamHeight, beamWidth] = beamOf(given);
  const away = Math.hypot(...line) > body + beamHeight;
  const beam = rectangle(-line[0] - beamHeight, -line[0] + beamHeight, -line[1] - beamWidth, -line[1] + beamWidth);
  const foot = ({ at, normal, round }) => (round ? [0, 0] : at), from = ({ round }) => (round ? far : half);
  return {
    body, outer: body, room: 0.75 * half, mostGap: largest(surfaces.map(({ gap }) => gap)) + largest(clearances),
    solid: away ? [beam] : [],
    seenThrough: surfaces.map((k) => plate(foot(k), k.normal, from(k), from(k) + 0.6 * half, 0.8 * half)),
    ring: () => null,
    pads: (clearance, gap) => surfaces.flatMap((k) => {
      const [y, z] = foot(k), reach = from(k) - gap * (k.gap + clearance), away = Math.hypot(y, z);
      const pad = plate([y, z], k.normal, k.round ? body : -half / 2, reach, 0.55 * half);
      return away > body ? [pad, plate([0, 0], Math.atan2(z, y), 0.7 * body, away, 0.3 * half)] : [pad];
    }),
  };
}

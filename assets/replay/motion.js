// Where everything of a launcher is at an instant, from the columns of its history and its geometry.
// Frames: I inertial, T undeformed launching tube (origin at its rear end, x along it), R tube.
import { initialOf, nodesOf, sectionOf, shapesOf } from "./curve.js";
import { hingesOf, rowsOf } from "./geometry.js";
import { guideOf } from "./guide.js";
import { followedIn, mechanismOf, placesOf } from "./mechanism.js";
import { outlineOf } from "./outline.js";
import { add, apply, aboutX, aboutY, aboutZ, between, multiply, pose, rotation, scaled, subtract } from "./vector.js";

const IDENTITY = [1, 0, 0, 0, 1, 0, 0, 0, 1];

// Least and greatest of some columns, none among them.
const rangeOf = (columns) => columns.reduce((range, values) => (values ?? []).reduce(([low, high], v) =>
  [v < low ? v : low, v > high ? v : high], range), [0, 0]);

export class Motion {
  constructor(table, geometry, rockets, { filled, rowAt }) {
    this.t = table.t;
    this.rowAt = rowAt;
    this.value = (name) => {
      const column = table.column.get(name);
      const values = column ? filled(column.value, table.t) : null;
      this.values.set(name, values);
      return values;
    };
    this.values = new Map();
    this.ranges = new Map();
    this.segments = numbered(table.segments);
    this.rockets = rockets;
    const rows = (name) => rowsOf(geometry, name), single = (name) => rows(name)[0];
    this.shapes = shapesOf(rows, "tube");
    this.stations = this.shapes.stations;
    this.initial = initialOf(rows("tube.initial_shape"));
    this.bent = Math.max(0, ...rows("tube.initial_shape").map(([, y, z]) => Math.max(Math.abs(y), Math.abs(z))));
    this.length = this.stations.at(-1);
    this.guide = guideOf(rows, this.length);
    this.outer = this.guide.outer;
    this.supports = rows("tube.support").map(([x]) => x);
    this.clamps = this.supports.filter((_, i) => rows("tube.clamped")[i]?.some((held) => held === 1));
    this.places = rows("tubes.rear_end");
    this.empty = rows("tubes.empty").map(([number]) => number);
    this.adaptors = rows("rocket.adaptor").map(([x]) => x);
    this.center = single("rocket.center")?.[0] ?? 0;
    this.outline = outlineOf(rows);
    this.mounts = rows("wheel.mount");
    this.wheelRadius = single("wheel.radius")?.[0] ?? 0;
    this.turns = rows("azimuth.hinge").length > 0;
    [this.azimuthHinge, this.elevationHinge] = hingesOf(rows);
    const mount = single("base.mount");
    this.mount = mount ? multiply(aboutY(mount[0]), aboutZ(mount[1])) : IDENTITY;
    this.looks = single("base.looks")?.[0] ?? 0;
    this.hangs = this.looks === 2 && this.mount[3] <= 0.26; // below an aircraft
    this.envelope = this.around();
    const named = (head, tail) => [...table.column.keys()].filter((name) => name.startsWith(head) &&
      name.endsWith(tail)).map((name) => name.slice(head.length, name.length - tail.length));
    this.adaptorNames = named("contact.", ".force");
    this.slides = named("recoil.", ".travel");
    this.closed = table.column.has("pressure.force");
    this.wheelNames = named("wheel.", ".travel");
    this.mechanism = mechanismOf(rows, [...table.column.keys()]);
  }

  get vehicle() {
    return this.mounts.length > 0 && this.mounts.length === this.wheelNames.length;
  }

  // Corners [y, z] of all guides with their frames across the first launching tube, in T.
  around() {
    const { low, high } = this.guide.envelope, room = this.places.length > 1 ? 0.5 * this.outer : 0;
    const from = this.places[(this.rockets[0]?.tube ?? 1) - 1] ?? this.places[0];
    const span = (of, by) => [1, 2].map((i) => of(...this.places.map((p) => p[i] - from[i])) + by[i - 1]);
    return { low: span(Math.min, low.map((v) => v - room)), high: span(Math.max, high.map((v) => v + room)) };
  }

  // The node next to a station.
  nearest(x) {
    return this.stations.reduce((best, s, i) => (Math.abs(s - x) < Math.abs(this.stations[best] - x) ? i : best), 0);
  }

  // Between what columns are at any instant.
  range(...names) {
    const key = names.join();
    if (!this.ranges.has(key)) this.ranges.set(key, rangeOf(names.map((name) => this.values.get(name) ?? this.value(name))));
    return this.ranges.get(key);
  }
  // The largest value of a column, in size.
  largest(name) {
    const [low, high] = this.range(name);
    return Math.max(-low, high);
  }

  // Rows before and after an instant and the share of the second; never from one phase to the next.
  place(time) {
    const last = this.t.length - 1, row = Math.min(last, Math.max(0, this.rowAt(this.t, time)));
    const part = this.segments.find(({ end }) => row < end) ?? this.segments.at(-1);
    const next = row + 1 < part.end ? row + 1 : row;
    const share = next > row ? Math.min(1, Math.max(0, (time - this.t[row]) / (this.t[next] - this.t[row]))) : 0;
    return { row, next, share, part };
  }

  // All that is drawn, at an instant on the run's clock.
  at(time) {
    const { row, next, share, part } = this.place(time);
    const read = (name) => {
      const values = this.values.has(name) ? this.values.get(name) : this.value(name);
      return values ? values[row] + share * (values[next] - values[row]) : NaN;
    };
    const all = (head, ...names) => names.map((name) => read(head + name));
    const base = this.mechanism ? this.poseAt("base.", row, next, share)
      : { r: all("base.", "x", "y", "z"), A: pose(...all("base.", "yaw", "pitch", "roll")) };
    const state = {
      time, part, number: part.number, base, read,
      tube: { r: base.r, A: multiply(base.A, this.mount) },
      thrust: read("thrust"),
      forces: this.adaptorNames.map((name) => read(`contact.${name}.force`)),
      pushes: this.adaptorNames.map((name) => all(`shoe.${name}.`, "force_y", "force_z")),
    };
    this.bend(state);
    this.putRocket(state);
    if (this.vehicle) this.putVehicle(state);
    if (this.mechanism) {
      state.places = placesOf(this.mechanism, (head) => this.poseAt(head, row, next, share), read);
      state.followed = followedIn(this.mechanism, state.places) ?? [0, 0, 0];
    }
    return state;
  }

  // A frame between two rows; its angles may jump from one to the next.
  poseAt(head, row, next, share) {
    const column = (name) => this.values.get(head + name) ?? this.value(head + name), frame = (k) => ({
      r: ["x", "y", "z"].map((name) => column(name)[k]), A: pose(...["yaw", "pitch", "roll"].map((name) => column(name)[k])) });
    return share > 0 ? between(frame(row), frame(next), share) : frame(row);
  }

  // The tube's axis against the undeformed one: at each station the offset in T.
  bend(state) {
    const { read } = state;
    state.r_TR = ["x", "y", "z"].map((name) => read(`replay.${name}`));
    state.A_TR = rotation(["rx", "ry", "rz"].map((name) => read(`replay.${name}`)));
    state.nodes = nodesOf(this.shapes, Array.from({ length: this.shapes.count }, (_, i) => read(`q${i + 1}`)));
  }

  // Deflections in R at any station.
  section(state, x) {
    return sectionOf(state.nodes, x, this.initial);
  }

  // How far a point y, z from the guide line is from its place in T on the undeformed tube; `section`: where.
  moved(state, { P, A }, y = 0, z = 0) {
    const [oy, oz] = this.guide.line, at = [P[0], oy + y, oz + z];
    const off = oy + y === 0 && oz + z === 0 ? P : add(P, apply(A, [0, at[1], at[2]]));
    return subtract(add(state.r_TR, apply(state.A_TR, off)), at);
  }

  // Offset in T of the guide line at a station from that of the undeformed tube.
  deflection(state, x) {
    return this.moved(state, this.section(state, x));
  }

  // Where the guide's point at node k, y and z from the guide line, is drawn in T.
  drawnGuide(state, k, y, z, scale) {
    const node = state.nodes[k], [oy, oz] = this.guide.line;
    const d = this.moved(state, this.initial ? this.section(state, node.x) : node, y, z);
    return [node.x + d[0], oy + y + scale * d[1], oz + z + scale * d[2]];
  }

  // Where the rocket's point l, y, z is drawn in T: off the drawn guide by `gap` times what it is off it.
  drawnRocket(state, [l, y, z], scale, gap) {
    const p = state.rocket.point(l, y, z), d = this.moved(state, this.section(state, p[0]), y, z);
    const drawn = (i, at) => at + scale * d[i] + gap * (p[i] - at - d[i]), [oy, oz] = this.guide.line;
    return [p[0], drawn(1, oy + y), drawn(2, oz + z)];
  }

  // The rocket while it is in the tube: points of its axis in T, its roll.
  putRocket(state) {
    const { read } = state, s = read("rocket.s");
    state.rocket = null;
    if (!Number.isFinite(s)) return;
    const { P, A } = this.section(state, s), roll = read("rocket.gamma");
    const O1 = add(P, apply(A, [0, read("rocket.y"), read("rocket.z")]));
    const body = multiply(A, multiply(aboutZ(read("rocket.psi")), multiply(aboutY(read("rocket.theta")), aboutX(roll))));
    state.rocket = {
      s, roll, point: (l, y = 0, z = 0) => add(state.r_TR, apply(state.A_TR, add(O1, apply(body, [l, y, z])))),
    };
  }

  putVehicle(state) {
    const { read } = state;
    const A = pose(read("chassis.yaw"), read("chassis.pitch"), read("chassis.roll"));
    state.chassis = { r: [read("chassis.x"), read("chassis.y"), read("chassis.z")], A };
    state.azimuth = {
      r: add(state.chassis.r, apply(A, this.azimuthHinge)), A: this.turns ? multiply(A, aboutY(read("azimuth.angle"))) : A,
    };
    state.wheels = this.mounts.map((mount, i) => add(state.chassis.r,
      apply(A, add(mount, [0, read(`wheel.${this.wheelNames[i]}.travel`), 0]))));
  }

  // Heights of the road over x under the left and the right wheels, as far as they roll.
  road() {
    const track = (side) => {
      const points = [];
      for (const { x, name } of this.rolling().filter((wheel) => wheel.side === side).sort((a, b) => a.x[0] - b.x[0])) {
        const h = this.value(`wheel.${name}.road`);
        x.forEach((at, i) => {
          if (Number.isFinite(h[i]) && !(at <= points.at(-1)?.[0])) points.push([at, h[i]]);
        });
      }
      return points;
    };
    return [track(-1), track(1)];
  }
  // The wheels: their places along the way, and the side on which they are.
  rolling() {
    if (!this.mechanism) {
      const x = this.value("chassis.x");
      return this.mounts.map((mount, i) => ({ name: this.wheelNames[i], side: Math.sign(mount[2]), x: x.map((at) => at + mount[0]) }));
    }
    const { wheels } = this.mechanism, z = wheels.map((name) => this.value(`wheel.${name}.z`)[0]), middle = 0.5 * (Math.min(...z) + Math.max(...z));
    return wheels.map((name, i) => ({ name, side: z[i] < middle ? -1 : 1, x: this.value(`wheel.${name}.x`) }));
  }
}

// A flight alone: no launcher, a rocket whose sizes are made up.
export class FreeMotion {
  constructor(table, { filled, rowAt }) {
    const thrust = table.column.get("thrust");
    Object.assign(this, {
      free: true, outline: null, t: table.t, rowAt, length: 3, adaptors: [0, 1.9], center: 1.1, slides: [], clamps: [], adaptorNames: [],
      segments: [{ name: "flight", first: 0, end: table.t.length, number: 0 }], vehicle: false, empty: [],
      thrust: thrust ? filled(thrust.value, table.t) : [],
      guide: { body: 0.08, mostGap: 0, room: 0, clearances: [], ring: () => null, pads: () => [], words: { guide: "tube", shoes: "adaptors" } },
    });
  }
  largest(name) {
    return name === "thrust" ? this.thrust.reduce((most, v) => Math.max(most, v || 0), 0) : 0;
  }
  place(time) {
    return { row: Math.min(this.t.length - 1, Math.max(0, this.rowAt(this.t, time))) };
  }
  at(time) {
    return { time, number: 0, rocket: null, tube: { r: [0, 0, 0], A: IDENTITY }, read: () => NaN };
  }
}

// Which rocket's turn it is in each phase, from 0; of quick ones nothing comes after the tube.
function numbered(segments) {
  const order = ["before", "tube", "after"], at = ({ name }) => order.indexOf(name);
  let number = 0;
  return segments.map((part, i) => {
    if (i > 0 && at(part) < at(segments[i - 1])) number++;
    return { ...part, number };
  });
}

const CANOPY = ["canopy.x", "canopy.y", "canopy.z"];

// A rocket in free flight; `zero`: its ignition on the run's clock, from which its instants count.
export class Flight {
  constructor(table, zero, { filled, rowAt }) {
    this.t = table.t;
    this.marks = table.marks.map(({ name, t }) => ({ name, t: t + zero }));
    this.rowAt = rowAt;
    this.values = new Map();
    for (const name of ["center.x", "center.y", "center.z", "rocket.pitch", "rocket.yaw", "rocket.spin", "thrust"])
      this.values.set(name, filled(table.column.get(name).value, table.t));
    // places of a line that it pulls, from the container
    this.line = [];
    while (table.column.has(`line.${this.line.length + 1}.x`)) {
      const names = ["x", "y", "z"].map((axis) => `line.${this.line.length + 1}.${axis}`);
      for (const name of names) this.values.set(name, filled(table.column.get(name).value, table.t));
      this.line.push(names);
    }
    // a canopy that is a body of its own, and how far it comes to be from the mass centre
    this.canopy = table.column.has("canopy.x");
    if (this.canopy) for (const name of [...CANOPY, "drag_area"]) this.values.set(name, filled(table.column.get(name).value, table.t));
    this.reach = this.canopy ? this.t.reduce((most, _, row) => Math.max(most,
      Math.hypot(...["x", "y", "z"].map((axis) => this.values.get(`canopy.${axis}`)[row] - this.values.get(`center.${axis}`)[row])) || 0), 0) : 0;
    this.heights = rangeOf([this.values.get("center.y")]);
    this.roll = [0];
    const spin = this.values.get("rocket.spin");
    for (let i = 1; i < this.t.length; i++)
      this.roll.push(this.roll[i - 1] + 0.5 * (spin[i] + spin[i - 1]) * (this.t[i] - this.t[i - 1]));
    this.values.set("roll", this.roll);
  }
  at(time) {
    const last = this.t.length - 1, row = Math.min(last, Math.max(0, this.rowAt(this.t, time)));
    const next = Math.min(last, row + 1), span = this.t[next] - this.t[row];
    const share = span > 0 ? Math.min(1, Math.max(0, (time - this.t[row]) / span)) : 0;
    const read = (name) => {
      const values = this.values.get(name);
      return values[row] + share * (values[next] - values[row]);
    };
    const canopy = this.canopy && { at: CANOPY.map(read), area: read("drag_area") };
    return {
      canopy: canopy && canopy.at.every(Number.isFinite) ? canopy : null, row, line: this.line.map((names) => names.map(read)), center: [read("center.x"), read("center.y"), read("center.z")], thrust: read("thrust"),
      A: multiply(pose(read("rocket.yaw"), read("rocket.pitch"), 0), aboutX(read("roll"))),
    };
  }
  points() {
    return ["x", "y", "z"].map((name) => this.values.get(`center.${name}`));
  }
  // About so many of its places in I, evenly over its rows, the first and the last among them.
  some(count) {
    const rows = this.t.length - 1, [x, y, z] = this.points(), step = Math.max(1, rows / count);
    return Array.from({ length: Math.floor(rows / step) + 1 }, (_, i) => Math.min(rows, Math.round(i * step))).map((row) => [x[row], y[row], z[row]]);
  }
}

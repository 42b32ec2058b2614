// The vehicle with its platforms, and what all bodies are painted with.
import { Group } from "three";
import { box, cylinder, line, material, place, prism } from "./shapes.js";
import { add, apply, subtract } from "./vector.js";

export const RING = 32; // points of a circle
export const COLOURS = {
  tube: 0x2f7fd0, inside: 0x9cc3ea, rocket: 0xe8602c, stripe: 0xffd9c4, adaptor: 0xf2b632, force: 0x17a05d,
  vehicle: 0x8f989f, platform: 0xaab2b8, bright: 0xd3d8dc, wheel: 0x33383d, hub: 0xb9bfc4, other: 0x7f8fa0,
  flame: 0xffb300, line: 0xd6308f,
};

export const edge = line(0x20262b, { transparent: true, opacity: 0.55 });
export const paint = Object.fromEntries(Object.entries(COLOURS).map(([name, color]) => [name, material(color)]));

// ---- what carries the tubes ----

const LORRY = { wheelbase: 3, wheel: 0.4 }; // at least, axle to axle and radius [m]; less is a trailer
const DRAWBAR = 1.1; // its length [m]

export class Vehicle {
  constructor(motion, group) {
    this.motion = motion;
    const { mounts, wheelRadius: R, azimuthHinge: a } = motion;
    const xs = mounts.map(([x]) => x), zs = mounts.map(([, , z]) => z), y = Math.max(...mounts.map((m) => m[1]));
    const front = Math.max(...xs), rear = Math.min(...xs), side = Math.max(...zs) + 0.2;
    const deck = a[1] - 0.12, floor = Math.min(y + 0.55 * R, deck - 0.2);
    const steep = Math.abs(motion.value("base.pitch")[0]) > 0.8; // the cab can stand in front of a steep launcher
    const reach = a[0] + motion.elevationHinge[0] + (steep ? 1 : Math.max(...motion.places.map(([x]) => x)) + motion.length);
    this.chassis = new Group();
    this.chassis.add(box([rear - 1.3 * R, floor, -0.55], [front + 1.3 * R, deck - 0.25, 0.55], paint.vehicle, edge));
    this.chassis.add(box([rear - 1.3 * R, deck - 0.25, -side], [front - 0.2, deck, side], paint.vehicle, edge));
    this.trailer = front - rear < LORRY.wheelbase || R < LORRY.wheel;
    if (this.trailer) this.chassis.add(drawbar(front + 1.3 * R, floor, side, Math.min(...mounts.map((m) => m[1])) - R));
    else if (front + 1.4 * R > reach + 0.3)
      this.chassis.add(cab(Math.max(reach + 0.1, front - 0.5), front + 1.5 * R, floor, deck, side));
    this.azimuth = new Group();
    this.azimuth.add(cylinder([0, -0.12, 0], [0, 0.1, 0], 0.75, paint.platform, edge, 40));
    const e = motion.elevationHinge, width = this.width();
    for (const z of [-width, width])
      this.azimuth.add(box([e[0] - 0.16, 0.1, z - 0.04], [e[0] + 0.16, e[1] + 0.12, z + 0.04], paint.platform, edge));
    this.azimuth.add(box([Math.min(0, e[0]) - 0.2, 0.05, -width], [Math.max(0, e[0]) + 0.3, 0.16, width], paint.platform, edge));
    this.wheels = mounts.map(() => wheel(R));
    this.seenFrom = [4.4, 2.8, 9.9];
    this.ends = [-R, this.trailer ? R + DRAWBAR / 1.3 : R].map((room) => [(room < 0 ? rear : front) + 1.3 * room, Math.min(...mounts.map((m) => m[1])) - R]);
    this.side = side;
    group.add(this.chassis, this.azimuth, ...this.wheels);
  }
  // Corners of all of it, from the anchor.
  corners(state, anchor) {
    return this.ends.flatMap(([x, y]) => [-this.side, this.side].map((z) =>
      subtract(add(state.chassis.r, apply(state.chassis.A, [x, y, z])), anchor)));
  }
  width() {
    const zs = this.motion.places.map(([, , z]) => z);
    return Math.max(...zs.map(Math.abs)) + 2.2 * this.motion.outer;
  }
  show(state, anchor) {
    place(this.chassis, subtract(state.chassis.r, anchor), state.chassis.A);
    place(this.azimuth, subtract(state.azimuth.r, anchor), state.azimuth.A);
    state.wheels.forEach((r, i) => {
      const c = Math.cos(-r[0] / this.motion.wheelRadius), s = Math.sin(-r[0] / this.motion.wheelRadius);
      const A = state.chassis.A, spin = [0, 3, 6].flatMap((k) =>
        [c * A[k] + s * A[k + 1], -s * A[k] + c * A[k + 1], A[k + 2]]);
      place(this.wheels[i], subtract(r, anchor), spin);
    });
  }
}

// Two beams from the front of a trailer to its coupling, with a wheel on a post to stand on.
function drawbar(front, height, side, ground) {
  const group = new Group(), tip = front + DRAWBAR, thick = 0.05;
  for (const z of [-0.6 * side, 0.6 * side])
    group.add(cylinder([front, height, z], [tip - 0.12, height, 0], thick, paint.vehicle, edge));
  group.add(cylinder([tip - 0.2, height, 0], [tip, height, 0], 1.4 * thick, paint.platform, edge));
  const at = tip - 0.35;
  group.add(cylinder([at, ground + 0.1, 0.16], [at, height + 0.35, 0.16], 0.03, paint.platform, edge),
    cylinder([at, ground + 0.1, 0.12], [at, ground + 0.1, 0.2], 0.1, paint.wheel, edge));
  return group;
}

// A cab with a raked windscreen, side windows, lamps and a bumper.
function cab(rear, front, floor, deck, side) {
  const group = new Group(), top = deck + 0.75, rake = 0.28, sill = deck + 0.18, out = side + 0.01;
  const outline = [[rear, floor], [front, floor], [front, sill], [front - rake, top], [rear, top]];
  const across = (points, half, surface, stroke) =>
    group.add(prism(points.map(([x, y]) => [x, y, -half]), [0, 0, 2 * half], surface, stroke));
  across(outline, out, paint.vehicle, edge);
  const edgeAt = (y) => front - rake * ((y - sill) / (top - sill));
  const pane = [[rear + 0.25, sill + 0.04], [edgeAt(sill + 0.04) - 0.12, sill + 0.04], [edgeAt(top - 0.1) - 0.12, top - 0.1], [rear + 0.25, top - 0.1]];
  across(pane, out + 0.012, paint.wheel);
  const glass = [[edgeAt(sill + 0.06) + 0.012, sill + 0.06], [edgeAt(top - 0.08) + 0.012, top - 0.08], [edgeAt(top - 0.08) - 0.05, top - 0.08], [edgeAt(sill + 0.06) - 0.05, sill + 0.06]];
  across(glass, out - 0.14, paint.wheel);
  group.add(box([front - 0.1, floor - 0.05, -out], [front + 0.08, floor + 0.17, out], paint.wheel));
  for (const z of [-out + 0.3, out - 0.3])
    group.add(cylinder([front - 0.02, floor + 0.35, z], [front + 0.03, floor + 0.35, z], 0.1, paint.bright));
  return group;
}

export function wheel(R) {
  const group = new Group();
  group.add(cylinder([0, 0, -0.17], [0, 0, 0.17], R, paint.wheel, edge, 36));
  group.add(cylinder([0, 0, -0.18], [0, 0, 0.18], 0.55 * R, paint.hub, null, 24));
  for (let i = 0; i < 5; i++) {
    const angle = (2 * Math.PI * i) / 5, at = [0.36 * R * Math.cos(angle), 0.36 * R * Math.sin(angle), 0];
    group.add(cylinder(add(at, [0, 0, -0.19]), add(at, [0, 0, 0.19]), 0.07 * R, paint.wheel, null, 8));
  }
  return group;
}

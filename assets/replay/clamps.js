// Clamps, which hold the tube or rail rigidly at their stations: dark blocks with hatched sides that
// stay with the base, a saddle below a tube, a trough about a rail's beam, a frame about a tower.
import { BufferGeometry, Float32BufferAttribute, Group, LineSegments } from "three";
import { COLOURS, edge, paint } from "./launcher.js";
import { box, line, loft, place } from "./shapes.js";
import { add, scaled, subtract } from "./vector.js";

// In radii of the tube: how far a saddle reaches down and to the sides, and round the tube [rad].
const DEEP = 1.6, WIDE = 1.4, ROUND = 1.2;

export class Clamps {
  constructor(motion, scene) {
    this.group = new Group();
    this.motion = motion;
    this.half = 0.02 * motion.length; // of a block, along the tube
    this.stroke = line(COLOURS.bright);
    const { kind, solid } = motion.guide;
    const block = kind === "bore" ? this.saddle : kind === "tower" || solid.length === 0 ? this.frame : this.trough;
    for (const x of motion.clamps) {
      const body = new Group();
      body.add(...block.call(this));
      body.position.x = x;
      this.group.add(body);
    }
    scene.add(this.group);
  }
  show(state, anchor) {
    place(this.group, subtract(state.tube.r, anchor), state.tube.A);
  }
  // Below the tube, or above it where that hangs, open towards its axis.
  saddle() {
    const { half, motion: { outer, hangs } } = this, side = hangs ? 1 : -1;
    const angles = Array.from({ length: 25 }, (_, i) => (i / 12 - 1) * ROUND);
    const point = (x, angle, r) => [x, side * r * Math.cos(angle), r * Math.sin(angle)];
    const out = (angle) => Math.min(DEEP / Math.cos(angle), WIDE / Math.abs(Math.sin(angle))) * outer;
    const rings = [[-half, () => outer], [-half, out], [half, out], [half, () => outer]]
      .map(([x, reach]) => angles.map((angle) => point(x, angle, reach(angle))));
    const ends = [0, -1].map((i) => loft([[rings[0].at(i), rings[1].at(i)], [rings[3].at(i), rings[2].at(i)]], paint.wheel, edge));
    const high = out(ROUND) * Math.cos(ROUND), rise = DEEP * outer - high;
    const sides = [-1, 1].map((z) => this.hatch([-half, side * high, 1.01 * z * WIDE * outer], [2 * half, 0, 0], [0, side * rise, 0]));
    return [loft([...rings, rings[0]], paint.wheel, edge), ...ends, ...sides];
  }
  // About the half of a rail's beam that is away from the rocket.
  trough() {
    const { line: [oy, oz], solid } = this.motion.guide, [low, high] = bounds(solid), middle = 0.5 * (low[0] + high[0]);
    const below = middle <= 0, rim = below ? 0.6 * low[0] + 0.4 * high[0] : 0.4 * low[0] + 0.6 * high[0];
    return this.walls([oy, oz], [below ? low[0] : rim, low[1]], [below ? rim : high[0], high[1]], [below, !below]);
  }
  // About all of a tower, or of surfaces without a beam.
  frame() {
    const { motion: { guide: { envelope: { low, high } } } } = this;
    return this.walls([0, 0], low, high, [true, true]);
  }
  // Walls outside a rectangle: both sides, and below or above where `closed` says so.
  walls([oy, oz], [y0, z0], [y1, z1], closed) {
    const { half } = this, thick = half, from = y0 - (closed[0] ? thick : 0), to = y1 + (closed[1] ? thick : 0);
    const wall = (ya, yb, za, zb) => box([-half, oy + ya, oz + za], [half, oy + yb, oz + zb], paint.wheel, edge);
    const parts = [wall(from, to, z0 - thick, z0), wall(from, to, z1, z1 + thick)];
    if (closed[0]) parts.push(wall(from, y0, z0, z1));
    if (closed[1]) parts.push(wall(y1, to, z0, z1));
    const sides = [z0 - 1.02 * thick, z1 + 1.02 * thick]
      .map((z) => this.hatch([-half, oy + from, oz + z], [2 * half, 0, 0], [0, to - from, 0]));
    return [...parts, ...sides];
  }
  // Slanted lines over the rectangle from a corner along u and v, as far apart as half a block is long.
  hatch(corner, u, v) {
    const wide = Math.hypot(...u), high = Math.hypot(...v), gap = this.half, points = [];
    const at = (a, b) => add(corner, add(scaled(a / wide, u), scaled(b / high, v)));
    for (let c = 0.5 * gap; c < wide + high; c += gap)
      points.push(...at(Math.max(0, c - high), Math.min(c, high)), ...at(Math.min(c, wide), Math.max(0, c - wide)));
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(points, 3));
    return new LineSegments(geometry, this.stroke);
  }
}

// Least and largest y and z of profiles.
function bounds(profiles) {
  const corners = profiles.flat();
  return [Math.min, Math.max].map((of) => [0, 1].map((i) => of(...corners.map((corner) => corner[i]))));
}

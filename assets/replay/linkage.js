// Bodies, beams, joints and force elements that carry the tubes. Sizes of marks are made up: of joints, springs, jacks, of
// what ties a joint to its body.
import { CylinderGeometry, Group, Mesh, MeshBasicMaterial, SphereGeometry } from "three";
import { carrierOf } from "./carriers.js";
import { COLOURS, edge, paint, wheel } from "./launcher.js";
import { CARRIER, frameOf, nearestOf, outlineOf, pointIn } from "./mechanism.js";
import { angular, box, cylinder, faceted, material, place, point, Sleeve } from "./shapes.js";
import { add, apply, aboutZ, cross, multiply, scaled, subtract, turnedBack, unit } from "./vector.js";

const JOINT = 0x8a4fc4, TONES = [0x8f989f, 0xa9b0a2, 0x9aa5b5, 0xb3a99b, 0x7f8a91, 0xbcc3c8];
const INSTANTS = 24; // at which a picture has to hold all of it
const TURNS = 9, BARREL = 0.6; // of a drawn spring; length of a hydraulic cylinder over that between its ends at first

// A cylinder, or what else is one long along y, between two points that move.
class Between {
  constructor(body, group) {
    this.body = new Group();
    this.body.add(body);
    group.add(this.body);
  }
  show(from, to) {
    const way = subtract(to, from), length = Math.hypot(...way);
    this.body.visible = length > 1e-9;
    if (!this.body.visible) return;
    point(this.body, from, way);
    this.body.scale.set(1, length, 1);
  }
}

const rod = (radius, surface, stroke = edge) => cylinder([0, 0, 0], [0, 1, 0], radius, surface, stroke, 16);

// A spring one long and so thick, as a wire along a helix.
function coil(radius) {
  const steps = 12 * TURNS, sleeve = new Sleeve(steps + 1, 6, paint.bright);
  sleeve.draw(Array.from({ length: steps + 1 }, (_, i) => {
    const angle = (2 * Math.PI * TURNS * i) / steps;
    return { at: [radius * Math.cos(angle), i / steps, radius * Math.sin(angle)], radius: 0.13 * radius };
  }));
  return sleeve.mesh;
}

export class Linkage {
  constructor(motion, scene) {
    const first = motion.at(motion.t[0]), { mechanism } = motion;
    Object.assign(this, { motion, mechanism, group: new Group(), seenFrom: [4.4, 2.8, 9.9], ghosts: [] });
    this.first = first;
    this.unit = 0.016 * motion.length;
    this.surfaces = [];
    this.buildBodies();
    this.buildBeams();
    this.joints = mechanism.joints.filter(({ kind }) => kind !== "free").map((joint) => this.jointOf(joint));
    this.elements = [...mechanism.struts.map((strut) => this.strutOf(strut)), ...mechanism.bushings.map((bushing) => this.bushingOf(bushing)),
      ...mechanism.feet.map((foot) => this.footOf(foot))];
    this.wheels = mechanism.wheels.map(() => wheel(mechanism.wheelRadius));
    for (const one of this.wheels) this.group.add(one);
    this.buildSupports();
    this.stand();
    scene.add(this.group);
  }

  // ---- what moves with a body

  buildBodies() {
    this.bodies = this.mechanism.bodies.map((body, i) => {
      const group = new Group(), surface = body.shape === "mesh" ? angular(0xffffff, { transparent: true, vertexColors: true })
        : (body.shape === "ellipsoid" ? material : angular)(TONES[i % TONES.length], { transparent: true });
      this.surfaces.push(surface);
      if (body.shape) {
        const made = new Group(), half = scaled(0.5, body.size);
        if (body.shape === "box") made.add(box(scaled(-1, half), half, surface, edge));
        else if (body.shape === "mesh") made.add(faceted(body.triangles, surface, edge));
        else if (body.shape === "cylinder") made.add(round(body.size, surface));
        else made.add(ellipsoid(half, surface));
        place(made, body.at, body.A);
        group.add(made);
      }
      this.group.add(group);
      return group;
    });
  }
  // From a point of a body, in its axes, to its shape, where it is away from it.
  tie(thing, at, thick = 0.5) {
    const body = this.mechanism.bodies[thing], near = body && nearestOf(body, at);
    if (near && Math.hypot(...subtract(near, at)) > 0.5 * this.unit)
      this.bodies[thing].add(cylinder(at, near, thick * this.unit, paint.platform, edge, 12));
  }
  // The same from a point in I at first.
  tieTo(thing, r) {
    if (this.mechanism.bodies[thing]) this.tie(thing, pointIn(this.first.places.bodies[thing], r));
  }
  buildBeams() {
    this.beams = this.mechanism.beams.map(({ radii }) => {
      const sleeve = new Sleeve(radii.length, 20, material(COLOURS.platform));
      this.group.add(sleeve.mesh);
      return sleeve;
    });
  }

  // ---- joints

  // A mark on the parent, seen through what hides it, and what ties both bodies to it.
  jointOf(joint) {
    const mark = new Group(), r = frameOf(this.mechanism, this.first.places, joint.parent, joint.at).r;
    for (const part of markOf(joint, this.unit)) mark.add(part, ...(joint.kind === "fixed" ? [] : this.ghostsOf(part)));
    if (joint.parent === -1) mark.add(this.groundMark(joint));
    this.group.add(mark);
    this.tie(joint.parent, joint.at);
    if (!joint.closes) this.tie(joint.body, [0, 0, 0]);
    else if (joint.kind !== "prismatic" && joint.kind !== "cylindrical" && joint.kind !== "planar") this.tieTo(joint.body, r);
    const slider = ["prismatic", "cylindrical"].includes(joint.kind) && !joint.closes;
    return { joint, mark, slider: slider ? new Between(rod(0.55 * this.unit, paint.bright), this.group) : null };
  }
  ghostsOf(part) {
    return part.children.filter(({ isMesh }) => isMesh).map((mesh) => {
      const ghost = new Mesh(mesh.geometry, new MeshBasicMaterial({ color: JOINT, transparent: true, opacity: 0.3, depthTest: false, depthWrite: false }));
      ghost.renderOrder = 3;
      ghost.position.copy(part.position);
      ghost.quaternion.copy(part.quaternion);
      ghost.scale.copy(mesh.scale);
      this.ghosts.push(ghost);
      return ghost;
    });
  }
  // A block below a joint on the ground, in I.
  groundMark(joint) {
    const u = this.unit, block = new Group();
    block.add(box([-2 * u, -2.4 * u, -2 * u], [2 * u, -1.1 * u, 2 * u], paint.wheel, edge));
    place(block, [0, 0, 0], transposed(joint.A));
    return block;
  }
  showJoint({ joint, mark, slider }, places, anchor) {
    const { r, A } = frameOf(this.mechanism, places, joint.parent, joint.at), from = subtract(r, anchor);
    place(mark, from, multiply(A, joint.A));
    slider?.show(from, subtract(frameOf(this.mechanism, places, joint.body, [0, 0, 0]).r, anchor));
  }

  // ---- struts, bushings, feet

  endsOf({ ends, at }, places) {
    return ends.map((thing, i) => frameOf(this.mechanism, places, thing, at[i]).r);
  }
  // A hydraulic cylinder where it has an actuator, else a spring about a damper; balls at both ends.
  strutOf(strut) {
    const u = this.unit, group = new Group(), [a, b] = this.endsOf(strut, this.first.places), long = BARREL * Math.hypot(...subtract(b, a));
    strut.ends.forEach((thing, i) => this.tie(thing, strut.at[i]));
    this.group.add(group);
    const balls = [0, 1].map(() => new Mesh(new SphereGeometry(0.9 * u, 16, 10), paint.wheel)), lines = strut.driven
      ? [new Between(rod(1.1 * u, paint.platform), group), new Between(rod(0.55 * u, paint.bright), group)]
      : [new Between(coil(1.2 * u), group), new Between(rod(0.4 * u, paint.wheel), group)];
    group.add(...balls);
    return (places, anchor) => {
      const [from, to] = this.endsOf(strut, places).map((r) => subtract(r, anchor)), way = unit(subtract(to, from));
      balls.forEach((ball, i) => ball.position.set(...[from, to][i]));
      lines[0].show(from, strut.driven ? add(from, scaled(long, way)) : to);
      lines[1].show(strut.driven ? subtract(to, scaled(long, way)) : from, to);
    };
  }
  bushingOf({ on, at }) {
    const u = this.unit, mark = new Group(), ring = cylinder([-u, 0, 0], [u, 0, 0], 1.5 * u, paint.wheel, edge);
    mark.add(ring);
    this.group.add(mark);
    this.tie(on, at);
    return (places, anchor) => {
      const { r, A } = frameOf(this.mechanism, places, on, at);
      place(mark, subtract(r, anchor), A);
    };
  }
  // A pad, level as the ground, and a leg up to the level of its body's middle.
  footOf({ on, at }) {
    const u = this.unit, pad = new Group(), body = this.mechanism.bodies[on];
    pad.add(cylinder([0, -0.5 * u, 0], [0, 0.1 * u, 0], 2.2 * u, paint.wheel, edge));
    this.group.add(pad);
    if (body?.shape) {
      const top = [at[0], Math.max(at[1], body.at[1]), at[2]];
      this.bodies[on].add(cylinder(at, top, 0.9 * u, paint.bright, edge, 16), cylinder(add(at, scaled(0.45, subtract(top, at))), top, 1.3 * u, paint.platform, edge, 16));
      this.tie(on, top, 0.9);
    }
    return (places, anchor) => pad.position.set(...subtract(frameOf(this.mechanism, places, on, at).r, anchor));
  }

  // ---- tubes, ground

  // From the tube's supports to the body that carries it.
  buildSupports() {
    const { motion: { supports, length, outer, envelope }, mechanism: { on, bodies }, first: { base, places } } = this;
    if (!bodies[on]?.shape) return;
    const { r, A } = places.bodies[on], half = 0.012 * length, inBody = (p) => turnedBack(A, subtract(add(base.r, apply(base.A, p)), r));
    const axes = [0, 1, 2].map((i) => turnedBack(A, [base.A[i], base.A[3 + i], base.A[6 + i]])); // of T, in the body
    for (const x of supports) {
      const block = new Group();
      block.add(box([-half, envelope.low[0] - half, -0.6 * outer], [half, envelope.low[0], 0.6 * outer], paint.platform, edge));
      place(block, inBody([x, 0, 0.5 * (envelope.low[1] + envelope.high[1])]), [0, 1, 2].flatMap((i) => axes.map((axis) => axis[i])));
      this.bodies[on].add(block);
      this.tie(on, inBody([x, envelope.low[0] - half, 0]), 0.8);
    }
  }
  // The carrier below what stands on it, or the ground; none where all of it floats.
  stand() {
    const { motion, mechanism, first } = this, levels = outlineOf(mechanism, first.places).map(([, y]) => y), low = Math.min(...levels);
    if (mechanism.carried) {
      this.deck = carrierOf(motion, this.group, this.deckUnder());
      Object.assign(this, { ground: this.deck.ground, sea: this.deck.sea, horizon: this.deck.horizon });
      return;
    }
    const feet = mechanism.feet.map(({ height }) => height), rooted = mechanism.joints.some(({ parent, kind }) => parent === -1 && kind !== "free");
    if (mechanism.wheels.length > 0) this.ground = -0.02;
    else if (feet.length > 0) this.ground = Math.min(...feet) - 0.5 * this.unit;
    else if (rooted) this.ground = low < 0 ? low - this.unit : 0;
    else this.ground = -1e9;
  }
  // What the drawing of the carrier asks for: its frame, what stands on it, in its axes.
  deckUnder() {
    const { mechanism, motion, first: { places } } = this, inCarrier = (r) => pointIn(places.carrier, r);
    const feet = [...mechanism.joints.filter(({ parent }) => parent === CARRIER).map(({ at }) => at),
      ...mechanism.struts.flatMap(({ ends, at }) => at.filter((_, i) => ends[i] === CARRIER))];
    const ends = [0, motion.length].map((x) => inCarrier(add(this.first.base.r, apply(this.first.base.A, [x, 0, 0]))));
    const corners = [...outlineOf(mechanism, places).map(inCarrier), ...ends], level = Math.min(...corners.map(([, y]) => y)) - this.unit;
    return { frame: (state) => state.places.carrier, corners, level, feet, forwards: ends[1][0] - ends[0][0], height: places.carrier.r[1] };
  }

  // ---- an instant

  show(state, anchor, close) {
    const { places } = state;
    for (const surface of this.surfaces) surface.opacity = close ? 0.3 : 1;
    this.bodies.forEach((group, i) => place(group, subtract(places.bodies[i].r, anchor), places.bodies[i].A));
    this.beams.forEach((sleeve, i) => {
      const { r, A, nodes } = places.beams[i], from = subtract(r, anchor);
      sleeve.draw(nodes.map(({ P }, k) => ({ at: add(from, apply(A, P)), radius: this.mechanism.beams[i].radii[k] })));
    });
    for (const joint of this.joints) this.showJoint(joint, places, anchor);
    for (const showElement of this.elements) showElement(places, anchor);
    this.showWheels(places, anchor);
    this.deck?.show(state, anchor);
  }
  showWheels({ bodies, wheels }, anchor) {
    const { wheelsOn, wheelRadius } = this.mechanism;
    wheels.forEach((r, i) => place(this.wheels[i], subtract(r, anchor), multiply(bodies[wheelsOn].A, aboutZ(-r[0] / wheelRadius))));
  }
  // Points about all of it at some instants of the launch, from what the picture follows, and the tube's ends.
  corners(state, anchor) {
    const { motion, mechanism } = this, { t } = motion;
    this.swept ??= Array.from({ length: INSTANTS }, (_, i) => t[Math.round((i * (t.length - 1)) / (INSTANTS - 1))]).flatMap((time) => {
      const then = motion.at(time), tube = [0, motion.length].map((x) => add(then.base.r, apply(then.base.A, [x, 0, 0])));
      return [...outlineOf(mechanism, then.places), ...tube].map((r) => subtract(r, then.followed));
    });
    const followed = subtract(state.followed, anchor);
    return [...this.swept.map((r) => add(r, followed)), ...(this.deck?.corners(state, anchor) ?? [])];
  }
}

const transposed = (A) => [0, 3, 6, 1, 4, 7, 2, 5, 8].map((i) => A[i]);

// A cylinder about x of a length and two diameters.
function round([length, high, wide], surface) {
  const made = cylinder([-length / 2, 0, 0], [length / 2, 0, 0], 0.5, surface, edge, 32), group = new Group();
  group.add(made);
  group.scale.set(1, high, wide);
  return group;
}

function ellipsoid(half, surface) {
  const mesh = new Mesh(new SphereGeometry(1, 40, 24), surface), group = new Group();
  mesh.scale.set(...half);
  group.add(mesh);
  return group;
}

// What shows a joint's kind, in the joint's axes: its axis as a pin, two crossed ones, a ball, a sleeve, a disc, a plate.
function markOf({ kind, axis }, u) {
  const surface = angular(JOINT), e = unit(axis), pin = (along, half, radius) =>
    cylinder(scaled(-half, along), scaled(half, along), radius, surface, edge, 20);
  const other = unit(cross(e, Math.abs(e[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0]));
  if (kind === "revolute") return [pin(e, 2.6 * u, 0.8 * u), pin(e, 0.9 * u, 1.3 * u)];
  if (kind === "cylindrical") return [pin(e, 2.6 * u, 0.8 * u), pin(e, 1.6 * u, 1.1 * u)];
  if (kind === "prismatic") return [squared(e, [1.8 * u, 1.1 * u, 1.1 * u], surface)];
  if (kind === "universal") return [pin(e, 1.9 * u, 0.6 * u), pin(other, 1.9 * u, 0.6 * u)];
  if (kind === "spherical") return [ball(1.3 * u, surface)];
  if (kind === "planar") return [pin(e, 0.3 * u, 2.4 * u)];
  return [box([-0.8 * u, -0.8 * u, -0.8 * u], [0.8 * u, 0.8 * u, 0.8 * u], paint.wheel, edge)];
}

function ball(radius, surface) {
  const group = new Group();
  group.add(new Mesh(new SphereGeometry(radius, 20, 14), surface));
  return group;
}

// A box along an axis.
function squared(axis, [long, high, wide], surface) {
  const group = new Group(), mesh = new Mesh(new CylinderGeometry(1, 1, 2, 4), surface);
  mesh.scale.set(1.3 * high, long, 1.3 * wide);
  group.add(mesh);
  point(group, [0, 0, 0], axis);
  return group;
}

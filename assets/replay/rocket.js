// A rocket with its adaptors or shoes, and the forces on it.
import { ConeGeometry, CylinderGeometry, BufferGeometry, DoubleSide, Float32BufferAttribute, Group, Mesh, MeshBasicMaterial } from "three";
import { COLOURS, edge, RING } from "./launcher.js";
import { finCorners } from "./outline.js";
import { angular, Beams, material, place, point, Sleeve } from "./shapes.js";
import { add, scaled, subtract } from "./vector.js";

const SLENDER = 16; // length over radius of what is seen from afar

// The body is drawn slimmer than it is, so that adaptors and clearances can be seen.
export class Rocket {
  constructor(motion, group) {
    const { adaptors, guide, outline } = motion, { body } = guide, front = Math.max(...adaptors);
    this.motion = motion;
    this.bodyRadius = body;
    this.length = outline ? outline.tip : front + 7.2 * body;
    this.profile = outline ? profileOf(outline, body) : profile(body, front + 2.2 * body, this.length);
    this.skin = material(0xffffff, { vertexColors: true });
    this.body = new Sleeve(this.profile.length, RING, this.skin);
    this.body.geometry.setAttribute("color", stripes(this.profile.length));
    this.rings = adaptors.map(() => new Sleeve(7, RING, material(COLOURS.adaptor)));
    this.shoes = adaptors.map(() => new Beams(guide.pads(0, 0).length, 2, angular(COLOURS.adaptor), edge));
    this.ghosts = [...this.rings.map(({ mesh }) => mesh), ...this.shoes.map((shoe) => shoe.group.children[0])].map(ghostOf);
    this.half = Math.min(0.01 * motion.length, 0.15 * front); // half the length of an adaptor
    this.flame = new Mesh(new ConeGeometry(1, 1, 20, 1, true), material(COLOURS.flame,
      { transparent: true, opacity: 0.75, depthWrite: false, emissive: 0xff7a00 }));
    this.powered = motion.largest("thrust") > 0;
    this.fins = new Group();
    for (const corners of outline ? finsOf(outline, body) : [0, 1, 2, 3].map((i) => across(MADE_UP.map(([x, r]) => [x, r * body]), (Math.PI * i) / 2)))
      this.fins.add(fin(corners));
    this.group = new Group();
    this.group.add(this.body.mesh, this.flame, this.fins, ...this.rings.map(({ mesh }) => mesh),
      ...this.shoes.map((shoe) => shoe.group), ...this.ghosts.map(({ ghost }) => ghost));
    group.add(this.group);
    this.straight = false;
  }
  hide() {
    this.group.visible = false;
  }
  // In the tube: each point is where the scaled tube is there, and from it by the scaled offset.
  showInTube(state, anchor, scale, gap, clearances, burning) {
    const { motion } = this;
    place(this.group, subtract(state.tube.r, anchor), state.tube.A);
    const { guide } = motion, at = (l, y = 0, z = 0) => motion.drawnRocket(state, [l, y, z], scale, gap);
    this.drawAlong(at, state.rocket.roll, (i) => guide.ring(clearances[i], gap), burning);
    this.drawShoes(at, (i) => guide.pads(clearances[i], gap));
    this.fins.visible = false;
    this.offsets = motion.adaptors.map((l) => {
      const p = state.rocket.point(l), d = motion.deflection(state, p[0]);
      return [1, 2].map((k) => p[k] - guide.line[k - 1] - d[k]);
    });
    this.straight = false;
  }
  // In flight: rigid, origin at its mass centre.
  showInFlight(flight, anchor, burning) {
    const { motion } = this;
    this.flying = { center: subtract(flight.center, anchor), A: flight.A };
    this.enlarge(1);
    const still = (l, y = 0, z = 0) => [l - motion.center, y, z];
    if (!this.straight) {
      this.drawAlong(still, 0, () => (motion.guide.ring(0, 0) ? 1.02 * this.bodyRadius : null), 0);
      this.drawShoes(still, () => motion.guide.pads(0, 0));
    }
    this.fins.position.set(-motion.center, 0, 0);
    this.straight = true;
    this.fins.visible = this.powered || motion.outline !== null;
    this.burn([-motion.center + this.profile[0].l, 0, 0], [-1, 0, 0], burning);
  }
  // So many times as long about its mass centre, in flight; a slender one then is as thick as is seen from afar.
  enlarge(times) {
    const across = times > 1 ? times * Math.max(1, this.length / (SLENDER * this.bodyRadius)) : 1;
    place(this.group, this.flying.center, this.flying.A.map((v, i) => (i % 3 === 0 ? times : across) * v));
  }
  drawAlong(at, roll, radius, burning) {
    this.group.visible = true;
    this.body.draw(this.profile.map(({ l, r, slope }) => ({ at: at(l), radius: r, slope })), roll, roll + 2 * Math.PI);
    this.rings.forEach((ring, i) => {
      const l = this.motion.adaptors[i], { half } = this, low = this.bodyRadius, high = radius(i);
      ring.mesh.visible = high !== null;
      if (high === null) return;
      ring.draw([[-half, low], [-half, high], [-half / 2, high], [0, high], [half / 2, high], [half, high], [half, low]]
        .map(([step, r]) => ({ at: at(l + step), radius: r })));
    });
    for (const { ghost, of } of this.ghosts) ghost.visible = of.visible;
    const rear = at(this.profile[0].l), ahead = at(this.profile[1].l + 0.1);
    this.burn(rear, subtract(rear, ahead), burning);
  }
  // The pads of each shoe; `at`: where a point of the rocket is drawn, `quads`: the profiles of shoe i.
  drawShoes(at, quads) {
    this.shoes.forEach((shoe, i) => {
      const profiles = quads(i), ends = [-this.half, this.half].map((step) => this.motion.adaptors[i] + step);
      shoe.draw((part, ring, corner) => at(ends[ring], ...profiles[part][corner]));
    });
  }
  // `burning`: thrust over its largest.
  burn(at, direction, burning) {
    this.flame.visible = burning > 0.01;
    if (!this.flame.visible) return;
    const length = 0.25 + 0.9 * burning, width = 0.75 * this.bodyRadius;
    const back = scaled(1 / Math.hypot(...direction), direction);
    point(this.flame, add(at, scaled(length / 2, back)), back);
    this.flame.scale.set(width, length, width);
  }
  // Adaptor i's centre as drawn [m], of a shoe that of its first pad, and its radius, from the vertices.
  adaptor(i) {
    const [ring, shoe] = [this.rings[i], this.shoes[i]];
    if (ring.mesh.visible) return { centre: ring.centre(3), radius: ring.radius(3) };
    return { centre: scaled(0.5, add(shoe.centre(0, 0), shoe.centre(0, 1))), radius: 0 };
  }
}

// What is seen of an adaptor or shoe through whatever stands before it.
function ghostOf(mesh) {
  const ghost = new Mesh(mesh.geometry, new MeshBasicMaterial({ color: COLOURS.adaptor, transparent: true, opacity: 0.45,
    depthTest: false, depthWrite: false, side: DoubleSide }));
  ghost.renderOrder = 3;
  ghost.frustumCulled = false;
  return { ghost, of: mesh };
}

// Radius over the length: nozzle, body, ogive.
function profile(body, shoulder, length) {
  const rear = -0.65 * body, out = [{ l: -1.95 * body, r: 0.66 * body }, { l: rear, r: 0.5 * body }, { l: rear, r: body }];
  for (let i = 0; i <= 12; i++) out.push({ l: rear + ((shoulder - rear) * i) / 12, r: body });
  for (let i = 1; i <= 10; i++) {
    const x = i / 10, r = body * Math.max(0.002, 1 - x * x);
    out.push({ l: shoulder + (length - shoulder) * x, r, slope: (-2 * x * body) / (length - shoulder) });
  }
  return out;
}

// A light stripe along the body, and one across from it half as wide, show the roll.
function stripes(rings) {
  const colours = [], rgb = (hex) => [hex >> 16, (hex >> 8) & 255, hex & 255].map((v) => (v / 255) ** 2.2);
  const plain = rgb(COLOURS.rocket), light = rgb(COLOURS.stripe);
  for (let j = 0; j < rings; j++)
    for (let i = 0; i <= RING; i++) colours.push(...(i < 4 || i === 18 || i === 19 ? light : plain));
  return new Float32BufferAttribute(colours, 3);
}

// The given body, as slim as the other is drawn, with a nozzle; the slope at a point is that of what is behind it.
function profileOf({ body, rear, widest }, radius) {
  const told = body.map(([l, r]) => ({ l, r: Math.max(0.002 * widest, r) * (radius / widest) })).reverse();
  const slope = (i) => (told[i].l > told[i - 1].l ? (told[i].r - told[i - 1].r) / (told[i].l - told[i - 1].l) : 0), [{ r }] = told;
  const points = told.flatMap((point, i) => [...(i > 0 ? [{ ...point, slope: slope(i) }] : []), ...(i + 1 < told.length ? [{ ...point, slope: slope(i + 1) }] : [])]);
  return [{ l: rear - 0.6 * r, r: 0.66 * r }, { l: rear, r: 0.5 * r }, { l: rear, r }, ...points];
}

// Corners across the body at an angle, from places along it and distances from its axis.
const across = (corners, angle) => corners.map(([x, r]) => [x, r * Math.cos(angle), r * Math.sin(angle)]);

const finsOf = ({ fins, widest }, radius) => fins.flatMap((of) => Array.from({ length: of.count }, (_, k) =>
  across(finCorners(of).map(([x, r]) => [x, r * (radius / widest)]), (2 * Math.PI * (k + 0.5)) / of.count)));

const MADE_UP = [[-0.03, 0.9], [0.28, 0.9], [0.1, 3], [-0.03, 3]]; // a fin where none is given: along the body, in its radii

function fin(corners) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(corners.flat(), 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  geometry.computeVertexNormals();
  return new Mesh(geometry, material(COLOURS.rocket));
}

// ---- forces ----

// Contact forces on the rocket: an arrow from outside the guide, along the force at an adaptor.
export class Forces {
  constructor(motion, group) {
    this.motion = motion;
    this.group = new Group();
    this.most = Math.max(1e-9, ...motion.adaptorNames.map((name) => motion.largest(`contact.${name}.force`)));
    this.metresPerNewton = (0.28 * motion.length) / this.most; // an arrow is as long as its force
    this.arrows = motion.adaptors.map(() => {
      const arrow = new Group(), paintIt = material(COLOURS.force, { emissive: 0x0b5c35 });
      arrow.shaft = new Mesh(new CylinderGeometry(0.013, 0.013, 1, 12), paintIt);
      arrow.head = new Mesh(new ConeGeometry(0.036, 0.09, 16), paintIt);
      arrow.add(arrow.shaft, arrow.head);
      this.group.add(arrow);
      return arrow;
    });
    group.add(this.group);
  }
  show(state, anchor, rocket) {
    place(this.group, subtract(state.tube.r, anchor), state.tube.A);
    this.arrows.forEach((arrow, i) => {
      const [y, z] = rocket ? this.direction(state, rocket, i) : [0, 0], e = Math.hypot(y, z), force = state.forces[i];
      arrow.visible = Boolean(rocket) && force > 1e-3 * this.most && e > 0;
      if (!arrow.visible) return;
      const inward = [0, y / e, z / e], { centre } = rocket.adaptor(i);
      const tip = subtract(centre, scaled(this.reach(centre, inward), inward)), size = this.motion.length / 3;
      const length = (this.metresPerNewton * force) / size, head = Math.min(1, length / 0.18);
      arrow.scale.setScalar(size);
      point(arrow, tip, inward);
      arrow.head.scale.setScalar(head);
      arrow.head.position.set(0, -0.045 * head, 0);
      arrow.shaft.position.set(0, -0.09 * head - (length - 0.09 * head) / 2, 0);
      arrow.shaft.scale.set(1, Math.max(1e-3, length - 0.09 * head), 1);
    });
  }
  // Where the force at an adaptor points across the guide: as a shoe's surfaces push, in a bore towards its axis.
  direction(state, rocket, i) {
    return Number.isFinite(state.pushes[i][0]) ? state.pushes[i] : (rocket.offsets?.[i] ?? [0, 0]).map((v) => -v);
  }
  // How far from a point, against a direction, one is outside the guide.
  reach([, y, z], [, dy, dz]) {
    const { kind, outer, envelope: { low, high } } = this.motion.guide, far = (at, d, i) =>
      Math.abs(d) < 1e-6 ? Infinity : ((d > 0 ? at - low[i] : high[i] - at) + 0.01) / Math.abs(d);
    return kind === "bore" ? outer : Math.max(0, Math.min(far(y, dy, 0), far(z, dz, 1)));
  }
}

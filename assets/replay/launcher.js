// The bodies of a launcher: vehicle, platforms, tubes, the launching tube, rockets.
import { BufferAttribute, BufferGeometry, ConeGeometry, CylinderGeometry, Float32BufferAttribute, Group, LineLoop,
  Mesh } from "three";
import { box, cylinder, line, material, place, point, prism, Sleeve } from "./shapes.js";
import { add, apply, scaled, subtract } from "./vector.js";

const RING = 32; // points of a circle

export const COLOURS = {
  tube: 0x2f7fd0, inside: 0x9cc3ea, rocket: 0xe8602c, stripe: 0xffd9c4, adaptor: 0xf2b632, force: 0x17a05d,
  vehicle: 0x8f989f, platform: 0xaab2b8, bright: 0xd3d8dc, wheel: 0x33383d, hub: 0xb9bfc4, other: 0x7f8fa0,
  flame: 0xffb300,
};

export const edge = line(0x20262b, { transparent: true, opacity: 0.55 });
export const paint = Object.fromEntries(Object.entries(COLOURS).map(([name, color]) => [name, material(color)]));

// ---- what carries the tubes ----

export class Vehicle {
  constructor(motion, group) {
    this.motion = motion;
    const { mounts, wheelRadius: R, azimuthHinge: a } = motion;
    const xs = mounts.map(([x]) => x), zs = mounts.map(([, , z]) => z), y = Math.max(...mounts.map((m) => m[1]));
    const front = Math.max(...xs), rear = Math.min(...xs), side = Math.max(...zs) + 0.2;
    const deck = a[1] - 0.12, floor = Math.min(y + 0.55 * R, deck - 0.2);
    const reach = a[0] + motion.elevationHinge[0] + Math.max(...motion.places.map(([x]) => x)) + motion.length;
    this.chassis = new Group();
    this.chassis.add(box([rear - 1.3 * R, floor, -0.55], [front + 1.3 * R, deck - 0.25, 0.55], paint.vehicle, edge));
    this.chassis.add(box([rear - 1.3 * R, deck - 0.25, -side], [front - 0.2, deck, side], paint.vehicle, edge));
    if (front + 1.4 * R > reach + 0.3)
      this.chassis.add(cab(Math.max(reach + 0.1, front - 0.5), front + 1.5 * R, floor, deck, side));
    this.azimuth = new Group();
    this.azimuth.add(cylinder([0, -0.12, 0], [0, 0.1, 0], 0.75, paint.platform, edge, 40));
    const e = motion.elevationHinge, width = this.width();
    for (const z of [-width, width])
      this.azimuth.add(box([e[0] - 0.16, 0.1, z - 0.04], [e[0] + 0.16, e[1] + 0.12, z + 0.04], paint.platform, edge));
    this.azimuth.add(box([Math.min(0, e[0]) - 0.2, 0.05, -width], [Math.max(0, e[0]) + 0.3, 0.16, width], paint.platform, edge));
    this.wheels = mounts.map(() => wheel(R));
    this.eye = { distance: 1, direction: [4.4, 2.8, 9.9] };
    group.add(this.chassis, this.azimuth, ...this.wheels);
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

function wheel(R) {
  const group = new Group();
  group.add(cylinder([0, 0, -0.17], [0, 0, 0.17], R, paint.wheel, edge, 36));
  group.add(cylinder([0, 0, -0.18], [0, 0, 0.18], 0.55 * R, paint.hub, null, 24));
  for (let i = 0; i < 5; i++) {
    const angle = (2 * Math.PI * i) / 5, at = [0.36 * R * Math.cos(angle), 0.36 * R * Math.sin(angle), 0];
    group.add(cylinder(add(at, [0, 0, -0.19]), add(at, [0, 0, 0.19]), 0.07 * R, paint.wheel, null, 8));
  }
  return group;
}

// ---- tubes ----

// The other tubes in their places, seen through, and the frames that hold all of them.
export class Pack {
  constructor(motion, group) {
    this.motion = motion;
    this.group = new Group();
    this.glass = material(COLOURS.other, { transparent: true, depthWrite: false });
    this.caps = material(COLOURS.rocket, { transparent: true, depthWrite: false });
    this.beam = material(COLOURS.platform, { transparent: true });
    this.rim = line(COLOURS.other, { transparent: true });
    this.tubes = motion.places.map((at) => this.tube(at));
    if (motion.places.length > 1) this.frames();
    this.group.add(...this.tubes);
    group.add(this.group);
  }
  tube(at) {
    const { length, outer } = this.motion, tube = new Group();
    const shell = new Mesh(new CylinderGeometry(outer, outer, length, 20, 1, true), this.glass);
    point(shell, add(at, [length / 2, 0, 0]), [1, 0, 0]);
    const rim = (x) => circle(add(at, [x, 0, 0]), outer, this.rim);
    tube.cap = cylinder(add(at, [length - 0.012, 0, 0]), add(at, [length - 0.002, 0, 0]), 0.93 * outer, this.caps, null, 20);
    tube.add(shell, rim(0), rim(length), tube.cap);
    return tube;
  }
  frames() {
    const { places, supports, outer } = this.motion, room = 1.5 * outer, bar = 0.025;
    const low = [1, 2].map((i) => Math.min(...places.map((p) => p[i])) - room);
    const high = [1, 2].map((i) => Math.max(...places.map((p) => p[i])) + room);
    const x0 = places[0][0];
    for (const s of supports) {
      const x = x0 + s, part = (y0, z0, y1, z1) =>
        this.group.add(box([x - 0.03, y0 - bar, z0 - bar], [x + 0.03, y1 + bar, z1 + bar], this.beam, edge));
      part(low[0], low[1], low[0], high[1]);
      part(high[0], low[1], high[0], high[1]);
      part(low[0], low[1], high[0], low[1]);
      part(low[0], high[1], high[0], high[1]);
    }
    const rear = Math.min(-0.15, x0 + Math.min(...supports)), front = x0 + Math.max(...supports) + 0.05;
    for (const z of [low[1] + 0.1, high[1] - 0.1])
      this.group.add(box([rear, low[0] - 0.09, z - 0.04], [front, low[0] - bar, z + 0.04], paint.platform, edge));
  }
  // `launching`: number of the tube that is drawn by itself; `fired`: those without a rocket;
  // `close`: the eye is on the tube, what stands before it steps back.
  show(state, anchor, launching, fired, close) {
    this.glass.opacity = close ? 0.025 : 0.12;
    this.caps.opacity = close ? 0.12 : 0.45;
    this.rim.opacity = close ? 0.25 : 0.6;
    this.beam.opacity = close ? 0.35 : 1;
    const rear = this.motion.places[launching - 1] ?? this.motion.places[0];
    const r = subtract(state.tube.r, apply(state.tube.A, rear));
    place(this.group, subtract(r, anchor), state.tube.A);
    this.tubes.forEach((tube, i) => {
      tube.visible = i + 1 !== launching;
      tube.cap.visible = !fired.has(i + 1);
    });
  }
}

function circle(at, radius, stroke) {
  const points = [];
  for (let i = 0; i < RING; i++) {
    const angle = (2 * Math.PI * i) / RING;
    points.push(at[0], at[1] + radius * Math.cos(angle), at[2] + radius * Math.sin(angle));
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(points, 3));
  return new LineLoop(geometry, stroke);
}

// The launching tube, cut open towards the eye: in T, so that small deflections keep their digits.
export class Tube {
  constructor(motion, group) {
    const rings = motion.stations.length;
    this.motion = motion;
    this.group = new Group();
    this.shell = new Sleeve(rings, 28, material(COLOURS.tube));
    this.lining = new Sleeve(rings, 28, material(COLOURS.inside));
    this.collars = [0, ...motion.supports.map((x) => this.nearest(x)), rings - 1].map((ring) => {
      const stroke = line(COLOURS.tube);
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(new Float32Array(RING * 3), 3));
      const loop = new LineLoop(geometry, stroke);
      loop.frustumCulled = false;
      return { ring, loop };
    });
    this.whole = new Sleeve(rings, RING, material(COLOURS.tube,
      { transparent: true, opacity: 0.07, depthWrite: false }));
    this.whole.mesh.renderOrder = 2;
    this.group.add(this.shell.mesh, this.lining.mesh, this.whole.mesh, ...this.collars.map(({ loop }) => loop));
    group.add(this.group);
  }
  nearest(x) {
    const { stations } = this.motion;
    return stations.reduce((best, s, i) => (Math.abs(s - x) < Math.abs(stations[best] - x) ? i : best), 0);
  }
  // `scale`: of the deflection; `opening`: angle from y towards z, in T, that the eye looks at.
  show(state, anchor, scale, opening) {
    const { bore, outer } = this.motion;
    place(this.group, subtract(state.tube.r, anchor), state.tube.A);
    const curve = (radius) => state.nodes.map(({ x, offset }) =>
      ({ at: [x + offset[0], scale * offset[1], scale * offset[2]], radius }));
    const from = opening + 1.2, to = opening + 2 * Math.PI - 1.2;
    this.shell.draw(curve(outer), from, to);
    this.lining.draw(curve(bore), from, to);
    this.whole.draw(curve(outer));
    for (const { ring, loop } of this.collars) {
      const position = loop.geometry.attributes.position, all = this.whole.position;
      for (let i = 0; i < RING; i++) {
        const k = ring * (RING + 1) + i;
        position.setXYZ(i, all.getX(k), all.getY(k), all.getZ(k));
      }
      position.needsUpdate = true;
    }
  }
  // Where the tip is drawn less where it is on the undeformed tube [m], from the vertices.
  tip() {
    return subtract(this.whole.centre(this.whole.rings - 1), [this.motion.length, 0, 0]);
  }
}

// ---- rocket ----

// The body is drawn slimmer than it is, so that adaptors and clearances can be seen.
export class Rocket {
  constructor(motion, group) {
    const { bore, adaptors } = motion, body = 0.56 * bore, front = Math.max(...adaptors);
    this.motion = motion;
    this.bodyRadius = body;
    this.length = front + 0.1 + 5 * body;
    this.profile = profile(body, front + 0.1, this.length);
    this.skin = material(0xffffff, { vertexColors: true });
    this.body = new Sleeve(this.profile.length, RING, this.skin);
    this.body.geometry.setAttribute("color", stripes(this.profile.length));
    this.rings = adaptors.map(() => new Sleeve(7, RING, material(COLOURS.adaptor)));
    this.flame = new Mesh(new ConeGeometry(1, 1, 20, 1, true), material(COLOURS.flame,
      { transparent: true, opacity: 0.75, depthWrite: false, emissive: 0xff7a00 }));
    this.fins = new Group();
    for (let i = 0; i < 4; i++) this.fins.add(fin(body, (Math.PI * i) / 2));
    this.group = new Group();
    this.group.add(this.body.mesh, this.flame, this.fins, ...this.rings.map(({ mesh }) => mesh));
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
    const at = (l) => {
      const p = state.rocket.point(l), d = motion.deflection(state, p[0]);
      return [p[0], scale * d[1] + gap * (p[1] - d[1]), scale * d[2] + gap * (p[2] - d[2])];
    };
    this.drawAlong(at, state.rocket.roll, (i) => motion.bore - gap * clearances[i], burning);
    this.fins.visible = false;
    this.offsets = motion.adaptors.map((l) => {
      const p = state.rocket.point(l), d = motion.deflection(state, p[0]);
      return [p[1] - d[1], p[2] - d[2]];
    });
    this.straight = false;
  }
  // In flight: rigid, origin at its mass centre.
  showInFlight(flight, anchor, burning) {
    const { motion } = this;
    place(this.group, subtract(flight.center, anchor), flight.A);
    if (!this.straight) this.drawAlong((l) => [l - motion.center, 0, 0], 0, () => 1.02 * this.bodyRadius, 0);
    this.fins.position.set(-motion.center, 0, 0);
    this.fins.visible = this.straight = true;
    this.burn([-motion.center + this.profile[0].l, 0, 0], [-1, 0, 0], burning);
  }
  drawAlong(at, roll, radius, burning) {
    this.group.visible = true;
    this.body.draw(this.profile.map(({ l, r, slope }) => ({ at: at(l), radius: r, slope })), roll, roll + 2 * Math.PI);
    this.rings.forEach((ring, i) => {
      const l = this.motion.adaptors[i], half = 0.03, low = this.bodyRadius, high = radius(i);
      ring.draw([[-half, low], [-half, high], [-half / 2, high], [0, high], [half / 2, high], [half, high], [half, low]]
        .map(([step, r]) => ({ at: at(l + step), radius: r })));
    });
    const rear = at(this.profile[0].l), ahead = at(this.profile[1].l + 0.1);
    this.burn(rear, subtract(rear, ahead), burning);
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
  // Adaptor i's centre against the tube's axis as drawn [m], and its radius, from the vertices.
  adaptor(i) {
    return { centre: this.rings[i].centre(3), radius: this.rings[i].radius(3) };
  }
}

// Radius over the length: nozzle, body, ogive.
function profile(body, shoulder, length) {
  const out = [{ l: -0.09, r: 0.66 * body }, { l: -0.03, r: 0.5 * body }, { l: -0.03, r: body }];
  for (let i = 0; i <= 12; i++) out.push({ l: -0.03 + ((shoulder + 0.03) * i) / 12, r: body });
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

function fin(body, angle) {
  const geometry = new BufferGeometry(), c = Math.cos(angle), s = Math.sin(angle);
  const corners = [[-0.03, 0.9], [0.28, 0.9], [0.1, 3], [-0.03, 3]].map(([x, r]) => [x, r * body * c, r * body * s]);
  geometry.setAttribute("position", new Float32BufferAttribute(corners.flat(), 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  geometry.computeVertexNormals();
  return new Mesh(geometry, material(COLOURS.rocket));
}

// ---- forces ----

// Contact forces on the rocket: an arrow through the wall that ends where the adaptor touches.
export class Forces {
  constructor(motion, group) {
    this.motion = motion;
    this.group = new Group();
    this.most = Math.max(1e-9, ...motion.adaptorNames.map((name) => motion.largest(`contact.${name}.force`)));
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
      const force = state.forces[i], [y, z] = rocket?.offsets?.[i] ?? [0, 0], e = Math.hypot(y, z);
      arrow.visible = Boolean(rocket) && force > 1e-3 * this.most && e > 0;
      if (!arrow.visible) return;
      const inward = [0, -y / e, -z / e], { centre } = rocket.adaptor(i);
      const tip = subtract(centre, scaled(this.motion.outer, inward)), length = 0.09 + 0.75 * (force / this.most);
      point(arrow, tip, inward);
      arrow.head.position.set(0, -0.045, 0);
      arrow.shaft.position.set(0, -0.09 - (length - 0.09) / 2, 0);
      arrow.shaft.scale.set(1, Math.max(1e-3, length - 0.09), 1);
    });
  }
}

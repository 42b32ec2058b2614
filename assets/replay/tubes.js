// The tubes or rails: those that wait in their places, and the launching one, which bends.
import { BufferAttribute, BufferGeometry, CylinderGeometry, Float32BufferAttribute, Group, LineLoop, Mesh } from "three";
import { COLOURS, edge, paint, RING } from "./launcher.js";
import { angular, Beams, box, cylinder, line, material, place, point, Sleeve } from "./shapes.js";
import { add, apply, subtract } from "./vector.js";

// The other tubes in their places, seen through, and the frames that hold all of them.
export class Pack {
  constructor(motion, group) {
    this.motion = motion;
    this.group = new Group();
    this.glass = material(COLOURS.other, { transparent: true, depthWrite: false });
    this.caps = material(COLOURS.rocket, { transparent: true, depthWrite: false });
    this.beam = material(COLOURS.platform, { transparent: true });
    this.rim = line(COLOURS.other, { transparent: true });
    this.tubes = motion.places.map((at) => (motion.guide.kind === "bore" ? this.tube(at) : this.rail(at)));
    if (motion.vehicle || motion.places.length > 1) this.frames();
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
  // A rail that does not move against the platform, as its beams.
  rail(at) {
    const { guide: { solid, seenThrough, line: [oy, oz] }, length } = this.motion, rail = new Group();
    const parts = [...solid, ...seenThrough], beams = new Beams(parts.length, 2, angular(COLOURS.other), edge);
    beams.draw((part, ring, i) => add(at, [ring * length, oy + parts[part][i][0], oz + parts[part][i][1]]));
    rail.cap = new Group();
    rail.add(beams.group, rail.cap);
    return rail;
  }
  frames() {
    const { places, supports, outer, guide: { kind, envelope } } = this.motion, room = 0.5 * outer, bar = 0.025;
    const low = [1, 2].map((i) => Math.min(...places.map((p) => p[i])) + envelope.low[i - 1] - (kind === "bore" ? room : bar));
    const high = [1, 2].map((i) => Math.max(...places.map((p) => p[i])) + envelope.high[i - 1] + room);
    const x0 = places[0][0];
    for (const s of supports) {
      const x = x0 + s, part = (y0, z0, y1, z1) =>
        this.group.add(box([x - 0.03, y0 - bar, z0 - bar], [x + 0.03, y1 + bar, z1 + bar], this.beam, edge));
      part(low[0], low[1], low[0], high[1]);
      if (kind !== "bore") continue; // a rail is open above
      part(high[0], low[1], high[0], high[1]);
      part(low[0], low[1], high[0], low[1]);
      part(low[0], high[1], high[0], high[1]);
    }
    const rear = this.motion.mechanism ? x0 + Math.min(...supports) - 0.05 : Math.min(-0.15, x0 + Math.min(...supports)), front = x0 + Math.max(...supports) + 0.05;
    for (const z of [low[1] + 0.1, high[1] - 0.1])
      this.group.add(box([rear, low[0] - 0.09, z - 0.04], [front, low[0] - bar, z + 0.04], paint.platform, edge));
  }
  // `launching`: number of the tube that is drawn on its own; `fired`: those without a rocket;
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
    this.collars = [0, ...motion.supports.map((x) => motion.nearest(x)), rings - 1].map((ring) => {
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
    this.fittings = this.fit();
    for (const { body } of this.fittings) this.group.add(body);
    group.add(this.group);
  }
  // What closes the rear end of a tube with gas in it, and the shoes of one that slides back.
  fit() {
    const { guide: { outer }, length, supports, slides, closed } = this.motion, fittings = [];
    const half = 0.02 * length, add = (ring, part) => {
      const body = new Group();
      body.add(part);
      fittings.push({ ring, body });
    };
    if (closed) add(0, cylinder([-0.03 * length, 0, 0], [0, 0, 0], 1.15 * outer, paint.platform, edge));
    for (const x of slides.length > 0 ? supports : [])
      add(this.motion.nearest(x), box([-half, -2 * outer, -0.6 * outer], [half, -0.9 * outer, 0.6 * outer], paint.platform, edge));
    return fittings;
  }
  // `scale`: of the deflection; `opening`: angle from y towards z, in T, that the eye looks at.
  show(state, anchor, scale, opening) {
    const { radius, outer } = this.motion.guide;
    place(this.group, subtract(state.tube.r, anchor), state.tube.A);
    const curve = (r) => state.nodes.map((_, k) => ({ at: this.motion.drawnGuide(state, k, 0, 0, scale), radius: r }));
    const from = opening + 1.2, to = opening + 2 * Math.PI - 1.2;
    this.shell.draw(curve(outer), from, to);
    this.lining.draw(curve(radius), from, to);
    this.whole.draw(curve(outer));
    for (const { ring, body } of this.fittings) body.position.set(...this.motion.drawnGuide(state, ring, 0, 0, scale));
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

// A rail or a tower: the beams of its profile, each of their corners where the section has it. What
// is around the shoes is seen through.
export class Rail {
  constructor(motion, group) {
    const { kind, solid, seenThrough } = motion.guide, rings = motion.stations.length;
    this.motion = motion;
    this.group = new Group();
    const thin = angular(COLOURS.tube, { transparent: true, opacity: 0.12, depthWrite: false });
    const faint = line(0x20262b, { transparent: true, opacity: 0.3 });
    this.beams = [[solid, angular(COLOURS.tube), edge], [seenThrough, thin, faint]].map(([profiles, surface, stroke]) => {
      const beams = new Beams(profiles.length, rings, surface, stroke);
      this.group.add(beams.group);
      return { profiles, beams };
    });
    if (kind === "tower") this.hoop();
    group.add(this.group);
  }
  // Square hoops around a tower, between its ends about as far apart as it is wide.
  hoop() {
    const { length, guide: { outer } } = this.motion, count = Math.max(4, Math.round(length / (6 * outer)));
    const bar = 0.1 * outer, far = outer + bar;
    this.hoops = Array.from({ length: count + 1 }, (_, i) => {
      const at = this.motion.nearest((length * i) / count), hoop = new Group();
      for (const side of [-1, 1]) {
        hoop.add(box([-bar, side * far - bar, -far], [bar, side * far + bar, far], paint.platform, edge));
        hoop.add(box([-bar, -far, side * far - bar], [bar, far, side * far + bar], paint.platform, edge));
      }
      this.group.add(hoop);
      return { hoop, at };
    });
  }
  show(state, anchor, scale) {
    const { motion } = this;
    place(this.group, subtract(state.tube.r, anchor), state.tube.A);
    for (const { profiles, beams } of this.beams)
      beams.draw((part, ring, i) => motion.drawnGuide(state, ring, ...profiles[part][i], scale));
    for (const { hoop, at } of this.hoops ?? []) hoop.position.set(...motion.drawnGuide(state, at, 0, 0, scale));
  }
}

// What a base without wheels is drawn as: a plate, a ship or an aircraft, with posts to the supports.
// All of it in the axes of the base, whose origin is the launching tube's rear end, or of the carrier of a multibody base;
// made up around the launcher, from whose length its sizes follow.
import { Group } from "three";
import { edge, paint } from "./launcher.js";
import { box, cylinder, loft, place, prism, Sleeve } from "./shapes.js";
import { add, apply, subtract } from "./vector.js";

// Corners of a box.
const cornersOf = (xs, ys, zs) => xs.flatMap((x) => ys.flatMap((y) => zs.map((z) => [x, y, z])));

// Places of a list of 0 to 1 where curves of hulls and bodies have their points.
const steps = (count) => Array.from({ length: count + 1 }, (_, i) => i / count);

// What all of them have: posts between launcher and carrier, and how the eye sees it.
class Carrier {
  // `load`: what stands on it, where that is more than the tubes: its corners, level and feet in the carrier's axes, where it
  // points, how high the carrier is at first, and the frame of the carrier at an instant.
  constructor(motion, scene, load = null) {
    this.group = new Group();
    this.motion = motion;
    this.load = load;
    const { length, slides, outer } = motion, low = motion.envelope.low[0] - (slides.length > 0 ? outer + 0.02 * length : 0);
    this.feet = load?.feet ?? motion.supports.map((x) => this.foot(x, low));
    if (slides.length > 0 && !load) this.cradle(low);
    this.height = load?.height ?? motion.value("base.y")[0];
    this.aft = load ? load.forwards < -0.2 * length : motion.mount[0] < -0.2;
    this.seenFrom = [4.4, 2.8, 9.9];
    scene.add(this.group);
  }
  // A point of the launcher's lower or upper side at a station, in the base's axes.
  foot(x, y) {
    const { low, high } = this.motion.envelope;
    return apply(this.motion.mount, [x, y, 0.5 * (low[1] + high[1])]);
  }
  // What a tube that recoils slides on: a beam below it that stays with the base.
  cradle(low) {
    const { motion } = this, { length, outer, supports } = motion, slide = new Group();
    slide.add(box([Math.min(...supports) - 0.08 * length, low, -outer], [Math.max(...supports) + 0.08 * length, low + 0.02 * length, outer],
      paint.vehicle, edge));
    place(slide, [0, 0, 0], motion.mount);
    this.group.add(slide);
  }
  // Corners of the launcher in the base's axes.
  launcherCorners() {
    if (this.load) return this.load.corners;
    const { envelope: { low, high }, length, mount } = this.motion, ends = [0, length];
    return ends.flatMap((x) => [low[0], high[0]].flatMap((y) => [low[1], high[1]].map((z) => apply(mount, [x, y, z]))));
  }
  // Posts from the feet down to a level; below a steep launcher a mast with an arm to each foot.
  stand(level) {
    if (this.load) {
      for (const [x, y, z] of this.feet)
        if (y > level + 0.02 * this.motion.length) this.group.add(cylinder([x, level, z], [x, y, z], 0.018 * this.motion.length, paint.platform, edge));
      return;
    }
    const { length, mount, outer } = this.motion, radius = 0.018 * length;
    const post = (from, to, r) => this.group.add(cylinder(from, to, r, paint.platform, edge));
    if (mount[3] < 0.8) {
      for (const [x, y, z] of this.feet) post([x, level, z], [x, y, z], radius);
      return;
    }
    const top = this.feet.reduce((best, foot) => (foot[1] > best[1] ? foot : best));
    const down = apply(mount, [0, -1, 0]), run = Math.hypot(down[0], down[2]) || 1, away = 0.06 * length + outer;
    const [x, z] = [top[0] + (away * down[0]) / run, top[2] + (away * down[2]) / run];
    post([x, level, z], [x, top[1] + 2 * radius, z], radius);
    for (const foot of this.feet) post([x, foot[1], z], foot, 0.5 * radius);
  }
  // Level of what it stands on: below launcher and supports.
  level() {
    return this.load?.level ?? Math.min(0, ...this.launcherCorners().map(([, y]) => y)) - 0.12 * this.motion.length;
  }
  // What of it a picture of the whole has to show, from the anchor: `ends` in the axes of the base.
  corners(state, anchor) {
    const { r, A } = this.frame(state);
    return this.ends.map((point) => subtract(add(r, apply(A, point)), anchor));
  }
  frame(state) {
    return this.load ? this.load.frame(state) : state.base;
  }
  show(state, anchor) {
    const { r, A } = this.frame(state);
    place(this.group, subtract(r, anchor), A);
  }
}

class Plate extends Carrier {
  constructor(motion, scene, load) {
    super(motion, scene, load);
    const level = this.level(), xs = this.feet.map(([x]) => x), zs = this.feet.map(([, , z]) => z);
    const margin = 0.16 * motion.length, thick = 0.04 * motion.length;
    const ends = (places) => [Math.min(...places) - margin, Math.max(...places) + margin], [x, z] = [ends(xs), ends(zs)];
    this.group.add(box([x[0], level - thick, z[0]], [x[1], level, z[1]], paint.vehicle, edge));
    this.stand(level);
    this.ends = cornersOf(x, [level - thick], z);
    const foot = this.height + level - thick;
    this.ground = foot > 0.3 ? 0 : foot - 0.01;
  }
}

// The launcher on the foredeck, or on the quarterdeck where it points aft; the sea where I's y is 0,
// if the deck is above it.
class Ship extends Carrier {
  constructor(motion, scene, load) {
    super(motion, scene, load);
    const deck = this.level(), height = this.height + deck, { aft } = this;
    const freeboard = height > 0.8 ? height : 0.5 * motion.length;
    const length = Math.max(4.6 * freeboard, 7 * motion.length);
    const xs = this.feet.map(([x]) => x), under = load ? 0.5 * (Math.min(...xs) + Math.max(...xs)) : 0;
    Object.assign(this, { deck, freeboard, length, beam: 0.17 * length, stern: under + (aft ? -0.2 : -0.68) * length });
    this.ground = height - freeboard;
    this.sea = true;
    this.hull();
    this.house(aft);
    this.stand(deck);
    const side = [0, 0.5, 0.75, 1].flatMap((share) => [1, 2].map((line) => this.point(share, line)));
    this.ends = [...side.flatMap(({ x, y, half }) => [[x, y, -half], [x, y, half]]), this.top];
    this.seenFrom = [aft ? -4.6 : 4.6, 2.5, 9.2];
  }
  // The side at a share of the length, from the stern: half the breadth and the height of a line of
  // the hull (0 the keel, 1 the water, 2 the deck, or between them), which ends the nearer to the stern the lower it is.
  point(share, line) {
    const { length, beam, stern, deck, freeboard } = this, low = Math.min(1, Math.floor(line)), part = line - low;
    const of = (values) => values[low] + part * (values[low + 1] - values[low]);
    const fore = Math.max(0, (share - 0.55) / 0.45), after = Math.max(0, (0.15 - share) / 0.15);
    const breadth = 0.5 * beam * of([0.35, 0.9, 1]) * (1 - fore ** of([1.3, 1.7, 2.6])) * (1 - 0.15 * after ** 2);
    const rise = 0.3 * freeboard * Math.max(0, (share - 0.78) / 0.22) ** 2;
    return { x: stern + share * length * of([0.9, 0.95, 1]), half: breadth,
      y: of([deck - freeboard - 0.09 * length, deck - freeboard, deck + rise]) };
  }
  // A rail along the edge of the deck.
  rails(side) {
    const high = 0.028 * this.length, posts = steps(22).map((k) => this.point(0.02 + 0.95 * k, 2)).map(({ x, y, half }) => [x, y, 0.97 * side * half]);
    const top = posts.map(([x, y, z]) => [x, y + high, z]), thin = 0.0014 * this.length;
    return [...posts.map((from, i) => cylinder(from, top[i], thin, paint.bright, null, 6)),
      ...top.slice(1).map((to, i) => cylinder(top[i], to, thin, paint.bright, null, 6))];
  }
  // A row of them in the fore half of the side.
  portholes(side) {
    return steps(6).map((k) => 0.3 + 0.42 * k).map((share) => {
      const { x, y, half } = this.point(share, 1.72), r = 0.0085 * this.length;
      return cylinder([x, y, side * (half - r)], [x, y, side * (half + 0.1 * r)], r, paint.wheel);
    });
  }
  hull() {
    const at = (line, side) => steps(24).map((share) => {
      const { x, y, half } = this.point(share, line);
      return [x, y, side * half];
    });
    for (const side of [-1, 1]) {
      this.group.add(loft([at(0, side), at(1.13, side)], paint.wheel), loft([at(1.13, side), at(1.18, side)], paint.bright),
        loft([at(1.18, side), at(2, side)], paint.vehicle, edge), ...this.rails(side), ...this.portholes(side));
    }
    this.group.add(loft([at(2, -1), at(2, 1)], paint.platform), loft([at(0, -1), at(0, 1)], paint.wheel));
    const transom = [0, 1, 2].map((line) => this.point(0, line));
    this.group.add(loft([-1, 1].map((side) => transom.map(({ x, y, half }) => [x, y, side * half])), paint.vehicle, edge));
  }
  // Bridge, mast and funnel behind the launcher, or before it.
  house(aft) {
    const { deck, beam, length, group } = this, u = length / 40, xs = this.launcherCorners().map(([x]) => x);
    const front = aft ? Math.max(...xs) + 0.32 * length : Math.min(...xs) - 1.5 * u, half = 0.36 * beam;
    const tier = (from, to, low, high, share) =>
      group.add(box([front - to, deck + low, -share * half], [front - from, deck + high, share * half], paint.bright, edge));
    const panes = (from, to, low, high, share) => // dark, a little beyond the wall
      group.add(box([front - to, deck + low, -share * half], [front - from, deck + high, share * half], paint.wheel));
    tier(0, 11 * u, 0, 2.3 * u, 1);
    tier(1 * u, 5.5 * u, 2.3 * u, 4.5 * u, 0.85);
    tier(0.8 * u, 5.9 * u, 4.5 * u, 4.7 * u, 0.95);
    panes(0.98 * u, 3 * u, 3.2 * u, 3.9 * u, 0.87);
    for (let k = 0; k < 5; k++) panes((2 + 1.8 * k) * u, (2.7 + 1.8 * k) * u, 1.1 * u, 1.6 * u, 1.01);
    const mast = front - 4.4 * u, top = deck + 7.5 * u;
    this.top = [mast, top, 0];
    group.add(cylinder([mast, deck + 4.7 * u, 0], [mast, top, 0], 0.14 * u, paint.vehicle));
    group.add(cylinder([mast, top - 1.4 * u, -1.2 * u], [mast, top - 1.4 * u, 1.2 * u], 0.08 * u, paint.vehicle));
    const funnel = [[-7, 2.3], [-9.4, 2.3], [-9, 4.2], [-7.2, 4.2]].map(([x, y]) => [front + x * u, deck + y * u, -0.8 * u]);
    group.add(prism(funnel, [0, 0, 1.6 * u], paint.vehicle, edge));
  }
}

const WING = 7.5; // radii of the fuselage from its middle to a wing's tip

// The launcher below the fuselage; on its back where it points up by more than 15 degrees.
class Aircraft extends Carrier {
  constructor(motion, scene, load) {
    super(motion, scene, load);
    const length = Math.max(3.8 * motion.length, 5), radius = 0.058 * length, above = !motion.hangs;
    const ys = this.launcherCorners().map(([, y]) => y), gap = 0.45 * radius;
    const axis = above ? Math.min(...ys) - gap - radius : Math.max(...ys) + gap + radius;
    const middle = apply(motion.mount, [0.5 * motion.length, 0, 0]);
    Object.assign(this, { length, radius, axis, nose: middle[0] + 0.5 * length, side: middle[2] });
    this.ground = -1e9;
    this.horizon = true;
    this.body();
    this.wings();
    this.pylons(above);
    this.ends = [[0, 0, 0], [1, 0, 0], [1, 3.2, 0], ...[-1, 1].flatMap((side) => [[0.54, 0.62, WING * side], [0.61, 0.62, WING * side], [1, 0.66, 2.9 * side]])]
      .map((place) => this.at(...place));
    this.seenFrom = above ? [4.4, 3.4, 9.9] : [5.6, -1.4, 9.2];
  }
  // Point at a share of the length behind the nose, above the axis and to the right, in radii.
  at(share, up, right) {
    return [this.nose - share * this.length, this.axis + up * this.radius, this.side + right * this.radius];
  }
  body() {
    const form = (share) => share < 0.24 ? Math.sqrt(1 - (1 - share / 0.24) ** 2)
      : share < 0.58 ? 1 : 1 - 0.9 * ((share - 0.58) / 0.42) ** 1.4;
    const rise = (share) => 0.55 * Math.max(0, (share - 0.58) / 0.42) ** 1.4;
    const curve = steps(48).map((k) => k ** 1.7).map((share) => ({ at: this.at(share, rise(share), 0), radius: this.radius * form(share) }));
    const fuselage = new Sleeve(curve.length, 32, paint.bright), glass = new Sleeve(13, 24, paint.wheel);
    fuselage.draw(curve);
    glass.draw(steps(12).map((k) => ({
      at: this.at(0.09 + 0.16 * k, 0.42 + 0.25 * k, 0), radius: 0.68 * this.radius * Math.sqrt(1 - (2 * k - 1) ** 2) })));
    this.group.add(fuselage.mesh, glass.mesh);
  }
  // Tapered and swept; at the tail the same, a fin, and the mouth of a jet.
  wings() {
    const { radius, group } = this, slab = (corners, thick) =>
      group.add(prism(corners.map((corner) => this.at(...corner)), thick.map((part) => part * radius), paint.vehicle, edge));
    for (const side of [-1, 1]) {
      slab([[0.36, 0.45, 0], [0.57, 0.45, 0], [0.61, 0.62, WING * side], [0.54, 0.62, WING * side]], [0, -0.12, 0]);
      slab([[0.86, 0.6, 0], [0.97, 0.6, 0], [1, 0.66, 2.9 * side], [0.94, 0.66, 2.9 * side]], [0, -0.08, 0]);
    }
    slab([[0.8, 0.9, -0.05], [0.97, 0.7, -0.05], [1.01, 3.2, -0.05], [0.93, 3.2, -0.05]], [0, 0, 0.1]);
    group.add(cylinder(this.at(0.96, 0.5, 0), this.at(1.015, 0.55, 0), 0.3 * radius, paint.wheel, edge));
  }
  pylons(above) {
    const half = 0.1 * this.radius, { low, high } = this.motion.envelope;
    for (const s of this.motion.supports) {
      const [x, y, z] = this.foot(s, above ? low[0] : high[0]), width = 0.05 * this.length;
      this.group.add(box([x - width / 2, Math.min(y, this.axis), z - half],
        [x + width / 2, Math.max(y, this.axis), z + half], paint.vehicle, edge));
    }
  }
}

const LOOKS = [Plate, Ship, Aircraft]; // by the geometry's base.looks

export const carrierOf = (motion, scene, load) => new LOOKS[motion.looks](motion, scene, load);

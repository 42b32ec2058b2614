// The scene of a replay: bodies, light, eye. Everything is drawn from an anchor that moves with the
// launcher, so that small numbers stay small.
import { AmbientLight, DirectionalLight, HemisphereLight, PerspectiveCamera, Scene, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { carrierOf } from "./carriers.js";
import { Clamps } from "./clamps.js";
import { Canopy } from "./canopy.js";
import { Grid, Horizon, Map, Path, Pulled, Road, Sea } from "./ground.js";
import { gltfOf } from "./gltf.js";
import { Vehicle } from "./launcher.js";
import { Linkage } from "./linkage.js";
import { Forces, Rocket } from "./rocket.js";
import { Pack, Rail, Tube } from "./tubes.js";
import { add, apply, cross, dot, scaled, subtract, turnedBack, unit } from "./vector.js";

const FIELD = 32; // degrees that the eye takes in from top to bottom
const MARGIN = 0.94; // of it for what is viewed
const HEAD = 34, FOOT = 16; // pixels at the top that words and buttons have, and at the bottom
const AFAR = 56; // pixels that a rocket on its path is long
const SOME = 200; // points of a flight that its picture is made to hold
const NARROW = 420, GAUGE = 40; // so narrow a picture leaves no room beside axes and scales, but above them

// Where an eye that looks along -`towards` sees all of the points, as near as it may: what it looks at, and how far from it
// it is. `half`: tangents of the angles that it takes in: to either side, up, down.
function fitted(points, towards, half) {
  const d = unit(towards), right = unit(cross([0, 1, 0], d)), up = cross(d, right), c = points.map((p) => dot(p, d));
  // the eye at x and at a distance D from the origin sees p if -low (D - c) <= p - x <= high (D - c)
  const across = (axis, low, high) => {
    const v = points.map((p) => dot(p, axis));
    const most = Math.max(...v.map((p, i) => p + high * c[i])), least = Math.min(...v.map((p, i) => p - low * c[i]));
    return { needed: (most - least) / (low + high), at: (D) => 0.5 * (most + least + (low - high) * D) };
  };
  const x = across(right, half.side, half.side), y = across(up, half.down, half.up);
  const D = Math.max(x.needed, y.needed), depth = 0.5 * (Math.min(...c) + Math.max(...c));
  return { focus: add(add(scaled(x.at(D), right), scaled(y.at(D), up)), scaled(depth, d)), distance: D - depth, d };
}

export class Stage {
  constructor(canvas, motion, flights, rockets) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.motion = motion;
    this.flights = flights;
    this.rockets = rockets;
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(FIELD, 2, 0.05, 400);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => { if (!this.following) this.draw(); });
    this.light();
    if (!motion.free) this.buildLauncher();
    this.bodies = rockets.map(() => new Rocket(motion, this.scene));
    this.forces = motion.free ? null : new Forces(motion, this.scene);
    this.paths = flights.map((flight) => flight && new Path(flight, this.scene));
    this.lines = flights.map((flight) => flight?.line.length && new Pulled(flight, this.scene));
    this.canopies = flights.map((flight, i) => flight?.canopy && new Canopy(motion, this.bodies[i].length, this.scene));
    this.map = this.paths.some(Boolean) ? new Map(this.extent(), this.scene) : null;
    if (this.map) this.survey();
    this.thrust = Math.max(motion.largest("thrust"), 1e-9);
    this.scale = this.gap = 1;
    this.view = motion.free ? "path" : "launcher";
    this.dots = [];
    this.target = null;
    this.chosen = null; // of several rockets
    this.seen = false; // nothing is drawn while the canvas is out of sight
  }
  // Measured places in I, which the view of the path shows, too.
  setDots(dots) {
    this.dots = dots;
    if (this.map) this.skyline.push(...dots);
  }
  buildLauncher() {
    const { motion, scene } = this;
    this.base = motion.mechanism ? new Linkage(motion, scene) : motion.vehicle ? new Vehicle(motion, scene) : carrierOf(motion, scene);
    this.road = motion.vehicle || motion.mechanism?.wheels.length > 0 ? new Road(motion, scene) : null;
    this.grid = new Grid(motion.vehicle ? -0.02 : this.base.ground, this.base.sea, scene);
    this.sea = this.base.sea ? new Sea(this.base.ground, scene) : null;
    this.horizon = this.base.horizon ? new Horizon(scene) : null;
    this.pack = new Pack(motion, scene);
    this.tube = new (motion.guide.kind === "bore" ? Tube : Rail)(motion, scene);
    this.clamps = new Clamps(motion, scene);
  }
  light() {
    const sun = new DirectionalLight(0xffffff, 2.1);
    sun.position.set(4, 9, 7);
    this.scene.add(sun, new HemisphereLight(0xffffff, 0x8a8f94, 1.5), new AmbientLight(0xffffff, 0.35));
  }
  // Deflections by `scale`; gaps as much, as far as they leave something of the adaptors.
  setScale(scale) {
    this.scale = scale;
    const { mostGap, room } = this.motion.guide, most = mostGap > 0 ? room / mostGap : scale;
    this.gap = Math.min(scale, most);
  }
  resize(width, height) {
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    if (this.camera.aspect !== width / height) this.target = null; // the view begins again
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }
  paint(colour) {
    this.scene.background = null;
    this.renderer.setClearColor(colour("card"), 1);
    this.grid?.paint(colour);
    this.road?.paint(colour);
    this.map?.paint(colour);
    this.sea?.paint(colour);
    this.horizon?.paint(colour);
  }

  // ---- an instant ----

  show(time) {
    const { motion } = this, state = motion.at(time);
    this.state = state;
    const fired = new Set(motion.empty), launching = this.rockets[state.number]?.tube ?? 1;
    this.anchor = motion.free ? this.flights[0].points().map((values) => values[0]) : state.followed ?? (motion.vehicle ? [state.chassis.r[0], 0, state.chassis.r[2]] : state.base.r);
    this.flying = this.flights.map((flight) =>
      flight && time >= flight.t[0] ? flight.at(time) : null);
    this.bodies.forEach((body, i) => {
      const gone = this.flying[i], turn = i === state.number && state.rocket;
      if (gone || i < state.number || (i === state.number && !state.rocket)) fired.add(this.rockets[i].tube);
      if (gone) body.showInFlight(gone, this.anchor, gone.thrust / this.thrust);
      else if (turn) {
        const { clearances: all } = motion.guide, clearances = all[i] ?? all[0];
        body.showInTube(state, this.anchor, this.scale, this.gap, clearances, state.thrust / this.thrust);
      } else body.hide();
    });
    if (!motion.free) this.showLauncher(state, launching, fired);
    const afar = this.view === "path";
    this.paths.forEach((path, i) => path?.show(this.anchor, this.flying[i], afar));
    this.lines.forEach((pulled, i) => pulled && pulled.show(this.anchor, this.flying[i]));
    this.canopies.forEach((canopy, i) => canopy && canopy.show(this.anchor, this.flying[i]));
    this.map?.show(this.anchor, afar);
    this.sea?.show(this.anchor, !afar);
    this.follow();
    this.draw();
  }
  showLauncher(state, launching, fired) {
    this.base.show(state, this.anchor, this.view === "tube" || this.view === "rocket");
    this.road?.show(this.anchor);
    this.grid.show(this.anchor);
    this.pack.show(state, this.anchor, launching, fired, this.view === "tube" || this.view === "rocket");
    this.clamps.show(state, this.anchor);
    const current = this.bodies[state.number];
    this.forces.show(state, this.anchor, state.rocket && !this.flying[state.number] ? current : null);
  }
  // Draws what is there as the eye sees it, where somebody can; the cut of the tube turns to the eye.
  draw() {
    const { state } = this, middle = apply(state.tube.A, [0.6 * this.motion.length, 0, 0]);
    const to = subtract(subtract(this.camera.position.toArray(), middle), subtract(state.tube.r, this.anchor));
    const [, y, z] = turnedBack(state.tube.A, to);
    this.tube?.show(state, this.anchor, this.scale, Math.atan2(z, y));
    this.horizon?.show(this.camera.position, this.view !== "path");
    this.enlarge();
    if (this.seen) this.render();
  }
  // Along its path a rocket is as long as can be seen, in pixels of the picture.
  enlarge() {
    this.camera.updateMatrixWorld();
    this.flying.forEach((flight, i) => {
      if (!flight) return;
      const far = -new Vector3(...subtract(flight.center, this.anchor)).applyMatrix4(this.camera.matrixWorldInverse).z;
      const times = this.view === "path" ? Math.max(1, AFAR / (this.pixels(far) * this.bodies[i].length)) : 1;
      this.bodies[i].enlarge(times);
      if (this.canopies[i]) this.canopies[i].enlarge(times);
    });
  }
  // Pixels a metre at a distance.
  pixels(far) {
    return this.renderer.domElement.clientHeight / (2 * Math.tan((FIELD * Math.PI) / 360) * far);
  }
  // Where points of I, from the anchor, are in the picture, in pixels from its upper left corner.
  seenAt(points) {
    const { clientWidth: width, clientHeight: height } = this.renderer.domElement;
    return points.map((point) => new Vector3(...point).project(this.camera)).map(({ x, y }) => [0.5 * width * (1 + x), 0.5 * height * (1 - y)]);
  }
  render() {
    this.renderer.render(this.scene, this.camera);
    this.rendered?.();
  }
  // The scene as glTF, without what stands for the ground, the far away and what is seen through others.
  gltf(generator) {
    const left = new Set([this.grid?.lines, this.sea?.disc, this.horizon?.circle, this.map?.lines, ...(this.base?.ghosts ?? []),
      ...this.bodies.flatMap(({ ghosts }) => ghosts.map(({ ghost }) => ghost)), ...this.paths.map((path) => path?.wide)]);
    this.scene.updateMatrixWorld();
    return gltfOf(this.scene, (object) => !left.has(object), generator);
  }

  // ---- the eye ----

  // The rocket that is viewed: the chosen one once its turn has come, else the one in the tube, or the last that has left.
  watched() {
    const { state, chosen } = this;
    if (chosen !== null && (this.flying[chosen] || state.number === chosen)) return chosen;
    if (state.rocket) return state.number;
    const flying = this.flying.map((flight, i) => (flight ? i : -1)).filter((i) => i >= 0);
    return flying.length > 0 ? flying.at(-1) : state.number;
  }
  // What a view looks at, from the anchor; the view follows it.
  focus() {
    const { motion, state, anchor } = this, inTube = (x) =>
      subtract(add(state.tube.r, apply(state.tube.A, [x, 0, 0])), anchor);
    const i = this.watched(), flying = this.flying[i];
    if (this.view === "path" && this.map) return subtract(this.launched, anchor);
    if (this.view === "rocket" && flying) return subtract(flying.canopy ? scaled(0.5, add(flying.center, flying.canopy.at)) : flying.center, anchor);
    if (this.view === "rocket" && state.rocket) return inTube(state.rocket.s + 0.5 * Math.max(...motion.adaptors));
    if (this.view === "launcher" && motion.mechanism) return subtract(state.followed, anchor);
    if (this.view === "launcher") return motion.vehicle ? [0, state.chassis.r[1], 0] : inTube(0.5 * motion.length);
    return inTube(0.55 * motion.length);
  }
  // From where, in the view's own place.
  stand() {
    const { motion, state } = this, wide = Math.max(1, 1.5 / this.camera.aspect);
    if (this.view === "path" && this.map) return this.beside;
    const across = (v) => apply(state.tube.A, v);
    const i = this.watched(), size = Math.max(motion.length, this.flying[i]?.canopy ? 1.5 * this.flights[i].reach : 0);
    if (this.view === "rocket")
      return this.flying[i] ? scaled(wide * 2.2 * size / 3, [-1.7, 0.9, 3.1])
        : across(scaled(wide * motion.length / 3, [0.5, 1.3, 3.2]));
    if (this.view === "tube") return across([0.6, 1.6, 6.4]);
    return this.base.seenFrom;
  }
  // What a view has to show all of, from the anchor: nothing where it has a distance of its own.
  shownPoints() {
    if (this.view === "path" && this.map) return this.skyline.map((p) => subtract(p, this.anchor));
    if (this.motion.free) return null;
    const { motion, state, anchor } = this, { low, high } = motion.envelope, corners = (from, to) => [from, to].flatMap((x) =>
      [low[0], high[0]].flatMap((y) => [low[1], high[1]].map((z) => subtract(add(state.tube.r, apply(state.tube.A, [x, y, z])), anchor))));
    if (this.view === "tube") return corners(-0.02 * motion.length, 1.05 * motion.length);
    if (this.view !== "launcher") return null;
    const nose = state.rocket && subtract(add(state.tube.r, apply(state.tube.A, state.rocket.point(this.bodies[state.number].length))), anchor);
    return [...corners(0, 1.02 * motion.length), ...(nose ? [nose] : []), ...this.base.corners(state, anchor)];
  }
  // What a picture of all flights has to show, some points of each and those below them, in I, from where they began, and
  // from which side: across the way to the farthest of them.
  survey() {
    this.skyline = this.flights.flatMap((flight) => (flight ? flight.some(SOME) : [])).flatMap(([x, y, z]) => [[x, y, z], [x, this.map.origin[1], z]]);
    this.launched = this.skyline[0];
    const away = this.skyline.map((p) => subtract(p, this.launched)).map(([x, , z]) => [x, z]), size = ([x, z]) => Math.hypot(x, z);
    const [x, z] = away.reduce((most, one) => (size(one) > size(most) ? one : most), [1e-9, 0]).map((v, _, all) => v / size(all));
    this.beside = [-0.3 * x - z, 0.42, x - 0.3 * z];
  }
  // Corners of all flights together.
  extent() {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (const flight of this.flights)
      flight?.points().forEach((values, i) => values.forEach((v) => {
        low[i] = Math.min(low[i], v);
        high[i] = Math.max(high[i], v);
      }));
    return { low, high };
  }
  look(view) {
    this.view = view;
    this.target = null;
  }
  // Tangents of what the eye takes in where nothing else stands.
  field() {
    const half = Math.tan((FIELD * Math.PI) / 360), { clientHeight, clientWidth } = this.renderer.domElement;
    const within = (room, size) => Math.max(0.5, 1 - (2 * room) / size), rocket = this.view === "path" ? AFAR / 2 : 0;
    const beside = (room) => half * within(Math.max(room, rocket), clientHeight || 400);
    return { side: Math.min(MARGIN, within(rocket, clientWidth || 400)) * half * this.camera.aspect,
      up: beside(HEAD), down: beside(clientWidth < NARROW ? GAUGE : FOOT) };
  }
  // Eye and focus of a view that begins, from what it follows.
  begin(focus) {
    const points = this.shownPoints(), { focus: seen, distance, d } = points ? fitted(points, this.stand(), this.field()) : {};
    this.offset = points ? subtract(seen, focus) : [0, 0, 0];
    this.camera.position.set(...(points ? add(seen, scaled(distance, d)) : add(focus, this.stand())));
    const far = Math.max(400, 6 * this.camera.position.distanceTo(new Vector3(...focus)));
    this.camera.near = this.view === "path" ? far * 1e-4 : 0.05;
    this.camera.far = far;
    this.camera.updateProjectionMatrix();
  }
  // Moves eye and focus together with what the view follows.
  follow() {
    const focus = this.focus(), { position } = this.camera, flying = this.flying[this.watched()], flew = (flying ? 1 : 0) + (flying?.canopy ? 1 : 0);
    if (!this.target || (this.view === "rocket" && flew !== this.flew)) this.begin(focus);
    else position.add(new Vector3(...subtract(focus, this.target)));
    this.flew = flew;
    this.target = focus;
    this.controls.target.set(...add(focus, this.offset));
    this.following = true; // the eye that we move ourselves asks for no other picture
    this.controls.update();
    this.following = false;
  }
  // The instants of a flight and the way itself, in the picture.
  namesOf(flight) {
    const seen = (points) => this.seenAt(points.map((point) => subtract(point, this.anchor)));
    const at = seen(flight.marks.map(({ t }) => flight.at(t).center));
    return { names: flight.marks.map(({ name }, i) => ({ name, x: at[i][0], y: at[i][1] })), way: seen(flight.some(SOME)), dots: seen(this.dots) };
  }
  // What the gauge shows: axes of I in the picture, pixels a metre and a newton where the view looks at.
  measured() {
    const { camera, controls } = this, d = camera.position.distanceTo(controls.target), e = camera.matrixWorldInverse.elements;
    const perMetre = this.pixels(d), flight = this.view === "path" && this.flights[this.watched()];
    const forces = this.view !== "path" && this.forces ? perMetre * this.forces.metresPerNewton : 0;
    return { axes: [0, 1, 2].map((i) => [e[4 * i], e[4 * i + 1]]), perMetre, perNewton: forces, ...(flight && this.namesOf(flight)) };
  }
}

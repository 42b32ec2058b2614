// The scene of a replay: bodies, light, eye. Everything is drawn from an anchor that moves with the
// launcher, so that small numbers stay small.
import { AmbientLight, DirectionalLight, HemisphereLight, PerspectiveCamera, Scene, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { carrierOf } from "./carriers.js";
import { Clamps } from "./clamps.js";
import { Grid, Horizon, Map, Path, Road, Sea } from "./ground.js";
import { Vehicle } from "./launcher.js";
import { Forces, Rocket } from "./rocket.js";
import { Pack, Rail, Tube } from "./tubes.js";
import { add, apply, scaled, subtract, turnedBack } from "./vector.js";

const FIELD = 32; // degrees that the eye takes in from top to bottom

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
    this.base = motion.vehicle ? new Vehicle(motion, this.scene) : carrierOf(motion, this.scene);
    this.road = motion.vehicle ? new Road(motion, this.scene) : null;
    this.grid = new Grid(motion.vehicle ? -0.02 : this.base.ground, this.base.sea, this.scene);
    this.sea = this.base.sea ? new Sea(this.base.ground, this.scene) : null;
    this.horizon = this.base.horizon ? new Horizon(this.scene) : null;
    this.pack = new Pack(motion, this.scene);
    this.tube = new (motion.guide.kind === "bore" ? Tube : Rail)(motion, this.scene);
    this.clamps = new Clamps(motion, this.scene);
    this.bodies = rockets.map(() => new Rocket(motion, this.scene));
    this.forces = new Forces(motion, this.scene);
    this.paths = flights.map((flight) => flight && new Path(flight, this.scene));
    this.map = this.paths.some(Boolean) ? new Map(this.extent(), this.scene) : null;
    this.thrust = Math.max(motion.largest("thrust"), 1e-9);
    this.scale = this.gap = 1;
    this.view = "launcher";
    this.target = null;
    this.seen = false; // nothing is drawn while the canvas is out of sight
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
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }
  paint(colour) {
    this.scene.background = null;
    this.renderer.setClearColor(colour("card"), 1);
    this.grid.paint(colour);
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
    this.anchor = motion.vehicle ? [state.chassis.r[0], 0, state.chassis.r[2]] : state.base.r;
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
    this.base.show(state, this.anchor);
    this.road?.show(this.anchor);
    this.grid.show(this.anchor);
    this.pack.show(state, this.anchor, launching, fired, this.view === "tube" || this.view === "rocket");
    this.clamps.show(state, this.anchor);
    const current = this.bodies[state.number];
    this.forces.show(state, this.anchor, state.rocket && !this.flying[state.number] ? current : null);
    const afar = this.view === "path";
    this.paths.forEach((path, i) => path?.show(this.anchor, this.flying[i], afar));
    this.map?.show(this.anchor, afar);
    this.sea?.show(this.anchor, !afar);
    this.follow();
    this.draw();
  }
  // Draws what is there as the eye sees it, where somebody can; the cut of the tube turns to the eye.
  draw() {
    const { state } = this, middle = apply(state.tube.A, [0.6 * this.motion.length, 0, 0]);
    const to = subtract(subtract(this.camera.position.toArray(), middle), subtract(state.tube.r, this.anchor));
    const [, y, z] = turnedBack(state.tube.A, to);
    this.tube.show(state, this.anchor, this.scale, Math.atan2(z, y));
    this.horizon?.show(this.camera.position, this.view !== "path");
    if (this.seen) this.render();
  }
  render() {
    this.renderer.render(this.scene, this.camera);
  }

  // ---- the eye ----

  // The rocket that is looked at: the one in the tube, or the last that has left.
  watched() {
    const { state } = this;
    if (state.rocket) return state.number;
    const flying = this.flying.map((flight, i) => (flight ? i : -1)).filter((i) => i >= 0);
    return flying.length > 0 ? flying.at(-1) : state.number;
  }
  // What a view looks at, from the anchor.
  aim() {
    const { motion, state, anchor } = this, inTube = (x) =>
      subtract(add(state.tube.r, apply(state.tube.A, [x, 0, 0])), anchor);
    const i = this.watched(), flying = this.flying[i];
    if (this.view === "path" && this.paths.some(Boolean)) return this.pathBox().centre;
    if (this.view === "rocket" && flying) return subtract(flying.center, anchor);
    if (this.view === "rocket" && state.rocket) return inTube(state.rocket.s + 0.5 * Math.max(...motion.adaptors));
    if (this.view === "launcher")
      return add(motion.vehicle ? [0, state.chassis.r[1], 0] : inTube(0.5 * motion.length), this.base.eye.aim);
    return inTube(0.55 * motion.length);
  }
  // From where, in the view's own place.
  stand() {
    const { motion, state } = this, wide = Math.max(1, 1.5 / this.camera.aspect);
    if (this.view === "path" && this.paths.some(Boolean)) {
      const { size } = this.pathBox();
      return scaled(1.05 * wide * Math.max(size, 1), [-0.3, 0.42, 1]);
    }
    const across = (v) => apply(state.tube.A, v);
    if (this.view === "rocket")
      return this.flying[this.watched()] ? scaled(wide * 2.2 * motion.length / 3, [-1.7, 0.9, 3.1])
        : across(scaled(wide * motion.length / 3, [0.5, 1.3, 3.2]));
    if (this.view === "tube") return across(scaled(wide * motion.length / 3, [0.6, 1.6, 6.4]));
    const { distance, direction } = this.base.eye;
    return scaled(wide * distance, direction);
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
  pathBox() {
    const { low, high } = this.extent();
    return { centre: subtract(scaled(0.5, add(low, high)), this.anchor), size: Math.hypot(...subtract(high, low)) };
  }
  look(view) {
    this.view = view;
    this.target = null;
  }
  // Moves eye and aim together with what the view follows.
  follow() {
    const aim = this.aim(), { position } = this.camera, flew = Boolean(this.flying[this.watched()]);
    if (!this.target || (this.view === "rocket" && flew !== this.flew)) {
      position.set(...add(aim, this.stand()));
      const far = Math.max(400, 6 * position.distanceTo(new Vector3(...aim)));
      this.camera.near = this.view === "path" ? far * 1e-4 : 0.05;
      this.camera.far = far;
      this.camera.updateProjectionMatrix();
    } else position.add(new Vector3(...subtract(aim, this.target)));
    this.flew = flew;
    this.target = aim;
    this.controls.target.set(...aim);
    this.following = true; // the eye that we move ourselves asks for no other picture
    this.controls.update();
    this.following = false;
  }
}

// What a launcher stands on: a road with its heights, a grid, and the way of a rocket in flight.
import { BufferAttribute, BufferGeometry, CircleGeometry, Float32BufferAttribute, Group, Line, LineLoop, LineSegments, Mesh,
  MeshBasicMaterial } from "three";
import { Line2 } from "three/examples/jsm/lines/Line2.js";
import { LineGeometry } from "three/examples/jsm/lines/LineGeometry.js";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { COLOURS } from "./launcher.js";
import { line, material } from "./shapes.js";

const MARGIN = 25, STEP = 0.1, HALF_WIDTH = 1.75, GRID = 40, CELL = 2;

// Height of a track at x: straight between its points, level beyond them.
function heightAt(points, x) {
  if (points.length === 0) return 0;
  let low = 0, high = points.length - 1;
  if (x <= points[0][0]) return points[0][1];
  if (x >= points[high][0]) return points[high][1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (points[middle][0] <= x) low = middle;
    else high = middle;
  }
  const [x0, h0] = points[low], [x1, h1] = points[high];
  return h0 + ((h1 - h0) * (x - x0)) / (x1 - x0 || 1);
}

// A strip over both tracks, with a line across at each metre.
export class Road {
  constructor(motion, group) {
    const [left, right] = motion.road();
    const ends = [...left, ...right].map(([x]) => x);
    const from = Math.floor(Math.min(...ends) - MARGIN), to = Math.ceil(Math.max(...ends) + MARGIN);
    const rows = Math.round((to - from) / STEP) + 1, position = [], index = [], marks = [];
    for (let i = 0; i < rows; i++) {
      const x = from + STEP * i, a = heightAt(left, x), b = heightAt(right, x);
      position.push(x - from, a, -HALF_WIDTH, x - from, b, HALF_WIDTH);
      if (i + 1 < rows) index.push(2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 2, 2 * i + 1, 2 * i + 3);
      if (i % 10 === 0) marks.push(x - from, a + 0.006, -HALF_WIDTH, x - from, b + 0.006, HALF_WIDTH);
    }
    const surface = new BufferGeometry(), across = new BufferGeometry();
    surface.setAttribute("position", new Float32BufferAttribute(position, 3));
    surface.setIndex(index);
    surface.computeVertexNormals();
    across.setAttribute("position", new Float32BufferAttribute(marks, 3));
    this.from = from;
    this.surface = material(0xffffff);
    this.marks = line(0xffffff);
    this.group = new Group();
    this.group.add(new Mesh(surface, this.surface), new LineSegments(across, this.marks));
    group.add(this.group);
  }
  show(anchor) {
    this.group.position.set(this.from - anchor[0], -anchor[1], -anchor[2]);
  }
  paint(colour) {
    this.surface.color.set(colour("line"));
    this.marks.color.set(colour("soft"));
  }
}

// A grid of lines that continues as far as one sees; `sea`: on water.
export class Grid {
  constructor(height, sea, group) {
    const points = [];
    for (let i = -GRID; i <= GRID; i += CELL)
      for (let j = -GRID; j < GRID; j += CELL) points.push(i, 0, j, i, 0, j + CELL, j, 0, i, j + CELL, 0, i);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(points, 3));
    this.height = height;
    this.colour = sea ? "card" : "line";
    this.stroke = line(0xffffff, { transparent: true, opacity: sea ? 0.5 : 0.8 });
    this.lines = new LineSegments(geometry, this.stroke);
    group.add(this.lines);
  }
  show(anchor) {
    const rest = (v) => v - CELL * Math.round(v / CELL);
    this.lines.position.set(-rest(anchor[0]), this.height - anchor[1], -rest(anchor[2]));
  }
  paint(colour) {
    this.stroke.color.set(colour(this.colour));
  }
}

const FAR = 380; // radius of what is seen of sea and horizon

// A flat sea as far as one sees; what is below it is seen through it.
export class Sea {
  constructor(height, group) {
    this.height = height;
    this.water = new MeshBasicMaterial({ transparent: true, opacity: 0.72, depthWrite: false });
    this.disc = new Mesh(new CircleGeometry(FAR, 96).rotateX(-Math.PI / 2), this.water);
    this.disc.renderOrder = -1;
    group.add(this.disc);
  }
  show(anchor, visible) {
    this.disc.visible = visible;
    this.disc.position.y = this.height - anchor[1] - 0.01;
  }
  paint(colour) {
    this.water.color.set(colour("sea"));
  }
}

// The horizon around an eye far above the ground.
export class Horizon {
  constructor(group) {
    const points = Array.from({ length: 96 }, (_, i) => (2 * Math.PI * i) / 96)
      .flatMap((angle) => [FAR * Math.cos(angle), 0, FAR * Math.sin(angle)]), geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(points, 3));
    this.stroke = line(0xffffff);
    this.circle = new LineLoop(geometry, this.stroke);
    this.circle.frustumCulled = false;
    group.add(this.circle);
  }
  show(eye, visible) {
    this.circle.visible = visible;
    this.circle.position.copy(eye);
  }
  paint(colour) {
    this.stroke.color.set(colour("soft"));
  }
}

// The ground below all flights, in squares of a round size.
export class Map {
  constructor({ low, high }, group) {
    const size = Math.max(high[0] - low[0], high[2] - low[2], high[1] - low[1], 1);
    const power = 10 ** Math.floor(Math.log10(size / 6)), points = [];
    this.cell = [1, 2, 5, 10].map((f) => f * power).find((s) => s >= size / 10);
    const ends = [0, 2].map((i) => [Math.floor(low[i] / this.cell) - 1, Math.ceil(high[i] / this.cell) + 1]);
    this.origin = [ends[0][0] * this.cell, Math.min(0, low[1]), ends[1][0] * this.cell];
    const n = ends.map(([from, to]) => to - from), c = this.cell;
    for (let i = 0; i <= n[0]; i++)
      for (let j = 0; j < n[1]; j++) points.push(i * c, 0, j * c, i * c, 0, (j + 1) * c);
    for (let j = 0; j <= n[1]; j++)
      for (let i = 0; i < n[0]; i++) points.push(i * c, 0, j * c, (i + 1) * c, 0, j * c);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(points, 3));
    this.stroke = line(0xffffff);
    this.lines = new LineSegments(geometry, this.stroke);
    this.lines.frustumCulled = false;
    group.add(this.lines);
  }
  show(anchor, visible) {
    this.lines.visible = visible;
    this.lines.position.set(...this.origin.map((v, i) => v - anchor[i]));
  }
  paint(colour) {
    this.stroke.color.set(colour("line"));
  }
}

// The line that a rocket in flight pulls.
export class Pulled {
  constructor(flight, group) {
    this.geometry = new BufferGeometry();
    this.geometry.setAttribute("position", new Float32BufferAttribute(new Float32Array(3 * flight.line.length), 3));
    this.drawn = new Line(this.geometry, line(COLOURS.line));
    this.drawn.frustumCulled = false;
    group.add(this.drawn);
  }
  show(anchor, state) {
    this.drawn.visible = Boolean(state);
    if (!state) return;
    const { position } = this.geometry.attributes;
    state.line.forEach((place, i) => position.setXYZ(i, ...place.map((v, k) => v - anchor[k])));
    position.needsUpdate = true;
  }
}

// The way of a rocket: all of it faint, what it has flown strong.
export class Path {
  constructor(flight, group) {
    const [x, y, z] = flight.points(), points = [];
    this.origin = [x[0], y[0], z[0]];
    for (let i = 0; i < x.length; i++) points.push(x[i] - x[0], y[i] - y[0], z[i] - z[0]);
    const geometry = () => {
      const made = new BufferGeometry();
      made.setAttribute("position", new BufferAttribute(new Float32Array(points), 3));
      return made;
    };
    this.whole = new Line(geometry(), line(COLOURS.rocket, { transparent: true, opacity: 0.6 }));
    this.flown = new Line(geometry(), line(COLOURS.rocket));
    this.wide = new Line2(new LineGeometry().setPositions(points), new LineMaterial({ color: COLOURS.rocket, linewidth: 2.5, transparent: true, opacity: 0.6 }));
    this.wide.frustumCulled = false;
    const track = new BufferGeometry(), ground = Math.min(0, ...y) - y[0];
    track.setAttribute("position", new Float32BufferAttribute(points.map((v, i) => (i % 3 === 1 ? ground : v)), 3));
    this.track = new Line(track, line(COLOURS.other, { transparent: true, opacity: 0.7 }));
    this.track.frustumCulled = this.whole.frustumCulled = this.flown.frustumCulled = false;
    this.group = new Group();
    this.group.add(this.track, this.whole, this.flown, this.wide);
    group.add(this.group);
  }
  show(anchor, state, afar) {
    this.group.position.set(...this.origin.map((v, i) => v - anchor[i]));
    this.track.visible = afar;
    this.flown.visible = Boolean(state);
    if (state) this.flown.geometry.setDrawRange(0, state.row + 1);
  }
}

// A canopy that is a body of its own, and its lines, to that end of the rocket which is nearer.
import { BufferGeometry, Float32BufferAttribute, LineSegments, Mesh, SphereGeometry, Vector3 } from "three";
import { COLOURS } from "./launcher.js";
import { line, material, point } from "./shapes.js";
import { add, apply, scaled, subtract, unit } from "./vector.js";

const LINES = 12, skirt = new Vector3();

// Of a round canopy with a drag coefficient of 0.75, which is filled to two thirds of its diameter.
export const radiusOf = (dragArea) => Math.max(0.08, Math.sqrt((4 * Math.max(0, dragArea)) / (0.75 * Math.PI)) / 3);

export class Canopy {
  constructor(motion, length, group) {
    this.ends = [-motion.center, length - motion.center];
    this.dome = new Mesh(new SphereGeometry(1, 24, 8, 0, 2 * Math.PI, 0, Math.PI / 2), material(COLOURS.rocket));
    this.geometry = new BufferGeometry();
    this.geometry.setAttribute("position", new Float32BufferAttribute(new Float32Array(6 * LINES), 3));
    this.lines = new LineSegments(this.geometry, line(COLOURS.hub));
    this.dome.frustumCulled = this.lines.frustumCulled = false;
    group.add(this.dome, this.lines);
  }
  show(anchor, state) {
    this.dome.visible = this.lines.visible = Boolean(state?.canopy);
    if (!this.dome.visible) return;
    this.center = subtract(state.center, anchor);
    this.offset = subtract(state.canopy.at, state.center);
    this.radius = radiusOf(state.canopy.area);
    const away = (l) => Math.hypot(...subtract(this.offset, apply(state.A, [l, 0, 0])));
    this.end = apply(state.A, [away(this.ends[0]) < away(this.ends[1]) ? this.ends[0] : this.ends[1], 0, 0]);
    this.enlarge(1);
  }
  // With the rocket, so many times as large about its mass centre.
  enlarge(times) {
    if (!this.dome.visible) return;
    const at = add(this.center, scaled(times, this.offset)), end = add(this.center, scaled(times, this.end)), r = times * this.radius;
    const reach = subtract(at, end), e = Math.hypot(...reach) > 0 ? unit(reach) : [0, 1, 0];
    point(this.dome, at, e);
    this.dome.scale.set(r, 0.7 * r, r);
    this.dome.updateMatrixWorld();
    const { position } = this.geometry.attributes;
    for (let i = 0; i < LINES; i++) {
      const angle = (2 * Math.PI * i) / LINES;
      this.dome.localToWorld(skirt.set(Math.cos(angle), 0, Math.sin(angle)));
      position.setXYZ(2 * i, ...end);
      position.setXYZ(2 * i + 1, skirt.x, skirt.y, skirt.z);
    }
    position.needsUpdate = true;
  }
}

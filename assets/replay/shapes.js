// Bodies for the scene: surfaces around a curve, boxes and cylinders with their edges.
import { BoxGeometry, BufferAttribute, BufferGeometry, CylinderGeometry, DoubleSide, EdgesGeometry, Group, LineBasicMaterial,
  LineSegments, Mesh, MeshLambertMaterial } from "three";
import { add, cross, dot, scaled, subtract, unit } from "./vector.js";

// A tube of circles about points of a curve, moved as often as one likes.
export class Sleeve {
  constructor(rings, segments, material) {
    this.rings = rings;
    this.segments = segments;
    this.position = new BufferAttribute(new Float32Array(rings * (segments + 1) * 3), 3);
    this.normal = new BufferAttribute(new Float32Array(rings * (segments + 1) * 3), 3);
    this.geometry = new BufferGeometry();
    this.geometry.setAttribute("position", this.position);
    this.geometry.setAttribute("normal", this.normal);
    const index = [];
    for (let j = 0; j + 1 < rings; j++)
      for (let i = 0; i < segments; i++) {
        const a = j * (segments + 1) + i, b = a + segments + 1;
        index.push(a, a + 1, b, b, a + 1, b + 1);
      }
    this.geometry.setIndex(index);
    this.mesh = new Mesh(this.geometry, material);
    this.mesh.frustumCulled = false;
  }
  // Curve: a list of { at: [x, y, z], radius, slope of the radius }; between the angles `from` and
  // `to` about the curve's direction, from y towards z.
  draw(curve, from = 0, to = 2 * Math.PI) {
    curve.forEach((ring, j) => {
      const { along, up, side } = framesAt(curve, j), radius = ring.radius, slope = ring.slope ?? 0;
      for (let i = 0; i <= this.segments; i++) {
        const angle = from + ((to - from) * i) / this.segments, c = Math.cos(angle), s = Math.sin(angle);
        const out = add(scaled(c, up), scaled(s, side)), k = j * (this.segments + 1) + i;
        this.position.setXYZ(k, ...add(ring.at, scaled(radius, out)));
        this.normal.setXYZ(k, ...unit(subtract(out, scaled(slope, along))));
      }
    });
    this.position.needsUpdate = this.normal.needsUpdate = true;
  }
  // Centre of a ring, from the vertices as they are drawn.
  centre(ring) {
    const sum = [0, 0, 0], n = this.segments;
    for (let i = 0; i < n; i++) {
      const k = ring * (n + 1) + i;
      sum[0] += this.position.getX(k);
      sum[1] += this.position.getY(k);
      sum[2] += this.position.getZ(k);
    }
    return scaled(1 / n, sum);
  }
  // Radius of a ring, from the vertices as they are drawn.
  radius(ring) {
    const k = ring * (this.segments + 1);
    return Math.hypot(...subtract([this.position.getX(k), this.position.getY(k), this.position.getZ(k)],
      this.centre(ring)));
  }
}

// Beams side by side: profiles of four corners along the same rings, moved as often as one likes.
export class Beams {
  constructor(parts, rings, surface, stroke) {
    Object.assign(this, { parts, rings });
    const count = 4 * parts * rings, faces = [], edges = [];
    const at = (part, ring, corner) => 4 * (part * rings + ring) + (corner % 4);
    const quad = (a, b, c, d) => faces.push(a, b, c, a, c, d);
    for (let part = 0; part < parts; part++) {
      for (let ring = 0; ring + 1 < rings; ring++)
        for (let i = 0; i < 4; i++) {
          quad(at(part, ring, i), at(part, ring, i + 1), at(part, ring + 1, i + 1), at(part, ring + 1, i));
          edges.push(at(part, ring, i), at(part, ring + 1, i));
        }
      for (const ring of [0, rings - 1]) {
        quad(at(part, ring, 0), at(part, ring, 1), at(part, ring, 2), at(part, ring, 3));
        for (let i = 0; i < 4; i++) edges.push(at(part, ring, i), at(part, ring, i + 1));
      }
    }
    this.position = new BufferAttribute(new Float32Array(3 * count), 3);
    const geometry = (index) => {
      const made = new BufferGeometry();
      made.setAttribute("position", this.position);
      made.setIndex(index);
      return made;
    };
    this.group = new Group();
    this.group.add(new Mesh(geometry(faces), surface), new LineSegments(geometry(edges), stroke));
    for (const child of this.group.children) child.frustumCulled = false;
  }
  // `corner(part, ring, i)`: where corner i of a profile is.
  draw(corner) {
    let k = 0;
    for (let part = 0; part < this.parts; part++)
      for (let ring = 0; ring < this.rings; ring++)
        for (let i = 0; i < 4; i++) this.position.setXYZ(k++, ...corner(part, ring, i));
    this.position.needsUpdate = true;
  }
  // Mean of a profile's corners, from the vertices as they are drawn.
  centre(part, ring) {
    const sum = [0, 0, 0];
    for (let i = 0; i < 4; i++) {
      const k = 4 * (part * this.rings + ring) + i;
      sum[0] += this.position.getX(k) / 4;
      sum[1] += this.position.getY(k) / 4;
      sum[2] += this.position.getZ(k) / 4;
    }
    return sum;
  }
}

// Directions at a point of a curve: along it, and across it from y and z.
function framesAt(curve, j) {
  const a = curve[Math.max(0, j - 1)].at, b = curve[Math.min(curve.length - 1, j + 1)].at;
  const step = subtract(b, a), along = Math.hypot(...step) > 0 ? unit(step) : [1, 0, 0];
  const up = unit(subtract([0, 1, 0], scaled(dot([0, 1, 0], along), along)));
  return { along, up, side: cross(along, up) };
}

// Seen from both sides, all of them: the fewer kinds, the fewer programs the browser has to compile.
export const material = (color, more = {}) => new MeshLambertMaterial({ color, side: DoubleSide, ...more });
export const angular = (color, more = {}) => material(color, { flatShading: true, ...more });

// A body with its edges drawn.
function edged(geometry, surface, edge) {
  const group = new Group();
  group.add(new Mesh(geometry, surface));
  if (edge) group.add(new LineSegments(new EdgesGeometry(geometry, 25), edge));
  return group;
}

// A box between two corners.
export function box(low, high, surface, edge) {
  const made = edged(new BoxGeometry(...subtract(high, low)), surface, edge);
  made.position.set(...scaled(0.5, add(low, high)));
  return made;
}

// A cylinder from one point to another.
export function cylinder(from, to, radius, surface, edge, segments = 24) {
  const axis = subtract(to, from), length = Math.hypot(...axis);
  const made = edged(new CylinderGeometry(radius, radius, length, segments), surface, edge);
  point(made, scaled(0.5, add(from, to)), axis);
  return made;
}

// A prism: a plane polygon without hollows, and the same moved by a vector.
export function prism(polygon, along, surface, edge) {
  const moved = polygon.map((p) => add(p, along)), faces = [];
  for (let i = 2; i < polygon.length; i++)
    for (const side of [polygon, moved]) faces.push(side[0], side[i - 1], side[i]);
  polygon.forEach((a, i) => {
    const k = (i + 1) % polygon.length;
    faces.push(a, polygon[k], moved[k], a, moved[k], moved[i]);
  });
  return edged(flat(faces), surface, edge);
}

// A surface over lists of points, as many in each.
export function loft(lists, surface, edge) {
  const faces = [];
  for (let j = 0; j + 1 < lists.length; j++)
    for (let i = 0; i + 1 < lists[j].length; i++) {
      const [a, b, c, d] = [lists[j][i], lists[j][i + 1], lists[j + 1][i + 1], lists[j + 1][i]];
      faces.push(a, b, c, a, c, d);
    }
  return edged(flat(faces), surface, edge);
}

// Triangles with a colour each.
export function faceted({ corners, colours }, surface, edge) {
  const geometry = flat(corners);
  geometry.setAttribute("color", new BufferAttribute(new Float32Array(colours.flatMap((rgb) => [...rgb, ...rgb, ...rgb])), 3));
  return edged(geometry, surface, edge);
}

// Triangles by their corners, each with its own direction.
function flat(corners) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(corners.flat()), 3));
  geometry.computeVertexNormals();
  return geometry;
}

// Puts an object's y axis along a direction.
export function point(object, at, direction) {
  object.position.set(...at);
  const [x, y, z] = unit(direction);
  // the shortest turn from y to the direction
  if (y < -0.999999) object.quaternion.set(1, 0, 0, 0);
  else object.quaternion.set(z, 0, -x, 1 + y).normalize();
}

export const line = (color, more = {}) => new LineBasicMaterial({ color, ...more });

// Puts an object in a frame given by origin and matrix by rows.
export function place(object, r, A) {
  object.matrixAutoUpdate = false;
  object.matrix.set(A[0], A[1], A[2], r[0], A[3], A[4], A[5], r[1], A[6], A[7], A[8], r[2], 0, 0, 0, 1);
  object.matrixWorldNeedsUpdate = true;
}

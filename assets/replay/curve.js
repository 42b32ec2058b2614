// The axis of a beam or tube that bends by its shapes.
import { rotation } from "./vector.js";

const sum = (shapes, q, from) => (shapes ?? []).reduce((total, shape, i) => total + shape * q[from + i], 0);

// The shapes of a tube or beam in the geometry, by its name there: rows over the stations.
export function shapesOf(rows, name) {
  const b = rows(`${name}.bending`), slope = rows(`${name}.bending_slope`);
  const or = (list, other) => (list.length > 0 ? list : other);
  return { stations: rows(`${name}.station`).map(([x]) => x), b: [b, or(rows(`${name}.bending_z`), b)],
    slope: [slope, or(rows(`${name}.bending_z_slope`), slope)], torsion: rows(`${name}.torsion`), modes: b[0]?.length ?? 0,
    count: 2 * (b[0]?.length ?? 0) + (rows(`${name}.torsion`)[0]?.length ?? 0) };
}

// At each station: the offsets u along y and z with their slopes, the twist, point and axes in the undeformed frame.
export function nodesOf({ stations, b, slope, torsion, modes }, q) {
  return stations.map((x, k) => {
    const u = [0, 1].map((plane) => sum(b[plane][k], q, plane * modes)), s = [0, 1].map((plane) => sum(slope[plane][k], q, plane * modes));
    const twist = sum(torsion[k], q, 2 * modes);
    return { x, u, slope: s, twist, P: [x, ...u], A: rotation([twist, -s[1], s[0]]) };
  });
}

// The initial shape of a guide at a station: offsets u with their slopes, twist; rows of station, y, z, twist and their
// derivatives, cubic between. Undefined where the guide is straight.
export function initialOf(rows) {
  if (rows.length < 2) return undefined;
  return (x) => {
    let k = 0, last = rows.length - 2;
    for (let end = last + 1; end - k > 1;) {
      const middle = (k + end) >> 1;
      if (x < rows[middle][0]) end = middle; else k = middle;
    }
    const a = rows[Math.min(k, last)], b = rows[Math.min(k, last) + 1], h = b[0] - a[0], xi = (x - a[0]) / h;
    const [y, z, twist] = [1, 2, 3].map((i) => {
      const s = (b[i] - a[i]) / h, c = 3 * s - 2 * a[i + 3] - b[i + 3], e = a[i + 3] + b[i + 3] - 2 * s;
      return [a[i] + h * xi * (a[i + 3] + xi * (c + xi * e)), a[i + 3] + xi * (2 * c + 3 * xi * e)];
    });
    return { u: [y[0], z[0]], slope: [y[1], z[1]], twist: twist[0] };
  };
}

// Point and axes at any station by the elements' own cubics; straight on beyond the ends.
export function sectionOf(nodes, x, initial) {
  const last = nodes.length - 2, length = nodes.at(-1).x;
  let k = Math.min(last, Math.max(0, Math.floor((x / length) * (last + 1))));
  while (k > 0 && x < nodes[k].x) k--;
  while (k < last && x > nodes[k + 1].x) k++;
  const a = nodes[k], b = nodes[k + 1], h = b.x - a.x, inside = Math.min(b.x, Math.max(a.x, x));
  const xi = (inside - a.x) / h, beyond = x - inside;
  const H = [1 + xi * xi * (2 * xi - 3), h * xi * (1 + xi * (xi - 2)), xi * xi * (3 - 2 * xi), h * xi * xi * (xi - 1)];
  const D = [(6 * xi * (xi - 1)) / h, 1 + xi * (3 * xi - 4), (6 * xi * (1 - xi)) / h, xi * (3 * xi - 2)];
  const by = (f, i) => f[0] * a.u[i] + f[1] * a.slope[i] + f[2] * b.u[i] + f[3] * b.slope[i];
  const more = initial?.(inside) ?? { u: [0, 0], slope: [0, 0], twist: 0 };
  const u = [by(H, 0) + more.u[0], by(H, 1) + more.u[1]], slope = [by(D, 0) + more.slope[0], by(D, 1) + more.slope[1]];
  return { P: [x, u[0] + beyond * slope[0], u[1] + beyond * slope[1]],
    A: rotation([a.twist + xi * (b.twist - a.twist) + more.twist, -slope[1], slope[0]]) };
}

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

// Point and axes at any station by the elements' own cubics; straight on beyond the ends.
export function sectionOf(nodes, x) {
  const last = nodes.length - 2, length = nodes.at(-1).x;
  let k = Math.min(last, Math.max(0, Math.floor((x / length) * (last + 1))));
  while (k > 0 && x < nodes[k].x) k--;
  while (k < last && x > nodes[k + 1].x) k++;
  const a = nodes[k], b = nodes[k + 1], h = b.x - a.x, inside = Math.min(b.x, Math.max(a.x, x));
  const xi = (inside - a.x) / h, beyond = x - inside;
  const H = [1 + xi * xi * (2 * xi - 3), h * xi * (1 + xi * (xi - 2)), xi * xi * (3 - 2 * xi), h * xi * xi * (xi - 1)];
  const D = [(6 * xi * (xi - 1)) / h, 1 + xi * (3 * xi - 4), (6 * xi * (1 - xi)) / h, xi * (3 * xi - 2)];
  const by = (f, i) => f[0] * a.u[i] + f[1] * a.slope[i] + f[2] * b.u[i] + f[3] * b.slope[i], slope = [by(D, 0), by(D, 1)];
  return { P: [x, by(H, 0) + beyond * slope[0], by(H, 1) + beyond * slope[1]],
    A: rotation([a.twist + xi * (b.twist - a.twist), -slope[1], slope[0]]) };
}

// Vectors [x, y, z] and matrices by rows [9], as plain arrays.

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scaled = (s, a) => [s * a[0], s * a[1], s * a[2]];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) =>
  [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const unit = (a) => scaled(1 / Math.hypot(...a), a);

export const apply = (A, v) => [0, 3, 6].map((i) => A[i] * v[0] + A[i + 1] * v[1] + A[i + 2] * v[2]);
export const turnedBack = (A, v) => [0, 1, 2].map((i) => A[i] * v[0] + A[i + 3] * v[1] + A[i + 6] * v[2]);

export function multiply(A, B) {
  const C = [];
  for (let i = 0; i < 9; i += 3)
    for (let j = 0; j < 3; j++) C.push(A[i] * B[j] + A[i + 1] * B[j + 3] + A[i + 2] * B[j + 6]);
  return C;
}

export function aboutX(angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return [1, 0, 0, 0, c, -s, 0, s, c];
}
export function aboutY(angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return [c, 0, s, 0, 1, 0, -s, 0, c];
}
export function aboutZ(angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return [c, -s, 0, s, c, 0, 0, 0, 1];
}

// A body's attitude from its angles.
export const pose = (yaw, pitch, roll) => multiply(multiply(aboutY(yaw), aboutZ(pitch)), aboutX(roll));

// The rotation by a rotation vector.
export function rotation(v) {
  const angle = Math.hypot(...v), a = angle < 1e-9 ? 1 : Math.sin(angle) / angle;
  const b = angle < 1e-9 ? 0.5 : (1 - Math.cos(angle)) / (angle * angle);
  const [x, y, z] = v, c = 1 - b * (x * x + y * y + z * z);
  return [c + b * x * x, b * x * y - a * z, b * x * z + a * y,
    b * x * y + a * z, c + b * y * y, b * y * z - a * x,
    b * x * z - a * y, b * y * z + a * x, c + b * z * z];
}

// The rotation vector of a rotation.
export function turnOf(A) {
  const cosine = Math.min(1, Math.max(-1, 0.5 * (A[0] + A[4] + A[8] - 1))), angle = Math.acos(cosine);
  const v = [A[7] - A[5], A[2] - A[6], A[3] - A[1]], sine = 0.5 * Math.hypot(...v);
  if (angle < 3) return scaled(sine < 1e-9 ? 0.5 : angle / (2 * sine), v);
  // near half a turn by the largest column of A + E
  const k = [0, 4, 8].reduce((best, i) => (A[i] > A[best] ? i : best), 0) / 4, column = [0, 3, 6].map((i) => A[i + k] + (i === 3 * k ? 1 : 0));
  return scaled(dot(column, v) < 0 ? -angle : angle, unit(column));
}

// Between two frames { r, A }, at a share of the way.
export function between(a, b, share) {
  const turn = turnOf(multiply(transposed(a.A), b.A));
  return { r: add(scaled(1 - share, a.r), scaled(share, b.r)), A: multiply(a.A, rotation(scaled(share, turn))) };
}

const transposed = (A) => [0, 3, 6, 1, 4, 7, 2, 5, 8].map((i) => A[i]);

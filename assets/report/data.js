// The numbers of a report: decoding, and where a row or an instant lies.

function bytes(text) {
  const raw = atob(text), out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
  return out;
}

function floats(text) {
  const b = bytes(text), view = new DataView(b.buffer);
  return Float64Array.from({ length: b.length / 4 }, (_, i) => view.getFloat32(i * 4, true));
}

// Running sums of steps from `from`, each of seven bits a byte, the lowest first.
function sums(text, from) {
  const out = [];
  let sum = from, step = 0, weight = 1;
  for (const b of bytes(text)) {
    step += (b & 127) * weight;
    weight *= 128;
    if (b & 128) continue;
    out.push((sum += step));
    step = 0;
    weight = 1;
  }
  return out;
}

// A table with times and, for each column, a value for each time: undefined where the curve needs
// none there, null where there is none.
export function decodeTable(table) {
  const parts = table.segments.map((segment) => ({
    ...segment, t: sums(segment.t, 0).map((ns) => segment.from + ns * 1e-9),
  }));
  const t = [], column = new Map();
  let full = 0;
  for (const part of parts) {
    part.first = t.length;
    for (const time of part.t) t.push(time);
    part.end = t.length;
    full += part.of;
  }
  table.columns.forEach(([name, unit], c) => {
    const value = new Array(t.length).fill(undefined);
    for (const part of parts) {
      const rows = part.rows[c] === null ? null : sums(part.rows[c], -1);
      floats(part.values[c]).forEach((v, i) => {
        value[part.first + (rows ? rows[i] : i)] = Number.isFinite(v) ? v : null;
      });
    }
    column.set(name, { name, unit, value });
  });
  return { kind: table.kind, rocket: table.rocket, t, column, full };
}

// Index of the last time not after `time`; -1 before the first.
export function rowAt(t, time) {
  let low = -1, high = t.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (t[middle] <= time) low = middle;
    else high = middle;
  }
  return low;
}

// All rows of a column: straight lines between those that it keeps, NaN in gaps.
export function filled(value, t) {
  const out = new Float64Array(t.length).fill(NaN);
  let last = -1;
  for (let i = 0; i < t.length; i++) {
    if (value[i] === undefined) continue;
    if (value[i] === null) { last = -1; continue; }
    out[i] = value[i];
    for (let j = last + 1; last >= 0 && j < i; j++)
      out[j] = out[last] + ((out[i] - out[last]) * (t[j] - t[last])) / (t[i] - t[last]);
    last = i;
  }
  return out;
}

// Columns that a pattern with one '*' names, with the text that it stands for.
export function matching(table, pattern) {
  const star = pattern.indexOf("*");
  if (star < 0) return table.column.has(pattern) ? [[table.column.get(pattern), ""]] : [];
  const head = pattern.slice(0, star), tail = pattern.slice(star + 1), found = [];
  for (const column of table.column.values())
    if (column.name.length > pattern.length - 1 && column.name.startsWith(head) &&
        column.name.endsWith(tail))
      found.push([column, column.name.slice(star, column.name.length - tail.length)]);
  return found;
}

// Six digits, or so many, as a person reads them.
export function readable(value, digits = 6) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e7)) return value.toExponential(digits - 1);
  return String(Number(value.toPrecision(digits)));
}

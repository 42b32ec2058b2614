// The numbers of a report: decoding, and where a row or an instant lies.
import { unzlibSync } from "fflate";

// Bytes from base64 of a deflated text.
export function inflated(text) {
  const raw = atob(text), bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
  return unzlibSync(bytes);
}

// Reads counts and columns of numbers one after the other.
class Reader {
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0;
  }
  // Seven bits a byte, the lowest first.
  count() {
    let value = 0, weight = 1, byte;
    do {
      byte = this.bytes[this.at++];
      value += (byte & 127) * weight;
      weight *= 128;
    } while (byte & 128);
    return value;
  }
  // Running sums of `length` steps from `from`.
  sums(length, from) {
    const out = new Array(length);
    for (let i = 0, sum = from; i < length; i++) out[i] = sum += this.count();
    return out;
  }
  // Single-precision numbers from second differences of their bits, the lowest bytes of all first,
  // on top of an offset.
  floats(length) {
    const offset = new DataView(this.bytes.buffer, this.bytes.byteOffset + this.at).getFloat64(0, true);
    this.at += 8;
    const { bytes, at } = this, out = new Array(length);
    const bits = new Uint32Array(1), single = new Float32Array(bits.buffer);
    this.at += 4 * length;
    for (let i = 0, before = 0, step = 0; i < length; i++) {
      const folded = bytes[at + i] | (bytes[at + length + i] << 8) |
        (bytes[at + 2 * length + i] << 16) | (bytes[at + 3 * length + i] << 24);
      step = (step + ((folded >>> 1) ^ -(folded & 1))) | 0;
      before = (before + step) | 0;
      bits[0] = before < 0 ? before ^ 0x80000000 : ~before;
      out[i] = offset + single[0];
    }
    return out;
  }
}

// A table with times and, for each column, a value for each time: undefined where the curve needs
// none there, null where there is none.
export function decodeTable(table) {
  const t = [], column = new Map(table.columns.map(([name, unit]) => [name, { name, unit, value: [] }]));
  const segments = [];
  let full = 0;
  for (const { name, of, from, count, data } of table.segments) {
    const reader = new Reader(inflated(data)), first = t.length;
    for (const ns of reader.sums(count, 0)) t.push(from + ns * 1e-9);
    for (const { value } of column.values()) {
      const kept = reader.count();
      const rows = kept < count ? reader.sums(kept, -1) : null;
      value.length = t.length;
      value.fill(undefined, first);
      reader.floats(kept).forEach((v, i) => {
        value[first + (rows ? rows[i] : i)] = Number.isFinite(v) ? v : null;
      });
    }
    segments.push({ name, first, end: t.length });
    full += of;
  }
  return { kind: table.kind, rocket: table.rocket, marks: table.marks, t, column, full, segments };
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

// The numbers of a report, decoded.
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

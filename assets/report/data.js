// The numbers of a report: where a row or an instant lies, how they are read.

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

// Round steps that cut a range into about `count` parts, two ticks at least.
export function ticks(low, high, count) {
  const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((f) => f * power).find((s) => s >= raw);
  const out = [];
  for (let k = Math.ceil(low / step); k * step <= high; k++) out.push(k * step);
  return out.length > 1 || !(high > low) ? out : ticks(low, high, 2 * count);
}

// Texts of ticks, to so many digits that neighbours differ.
export function tickTexts(values) {
  const step = values[1] - values[0] || 1;
  return values.map((v) => {
    if (Math.abs(v) < step / 1e6) return "0";
    const digits = Math.ceil(Math.log10(Math.abs(v) / step)) + 2;
    return String(Number(v.toPrecision(Math.min(15, Math.max(1, digits))))).replace("-", "−");
  });
}

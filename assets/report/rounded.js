// Numbers as people say them: three or four digits, in a unit of their size.

// Units of a size, each from so much of it on.
const SIZES = { m: [["km", 1e-3, 1], ["m", 1, 1], ["mm", 1e3, 0.01], ["µm", 1e6, 0]], N: [["kN", 1e-3, 1], ["N", 1, 0]],
  s: [["s", 1, 1], ["ms", 1e3, 0]] };

const superscript = (text) => [...String(text)].map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] ?? "⁻").join("");

// Three digits, zeros too, of whole thousands all.
export function rounded(value) {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size === 0) return "0";
  if (size < 1e-3 || size >= 1e6) {
    const [head, power] = value.toExponential(1).split("e");
    return `${head.replace("-", "−")}·10${superscript(Number(power))}`;
  }
  const text = size >= 1000 ? String(Math.round(value)) : value.toPrecision(3);
  return text.replace("-", "−");
}

// The unit of a value's size, and the factor to it.
function sizeOf(value, unit) {
  const size = Math.abs(value) || 1e-3; // none is so many mm, N, ms
  return (SIZES[unit] ?? [[unit, 1, 0]]).find(([, f, least]) => size * f >= 0.9995 * least);
}

// A number in SI with its unit, in one of their size; `like`: whose size the unit has.
export function inUnit(value, unit, like = value) {
  const [name, factor] = sizeOf(like, unit);
  return [rounded(value * factor), name];
}

// ---- numbers that play

// With so many decimals, and as wide as the widest of its range: behind spaces of a digit's width.
export function fixed(value, places, [low, high]) {
  const text = (v) => (!Number.isFinite(v) ? "–" : Number(v.toFixed(places)) === 0 ? (0).toFixed(places) : v.toFixed(places).replace("-", "−"));
  return text(value).padStart(Math.max(text(low).length, text(high).length), "\u2007");
}

// A number in SI with its unit, both by the end of its range that is farther from none: that one has so many digits.
export function playing(value, unit, [low, high], digits = 3) {
  const most = Math.max(-low, high), [name, factor] = sizeOf(most, unit);
  const power = Number((factor * most).toExponential(digits - 1).split("e")[1]);
  const places = Math.min(4, Math.max(0, digits - 1 - power));
  return `${fixed(factor * value, places, [factor * low, factor * high])} ${name}`;
}

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

// A number in SI with its unit, in one of their size; `like`: whose size the unit has.
export function inUnit(value, unit, like = value) {
  const sizes = SIZES[unit] ?? [[unit, 1, 0]];
  const size = Math.abs(like) || 1e-3; // none is so many mm, N, ms
  const [name, factor] = sizes.find(([, f, least]) => size * f >= 0.9995 * least);
  return [rounded(value * factor), name];
}

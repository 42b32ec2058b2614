// Numbers as people say them: three or four digits, in a unit of their size.

const SIZES = { m: [["km", 1e-3], ["m", 1], ["mm", 1e3]], N: [["kN", 1e-3], ["N", 1]],
  s: [["s", 1], ["ms", 1e3]] };

const superscript = (text) => [...String(text)].map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] ?? "⁻").join("");

// Three digits, of whole thousands all.
export function rounded(value) {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size === 0) return "0";
  if (size < 1e-3 || size >= 1e6) {
    const [head, power] = value.toExponential(1).split("e");
    return `${head.replace("-", "−")}·10${superscript(Number(power))}`;
  }
  const text = size >= 1000 ? String(Math.round(value)) : String(Number(value.toPrecision(3)));
  return text.replace("-", "−");
}

// A number in SI with its unit, in one of their size; `like`: whose size the unit has.
export function inUnit(value, unit, like = value) {
  const sizes = SIZES[unit] ?? [[unit, 1]];
  const [name, factor] = sizes.find(([, f]) => Math.abs(like) * f >= 0.9995) ?? sizes.at(-1);
  return [rounded(value * factor), name];
}

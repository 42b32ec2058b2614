// Figures and tables speak of a tube with adaptors; of a guide of surfaces they say rail, or tower, and shoes.
const GUIDES = [null, "rail", "rail", "tower"]; // by the geometry's guide.form

const asWritten = (word, first) => (first === first.toUpperCase() ? word[0].toUpperCase() + word.slice(1) : word);

// A function that puts the right words into a text.
export function namingOf(geometry) {
  const guide = GUIDES[geometry?.["guide.form"]?.value[0] ?? 0];
  if (!guide) return (text) => text;
  return (text) => text.replace(/\b([Tt])ubes?\b/g, (_, first) => asWritten(guide, first))
    .replace(/\b([Aa])daptor/g, (_, first) => asWritten("shoe", first === "A" ? "S" : "s"));
}

// Figures with their titles and the names of their curves in those words.
export function namedFigures(figures, named) {
  const ofCurve = ([pattern, label, ...more]) => [pattern, label && named(label), ...more];
  return figures.map((figure) => ({ ...figure, title: named(figure.title),
    panels: figure.panels.map((panel) => ({ ...panel, title: named(panel.title), curves: panel.curves.map(ofCurve) })) }));
}

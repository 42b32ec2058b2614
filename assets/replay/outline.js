// The rocket's own shape, where the scenario gives the air on it by surface: body and fins, in B.

// `rows`: an array of the geometry by its name, as a list of rows. The body from its tip backwards, points [x, radius], to
// where the last fin ends; fins by sets. Null where the results have no shape.
export function outlineOf(rows) {
  const body = rows("rocket.outline");
  if (body.length === 0) return null;
  const fins = rows("rocket.fins").map(([at, root, tip, span, sweep, radius, count]) => ({ at, root, tip, span, sweep, radius, count }));
  const last = body.at(-1), rear = Math.min(last[0], ...fins.map(({ at, root }) => at - root));
  return { body: rear < last[0] ? [...body, [rear, last[1]]] : body, fins, rear, tip: body[0][0], widest: Math.max(...body.map(([, r]) => r)) };
}

// Corners of a fin: along the body and from its axis.
export const finCorners = ({ at, root, tip, span, sweep, radius }) =>
  [[at, radius], [at - sweep, radius + span], [at - sweep - tip, radius + span], [at - root, radius]];

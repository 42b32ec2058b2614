// Where names stand so that none goes through another.

const FAR = 12; // gaps that a name may stand from its place

// Places names, which have room, from the left and back from the right.
function placeAll(names, low, high, gap) {
  let free = low, end = high;
  for (const name of names) {
    name.left = Math.max(name.at - name.width / 2, free);
    free = name.left + name.width + gap;
  }
  for (const name of [...names].reverse()) {
    name.left = Math.min(name.left, end - name.width);
    end = name.left - gap;
  }
}

// On a line: left ends of names of these widths, each as near to its middle as the others let it, between `low`
// and `high`; null for those that have no room, or none near it. The lower its rank, the sooner a name has it.
export function placeOnLine(names, low, high, gap = 6) {
  const kept = names.map((name, i) => ({ ...name, i })).sort((a, b) => a.rank - b.rank || a.i - b.i);
  const taken = () => kept.reduce((sum, { width }) => sum + width + gap, -gap);
  while (kept.length > 0 && taken() > high - low) kept.pop();
  kept.sort((a, b) => a.at - b.at || a.i - b.i);
  for (;;) {
    placeAll(kept, low, high, gap);
    const moved = ({ at, width, left: x }) => Math.abs(x + width / 2 - at), half = kept.filter((one) => moved(one) > (FAR * gap) / 2);
    if (half.every((one) => moved(one) <= FAR * gap)) break;
    kept.splice(kept.indexOf(half.reduce((worst, one) => (one.rank >= worst.rank ? one : worst))), 1);
  }
  const left = names.map(() => null);
  for (const name of kept) left[name.i] = name.left;
  return left;
}

const meet = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;

// Beside points { x, y, width }: boxes of names `height` high, within `bounds`, clear of each other and of all points, and
// of as many of the places `others` [x, y] as can be; null for those without room.
export function placeBeside(points, height, bounds, others = []) {
  const around = 5, taken = points.map(({ x, y }) => ({ left: x - 4, right: x + 4, top: y - 4, bottom: y + 4 }));
  const covered = (box) => others.filter(([x, y]) => x > box.left && x < box.right && y > box.top && y < box.bottom).length;
  return points.map(({ x, y, width }) => {
    const sides = [[around, -height], [around, 0], [-around - width, -height], [-around - width, 0],
      [-width / 2, -height - around], [-width / 2, around]];
    const free = sides.map(([dx, dy]) => ({ left: x + dx, right: x + dx + width, top: y + dy, bottom: y + dy + height }))
      .filter((one) => one.left >= bounds.left && one.right <= bounds.right && one.top >= bounds.top &&
        one.bottom <= bounds.bottom && !taken.some((other) => meet(one, other)));
    if (free.length === 0) return null;
    const [box] = free.map((one) => [one, covered(one)]).reduce((best, one) => (one[1] < best[1] ? one : best));
    taken.push(box);
    return box;
  });
}

// A text in one line, or in two where it is longer than `room` letters.
export function linesOf(label, room) {
  if (label.length <= room) return [label];
  const spaces = [...label.matchAll(/ /g)].map(({ index }) => index), middle = label.length / 2;
  if (spaces.length === 0) return [label];
  const at = spaces.reduce((best, one) => (Math.abs(one - middle) < Math.abs(best - middle) ? one : best));
  return [label.slice(0, at), label.slice(at + 1)];
}

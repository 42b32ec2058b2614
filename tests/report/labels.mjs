// The browser's rule for names against tests/figures/labels.txt, which src/figures/labels.c keeps, too.
import { readFileSync } from "node:fs";
import { placeBeside, placeOnLine } from "../../assets/report/labels.js";

const cases = [];
for (const line of readFileSync(new URL("../figures/labels.txt", import.meta.url), "utf8").split("\n")) {
  const [word, ...texts] = line.split(" "), numbers = texts.map((text) => (text === "none" ? null : Number(text)));
  if (word === "line" || word === "beside") cases.push({ word, given: numbers, names: [], others: [] });
  else if (word === "other") cases.at(-1).others.push(numbers);
  else if (word === "name") cases.at(-1).names.push(numbers);
}

function placesOf({ word, given, names, others }) {
  if (word === "line") return placeOnLine(names.map(([at, width, rank]) => ({ at, width, rank })), ...given);
  const [height, left, right, top, bottom] = given;
  return placeBeside(names.map(([x, y, width]) => ({ x, y, width })), height, { left, right, top, bottom }, others)
    .map((box) => box && `${box.left},${box.top}`);
}

const wrong = cases.filter((one) => {
  const wanted = one.names.map(([, , , left, top]) => (one.word === "line" || left === null ? left : `${left},${top}`));
  const found = placesOf(one), fine = JSON.stringify(found) === JSON.stringify(wanted);
  if (!fine) console.log(`${one.word} ${one.given}: ${JSON.stringify(found)} instead of ${JSON.stringify(wanted)}`);
  return !fine;
});
console.log(`${cases.length} cases of names, ${wrong.length} wrong`);
process.exit(cases.length > 15 && wrong.length === 0 ? 0 : 1);

// The browser's rule for names against tests/figures/labels.txt, which src/figures/labels.c keeps, too; numbers as people
// say them and as they play, ticks of axes, what moved most.
import { readFileSync } from "node:fs";
import { motions } from "../../assets/report/answer.js";
import { linesOf, placeBeside, placeOnLine } from "../../assets/report/labels.js";
import { fixed, inUnit, playing, rounded } from "../../assets/report/rounded.js";
import { ticks, tickTexts } from "../../assets/report/ticks.js";
import { together } from "../../assets/replay/gauge.js";

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

// Of parts that move across two axes: each comes back on one of them while it is farthest off on the other.
const moving = { "tip.y": [0, 0, 3, 0], "tip.z": [9, 1, 5, -3], "rocket.y": [0, 1, 1, 4.5], "rocket.z": [0, 2, 2, 14], "chassis.y": [0, -7, -7, -8] };
const table = { t: [0, 1, 2, 3], column: new Map(Object.entries(moving).map(([name, value]) => [name, { name, value }])) };
const parts = motions(table, 1).map(({ label, most, when }) => `${label} ${most} at ${when}`);

// What is said, and what ought to be; a space of a digit's width as _.
const wide = (text) => text.replaceAll("\u2007", "_");
const said = [
  [rounded(38.01), "38.0"], [rounded(-0.0289), "−0.0289"], [rounded(2.0961), "2.10"], [rounded(1499.6), "1500"], [rounded(0), "0"],
  [rounded(4.44e-12), "4.4·10⁻¹²"], [rounded(-2.5e7), "−2.5·10⁷"], [rounded(NaN), "–"],
  [inUnit(0.00332, "m"), "3.32,mm"], [inUnit(3.63e-5, "m"), "0.0363,mm"], [inUnit(9.88e-7, "m"), "0.988,µm"], [inUnit(708.3, "m"), "708,m"],
  [inUnit(1500, "m"), "1.50,km"], [inUnit(999.6, "m"), "1.00,km"], [inUnit(747, "m", 3120), "0.747,km"], [inUnit(0, "m"), "0,mm"],
  [inUnit(53, "N"), "53.0,N"], [inUnit(1640, "N"), "1.64,kN"], [inUnit(0.1564, "s"), "156,ms"], [inUnit(24.19, "s"), "24.2,s"], [inUnit(0.136, ""), "0.136,"],
  [wide(fixed(0.11894, 4, [-0.05, 0.2])), "_0.1189"], [wide(fixed(-0.05, 4, [-0.05, 0.2])), "−0.0500"], [wide(fixed(-1e-6, 2, [-1, 12])), "_0.00"],
  [wide(playing(-0.00106, "m", [-0.00314, 0.002])), "−1.06 mm"], [wide(playing(0.0004, "m", [-0.00314, 0.002])), "_0.40 mm"],
  [wide(playing(4.2, "m/s", [0, 38.01])), "_4.2 m/s"], [wide(playing(12.34, "m", [-0.2, 3120], 4)), "0.012 km"], [wide(playing(3e-7, "m", [0, 9.88e-6])), "0.30 µm"],
  [wide(playing(0, "m", [0, 0])), "0.00 mm"], [wide(playing(NaN, "m", [0, 1.5])), "___– m"], [wide(playing(1e-9, "m", [0, 1e-12])), "0.0010 µm"],
  [wide(playing(0.9996, "m", [0, 0.9996])), "1.00 m"], [parts.join("; "), "rear adaptor across the tube 12.5 at 3; tip of the tube 5 at 2; chassis, up and down 1 at 3"],
  [ticks(0, 1, 5), "0,0.2,0.4,0.6000000000000001,0.8,1"], [tickTexts(ticks(0, 1, 5)), "0,0.2,0.4,0.6,0.8,1"], [tickTexts(ticks(-0.25, 0.38, 3)), "−0.2,0,0.2"],
  [tickTexts(ticks(1163, 1177, 3)), "1165,1170,1175"], [ticks(3, 3, 4).length, "0"],
  [together([[9, 9, "exit"], [50, 20, "apogee"], [52, 23, "drogue"], [60, 30, "main"]].map(([x, y, name]) => ({ x, y, name })))
    .map(({ x, name }) => `${x} ${name}`).join("; "), "9 exit; 50 apogee, drogue; 60 main"],
  [linesOf("yaw [deg]", 20), "yaw [deg]"], [linesOf("yaw rate, the launcher's axes held still [mrad/s]", 27).join("|"), "yaw rate, the launcher's|axes held still [mrad/s]"],
];
const unlike = said.filter(([found, wanted]) => String(found) !== wanted);
for (const [found, wanted] of unlike) console.log(`${found} instead of ${wanted}`);
console.log(`${said.length} words and numbers, ${unlike.length} wrong`);
process.exit(cases.length > 15 && wrong.length + unlike.length === 0 ? 0 : 1);

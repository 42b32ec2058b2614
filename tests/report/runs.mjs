// The report of runs laid over each other in a real browser.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { check, checkFits, checkHeight, checkInjected, checkNoneEmpty, drawn, example, folder, inBrowser, launchdyn, launchdynEnding, leave, near, open, paper,
  picture, readCsv } from "./support.mjs";

// A run of an example with other values for some keys.
function runWith(name, file, ...sets) {
  const out = join(folder, name);
  launchdyn("run", example(file), "--out", out, "--csv", "--quiet", ...sets.flatMap((set) => ["--set", set]));
  return { out, column: readCsv(join(out, "history.csv")), summary: JSON.parse(readFileSync(join(out, "summary.json"))) };
}

// Where a folder holds nothing, the code says so.
function reportOf(name, ...runs) {
  const file = join(folder, name);
  launchdynEnding([runs.every(({ column }) => column) ? 0 : 2], "report", ...runs.map(({ out }) => out), "-o", file);
  return file;
}

// A column of the history at a time between two rows.
function valueAt(column, name, time) {
  const t = column.get("t"), value = column.get(name), after = t.findIndex((one) => one >= time);
  const share = (time - t[after - 1]) / (t[after] - t[after - 1]);
  return value[after - 1] + share * (value[after] - value[after - 1]);
}

// The cursor shows each run's own value, in the runs' order.
async function checkCursor(page, runs) {
  const over = page.locator("#launch-tip .u-over").first(), values = "#launch-tip .panel:first-child .u-value";
  const box = await over.boundingBox();
  await over.hover(); // what follows are moves within
  for (const share of [0.2, 0.5, 0.8]) {
    await over.hover({ position: { x: share * box.width, y: box.height / 2 } });
    await page.waitForFunction((cells) => document.querySelector(cells).textContent !== "–", values);
    await drawn(page);
    const [time, ...shown] = await page.$$eval(values, (cells) => cells.map((cell) => Number(cell.textContent)));
    const wanted = runs.flatMap(({ column }) => ["tip.y", "tip.z"].map((name) => 1e3 * valueAt(column, name, time)));
    check(`cursor at ${time} s shows each run's values`, shown.length === wanted.length &&
      shown.every((value, i) => near(value, wanted[i], 1e-3)), `${shown.join(" ")} for ${wanted.map((v) => v.toPrecision(6)).join(" ")}`);
  }
}

const cellsOf = (page, row) => page.$$eval("#tables tr", (rows, name) =>
  [...(rows.find((one) => one.firstChild.textContent === name)?.children ?? [])].slice(1).map((cell) => cell.textContent), row);

async function checkOver(browser, runs) {
  console.log("three runs, one key apart");
  const page = await open(browser, reportOf("three.html", ...runs), { width: 1400 });
  await checkHeight(page);
  const legend = await page.$$eval(".legend .series", (list) => list.map((node) => node.textContent));
  check("runs are named by the key in which they differ", legend.join() === "clearance 0.0002 m,clearance 0.0003 m,clearance 0.0005 m", legend);
  const values = await cellsOf(page, "rocket.adaptors.rear.clearance");
  check("the key stands in the table", values.join() === "0.0002 m,0.0003 m,0.0005 m", values);
  const speeds = await cellsOf(page, "exit speed, along the tube");
  check("summaries stand side by side", speeds.length === 4 && runs.every(({ summary }, i) =>
    near(Number(speeds[i]), summary.rockets[0].exit_speed, 1e-5)), speeds);
  const measured = await cellsOf(page, "bound");
  check("measures, too, with their unit", measured.at(-1) === "rad/s" && runs.every(({ summary }, i) =>
    near(Number(measured[i]), summary.rockets[0].measure.bound, 1e-5)), measured);
  await checkNoneEmpty(page);
  await checkCursor(page, runs);
  await checkFits(page);
  await picture(page, "runs.png");
  await leave(page);
}

// One measure that all have, one of one run alone, one name for measures of two units: a row each, a dash where a run has none.
async function checkMeasures(browser) {
  console.log("runs of different measures");
  const measure = (name, of) => `{name: ${name}, of: ${of}, take: value, at: t_rear}`;
  const lists = [[measure("both", "tip.y"), measure("mine", "tip.z")], [measure("both", "tip.y"), measure("one", "tip.pitch")],
    [measure("both", "tip.y"), measure("one", "tip.vy")], []];
  const runs = lists.map((list, i) => runWith(`measures-${i}`, "fixed.yaml", `rocket.mass_error=${i} kg`, "run.end=tip", `measures=[${list.join(", ")}]`));
  const page = await open(browser, reportOf("measures.html", ...runs), { width: 1400 });
  const rows = await page.$$eval("#tables tr", (list) => list.map((row) => [...row.cells].map((cell) => cell.textContent)));
  const found = rows.filter(([name]) => ["both", "mine", "one"].includes(name));
  const has = { "both m": [0, 1, 2], "mine m": [0], "one rad": [1], "one m/s": [2] };
  const wanted = Object.entries(has).map(([name, of]) => [name, runs.map(({ summary }, i) =>
    (of.includes(i) ? summary.rockets[0].measure[name.split(" ")[0]] : null))]);
  check("a row for each name and unit", found.map((row) => `${row[0]} ${row.at(-1)}`).join() === Object.keys(has).join(), found.join(" | "));
  check("values where a run has them, dashes where not", wanted.every(([, values], k) => values.every((value, i) =>
    (value === null ? found[k][i + 1] === "–" : near(Number(found[k][i + 1]), value, 1e-5)))), found.join(" | "));
  await leave(page);
}

async function checkNarrow(browser, runs) {
  console.log("the same, dark, 400 pixels wide");
  const page = await open(browser, reportOf("narrow.html", ...runs), { width: 400, dark: true });
  await checkFits(page);
  check("dark as the system says", (await paper(page)) === "rgb(20, 24, 28)");
  await page.locator("#launch-tip").evaluate((node) => node.scrollIntoView());
  await picture(page, "runs-narrow.png");
  await leave(page);
}

// Titles that differ name the runs; one that would be code is text, a folder that is none gives a warning.
async function checkHostile(browser) {
  console.log("titles and folders that would be code");
  const code = "</script><img src=x onerror=window.owned=1>";
  const runs = [code, "plain"].map((title, i) => runWith(i ? "plain" : "<img src=x onerror=window.owned=1>", "fixed.yaml",
    `title=${JSON.stringify(`Launch ${title}`)}`, "run.end=0.02 s"));
  const file = reportOf("hostile.html", ...runs, { out: join(folder, "none") });
  const page = await open(browser, file);
  const legend = await page.$$eval(".legend .series", (list) => list.map((node) => node.textContent));
  check("titles without what they share", legend[1] === "plain" && legend[0].startsWith("</script><img"), legend);
  check("what is missing is noted", (await page.locator(".warning").first().textContent()).startsWith("no results in"));
  check("nothing of it ran", await page.evaluate(() => window.owned === undefined && !document.querySelector("img")));
  await leave(page);
  await checkInjected(browser, file);
}

await inBrowser(async (browser) => {
  const runs = ["0.2 mm", "0.3 mm", "0.5 mm"].map((clearance, i) => runWith(`run-${i}`, "fixed.yaml",
    `rocket.adaptors.rear.clearance=${clearance}`, "measures=[{name: bound, of: tip.pitch_rate, take: rms, from: t_middle, to: t_rear}]"));
  await checkOver(browser, runs);
  await checkMeasures(browser);
  await checkNarrow(browser, runs);
  await checkHostile(browser);
});

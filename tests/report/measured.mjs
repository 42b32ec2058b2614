// The report of a run beside a log, in a real browser: verdicts, curves over curves with residuals, dots on the path.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { check, checkFits, checkNoneEmpty, drawn, example, folder, inBrowser, launchdyn, leave, near, open, picture, readCsv, rowNear,
  runOf } from "./support.mjs";

// A report beside a log, and what the command says of the same.
function beside(run, log, name) {
  const file = join(folder, name);
  launchdyn("report", run.out, "--log", log, "-o", file);
  return { file, said: JSON.parse(launchdyn("compare", run.out, log, "--json")) };
}

const numberOf = (text) => Number(text.replace("−", "-").match(/-?[\d.]+(e-?\d+)?/)?.[0]);

// Verdicts and numbers of the table and of the answer are the command's.
async function checkVerdicts(page, { series, results }) {
  const rows = await page.$$eval("table.compared tbody tr", (list) => list.map((row) => [...row.cells].map((cell) => cell.textContent)));
  check("a row for each series and number", rows.length === series.length + results.length, rows.map(([name]) => name));
  const wrong = [...series, ...results].filter((one, i) => {
    const [name, measured, simulated, E, u, verdict] = rows[i];
    return !name.startsWith(one.name) || verdict !== one.verdict || !near(numberOf(E), one.E ?? one.E_rms, 6e-3) || !near(numberOf(u), one.u_val, 6e-3) ||
      (i >= series.length && !(near(numberOf(measured), one.measured, 6e-3) && near(numberOf(simulated), one.simulated, 6e-3)));
  });
  check("verdicts, E and u_val are the command's", wrong.length === 0, rows.map((row) => row.join(" ")).join("; "));
  const lines = await page.$$eval(".answer tr", (list) => list.map((row) => row.textContent).filter((text) => text.startsWith("Measured ")));
  check("the answer has a line for each series", lines.length === series.length && series.every(({ name, verdict }, i) =>
    lines[i].startsWith(`Measured ${name}`) && lines[i].includes(verdict)), lines);
}

// The cursor shows the log's samples and, below, what the run has more, between twice u_val.
async function checkCurves(page, { series: [height] }) {
  const panels = page.locator("#compared0-compared .panel"), count = await panels.count();
  check("a panel of curves, one of residuals", count === 2, await panels.locator("h3").allTextContents());
  const over = panels.first().locator(".u-over"), box = await over.boundingBox();
  for (const share of [0.25, 0.6, 0.9]) {
    await over.hover({ position: { x: share * box.width, y: box.height / 2 } });
    await drawn(page);
    const read = (panel) => panel.locator(".u-value").evaluateAll((cells) => cells.map((cell) => Number(cell.textContent)));
    const [time, measured, simulated] = await read(panels.nth(0)), [, E, above, below] = await read(panels.nth(1));
    const i = rowNear(height.t, time);
    check(`cursor at ${time} s shows measured and simulated, E between twice u_val`, near(measured, height.measured[i], 1e-5) &&
      near(simulated, height.simulated[i], 1e-5) && near(E, height.simulated[i] - height.measured[i], 1e-3) &&
      near(above, 2 * height.u[i], 1e-5) && below === -above, `${measured} ${simulated} ${E} ${above}`);
  }
}

// The first screen shows the altimeter: dots on the path, each as high above the start as it was measured.
async function checkDots(page, run, { series: [height] }) {
  const { view, dots, words, high, painted } = await page.evaluate(() => {
    const { stage, reading, gauge } = window.launchdyn.current, { data } = gauge.getContext("2d").getImageData(0, 0, gauge.width, gauge.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4)
      count += data[i + 3] > 200 && Math.abs(data[i] - 0x1f) + Math.abs(data[i + 1] - 0x78) + Math.abs(data[i + 2] - 0xd1) < 30;
    return { view: stage.view, dots: stage.dots, words: reading.textContent, high: document.querySelector(".replay").getBoundingClientRect().bottom, painted: count };
  });
  check("the replay opens on the path, in the first screen", view === "path" && high <= 900, `${view}, ${high}`);
  check("and says what the dots are", words.includes("dots: measured"), words);
  const { column } = run, start = column.get("center.y")[rowNear(column.get("t"), 0)];
  const flown = height.t.map((_, i) => i).filter((i) => height.t[i] >= column.get("t").at(-1));
  const off = flown.map((i, k) => Math.abs(dots[k]?.[1] - start - height.measured[i]));
  check("dots are as high as measured", dots.length === flown.length && Math.max(...off) < 0.5, `${dots.length}, ${Math.max(...off).toPrecision(2)} m`);
  check("and are drawn", painted > 5 * dots.length, `${painted} points of the picture`);
}

// Of columns of the mass centre all three places count; a log of the launch alone leaves the path as it is.
async function checkPlaces(browser, run) {
  console.log("places by three columns");
  const flight = readCsv(join(run.out, "flights.csv")), rows = flight.get("t").map((_, i) => i).filter((i) => i % 40 === 5), log = join(folder, "places.csv");
  const shift = { "center.x": 20, "center.y": -30, "center.z": 40 }, names = Object.keys(shift);
  writeFileSync(log, [["t [s]", ...names.map((name) => `${name} [ft]`)].join(","), ...rows.map((i) => [flight.get("t")[i],
    ...names.map((name) => (flight.get(name)[i] + shift[name]) / 0.3048)].join(","))].join("\n") + "\n");
  const page = await open(browser, beside(run, log, "places.html").file);
  const dots = await page.evaluate(() => window.launchdyn.current.stage.dots);
  const off = rows.slice(0, dots.length).map((i, k) => Math.max(...names.map((name, axis) => Math.abs(dots[k][axis] - flight.get(name)[i] - shift[name]))));
  check("dots where the log has them", dots.length === rows.length && Math.max(...off) < 0.5, `${dots.length}, ${Math.max(...off).toPrecision(2)} m`);
  await leave(page);
}

async function checkLaunchOnly(browser, run) {
  console.log("a log of the launch alone");
  const log = join(folder, "rail.csv"), t = run.column.get("t"), speed = run.column.get("rocket.s_dot"), rows = [10, 20, 30, 40].filter((i) => i < t.length);
  writeFileSync(log, `t [s],rocket.s_dot [ft/s]\n${rows.map((i) => `${t[i]},${speed[i] / 0.3048}`).join("\n")}\n`);
  const page = await open(browser, beside(run, log, "rail.html").file);
  const { view, count } = await page.evaluate(() => ({ view: window.launchdyn.current.stage.view, count: window.launchdyn.current.stage.dots.length }));
  check("no dots, and the launcher is shown", view === "launcher" && count === 0, `${view}, ${count}`);
  await leave(page);
}

await inBrowser(async (browser) => {
  console.log("the student rocket and its altimeter");
  const run = runOf("student-rocket/student-rocket.yaml"), { file, said } = beside(run, example("student-rocket/measured.csv"), "measured.html");
  const page = await open(browser, file, { width: 1400 });
  await page.waitForFunction(() => window.launchdyn.current);
  await drawn(page);
  await picture(page, "measured.png");
  await checkDots(page, run, said);
  await checkVerdicts(page, said);
  await checkCurves(page, said);
  await page.locator("#compared").evaluate((node) => node.scrollIntoView());
  await picture(page, "measured-section.png");
  await checkNoneEmpty(page);
  await leave(page);
  const narrow = await open(browser, file, { width: 400, dark: true });
  await checkFits(narrow);
  await leave(narrow);
  await checkPlaces(browser, run);
  await checkLaunchOnly(browser, run);
});

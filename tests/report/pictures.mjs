// Takes the pictures of docs/figures that show reports again, in some minutes:
//   LD_SCREENSHOTS=docs/figures tests/report/browser pictures.mjs BUILD
// LD_PICTURES="studies footprints": only those functions' pictures.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { drawn, example, folder, inBrowser, launchdyn, open, picture, runOf } from "./support.mjs";

function studyOf(name, file, ...sets) {
  const out = join(folder, name);
  launchdyn("study", file, "--out", out, "--quiet", ...sets.flatMap((set) => ["--set", set]));
  return out;
}

function reportOf(name, ...words) {
  const file = join(folder, name);
  launchdyn("report", ...words, "-o", file);
  return file;
}

// A window as high as the picture, with what `top` names below the header, and the mouse over what `under` names.
async function take(browser, name, file, { width, height, top, before, under }) {
  const page = await open(browser, file, { width });
  await page.setViewportSize({ width, height });
  if (before) await page.evaluate(before);
  if (top) await page.locator(top).evaluate((node) => {
    scrollTo(0, node.getBoundingClientRect().top + scrollY - document.querySelector("header").offsetHeight - 8);
  });
  if (under) await page.locator(under).first().hover();
  await drawn(page);
  await picture(page, name);
  await page.context().close();
}

// The first screen, 0.1 s after ignition.
async function oneRun(browser) {
  const { file } = runOf("reference.yaml");
  await take(browser, "report.png", file, { width: 1400, height: 830, before: () => window.launchdyn.current.show(0.1, true) });
}

async function severalRuns(browser) {
  const runs = ["stationary", "15-kmh", "30-kmh"].map((name) => runOf(`marching/firm-${name}.yaml`).out);
  const page = reportOf("runs.html", ...runs);
  await take(browser, "report-runs.png", page, { width: 1200, height: 545, top: "#launch-relative", under: "#launch-relative .u-over" });
}

// 10 000 flights with sensitivities; salvos at three speeds; launches beside two studies.
async function studies(browser) {
  const flight = join(folder, "flight-scattered.yaml");
  writeFileSync(flight, `include: ${example("flight.yaml")}
title: Flight, scattered
scatter:
  seed: 7
  samples: 10000
  factors:
    rocket.motor.thrust_scale: {normal: 1 %, within: 3}
    rocket.motor.misalignment.y: {normal: 0.5 mrad, within: 3}
    rocket.motor.misalignment.z: {normal: 0.5 mrad, within: 3}
`);
  await take(browser, "report-study.png", reportOf("flights.html", studyOf("flights", flight)), { width: 1200, height: 605 });
  const speeds = studyOf("speeds", example("salvo-marching.yaml"), "scatter.samples=10", "title=Ten salvos of 18 rockets at each speed");
  await take(browser, "report-studies.png", reportOf("speeds.html", speeds), { width: 1280, height: 640, top: "#scatter" });
  await take(browser, "report-sweep.png", reportOf("interval.html", studyOf("interval", example("interval.yaml"))), { width: 1200, height: 700 });
  const salvo = studyOf("salvo", example("salvo.yaml"));
  const same = studyOf("same", example("measured.yaml"), "scatter.seed=2026", "scatter.samples=10");
  const from = process.cwd();
  process.chdir(example(".")); // the page says where the launches lie
  const measured = reportOf("measured.html", salvo, same, "--measured", "measured.csv");
  process.chdir(from);
  await take(browser, "report-measured.png", measured, { width: 1280, height: 1100, top: "#measured" });
}

// Footprints of 10 000 landings and of the line of 400 throws of docs/tutorial-ship.md: the panel that has the title.
async function footprints(browser) {
  const safety = studyOf("safety", example("range-safety.yaml"), "scatter.samples=10000");
  const scenario = readFileSync(example("../docs/tutorial-ship.md"), "utf8").match(/```yaml thrower.yaml\n(.*?)```/s)[1];
  writeFileSync(join(folder, "thrower.yaml"), scenario.replace("examples/line-thrower.yaml", example("line-thrower.yaml")));
  const thrower = studyOf("thrower", join(folder, "thrower.yaml"), "scatter.samples=400");
  for (const [name, out, title, width] of [["footprint.png", safety, "Landing points", 1400],
    ["line-footprint.png", thrower, "Where the line lies", 960]]) {
    const page = await open(browser, reportOf(`${name}.html`, out), { width });
    await drawn(page);
    await page.locator(`.panel[data-title="${title}"]`).screenshot({ path: join(process.env.LD_SCREENSHOTS, name) });
    await page.context().close();
  }
}

// A launcher of one's own each, 0.1 s after ignition.
async function launchers(browser) {
  for (const name of ["erector", "suspended", "trailer", "mast", "gondola", "sled", "ship-turntable"]) {
    const page = await open(browser, runOf(`multibody/${name}.yaml`).file, { width: 800 });
    await page.evaluate(() => window.launchdyn.current.show(0.1, true));
    await drawn(page);
    await page.locator(".screen").screenshot({ path: join(process.env.LD_SCREENSHOTS, `replay-${name}.png`) });
    await page.context().close();
  }
}

const all = { launchers, oneRun, severalRuns, studies, footprints };
const chosen = process.env.LD_PICTURES?.split(" ") ?? Object.keys(all);
await inBrowser(async (browser) => {
  for (const name of chosen) await all[name](browser);
});

// The page that simulates in a real browser; skipped (77) where it has not been built.
import { existsSync, readFileSync, statSync } from "node:fs";
import { dirname, join } from "node:path";
import { check, checkFits, checkInjected, checkNoneEmpty, example, folder, inBrowser, launchdyn, leave, open, picture } from "../report/support.mjs";
import { after, checkWrong, field, same, setNumber, summaryOf } from "./page.mjs";

const file = join(dirname(process.env.LD_COMMAND), "page/launchdyn.html");
if (!existsSync(file)) {
  console.log("skipped: no page has been built (scripts/setup page, cmake --build build --target page)");
  process.exit(77);
}

// An example, a field, curves over each other, the same again from the address, the scenario saved.
async function checkFields(browser) {
  const page = await open(browser, file, { width: 1280 });
  await same(page, "fixed.yaml", summaryOf("fixed.yaml"));
  const { paint, took } = await page.evaluate(() => ({ took: window.launchdyn.result.took,
    paint: performance.getEntriesByType("paint").find(({ name }) => name === "first-contentful-paint").startTime }));
  console.log(`    first paint after ${paint.toFixed(0)} ms, launch in ${took.toFixed(0)} ms`);
  await checkNoneEmpty(page);
  await picture(page, "page.png");
  await setNumber(page, "rocket.mass", 66);
  await setNumber(page, "base.elevation", 35);
  const heavy = summaryOf("fixed.yaml", "--set", "rocket.mass=66 kg", "--set", "base.elevation=35 deg");
  await same(page, "two fields", heavy);
  const answer = await page.textContent("#answer");
  check("the answer is renewed", answer.includes(heavy.rockets[0].exit_speed.toPrecision(3)), answer.slice(0, 40));
  const legend = await page.$$eval(".figure .u-legend .u-label", (list) => list.map(({ textContent }) => textContent));
  const runs = ["mass 66 kg, elevation 35 deg", "mass 66 kg", "as it was read"];
  check("curves of three runs lie over each other", runs.every((run) => legend.some((text) => text.startsWith(run))), legend.slice(0, 3).join("; "));
  check("the replay stands at its instant", await page.evaluate(() => !window.launchdyn.current.stage.renderer.getContext().isContextLost()));
  const address = await page.evaluate(() => location.hash);
  const [saved] = await Promise.all([page.waitForEvent("download"), page.click("#save")]);
  await saved.saveAs(join(folder, "saved.yaml"));
  launchdyn("run", join(folder, "saved.yaml"), "--out", join(folder, "saved"), "--quiet");
  const again = JSON.parse(readFileSync(join(folder, "saved/summary.json"), "utf8"));
  check("the YAML that is saved is the same launch", JSON.stringify(again.rockets) === JSON.stringify(heavy.rockets));
  for (let mass = 50; mass < 68; mass++) await setNumber(page, "rocket.mass", mass); // more than a browser has contexts of WebGL
  check("after 20 launches the replay still draws", await page.evaluate(() => !window.launchdyn.current.stage.renderer.getContext().isContextLost()));
  await leave(page);
  return { address, heavy };
}

async function checkAddress(browser, { address, heavy }) {
  const page = await open(browser, `${file}${address}`, { width: 400, dark: true });
  page.file = file;
  page.requests = page.requests.map((url) => url.replace(/#.*/, ""));
  await same(page, `an address of ${address.length} letters`, heavy);
  check("its fields are set", await field(page, "rocket.mass", "number").inputValue() === "66" &&
    await field(page, "base.elevation", "number").inputValue() === "35");
  await checkFits(page);
  await picture(page, "page-dark.png");
  await leave(page);
}

// A wrong scenario, a file with one that it names, each written as a user would.
async function checkScenarios(browser) {
  const page = await open(browser, file, { replay: false });
  await checkWrong(page, readFileSync(example("fixed.yaml"), "utf8"));
  await after(page, () => page.setInputFiles("input[type=file]", [example("parachutes.yaml"), example("reference-aero.csv")]));
  check("then there is none", await page.isHidden("#messages"));
  const flown = await page.evaluate(() => JSON.parse(window.launchdyn.result.summary).rockets[0].flight.t_apogee);
  check("a flight alone has the command's apogee", flown === summaryOf("parachutes.yaml").rockets[0].flight.t_apogee, flown);
  await after(page, () => page.selectOption("#example", "reference.yaml"));
  await same(page, "reference.yaml", summaryOf("reference.yaml"));
  await leave(page);
}

await inBrowser(async (browser) => {
  check("the page has at most 3 MB", statSync(file).size <= 3e6, statSync(file).size);
  await checkAddress(browser, await checkFields(browser));
  await checkScenarios(browser);
  await checkInjected(browser, file);
});

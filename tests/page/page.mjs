// What both tests of the page that simulates do in it.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { check, drawn, runOf } from "../report/support.mjs";

// Waits for the run that follows what `act` does.
export async function after(page, act) {
  const before = await page.evaluate(() => Number(document.documentElement.dataset.run ?? 0));
  await act();
  await page.waitForFunction((number) => Number(document.documentElement.dataset.run ?? 0) > number, before);
  await drawn(page);
}

const rocketOf = (page) => page.evaluate(() => JSON.parse(window.launchdyn.result.summary).rockets[0]);
export const summaryOf = (name, ...options) => JSON.parse(readFileSync(join(runOf(name, ...options).out, "summary.json"), "utf8"));
export const field = (page, path, kind) => page.locator(`.field[data-path="${path}"] input[type="${kind}"]`);

export async function setNumber(page, path, value) {
  await after(page, async () => {
    await field(page, path, "number").fill(String(value));
    await field(page, path, "number").dispatchEvent("change");
  });
}

export async function same(page, what, expected) {
  const rocket = await rocketOf(page);
  check(`${what}: the command's exit to the bit`, JSON.stringify(rocket) === JSON.stringify(expected.rockets[0]),
    `exit speed ${rocket.exit_speed} m/s`);
}

// A scenario with an error in place of this one, as a user would write it.
export async function checkWrong(page, scenario) {
  await page.click("details.text summary");
  await page.fill("#scenario", scenario.replace("release_force: 5 kN", "release_force: 5 km"));
  await after(page, () => page.click("#launch"));
  const shown = await page.textContent("#messages");
  check("an error has its place, what was found and what is expected", /^scenario\.yaml:\d+:\d+: error: rocket\.lock\.release_force: /.test(shown), shown);
  check("what was shown stays, without a time", (await page.$$(".figure")).length > 5 && await page.textContent("#took") === "");
  check("it is none of the examples", await page.inputValue("#example") === "");
}

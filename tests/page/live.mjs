// The page that simulates behind launchdyn live, in a real browser: launches are the command's, to the bit; errors are shown,
// also that the command has ended.
import { spawn } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { check, checkNoneEmpty, example, folder, inBrowser, leave, open, picture } from "../report/support.mjs";
import { after, checkWrong, same, setNumber, summaryOf } from "./page.mjs";

const place = join(folder, "live");
mkdirSync(place);
copyFileSync(example("fixed.yaml"), join(place, "scenario.yaml"));

// The command at work, its address, and what it ends with.
async function begin() {
  const child = spawn(process.env.LD_COMMAND, ["live", "scenario.yaml", "--set", "rocket.mass=61 kg", "--quiet"], { cwd: place });
  const ended = new Promise((go) => child.on("exit", go));
  const address = await new Promise((go) => child.stdout.once("data", (data) => go(String(data).trim())));
  return { child, ended, address };
}

await inBrowser(async (browser) => {
  const { child, ended, address } = await begin();
  try {
    const page = await open(browser, address, { width: 1280 });
    await same(page, "fixed.yaml, with --set", summaryOf("fixed.yaml", "--set", "rocket.mass=61 kg"));
    console.log(`    launch in ${(await page.evaluate(() => window.launchdyn.result.took)).toFixed(0)} ms`);
    await checkNoneEmpty(page);
    await setNumber(page, "base.elevation", 35);
    await same(page, "a field", summaryOf("fixed.yaml", "--set", "rocket.mass=61 kg", "--set", "base.elevation=35 deg"));
    await picture(page, "live.png");
    await checkWrong(page, readFileSync(example("fixed.yaml"), "utf8"));
    await leave(page, [address, `${address}launch`]);
    const late = await open(browser, address, { replay: false });
    child.kill("SIGINT");
    check("Ctrl-C ends it", await ended === 130, await ended);
    await after(late, () => late.evaluate(() => document.getElementById("launch").click()));
    const shown = await late.textContent("#messages");
    check("the page says that nobody answers", shown.startsWith("launchdyn live has not answered: "), shown);
    await late.context().close();
  } finally {
    child.kill();
  }
});

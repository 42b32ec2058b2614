// The report of a run in a real browser.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { check, checkFits, checkNoneEmpty, checkSilence, drawn, inBrowser, launchdyn, near, open, paper, picture,
  rowNear, runOf } from "./support.mjs";

// The numbers below a plot, the time first.
const legend = (page, selector) => page.$$eval(`${selector} .u-value`, (cells) =>
  cells.map((cell) => Number(cell.textContent)));

// The cursor at some places of a plot: what stands below it is a row of the results.
async function checkCursor(page, run, selector, columns) {
  const over = page.locator(`${selector} .u-over`).first();
  await over.scrollIntoViewIfNeeded();
  const box = await over.boundingBox(), t = run.column.get("t");
  for (const share of [0.15, 0.5, 0.85]) {
    await page.mouse.move(box.x + share * box.width, box.y + box.height / 2);
    await drawn(page);
    const [time, ...values] = await legend(page, `${selector} .uplot`);
    const row = rowNear(t, time);
    check(`cursor at ${time} s shows the results`, near(t[row], time, 1e-5) &&
      columns.every(([name, factor], i) => near(run.column.get(name)[row] * factor, values[i], 1e-5)),
      values.join(" "));
  }
}

async function checkLaunch(browser) {
  const run = runOf("fixed.yaml");
  console.log("fixed.yaml");
  const page = await open(browser, run.file);
  checkSilence(page, run.file);
  const counts = await page.evaluate(() =>
    [".panel", ".plot canvas"].map((selector) => document.querySelectorAll(selector).length));
  check("plots, each with a canvas", counts[0] >= 30 && counts[0] === counts[1], counts);
  await checkNoneEmpty(page);
  await checkCursor(page, run, "#table0-tip .panel", [["tip.y", 1e3], ["tip.z", 1e3]]);
  await checkCursor(page, run, "#table0-contact .panel",
    [["contact.rear.force", 1e-3], ["contact.middle.force", 1e-3], ["contact.front.force", 1e-3]]);
  const shared = await page.$$eval(".uplot .u-legend tr:first-child .u-value",
    (cells) => [...new Set(cells.map((cell) => cell.textContent))]);
  check("all plots show the same instant", shared.length === 1, shared);
  await picture(page, "launch.png");
  await checkKeys(page);
  await page.context().close();
}

async function checkKeys(page) {
  const time = async () => (await legend(page, "#table0-tip .uplot"))[0];
  const press = async (key) => {
    await page.keyboard.press(key);
    await drawn(page);
  };
  await page.locator("#table0-tip .uplot").first().focus();
  await page.mouse.move(1, 1);
  await drawn(page);
  await press("ArrowRight");
  const before = await time();
  await press("ArrowRight");
  check("an arrow moves the cursor by a row", near((await time()) - before, 1e-4, 0.01),
    `${before} to ${await time()}`);
  check("and on the paths too",
    (await page.locator("#table0-phase .reading").first().textContent()).startsWith(`t ${await time()} `));
  const drawing = () => page.$eval("#table0-travel canvas", (canvas) => canvas.toDataURL());
  const whole = await drawing();
  await press("+");
  check("+ zooms the other plots", (await drawing()) !== whole);
  await press("Escape");
  check("Escape shows all again", (await drawing()) === whole);
}

async function checkLooks(browser) {
  const run = runOf("reference.yaml");
  console.log("reference.yaml, dark, 400 pixels wide");
  const page = await open(browser, run.file, { width: 400, dark: true });
  checkSilence(page, run.file);
  await checkNoneEmpty(page);
  await checkFits(page);
  check("dark as the system says", (await paper(page)) === "rgb(20, 24, 28)");
  await picture(page, "narrow.png");
  await page.click("#theme");
  check("the switch makes it light", (await paper(page)) === "rgb(255, 255, 255)");
  check("flight and vehicle are there", (await page.$("#table1-trajectory")) && (await page.$("#table0-wheels")));
  await page.context().close();
}

async function checkHostile(browser) {
  console.log("a title that would be code");
  const title = "</title></script><script>window.owned=1</script><img src=x onerror=window.owned=1>";
  const run = runOf("straight.yaml", "--set", `title='${title}'`);
  const page = await open(browser, run.file);
  checkSilence(page, run.file);
  check("the title is text", (await page.textContent("h1")) === title);
  check("nothing of it ran", await page.evaluate(() => window.owned === undefined && !document.querySelector("img")));
  writeFileSync(join(run.out, "summary.json"), "{\"title\": ");
  launchdyn("report", run.out);
  await page.context().close();
  const broken = await open(browser, run.file);
  check("a broken summary is said",
    (await broken.textContent("body")).includes("summary.json is not complete"));
  await broken.context().close();
}

await inBrowser(async (browser) => {
  await checkLaunch(browser);
  await checkLooks(browser);
  await checkHostile(browser);
});

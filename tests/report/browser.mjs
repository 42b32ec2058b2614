// usage: node browser.mjs LAUNCHDYN EXAMPLES
// The report in a real browser: Chromium without a window, led over its debugging pipe, so that
// nothing beside Node and Chromium is needed. Ends with 77 where one is missing.
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const [launchdyn, examples] = process.argv.slice(2);
const shots = process.env.LD_SCREENSHOTS; // a folder: pictures to look at are left there
const folder = mkdtempSync(join(tmpdir(), "launchdyn-browser-"));

function findBrowser() {
  for (const name of [process.env.CHROMIUM, "chromium", "chromium-browser", "google-chrome"])
    try {
      if (name) return execFileSync("which", [name], { encoding: "utf8" }).trim();
    } catch { /* not this one */ }
  console.log("skipped: no Chromium here (Debian: apt install chromium)");
  process.exit(77);
}

// ---- the browser ----

class Browser {
  constructor(program) {
    this.child = spawn(program, ["--headless", "--no-sandbox", "--disable-dev-shm-usage",
      "--disable-gpu", "--no-first-run", "--remote-debugging-pipe",
      `--user-data-dir=${join(folder, "profile")}`],
    { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    this.number = 0;
    this.waiting = new Map();
    this.said = []; // events of the page: errors, requests
    let text = "";
    this.child.stdio[4].setEncoding("utf8").on("data", (part) => {
      const messages = (text + part).split("\0");
      text = messages.pop();
      messages.forEach((message) => this.take(JSON.parse(message)));
    });
  }
  take(message) {
    if (message.id === undefined) return void this.said.push(message);
    const { fine, wrong } = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    message.error ? wrong(new Error(message.error.message)) : fine(message.result);
  }
  send(method, params = {}) {
    const id = ++this.number;
    this.child.stdio[3].write(JSON.stringify({ id, method, params, sessionId: this.session }) + "\0");
    return new Promise((fine, wrong) => this.waiting.set(id, { fine, wrong }));
  }
  async open() {
    const { targetId } = await this.send("Target.createTarget", { url: "about:blank" });
    this.session = (await this.send("Target.attachToTarget", { targetId, flatten: true })).sessionId;
    for (const domain of ["Page", "Runtime", "Network", "Log"]) await this.send(`${domain}.enable`);
  }
  async run(code) {
    const { result, exceptionDetails } = await this.send("Runtime.evaluate",
      { expression: code, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? code);
    return result.value;
  }
  async load(file, { width = 1200, dark = false } = {}) {
    this.said = [];
    await this.send("Emulation.setDeviceMetricsOverride",
      { width, height: 900, deviceScaleFactor: 1, mobile: false });
    await this.send("Emulation.setEmulatedMedia",
      { features: [{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }] });
    await this.send("Page.navigate", { url: `file://${file}` });
    await this.until("location.protocol === 'file:' && document.documentElement.dataset.ready === 'yes'");
  }
  async until(condition) {
    for (const end = Date.now() + 20000; Date.now() < end;) {
      if (await this.run(condition).catch(() => false)) return;
      await new Promise((go) => setTimeout(go, 50));
    }
    throw new Error(`never: ${condition}`);
  }
  async key(key) {
    for (const type of ["keyDown", "keyUp"]) await this.send("Input.dispatchKeyEvent", { type, key });
  }
  async mouse(x, y) {
    await this.send("Input.dispatchMouseEvent", { type: "mouseMoved", x, y });
  }
  async picture(name) {
    if (!shots) return;
    const { data } = await this.send("Page.captureScreenshot");
    writeFileSync(join(shots, name), Buffer.from(data, "base64"));
  }
  end() {
    this.child.kill();
  }
}

// ---- checks ----

let wrong = 0;
function check(what, fine, measured = "") {
  console.log(`    ${fine ? "ok   " : "WRONG"} ${what} ${measured}`);
  wrong += !fine;
}

const near = (a, b, share) => Math.abs(a - b) <= share * Math.max(Math.abs(a), Math.abs(b)) + 1e-12;

// A run with its report and its history as text: name to values.
function runOf(name, ...options) {
  const out = join(folder, name);
  execFileSync(launchdyn, ["run", join(examples, name), "--out", out, "--csv", "--report", "--quiet",
    ...options]);
  const [head, ...rows] = readFileSync(join(out, "history.csv"), "utf8").trim().split("\n");
  const table = rows.map((row) => row.split(",").map(Number));
  const column = new Map(head.split(",").map((title, i) =>
    [title.replace(/ \[.*/, ""), table.map((row) => row[i])]));
  return { file: join(out, "report.html"), column };
}

// No errors, and no request but that for the file itself.
function checkSilence(browser, file) {
  const errors = browser.said.filter(({ method, params }) => method === "Runtime.exceptionThrown" ||
    (method === "Log.entryAdded" && params.entry.level === "error") ||
    (method === "Runtime.consoleAPICalled" && ["error", "assert"].includes(params.type)));
  const requests = browser.said.filter(({ method }) => method === "Network.requestWillBeSent")
    .map(({ params }) => params.request.url);
  check("no errors", errors.length === 0, JSON.stringify(errors).slice(0, 300));
  check("no request but the file", requests.every((url) => url === `file://${file}`), requests);
}

// Panels on whose canvas hardly a point has the colour of a curve.
const EMPTY = `(() => {
  const curves = [0, 1, 2, 3, 5].map((i) => getComputedStyle(document.documentElement)
    .getPropertyValue("--curve" + i).trim().match(/[0-9a-f]{2}/g).map((text) => parseInt(text, 16)));
  const drawn = (canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4)
      count += data[i + 3] > 60 && curves.some(([r, g, b]) =>
        Math.abs(data[i] - r) + Math.abs(data[i + 1] - g) + Math.abs(data[i + 2] - b) < 40);
    return count;
  };
  return [...document.querySelectorAll(".plot canvas")].filter((canvas) => drawn(canvas) < 50)
    .map((canvas) => canvas.closest(".panel").textContent.slice(0, 60));
})()`;

const place = (selector) => `(() => {
  const node = document.querySelector(${JSON.stringify(selector)});
  node.scrollIntoView({ block: "center" });
  const box = node.getBoundingClientRect();
  return { x: box.x, y: box.y, width: box.width, height: box.height };
})()`;

const legend = (selector) => `[...document.querySelectorAll(${JSON.stringify(`${selector} .u-value`)})]
  .map((cell) => Number(cell.textContent))`;

const frame = "new Promise((go) => requestAnimationFrame(() => requestAnimationFrame(go)))";

// The cursor at some places of a plot: what stands below it is a row of the results.
async function checkCursor(browser, run, selector, columns) {
  const box = await browser.run(place(`${selector} .u-over`));
  const t = run.column.get("t");
  for (const share of [0.15, 0.5, 0.85]) {
    await browser.mouse(box.x + share * box.width, box.y + box.height / 2);
    await browser.run(frame);
    const [time, ...values] = await browser.run(legend(`${selector} .uplot`));
    const row = t.reduce((best, at, i) => (Math.abs(at - time) < Math.abs(t[best] - time) ? i : best), 0);
    check(`cursor at ${time} s shows the results`, near(t[row], time, 1e-5) &&
      columns.every(([name, factor], i) => near(run.column.get(name)[row] * factor, values[i], 1e-5)),
      values.join(" "));
  }
}

async function checkLaunch(browser) {
  const run = runOf("fixed.yaml");
  console.log("fixed.yaml");
  await browser.load(run.file);
  checkSilence(browser, run.file);
  const counts = await browser.run(
    "[document.querySelectorAll('.panel').length, document.querySelectorAll('.plot canvas').length]");
  check("plots, each with a canvas", counts[0] >= 30 && counts[0] === counts[1], counts);
  const empty = await browser.run(EMPTY);
  check("no plot is empty", empty.length === 0, empty);
  check("at most 2 MB", statSync(run.file).size <= 2e6, statSync(run.file).size);
  await checkCursor(browser, run, "#table0-tip .panel", [["tip.y", 1e3], ["tip.z", 1e3]]);
  await checkCursor(browser, run, "#table0-contact .panel",
    [["contact.rear.force", 1e-3], ["contact.middle.force", 1e-3], ["contact.front.force", 1e-3]]);
  const shared = await browser.run(`[...document.querySelectorAll(".uplot .u-legend tr:first-child .u-value")]
    .map((cell) => cell.textContent)`);
  check("all plots show the same instant", new Set(shared).size === 1, [...new Set(shared)]);
  await browser.picture("launch.png");
  await checkKeys(browser);
}

async function checkKeys(browser) {
  const plot = "document.querySelector('#table0-tip .uplot')";
  const time = async () => (await browser.run(legend("#table0-tip .uplot")))[0];
  await browser.run(`${plot}.focus()`);
  await browser.mouse(1, 1);
  await browser.run(frame);
  await browser.key("ArrowRight");
  await browser.run(frame);
  const before = await time();
  await browser.key("ArrowRight");
  await browser.run(frame);
  check("an arrow moves the cursor by a row", near((await time()) - before, 1e-4, 0.01),
    `${before} to ${await time()}`);
  const path = "#table0-phase .reading";
  check("and on the paths too",
    (await browser.run(`document.querySelector("${path}").textContent`)).startsWith(`t ${await time()} `));
  const labels = () => browser.run(`(() => {
    const canvas = document.querySelector("#table0-travel canvas");
    return canvas.toDataURL().length + canvas.toDataURL().slice(-400);
  })()`);
  const whole = await labels();
  await browser.key("+");
  await browser.run(frame);
  const zoomed = await labels();
  check("+ zooms the other plots", zoomed !== whole);
  await browser.key("Escape");
  await browser.run(frame);
  check("Escape shows all again", (await labels()) === whole);
}

async function checkLooks(browser) {
  const run = runOf("reference.yaml");
  console.log("reference.yaml, dark, 400 pixels wide");
  await browser.load(run.file, { width: 400, dark: true });
  checkSilence(browser, run.file);
  const empty = await browser.run(EMPTY);
  check("no plot is empty", empty.length === 0, empty);
  check("nothing is wider than the window",
    await browser.run("document.documentElement.scrollWidth <= 400"),
    await browser.run("document.documentElement.scrollWidth"));
  const paper = "getComputedStyle(document.body).backgroundColor";
  check("dark as the system says", (await browser.run(paper)) === "rgb(20, 24, 28)");
  await browser.picture("narrow.png");
  await browser.run("document.getElementById('theme').click()");
  check("the switch makes it light", (await browser.run(paper)) === "rgb(255, 255, 255)");
  check("flight and vehicle are there",
    await browser.run("!!document.querySelector('#table1-trajectory') && !!document.querySelector('#table0-wheels')"));
}

async function checkHostile(browser) {
  console.log("a title that would be code");
  const title = "</title></script><script>window.owned=1</script><img src=x onerror=window.owned=1>";
  const run = runOf("straight.yaml", "--set", `title='${title}'`);
  await browser.load(run.file);
  checkSilence(browser, run.file);
  check("the title is text", (await browser.run("document.querySelector('h1').textContent")) === title);
  check("nothing of it ran", await browser.run("window.owned === undefined && !document.querySelector('img')"));
  writeFileSync(join(folder, "straight.yaml/summary.json"), "{\"title\": ");
  execFileSync(launchdyn, ["report", join(folder, "straight.yaml")]);
  await browser.load(run.file);
  check("a broken summary is said",
    (await browser.run("document.body.textContent")).includes("summary.json is not complete"));
}

const browser = new Browser(findBrowser());
try {
  await browser.open();
  await checkLaunch(browser);
  await checkLooks(browser);
  await checkHostile(browser);
} finally {
  browser.end();
  await new Promise((go) => browser.child.on("exit", go));
  rmSync(folder, { recursive: true, force: true, maxRetries: 5 });
}
process.exit(wrong > 0 ? 1 : 0);

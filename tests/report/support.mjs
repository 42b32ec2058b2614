// What the tests of reports in a browser share: runs, Chromium led by playwright-core, checks. Run by
// the script `browser` beside it, which says where everything is.
import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";

const { LD_BROWSER, LD_FIREFOX, LD_MODULES, LD_COMMAND, LD_EXAMPLES, LD_SCREENSHOTS } = process.env;
const { chromium, _bidiFirefox } = createRequire(join(LD_MODULES, "package.json"))("playwright-core");
export const firefox = Boolean(LD_FIREFOX); // in place of Chromium; it has no WebGL without a screen

// A scratch folder, gone at the end.
export const folder = mkdtempSync(join(tmpdir(), "launchdyn-browser-"));

// ---- checks ----

let wrong = 0;

export function check(what, fine, measured = "") {
  console.log(`    ${fine ? "ok   " : "WRONG"} ${what} ${measured}`);
  wrong += !fine;
}

// Whether two numbers differ by no more than a share of the larger.
export const near = (a, b, share) => Math.abs(a - b) <= share * Math.max(Math.abs(a), Math.abs(b)) + 1e-12;

// ---- runs ----

export function launchdyn(...words) {
  return execFileSync(LD_COMMAND, words, { encoding: "utf8" });
}

// Where the command may end with one of several codes.
export function launchdynEnding(codes, ...words) {
  const { status, stderr } = spawnSync(LD_COMMAND, words, { encoding: "utf8" });
  if (!codes.includes(status)) throw new Error(`${words.join(" ")}: code ${status}, ${stderr}`);
}

export const example = (name) => join(LD_EXAMPLES, name);

// A table of text as columns: name to values.
export function readCsv(file) {
  const [head, ...rows] = readFileSync(file, "utf8").trim().split("\n");
  const table = rows.map((row) => row.split(",").map(Number));
  return new Map(head.split(",").map((title, i) => [title.replace(/ \[.*/, ""), table.map((row) => row[i])]));
}

// A run of an example with its report and its history.
export function runOf(name, ...options) {
  const out = join(folder, name);
  launchdyn("run", example(name), "--out", out, "--csv", "--report", "--quiet", ...options);
  return { out, file: join(out, "report.html"), column: readCsv(join(out, "history.csv")) };
}

// Index of the row next to a time.
export const rowNear = (times, time) =>
  times.reduce((best, t, i) => (Math.abs(t - time) < Math.abs(times[best] - time) ? i : best), 0);

// ---- the browser ----

// Runs a test with Chromium, or with Firefox by WebDriver BiDi; ends the program with its outcome. WebGL by the software
// renderer, the page itself without it, which is several times as fast.
export async function inBrowser(test, ...more) {
  const chromiums = ["--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu", "--enable-unsafe-swiftshader", ...more];
  const browser = await (firefox ? _bidiFirefox : chromium).launch({ executablePath: LD_BROWSER, timeout: 0, args: firefox ? [] : chromiums });
  try {
    await test(browser);
  } finally {
    await browser.close();
  }
  process.exitCode = wrong > 0 ? 1 : 0;
}
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));

// A replay without smoothed edges, which cost a software renderer the most, or none at all, which costs nothing; code
// of the page.
function withReplay(wanted) {
  const { getContext } = HTMLCanvasElement.prototype;
  HTMLCanvasElement.prototype.getContext = function (kind, asked, ...more) {
    if (!kind.startsWith("webgl")) return getContext.call(this, kind, asked, ...more);
    return wanted ? getContext.call(this, kind, { ...asked, antialias: false }, ...more) : null;
  };
}

// Opens a report, or an address, and waits until it says that it is ready. `before` is code that runs in the page
// before any of its own; without `replay` there is no WebGL.
export async function open(browser, file, { width = 1200, dark = false, replay = true, before, media } = {}) {
  const context = await browser.newContext(
    { viewport: { width, height: 900 }, colorScheme: dark ? "dark" : "light" });
  const page = await context.newPage();
  page.setDefaultTimeout(0); // a busy machine is not a failure
  Object.assign(page, { file, errors: [], requests: [] });
  page.on("pageerror", (error) => page.errors.push(error.message));
  page.on("console", (message) => {
    if (["error", "assert"].includes(message.type())) page.errors.push(message.text());
  });
  page.on("request", (request) => page.requests.push(request.url()));
  await page.addInitScript(() => {
    window.violations = [];
    document.addEventListener("securitypolicyviolation", ({ effectiveDirective, blockedURI }) =>
      window.violations.push(`${effectiveDirective} ${blockedURI}`));
  });
  if (!replay || !LD_SCREENSHOTS) await page.addInitScript(withReplay, replay);
  if (before) await page.addInitScript(before);
  if (media) await page.emulateMedia({ media });
  await page.goto(file.startsWith("http:") ? file : `file://${file}`);
  await page.waitForFunction(() => document.documentElement.dataset.ready === "yes");
  return page;
}

// Closes a report: whatever was done in it, there was no error, nothing against its policy, and no
// request but that for the file itself, or for what may be.
export async function leave(page, may = [`file://${page.file}`]) {
  const icon = /\/favicon\.ico\b/; // which Firefox asks a server for by itself, and the policy refuses
  const violations = (await page.evaluate(() => window.violations)).filter((text) => !icon.test(text));
  page.errors = page.errors.filter((text) => !icon.test(text));
  check("no errors", page.errors.length === 0, page.errors.join("; ").slice(0, 300));
  check("nothing against the policy", violations.length === 0, violations.join("; ").slice(0, 300));
  const asked = page.requests.filter((url) => !/^(data|blob):/.test(url));
  check("no request but the file", asked.every((url) => may.includes(decodeURIComponent(url))), asked);
  await page.context().close();
}

// What would run, style or lead away if it stood in the page, each by what it does; the policy lets none.
const injected = {
  script: "<script>window.owned = 'script'</script>",
  "script from data": "<script src=\"data:text/javascript,window.owned='data'\"></script>",
  handler: "<img src=\"data:,\" onerror=\"window.owned = 'handler'\">",
  link: "<a id=\"injected-link\" href=\"javascript:window.owned='link'\">link</a>",
  frame: "<iframe srcdoc=\"<script>parent.owned = 'frame'</script>\"></iframe>",
  style: "<style>#injected-link { position: fixed }</style>",
  attribute: "<p id=\"injected-text\" style=\"position: fixed\">text</p>",
  base: "<base href=\"file:///elsewhere/\">",
  object: "<object data=\"data:text/html,x\"></object>",
  form: "<form id=\"injected-form\" action=\"file:///elsewhere/\"></form>",
};

// A report with code in it that no escaping has stopped: the page's policy does.
export async function checkInjected(browser, file) {
  const text = readFileSync(file, "utf8"), name = file.replace(/\.html$/, "-injected.html");
  const place = text.indexOf("<main ");
  writeFileSync(name, text.slice(0, place) + Object.values(injected).join("\n") + text.slice(place));
  const page = await open(browser, name, { replay: false });
  await page.evaluate(() => {
    document.getElementById("injected-link").click();
    document.getElementById("injected-form").submit();
  });
  const sent = await page.evaluate(() => fetch("data:,x").then(() => "sent", () => "refused"));
  // What the policy stops it reports later, a form's sending last: wait for it, and no longer than need be.
  const directives = ["script-src-elem", "script-src-attr", "style-src-elem", "style-src-attr", "base-uri",
    "form-action", "connect-src", "object-src"];
  await page.waitForFunction((names) => names.every((name) => window.violations.some((text) => text.startsWith(name))),
    directives).catch(() => undefined);
  const found = await page.evaluate(() => ({
    owned: window.owned, base: document.baseURI, violations: window.violations,
    styled: ["injected-link", "injected-text"].filter((id) =>
      getComputedStyle(document.getElementById(id)).position === "fixed"),
  }));
  check("injected code does not run", found.owned === undefined, found.owned);
  check("an injected style has no effect", found.styled.length === 0, found.styled);
  check("nor has a base, or a form", ![found.base, page.url()].some((url) => url.includes("elsewhere")), found.base);
  check("nothing can be fetched", sent === "refused", sent);
  for (const directive of directives)
    check(`the policy has stopped it: ${directive}`,
      found.violations.some((violation) => violation.startsWith(directive)), found.violations.join("; "));
  await page.context().close();
}

// Waits until what was requested is drawn.
export const drawn = (page) =>
  page.evaluate(() => new Promise((go) => requestAnimationFrame(() => requestAnimationFrame(go))));

// Opens all that is folded; what has been folded draws itself then.
export async function unfold(page) {
  await page.evaluate(() => document.querySelectorAll("details").forEach((node) => { node.open = true; }));
  await drawn(page);
}

// A picture of the window, where pictures are requested.
export async function picture(page, name) {
  if (LD_SCREENSHOTS) await page.screenshot({ path: join(LD_SCREENSHOTS, name) });
}

// How many points of each 2-D canvas have the colour of a curve, with the text of its panel.
export function curvePoints(page, canvases = ".plot canvas") {
  return page.evaluate((selector) => {
    const style = getComputedStyle(document.documentElement);
    const curves = [0, 1, 2, 3, 5].map((i) => style.getPropertyValue(`--curve${i}`).trim()
      .match(/[0-9a-f]{2}/g).map((text) => parseInt(text, 16)));
    return [...document.querySelectorAll(selector)].map((canvas) => {
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      let count = 0;
      for (let i = 0; i < data.length; i += 4)
        count += data[i + 3] > 60 && curves.some(([r, g, b]) =>
          Math.abs(data[i] - r) + Math.abs(data[i + 1] - g) + Math.abs(data[i + 2] - b) < 40);
      return { count, text: canvas.closest(".panel").textContent.slice(0, 60) };
    });
  }, canvases);
}

export async function checkNoneEmpty(page) {
  const points = await curvePoints(page);
  const empty = points.filter(({ count }) => count < 50).map(({ text }) => text);
  check(`none of ${points.length} plots is empty`, points.length > 0 && empty.length === 0, empty);
}

// The page's style: nothing wider than its window, and the paper's colour.
export async function checkFits(page) {
  const [wide, room] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
  check("nothing is wider than the window", wide <= room, `${wide} of ${room}`);
}

export async function checkHeight(page) {
  const high = await page.evaluate(() => document.documentElement.scrollHeight);
  check("the page before unfolding is at most 5000 pixels high", high <= 5000, high);
}

export const paper = (page) => page.evaluate(() => getComputedStyle(document.body).backgroundColor);

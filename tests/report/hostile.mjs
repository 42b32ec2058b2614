// Texts that mean something elsewhere, through every output: what is read back, by parsers that are not
// ours (the browser's of HTML, JSON and XML, h5dump), is the text, and nothing of it ran.
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync, readdirSync, symlinkSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { check, example, folder, inBrowser, launchdyn, launchdynEnding, leave, open } from "./support.mjs";

const parts = [
  "</title></script></style><script>window.owned=1</script><!-- <script> --> ]]> <![CDATA[",
  "<img src=x onerror=window.owned=1> &lt;&amp;&#60; javascript:window.owned=1",
  "'`touch owned`' \"$(touch owned)\" ; system('touch owned') # \\",
  "@touch {/Symbol a}_2^3 &{x} %s%n%1$s ${HOME} ~ * ?",
  "'); DROP TABLE study; -- \"; DELETE FROM sample",
  "=cmd()|'/c calc'!A0,\"a\"\"b\";\tc",
  "\u2028\u2029\u202eabc\u2066def\u200b\u00ad\ufeff\u0085\u009b31m \u{1f680} \u{e0041} \uffff",
  "\u001b[31m \u0007 \u0001 \u007f line\nline\r\nline",
];
const title = `=1+1${parts.join(" ")} ${"x".repeat(100000)}`;

// What XML 1.0 cannot hold, and what a terminal does not show, bytes in UTF-8.
const inXml = (text) => text.replace(/[^\t\n\u0020-\ufffd\u{10000}-\u{10ffff}]/gu, "\ufffd");
const hidden = /[\p{Cc}\p{Zl}\p{Zp}\p{Default_Ignorable_Code_Point}\p{Noncharacter_Code_Point}\ufff9-\ufffb]/gu;
const visible = (text) => text.replace(hidden, (c) => [...Buffer.from(c)].map((byte) =>
  `\\x${byte.toString(16).padStart(2, "0")}`).join(""));

// A scenario of our own; JSON's strings are YAML's, with the escapes that YAML requires.
function scenario(name, lines) {
  const file = join(folder, name);
  writeFileSync(file, lines.join("\n") + "\n");
  return file;
}
const yaml = (text) => JSON.stringify(text).replace(/[\u007f-\uffff]/g, (c) =>
  /[\ud800-\udfff]/.test(c) ? c : `\\u${c.charCodeAt(0).toString(16).padStart(4, "0")}`);

// A text in YAML's double quotes.
const fromYaml = (text) => JSON.parse(text.replace(/\\(x..|U.{8}|u.{4}|.)/g, (whole, code) =>
  code.length === 1 ? whole : JSON.stringify(String.fromCodePoint(parseInt(code.slice(1), 16))).slice(1, -1)));

// Rows of CSV (RFC 4180), quotes and line ends in fields.
function rowsOf(text) {
  const rows = [[]];
  const field = /("(?:[^"]|"")*"|[^,"\r\n]*)(,|\r?\n|$)/gy;
  while (field.lastIndex < text.length) {
    const [, value, end] = field.exec(text);
    rows.at(-1).push(value.startsWith('"') ? value.slice(1, -1).replaceAll('""', '"') : value);
    if (end !== ",") rows.push([]);
  }
  return rows.slice(0, -1);
}

// The texts of all elements of a name in a file of XML, as the browser reads it.
const xmlTexts = (page, file, name) => page.evaluate(([text, tag]) => {
  const document = new DOMParser().parseFromString(text, "application/xml");
  return document.querySelector("parsererror")?.textContent ?? [...document.getElementsByTagName(tag)].map((node) => node.textContent);
}, [readFileSync(file, "utf8"), name]);

const same = (found, wanted) => found === wanted ? "" : `${JSON.stringify(found)?.slice(0, 1500)} in place of ${JSON.stringify(wanted).slice(0, 1500)}`;
const checkSame = (what, found, wanted) => check(what, found === wanted, same(found, wanted));

async function checkRun(browser) {
  console.log(`a title of ${title.length} characters through the files of a run`);
  const flight = scenario("flight.yaml", [`include: ${example("flight.yaml")}`, `title: ${yaml(title)}`,
    "environment: {site: {latitude: 45 deg, longitude: 7 deg}}", "run: {end: 0.2 s}"]);
  const out = join(folder, "<img src=x onerror=window.owned=1>&'`touch owned`");
  const printed = launchdyn("run", flight, "--out", out, "--csv", "--report");
  check("the terminal", printed.startsWith(visible(title).slice(0, 4000)) && !hidden.test(printed.replaceAll("\n", "")),
    printed.slice(0, 60));
  const summary = JSON.parse(readFileSync(join(out, "summary.json"), "utf8"));
  checkSame("summary.json", summary.title, title);
  const [, attribute] = execFileSync("h5dump", ["-a", "/title", join(out, "history.h5")],
    { encoding: "utf8", maxBuffer: 1e8 }).split("(0): ");
  check("history.h5: the title, as h5dump prints it", attribute.includes("=1+1</title></script>") && attribute.includes("x".repeat(1000)));
  const page = await open(browser, join(out, "report.html"));
  checkSame("report.html: heading", await page.textContent("h1"), title);
  checkSame("report.html: title", await page.evaluate(() => document.querySelector("title").textContent.replace(/\r\n?/g, "\n")),
    title.replace(/\r\n?/g, "\n"));
  checkSame("trajectories.kml", (await xmlTexts(page, join(out, "trajectories.kml"), "name"))[0], inXml(title));
  check("nothing of it ran", await page.evaluate(() => window.owned === undefined && !document.querySelector("img:not(.photo)")));
  await checkPicture(page, flight, out);
  await leave(page);
}

// Two runs laid one over the other are named by their titles; two of one title by their folders.
async function checkPicture(page, flight, out) {
  const other = join(folder, "other");
  launchdyn("run", flight, "--out", other, "--quiet", "--set", `title=${JSON.stringify("other")}`);
  const picture = join(folder, "picture.svg"), named = () => xmlTexts(page, picture, "text").then((list) => list.map((t) => t.trim()));
  launchdyn("plot", out, other, "--what", "flight-speed", "-o", picture);
  const texts = await named();
  const found = Array.isArray(texts) && texts.find((text) => text.startsWith("=1+1"));
  checkSame("plot: the name of a run", found, visible(title).replace("]]>", "]]\\x3e").trim()); // ]]> is not text of XML
  const again = `${out}\udcff`.replace(/\udcff/, ""), odd = Buffer.concat([Buffer.from(join(folder, "a")), Buffer.from([0xff, 0x62])]);
  symlinkSync(again, odd);
  execFileSync("sh", ["-c", `"$1" plot "$2" "$(printf '%s/a\\377b' "$3")" --what flight-speed -o "$4"`, "sh",
    process.env.LD_COMMAND, out, folder, picture], { encoding: "utf8" });
  const folders = await named();
  check("plot: the names of folders, one with a byte that is no UTF-8", folders.includes(out) &&
    folders.includes(join(folder, "a\\xffb")), folders.length);
}

// Summaries that are not ours, without the digests that would show it: the page shows what it can and says so.
async function checkSummaries(browser) {
  console.log("summaries by hand");
  const out = join(folder, "other"), file = join(out, "report.html"), code = parts[1];
  const usual = { title: "by hand", version: "0", complete: false, t_end: 1, rockets: [] };
  const summaries = { text: "{", "wrong rockets": { ...usual, rockets: { length: 3 } },
    "wrong notes": { ...usual, notes: 5 },
    texts: { ...usual, title: code, stopped: code, notes: [code], rockets: [{ tube: 1, [code]: 1 }],
      modes: [{ shape: code, frequency: 1, damping: 0 }], equilibrium: { contact_force: { [code]: 1 } } } };
  for (const [name, summary] of Object.entries(summaries)) {
    writeFileSync(join(out, "summary.json"), typeof summary === "string" ? summary : JSON.stringify(summary));
    launchdynEnding([0, 2], "report", out);
    const page = await open(browser, file, { replay: false }), text = await page.textContent("body");
    if (name === "texts") check("texts are shown as texts", (await page.textContent("h1")) === code && text.includes(`ended early: ${code}`) &&
      text.includes(`contact force, ${code}`), text.slice(0, 300));
    else check(`${name}: a note says what is not there`, /No summary/.test(text), text.slice(0, 300));
    check("the plots are there", (await page.locator(".plot canvas").count()) > 3);
    check("nothing of it ran", await page.evaluate(() => window.owned === undefined && !document.querySelector("img:not(.photo)")));
    await leave(page);
  }
}

async function checkStudy(browser) {
  console.log("texts of a study");
  const cells = parts.map((part) => part.replace(/[\t\r\n]/g, " "));
  const file = scenario("study.yaml", [`include: ${example("flight.yaml")}`, "run: {end: 0.2 s}",
    `sweep: {title: [${cells.map(yaml).join(", ")}]}`,
    "scatter: {samples: 1, factors: {rocket.motor.thrust_scale: {normal: 1 %}}}"]);
  const out = join(folder, "study"), csv = join(folder, "=study.csv");
  launchdyn("study", file, "--out", out, "--quiet");
  launchdyn("study", "export", out, "--csv", csv);
  const [head, ...rows] = rowsOf(readFileSync(csv, "utf8"));
  const values = rows.map((row) => row[head.indexOf("title")]);
  check(`CSV: ${cells.length} texts of a sweep, as a scenario has them`, values.map(fromYaml).join() === cells.join(), JSON.stringify(values));
  check("none of them is a formula", rows.flat().every((value) => Number.isFinite(Number(value)) || !/^[=+\-@\t\r]/.test(value)));
  const report = join(folder, "study.html");
  launchdyn("report", out, "-o", report);
  const page = await open(browser, report), text = await page.textContent("body");
  check("report: the same texts", values.every((value) => text.includes(value)));
  check("nothing of it ran", await page.evaluate(() => window.owned === undefined && !document.querySelector("img")));
  await leave(page);
}

await inBrowser(async (browser) => {
  await checkRun(browser);
  await checkSummaries(browser);
  await checkStudy(browser);
  check("no file `owned` was made", !existsSync("owned") && !readdirSync(folder, { recursive: true }).includes("owned"));
});

// The report of studies in a real browser.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { check, checkFits, checkHeight, checkInjected, drawn, example, folder, inBrowser, launchdyn, leave, near, open, paper, picture,
  readCsv, unfold } from "./support.mjs";

// Of the thrust and of its angles.
const NORMAL = ["{normal: 1 %, within: 3}", "{normal: 0.5 mrad, within: 3}"], UNIFORM = ["{uniform: 0.98 1.02}", "{uniform: -0.9 0.9 mrad}"];

// A scattered flight, with other values for some keys.
function studyOf(name, samples, { title = "Flight, scattered", speed = "36.8 12.6 0 m/s", factors: [thrust, angle] = NORMAL, more = "" } = {}) {
  const scenario = join(folder, `${name}.yaml`), out = join(folder, name), csv = join(folder, `${name}.csv`);
  writeFileSync(scenario, `include: ${example("flight.yaml")}
title: ${JSON.stringify(title)}
flight: {velocity: ${speed}}
scatter:
  seed: 7
  samples: ${samples}
  factors:
    rocket.motor.thrust_scale: ${thrust}
    rocket.motor.misalignment.y: ${angle}
    rocket.motor.misalignment.z: ${angle}
${more}`);
  launchdyn("study", scenario, "--out", out, "--quiet");
  launchdyn("study", "export", out, "--csv", csv);
  return { out, column: readCsv(csv) };
}

function reportOf(name, ...studies) {
  const file = join(folder, name);
  launchdyn("report", ...studies.map((study) => study.out), "-o", file);
  return file;
}

const panel = (title) => `.panel[data-title="${title}"]`;
const readingOf = (page, title) => page.$eval(`${panel(title)} .reading`, (node) => node.textContent);
const dataOf = (page) => page.evaluate(() => JSON.parse(document.getElementById("data").textContent));
const frame = async (page, title) => {
  const marks = page.locator(`${panel(title)} .marks`);
  await marks.evaluate((node) => node.scrollIntoView({ block: "center" }));
  return marks.boundingBox();
};

// Every plot has marks, and some of them stand between the axes.
async function checkNoneEmpty(page, least) {
  const shown = await page.$$eval(".panel", (panels) => panels.map((node) => {
    const box = node.querySelector("svg.marks").getBoundingClientRect();
    const inside = [...node.querySelectorAll("svg.marks :is(path, rect, circle)")].filter((mark) => {
      const own = mark.getBoundingClientRect();
      return own.width + own.height > 4 && own.right > box.left && own.left < box.right &&
        own.bottom > box.top && own.top < box.bottom && getComputedStyle(mark).stroke + getComputedStyle(mark).fill !== "nonenone";
    });
    return { title: node.dataset.title, count: inside.length };
  }));
  const empty = shown.filter(({ count }) => count === 0).map(({ title }) => title);
  check(`none of ${shown.length} plots is empty`, shown.length >= least && empty.length === 0, empty);
}

const numbersIn = (text) => (text.match(/-?\d+(\.\d+)?(e[-+]\d+)?/g) ?? []).map(Number);

// The mouse over a histogram, a scatter plot, an estimate: what stands below is what the study holds.
async function checkCursor(page, study) {
  const downrange = study.column.get("downrange"), drift = study.column.get("drift");
  for (const share of [0.3, 0.5, 0.7]) {
    const box = await frame(page, "Downrange: distribution");
    await page.mouse.move(box.x + share * box.width, box.y + box.height / 2);
    const text = await readingOf(page, "Downrange: distribution");
    const [low, high, count, of] = numbersIn(text.replace(" to ", " "));
    const slack = 1e-5 * high, within = (from, to) => downrange.filter((v) => v >= from && v < to).length;
    check("a bin holds the values that it says", of === downrange.length &&
      count >= within(low + slack, high - slack) && count <= within(low - slack, high + slack), text);
  }
  for (const share of [0.4, 0.6]) {
    const box = await frame(page, "Landing points");
    await page.mouse.move(box.x + share * box.width, box.y + box.height / 2);
    const text = await readingOf(page, "Landing points"), [sample, x, y] = numbersIn(text);
    check("a point is that of its sample",
      near(downrange[sample - 1], x, 1e-5) && near(drift[sample - 1], y, 1e-5), text);
  }
  const box = await frame(page, "Downrange: running mean");
  await page.mouse.move(box.x + box.width - 1, box.y + box.height / 2);
  const text = await readingOf(page, "Downrange: running mean"), [n, mean] = numbersIn(text);
  check("the last estimate is the mean of all", n === downrange.length &&
    near(mean, downrange.reduce((sum, v) => sum + v) / n, 1e-5), text);
}

// The bars of a result: the longest on top, each as long as its share, the same number below.
async function checkBars(page) {
  const data = await dataOf(page), title = "Drift: factors";
  const [own] = data.sensitivities.find(({ name }) => name === "drift").series;
  const shares = own.map(([, [value]]) => value).sort((a, b) => b - a);
  await frame(page, title);
  const lengths = await page.$$eval(`${panel(title)} rect.bar`, (bars) => bars.map((bar) => bar.getBBox().width));
  check("a bar for each factor", lengths.length === 3 && shares.length === 3, lengths);
  check("as long as its share", near(lengths[1] / lengths[0], Math.abs(shares[1] / shares[0]), 1e-3) && shares[0] > 0.9,
    shares);
  const bar = await page.locator(`${panel(title)} rect.bar`).first().boundingBox();
  await page.mouse.move(bar.x + 20, bar.y + bar.height / 2);
  const text = await readingOf(page, title);
  check("its number stands below", text.startsWith("rocket.motor.misalignment.y: ") &&
    near(numbersIn(text)[0], 100 * shares[0], 1e-5), text);
}

async function checkTable(page) {
  const data = await dataOf(page), result = data.results.find(({ name }) => name === "downrange");
  const cells = await page.$$eval(".statistics tr[title='downrange'] td:not(.unit)", (list) =>
    list.map((cell) => cell.childNodes[0].textContent));
  const { mean, deviation, quantiles } = result.series[0];
  const expected = [mean[0], deviation[0], null, ...quantiles.map(([v]) => v)];
  check("the table has the statistics", expected.every((v, i) => v === null || near(Number(cells[i]), v, 1e-2)), cells);
}

async function checkKeys(page) {
  const title = "Downrange: distribution", data = await dataOf(page);
  const { from, width, count } = data.results.find(({ name }) => name === "downrange").bins;
  await page.mouse.move(1, 1);
  await page.locator(`${panel(title)} .plot > svg`).focus();
  const after = async (key) => {
    await page.keyboard.press(key);
    return numbersIn((await readingOf(page, title)).replace(" to ", " "))[0];
  };
  check("an arrow begins at the first bin", near(await after("ArrowRight"), from, 1e-5));
  check("the next one is the second", near(await after("ArrowRight"), from + width, 1e-5));
  check("End is the last", near(await after("End"), from + (count - 1) * width, 1e-5));
  check("Escape takes the cursor away", (await after("Escape")) === undefined);
}

// What the button hands out is the data of the plot.
async function checkDownload(page, study) {
  const [file] = await Promise.all([page.waitForEvent("download"),
    page.locator(`${panel("Landing points")} .csv`).click()]);
  const text = readFileSync(await file.path(), "utf8"), rows = text.trim().split("\n");
  const [, sample, , x, y] = rows[5].split(",");
  check("CSV with units", rows[0].includes('"downrange [m]","drift [m]"'), rows[0]);
  check("CSV of all points", rows.length === 1 + study.column.get("drift").length && near(study.column.get("downrange")[sample - 1], Number(x), 1e-7) &&
    near(study.column.get("drift")[sample - 1], Number(y), 1e-7), rows[5]);
}

// What one reads first: the answer and the sensitivities, one plot a result, the rest folded.
async function checkFirst(page, study) {
  await checkHeight(page);
  const heads = await page.$$eval("h2", (list) => list.map((node) => node.textContent));
  check("the answer and the sensitivities stand first", heads.join() === "Answer and sensitivities,Scatter,Results,Numbers,Origin", heads);
  const bottom = await page.$eval(".lead", (node) => node.getBoundingClientRect().bottom);
  check("on the first screen", bottom < 900, bottom);
  const tops = await page.$$eval(".lead .panel", (list) => list.map((node) => Math.round(node.getBoundingClientRect().top)));
  check("three plots beside it stand in one row", tops.length !== 3 || new Set(tops).size === 1, tops);
  const rows = await page.$$eval(".answer tr", (list) => list.map((row) => [...row.cells].map((cell) => cell.textContent)));
  const downrange = study.column.get("downrange"), mean = downrange.reduce((sum, v) => sum + v) / downrange.length;
  const deviation = Math.sqrt(downrange.reduce((sum, v) => sum + (v - mean) ** 2, 0) / (downrange.length - 1));
  const [, said, between] = rows.find(([name]) => name === "Downrange"), sorted = [...downrange].sort((a, b) => a - b);
  const [low, high95] = numbersIn(between), inside = sorted.filter((v) => v >= low && v <= high95).length;
  check("mean and deviation to two digits of the deviation", Math.abs(numbersIn(said)[0] - mean) <= 0.5 && Math.abs(numbersIn(said)[1] - deviation) <= 0.5, said);
  check("and between what 90 % lie", near(inside, 0.9 * sorted.length, 0.02), `${inside} of ${sorted.length}`);
  const plots = await page.$$eval(".panel", (list) => list.filter((node) => !node.closest("details") && node.dataset.title.endsWith("distribution"))
    .map((node) => node.dataset.title));
  check("one plot for each of the first results", plots.length === rows.length - 1 && new Set(plots).size === plots.length, plots);
  const note = await page.textContent(`${panel("Landing points")} .shown`);
  check("what the cloud is stands below it, with the level", note.includes("normal by Mardia's test at 5") && note.includes("ellipses"), note);
}

async function checkOne(browser, study) {
  console.log("one study");
  const file = reportOf("one.html", study), page = await open(browser, file, { width: 1400 });
  await checkFirst(page, study);
  await unfold(page);
  await checkNoneEmpty(page, 25);
  await checkCursor(page, study);
  await checkTable(page);
  await checkBars(page);
  await checkKeys(page);
  await checkDownload(page, study);
  await picture(page, "study.png");
  await leave(page);
  await checkInjected(browser, file);
}

// A sweep of single runs: what differs from point to point is the answer.
async function checkSweep(browser) {
  console.log("a sweep of single runs");
  const scenario = join(folder, "sweep.yaml"), out = join(folder, "sweep"), masses = [55, 60, 65];
  writeFileSync(scenario, `include: ${example("fixed.yaml")}\nsweep: {rocket.mass: [${masses.map((mass) => `${mass} kg`)}]}\n`);
  launchdyn("study", scenario, "--out", out, "--quiet");
  const page = await open(browser, reportOf("sweep.html", { out }), { width: 1400 });
  const rows = await page.$$eval(".answer tr", (list) => list.map((row) => [...row.cells].map((cell) => cell.textContent)));
  const column = rows[0].indexOf("Exit speed, along the tube [m/s]"), speeds = masses.map((mass) =>
    JSON.parse(launchdyn("run", example("fixed.yaml"), "--set", `rocket.mass=${mass} kg`, "--json")).rockets[0].exit_speed);
  check("each point has a row with its values", rows.length === 4 && column > 0 && speeds.every((speed, i) => near(Number(rows[i + 1][column]), speed, 2e-4)), JSON.stringify(rows));
  check("not called means", (await page.textContent(".answer h3")) === "Results");
  check("the table begins with the swept values", rows[0][0] === "rocket.mass" && masses.every((mass, i) => rows[i + 1][0] === `${mass} kg`), JSON.stringify(rows.map(([first]) => first)));
  const said = await page.textContent(".sentence");
  check("single launches have no interval", said.startsWith("With rocket.mass ") && said.endsWith("Single launches: no interval."), said);
  await leave(page);
}

// The first screen of a sweep with scatter: one sentence with its interval, then one picture, whose dots stand where its
// axes say; pooled numbers as study show has them.
async function checkSwept(browser) {
  console.log("a sweep over two keys");
  const scenario = join(folder, "swept.yaml"), out = join(folder, "swept"), masses = [55, 60, 65];
  writeFileSync(scenario, `include: ${example("fixed.yaml")}\nsweep: {rocket.mass: [${masses.map((mass) => `${mass} kg`)}], base.elevation: [10 deg, 20 deg]}\n` +
    "scatter: {samples: 8, factors: {rocket.mass_error: {normal: 0.2 kg}, rocket.eccentricity.y: {normal: 0.3 mm}}}\n");
  launchdyn("study", scenario, "--out", out, "--quiet");
  const page = await open(browser, reportOf("swept.html", { out }), { width: 1400 }), { over } = await dataOf(page);
  const { result: r, key: k, value, deviation } = over.lead, result = over.results[r], key = over.keys[k], said = await page.textContent(".sentence");
  const cell = result.keys[k][value], estimate = deviation ? cell.ratio : cell.difference.map((v) => 1e3 * v);
  const [low, high] = /95\s% interval (\S+) to (\S+)\)/.exec(said).slice(1).map((text) => Number(text.replace("−", "-")));
  check("the sentence has the interval", near(low, estimate[1], 0.05) && near(high, estimate[2], 0.05) && said.includes(`${key.name} ${key.texts[value]}`), said);
  const other = over.keys[1 - k].name;
  check("the sentence says over what it is pooled", said.includes(`pooled over ${other}`), said);
  const boxes = await page.$$eval("#summary ~ *", (list) => list.slice(0, 3).map((node) => node.className.split(" ").find((name) => ["sentence", "panel", "answer"].includes(name)) ?? node.className));
  check("sentence, picture, table", boxes.join() === "sentence,panel,answer", boxes);
  const rows = await page.$$eval(".answer tr", (list) => list.map((row) => [...row.cells].map((one) => one.textContent)));
  check("a row names both swept values", rows[0].slice(0, 2).join() === "rocket.mass,base.elevation" && rows[6].slice(0, 2).join() === "65 kg,20 deg", JSON.stringify(rows.map((row) => row.slice(0, 2))));
  check("no point by its number", !/\bpoint \d/.test(await page.textContent("main, #report")));
  const title = await page.getAttribute("#summary ~ .panel", "data-title"), dots = await page.$$eval(`${panel(title)} circle.dot`, (list) => list.map((dot) => [Number(dot.getAttribute("cx")), Number(dot.getAttribute("cy"))]));
  const ticks = await page.$$eval(`${panel(title)} .plot > svg > text:not(.axis)`, (list) => list.map((text) => [text.getAttribute("text-anchor"), Number(text.getAttribute("x")), Number(text.getAttribute("y")), Number(text.textContent.replace("−", "-"))]));
  const lineOf = (pairs) => { const [[a, u], [b, v]] = [pairs[0], pairs.at(-1)]; return (at) => u + ((at - a) / (b - a)) * (v - u); };
  const y = lineOf(ticks.filter(([anchor]) => anchor === "end").filter(([, x]) => x < 100).map(([, , at, v]) => [at - 4, v]));
  const x = lineOf(ticks.filter(([anchor]) => anchor === "middle").map(([, at, , v]) => [at, v]));
  const shown = result.keys[k].map((own) => 1e3 * own[deviation ? "deviation" : "mean"][0]), span = Math.max(...shown) - Math.min(...shown);
  check("dots stand at their values", dots.length === shown.length && dots.every(([left, top], i) => Math.abs(x(left) - key.numbers[i]) < 0.01 * (key.numbers.at(-1) - key.numbers[0]) && Math.abs(y(top) - shown[i]) < 0.02 * span), `${JSON.stringify(dots)} ${shown}`);
  const table = launchdyn("study", "show", out, "--over", key.name, "--what", result.name).split("\n").filter((line) => line.startsWith(key.texts[value]));
  check("the pooled mean is that of study show", near(Number(table[0].split(/\s+/)[2]), 1e3 * cell.mean[0], 1e-4), table[0]);
  const from = launchdyn("study", "show", out, "--over", key.name, "--against", `${key.name}=${key.reference}`, "--what", result.name).split("\n").find((line) => line.startsWith(key.texts[value]));
  check("the difference is that of study show", near(Number(from.split(/\s+/)[2]), 1e3 * cell.difference[0], 1e-3), from);
  await picture(page, "swept.png");
  await leave(page);
}

// Where nothing distinguishes factors, clouds stand beside the answer, and fill the first screen with it at every width.
async function checkWithout(browser) {
  console.log("a study without sensitivities");
  const scenario = join(folder, "seeds_in_a_file_whose_name_has_no_place_where_a_line_might_break.yaml"), out = join(folder, "seeds");
  writeFileSync(scenario, `include: ${example("marching/15-kmh.yaml")}\nscatter: {samples: 12, factors: {base.road.seed: {each: sample}}}\n`);
  launchdyn("study", scenario, "--out", out, "--quiet");
  const page = await open(browser, reportOf("seeds.html", { out }), { width: 1400 });
  const heads = await page.$$eval("h2", (list) => list.map((node) => node.textContent));
  check("the answer and clouds stand first", heads.join() === "Answer and scatter,Results,Numbers,Origin", heads);
  for (const [width, least] of [[1400, 0.7], [1000, 0.7], [400, 0.8]]) {
    await page.setViewportSize({ width, height: 900 });
    await drawn(page);
    const { share, narrow, titles } = await page.evaluate(() => {
      const cards = [...document.querySelectorAll(".lead .answer, .lead .panel")].map((node) => node.getBoundingClientRect());
      const seen = cards.map(({ width, top, bottom }) => width * Math.max(0, Math.min(900, bottom) - Math.max(0, top)));
      const top = document.querySelector(".lead").getBoundingClientRect().top, end = Math.min(900, document.querySelector(".lead").getBoundingClientRect().bottom);
      return { share: seen.reduce((sum, v) => sum + v, 0) / (document.querySelector("main").clientWidth * (end - top)),
        narrow: Math.min(...cards.map(({ width }) => width)), titles: [...document.querySelectorAll(".lead .panel")].map(({ dataset }) => dataset.title) };
    });
    check(`${width} pixels: cards fill it, none too narrow`, share > least && narrow > 270 && titles.length === 4, `${share}, ${narrow} pixels, ${titles}`);
    await checkFits(page);
    await picture(page, `study-without-${width}.png`);
  }
  const all = await page.$$eval(".panel", (list) => list.map(({ dataset }) => dataset.title));
  await unfold(page);
  const shown = await page.$$eval(".panel", (list) => list.map(({ dataset }) => dataset.title));
  check("no plot twice", all.length > 6 && new Set(shown).size === shown.length, shown.length);
  await leave(page);
}

// Where lines lie: twelve places of each, in a plot and a table of their own.
async function checkLine(browser) {
  const out = join(folder, "thrown");
  launchdyn("study", example("line-thrower.yaml"), "--set", "environment.wind={speed: 5 m/s, heading: 90 deg}",
    "--set", "scatter={samples: 5, factors: {tubes.pressure.scale: {normal: 2 %}}}", "--quiet", "--out", out);
  const page = await open(browser, reportOf("thrown.html", { out }), { width: 1400 });
  await unfold(page);
  const dots = await page.$eval(`${panel("Where the line lies")} .points`, (node) => node.getAttribute("d").match(/M/g).length);
  check("places of five lines", dots === 60, dots);
  const rows = await page.$$eval(".footprints tr", (list) => list.map((row) => [...row.cells].map((cell) => cell.textContent)));
  check("landings and lines", rows.filter(([name]) => name === "95\u00a0%").map((row) => row.at(-1)).join() === "too few landings,too few places", rows);
  await leave(page);
}

// Landing points within their footprint, as it is drawn, and what its table says.
async function checkFootprints(browser) {
  console.log("footprints");
  const { out } = studyOf("safety", 400, { factors: UNIFORM });
  const page = await open(browser, reportOf("safety.html", { out }), { width: 1400 });
  const drawn = await page.$$eval(`${panel("Landing points")} .ellipse`, (list) => list.map((node) => `${node.classList[1]} ${node.dataset.name}`));
  check("that for which there are enough landings, nothing else", drawn.join() === "footprint 95 %", drawn);
  const names = await page.$$eval(`${panel("Landing points")} .outline-name`, (list) => list.map((node) => node.textContent));
  check("with its name", names.join() === "95 %", names);
  const share = await page.$eval(panel("Landing points"), (node) => {
    const outline = node.querySelector(".footprint"), dots = node.querySelector(".points").getAttribute("d").match(/[\d.]+ [\d.]+/g);
    const inside = dots.filter((dot) => outline.isPointInFill(new DOMPoint(...dot.split(" ").map(Number))));
    return inside.length / dots.length;
  });
  check("it holds as many landings as it says", near(share, 0.95, 0.025), share);
  const rows = await page.$$eval(".footprints tr", (list) => list.map((row) => [...row.cells].map((cell) => cell.textContent)));
  check("the table has each share", rows.slice(1).map(([name]) => name).join() === "95\u00a0%,99\u00a0%,99.9\u00a0%", rows.slice(1));
  check("and how many landings it wants", rows.slice(1).map(([, there, needed]) => `${there} of ${needed}`).join() === "400 of 180,400 of 900,400 of 9000");
  check("too few are told", rows.slice(2).every((row) => row.at(-1) === "too few landings"), rows.slice(2));
  const note = await page.textContent(`${panel("Landing points")} .shown`);
  check("below the plot, too", note.includes("footprints: 95\u00a0% of landings lie within"), note);
  await leave(page);
  await checkLine(browser);
}

async function checkSideBySide(browser, studies) {
  console.log("three studies beside each other, dark, 400 pixels wide");
  const file = reportOf("three.html", ...studies), page = await open(browser, file, { width: 400, dark: true });
  await unfold(page);
  await checkNoneEmpty(page, 25);
  await checkFits(page);
  check("dark as the system says", (await paper(page)) === "rgb(20, 24, 28)");
  const box = await frame(page, "Downrange: distribution");
  await page.mouse.move(box.x + 0.5 * box.width, box.y + box.height / 2);
  const text = await readingOf(page, "Downrange: distribution");
  check("a bin says what each study has there", ["slow", "middle", "fast"].every((name) => text.includes(`${name}: `)), text);
  const ellipses = await page.$$eval(`${panel("Landing points")} .ellipse`, (list) => list.map((node) => getComputedStyle(node).stroke));
  check("two lines each, in the study's colour", ellipses.length === 6 && new Set(ellipses).size === 3, ellipses);
  const forms = await page.$$eval(`${panel("Landing points")} .ellipse`, (list) => list.map((node) => node.classList[1]));
  check("ellipses where a cloud is normal, contours of the one that is not", forms.sort().join() === "contour,contour,normal,normal,normal,normal", forms);
  const heads = await page.$$eval(".statistics thead tr:last-child", (rows) => rows[0].textContent);
  check("the table has columns for each", heads === "slowmiddlefastslowmiddlefast", heads);
  await page.locator("#scatter").scrollIntoViewIfNeeded();
  await picture(page, "studies-narrow.png");
  await page.locator("#theme").click();
  await drawn(page);
  check("the switch makes it light", (await paper(page)) === "rgb(255, 255, 255)");
  await page.emulateMedia({ media: "print" });
  check("on paper without buttons", !(await page.locator(".csv").first().isVisible()));
  await leave(page);
}

// A column goes from 5 to 95 %, on the scale that its median and its mean give.
async function checkColumnEnds(page) {
  const { series } = (await dataOf(page)).results.find(({ name }) => name === "downrange");
  const drawn = await page.$eval(panel("Downrange: distribution"), (node) => {
    const all = (kind, ...names) => [...node.querySelectorAll(kind)].map((one) => names.map((name) => Number(one.getAttribute(name))));
    return { boxes: all("rect.area", "y", "height"), middles: all("line.quantile", "y1"), means: all("circle.dot", "cy") };
  });
  const medians = series.map(({ quantiles }) => quantiles[1][0]), [[first], , [last]] = drawn.middles;
  const at = (v) => first + ((last - first) * (v - medians[0])) / (medians[2] - medians[0]);
  const off = series.map(({ mean, quantiles }, i) => { const [top, height] = drawn.boxes[i];
    return Math.max(Math.abs(top - at(quantiles[2][0])), Math.abs(top + height - at(quantiles[0][0])), Math.abs(drawn.means[i][0] - at(mean[0]))); });
  check("from 5 to 95 %, with its mean", Math.max(...off) < 0.05 && drawn.boxes.every(([, height]) => height > 10), `${Math.max(...off)} pixels off`);
}

// More than can be laid over each other stand in columns.
async function checkColumns(browser, studies) {
  console.log("six studies");
  const file = reportOf("six.html", ...studies, ...studies), page = await open(browser, file);
  await unfold(page);
  await checkNoneEmpty(page, 25);
  const columns = await page.locator(`${panel("Downrange: distribution")} rect.area`).count();
  check("a column for each", columns === 6, columns);
  await checkColumnEnds(page);
  await picture(page, "studies-columns.png");
  await leave(page);
}

// Launches beside two studies: a row of dots for each side, and what the table says of the mean.
async function checkMeasured(browser, [slow, fast]) {
  console.log("measured launches");
  const launches = join(folder, "launches.csv"), downrange = slow.column.get("downrange"), file = join(folder, "measured.html");
  writeFileSync(launches, `downrange [km],apogee [m]\n${downrange.filter((_, i) => i % 3 === 0).map((v) => `${v / 1000},`).join("\n")}\n,900\n`);
  launchdyn("report", slow.out, fast.out, "--measured", launches, "-o", file);
  const page = await open(browser, file), title = "Downrange: measured and simulated";
  const rows = await page.$$eval("#measured + section tr", (list) => list.map((row) => [...row.cells].map((cell) => cell.textContent)));
  const [, , mean] = rows, stars = [mean[7], mean[10]].map((text) => text.endsWith("*"));
  check("the fast study has a star, the slow one none", mean[0] === "Downrange" && !stars[0] && stars[1], mean);
  const single = rows.at(-1); // one launch has no deviation
  check("a dash for what cannot be stated", [4, 6, 7, 9, 10].every((i) => single[i] === "–"), single);
  const dots = await page.$$eval(`${panel(title)} .points`, (list) => list.map((node) => node.getAttribute("d").split("M").length - 1));
  check("dots of three sides", dots.length === 3 && dots[0] === 50 && dots[1] > 100, dots);
  const box = await frame(page, title);
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 5);
  const text = await readingOf(page, title), all = downrange.filter((_, i) => i % 3 === 0);
  check("the reading says the mean", near(all.reduce((sum, v) => sum + v, 0) / all.length, numbersIn(text)[0], 1e-4), text);
  await picture(page, "studies-measured.png");
  await leave(page);
}

// Launches near the vertical: a warning, marks at what is singular there, none at what is not.
async function checkVertical(browser) {
  console.log("launches near the vertical");
  const marks = [];
  for (const elevation of [70, 89.99]) {
    const scenario = join(folder, `at${elevation}.yaml`), out = join(folder, `at${elevation}`);
    writeFileSync(scenario, `include: ${example("fixed.yaml")}
base: {elevation: ${elevation} deg}
scatter: {samples: 12, factors: {rocket.mass: {normal: 1 kg}}}
`);
    launchdyn("study", scenario, "--out", out, "--quiet");
    const page = await open(browser, reportOf(`at${elevation}.html`, { out }));
    await unfold(page);
    const titles = await page.$$eval(".panel", (panels) => panels.map((node) => node.dataset.title)), marked = titles.filter((title) => title.includes("near the vertical"));
    const rows = await page.$$eval("#report th", (heads) => heads.map((node) => node.textContent).filter((text) => text.includes("near the vertical")));
    const warned = await page.$$eval(".warning", (list) => list.some((node) => node.textContent.includes("near the vertical")));
    marks.push([warned, marked.length > 0, rows.length > 0]);
    if (elevation > 80) {
      check("what is singular is marked, and that alone", marked.every((title) => /ground frame/.test(title)) &&
        ["Yaw", "Pitch rate", "Yaw rate"].every((name) => marked.some((title) => title.startsWith(`${name}, ground frame (near the vertical`))) &&
        titles.some((title) => title.startsWith("Pitch, ground frame: ")), marked.join("; "));
      const of = (start) => titles.findIndex((title) => title.startsWith(start));
      check("the launcher's axes come first", of("Rates at the exit, launcher's axes at ignition") >= 0 &&
        of("Rates at the exit, launcher's axes at ignition") < of("Rates at the exit, ground frame"), titles.slice(0, 12).join("; "));
    }
    await leave(page);
  }
  check("at 89.99 degrees and not at 70", marks[0].every((mark) => !mark) && marks[1][0] && marks[1][1], JSON.stringify(marks));
}

async function checkHostile(browser) {
  console.log("titles, folders and reasons that would be code; samples that fail");
  const code = "</script><img src=x onerror=window.owned=1>", title = `</title>${code}<script>window.owned=1</script>`;
  const study = studyOf("<img src=x onerror=window.owned=1>", 30,
    { title, more: "    rocket.empty.mass: {normal: 20 kg}\n" });
  const file = reportOf("hostile.html", study), text = readFileSync(file, "utf8");
  const failed = /"failures":\[\[\d+,"input","/;
  check("some samples failed", failed.test(text));
  writeFileSync(file, text.replace(failed, (found) => found + code.replaceAll("<", "\\u003c")));
  const page = await open(browser, file);
  check("the title is text", (await page.locator("h1").textContent()) === title);
  check("so is a reason", (await page.locator("#failures").textContent()).includes(code));
  check("nothing of it ran", await page.evaluate(() => window.owned === undefined && !document.querySelector("img")));
  await leave(page);
}

await inBrowser(async (browser) => {
  const studies = [studyOf("slow", 150), studyOf("middle", 150, { speed: "39.8 12.6 0 m/s", factors: UNIFORM }),
    studyOf("fast", 150, { speed: "44 12.6 0 m/s" })];
  await checkOne(browser, studies[0]);
  await checkWithout(browser);
  await checkSweep(browser);
  await checkSwept(browser);
  await checkFootprints(browser);
  await checkSideBySide(browser, studies);
  await checkColumns(browser, studies);
  await checkMeasured(browser, [studies[0], studies[2]]);
  await checkVertical(browser);
  await checkHostile(browser);
});

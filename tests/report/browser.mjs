// The report of a run in a real browser.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { check, checkFits, checkHeight, checkInjected, checkNoneEmpty, drawn, inBrowser, launchdyn, launchdynEnding, leave, near, open, paper, picture,
  readCsv, rowNear, runOf, unfold } from "./support.mjs";

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

// What the folded block says, against the files and the summary.
async function checkOrigin(page, run) {
  const [understood, file] = await page.$$eval(".origin pre", (blocks) => blocks.map((block) => block.textContent));
  const { scenario, program, source } = JSON.parse(readFileSync(join(run.out, "summary.json"), "utf8"));
  check("the scenario as it was understood", understood.length > 500 && understood === scenario, understood.length);
  check("the scenario's own text", file === source.files[0].text && file.includes("adaptors:"), file.length);
  const cells = await page.$$eval(".origin td", (list) => list.map((cell) => cell.textContent));
  check("program and libraries", cells.length >= 10 && cells.join() === Object.values(program).join(), cells.join(", "));
}

// Every figure that the command lists stands on the page, but for those of which this launch has nothing.
async function checkAllFigures(page) {
  const none = ["pressure", "recoil", "loads", "bodies", "joints", "struts", "flight-canopy"];
  const listed = launchdyn("plot", "--help").split("Figures for --what")[1].split("Examples:")[0].matchAll(/^  ([a-z][a-z-]*) /gm);
  const names = [...listed].map(([, name]) => name).filter((name) => name !== "all" && !none.includes(name));
  const there = await page.$$eval(".figure", (list) => list.map(({ id }) => id.replace(/^table\d+-/, "")));
  check("the figures of plot, in its order", names.length >= 24 && there.join() === names.join(), there.join(" "));
}

// The table of the rocket has every figure of the exit in the launcher's axes, in mrad, mrad/s, m/s, roll in deg and rad/s.
async function checkFigures(page, run) {
  const shown = await page.$$eval("#tables td", (cells) => cells.map((cell) => Number(cell.textContent.split(" ± ")[0])));
  const [{ tip_off: off, since_ignition: since }] = JSON.parse(readFileSync(join(run.out, "summary.json"))).rockets;
  const figures = [since, off].flatMap((of) => Object.entries(of));
  const missing = figures.filter(([name, value]) => {
    const wanted = name.startsWith("v") || name === "roll_rate" ? value : name === "roll" ? (180 / Math.PI) * value : 1e3 * value;
    return !shown.some((number) => Math.abs(number - wanted) <= 1e-5 * Math.abs(wanted));
  });
  check("all figures against the launcher are in the table", figures.length === 18 && missing.length === 0, missing);
}

// Rates at the exit, and they alone, are shown with what the errors of the steps leave of them.
async function checkErrors(page, run) {
  const shown = await page.$$eval("#tables td", (cells) => cells.map(({ textContent }) => textContent).filter((text) => text.includes("±")));
  const [{ exit_error: error }] = JSON.parse(readFileSync(join(run.out, "summary.json"))).rockets;
  const told = shown.map((text) => Number(text.split(" ± ")[1])), twoDigits = (value) => Number((1e3 * value).toPrecision(2));
  const wanted = [...Array(6).fill(error.rates), error.yaw_rate, error.yaw_rate].map(twoDigits);
  check("errors of the rates stand beside them in the table", told.length === 8 && told.every((value, i) => value === wanted[i]), shown.join("; "));
  const answer = await page.$$eval(".answer small", (list) => list.map(({ textContent }) => textContent).filter((text) => text.includes("±")));
  check("and in the answer", answer.length === 2 && answer.every((text) => parseFloat(text.split("± ")[1]) === twoDigits(error.rates)), answer.join("; "));
}

// What one reads in ten seconds: replay, drawing and answer in the first window, the rest in 5000 pixels.
async function checkFirstScreen(page, run) {
  const boxes = await page.evaluate(() => [".replay", ".drawing", ".answer"].map((name) => {
    const { top, bottom, height } = document.querySelector(name).getBoundingClientRect();
    return { name, top, bottom, height };
  }));
  check("replay, drawing and answer fill the first screen", boxes.every(({ top, bottom, height }) => top >= 0 && bottom <= 900 && height > 100),
    boxes.map(({ name, top, bottom }) => `${name} ${top.toFixed(0)} to ${bottom.toFixed(0)}`).join(", "));
  await checkHeight(page);
  await checkPaper(page);
  const open = await page.$$eval("details[open]", (list) => list.length);
  check("tables, origin and what is beside the story are folded", open === 0 && (await page.$$("details")).length > 15, open);
  await checkAnswer(page, run);
  await checkDrawing(page);
}

// On paper each panel of the story has another beside it or fills its row, those of a figure of so many, too.
async function checkRows(page, many) {
  const counts = await page.$$eval("section.figure .grid", (grids) => grids.map((grid) => {
    const { left, right } = grid.getBoundingClientRect(), boxes = [...grid.children].map((node) => node.getBoundingClientRect());
    const filled = boxes.every(({ top }) => {
      const row = boxes.filter((box) => Math.abs(box.top - top) < 2);
      return Math.min(...row.map((box) => box.left)) < left + 2 && Math.max(...row.map((box) => box.right)) > right - 2;
    });
    return filled ? boxes.length : -boxes.length;
  }));
  check("on paper no panel alone in half a row", counts.includes(many) && counts.every((count) => count > 0), counts);
}

// On paper replay, answer and drawing stand below each other, and what is folded is not there, nor its heading.
async function checkPaper(page) {
  await page.emulateMedia({ media: "print" });
  const { left, folded, heads } = await page.evaluate(() => {
    const seen = (selector) => [...document.querySelectorAll(selector)].filter((node) => node.getClientRects().length > 0);
    return { left: seen(".overview > *").map((node) => node.getBoundingClientRect().left), folded: seen("details:not([open])").length,
      heads: seen("main h2").map((node) => node.textContent) };
  });
  check("on paper one thing below the other", left.length === 3 && new Set(left).size === 1, left);
  await checkRows(page, 5);
  check("and nothing that is folded", folded === 0 && heads.includes("Launch") && !heads.includes("All numbers"), heads.join());
  await page.emulateMedia({ media: null });
}

// The card's numbers are those of the results, rounded to three digits.
async function checkAnswer(page, run) {
  const said = Object.fromEntries(await page.$$eval(".answer tr", (rows) => rows.map((row) => [row.cells[0].firstChild.textContent,
    row.cells[1].textContent.replace("−", "-"), row.cells[0].querySelector("small")?.textContent ?? ""]).map(([name, ...more]) => [name, more])));
  const summary = JSON.parse(readFileSync(join(run.out, "summary.json"))), [rocket] = summary.rockets, { column } = run, t = column.get("t");
  const forces = Object.entries(rocket.max_contact_force), [part, force] = forces.reduce((best, one) => (one[1] > best[1] ? one : best));
  const headline = parseFloat(await page.textContent(".headline strong"));
  const first = t.findIndex((time) => time >= 0), apart = (row, names) => Math.hypot(...names.map((name) => column.get(name)[row] - column.get(name)[first]));
  const way = (names) => Math.max(...t.map((_, row) => (row >= first && Number.isFinite(column.get(names[0])[row]) ? apart(row, names) : 0)));
  const wanted = { "Tip-off pitch rate": 1e3 * rocket.tip_off.pitch_rate, "Tip-off yaw rate": 1e3 * rocket.tip_off.yaw_rate,
    "Spin at the exit": rocket.spin_rate, "From release to exit": 1e3 * (rocket.t_rear - rocket.t_release), "Largest contact force": 1e-3 * force,
    "Moved most": 1e3 * Math.max(way(["tip.y", "tip.z"]), way(["rocket.y", "rocket.z"])) };
  const wrong = Object.entries(wanted).filter(([name, value]) => !near(parseFloat(said[name]?.[0]), value, 6e-3));
  check("the answer says what the results do, in three digits", near(headline, rocket.exit_speed, 6e-3) && wrong.length === 0 &&
    Object.values(said).every(([text]) => (text.match(/[1-9][0-9.]*/)?.[0] ?? "").replace(".", "").length <= 4), JSON.stringify(said));
  check("with the part of the largest force, and the unit", said["Largest contact force"][1] === part && said["Largest contact force"][0].endsWith("kN") &&
    said["Moved most"][0].endsWith("mm"), part);
  const [, relative] = said["Tip-off pitch rate"][1].replace("−", "-").match(/relative rate (\S+)\u00a0mrad\/s$/) ?? [];
  check("beside the tip-off rate the relative one", near(Number(relative), 1e3 * rocket.tip_off.pitch_rate_relative, 6e-3) &&
    /^± \S+\u00a0mrad\/s; /.test(said["Tip-off pitch rate"][1]), said["Tip-off pitch rate"][1]);
  const [digits, power] = said["Energy residual"][0].split("·10");
  check("and how well energies balance", near(Number(digits) * 10 ** Number([...power].map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(c)).map((d) => (d < 0 ? "-" : d)).join("")),
    Math.abs(summary.energy.residual_relative), 0.06), said["Energy residual"][0]);
}

// Tube, adaptors, supports and mass centre are where the geometry has them, with one scale in both directions.
async function checkDrawing(page) {
  const boxes = (kind) => page.$$eval(`.plan .${kind}`, (list) => list.map((node) => {
    const { x, y, width, height } = node.getBBox();
    return { x, y, width, height };
  }));
  const [walls, adaptors, supports, [centre]] = await Promise.all(["beam", "adaptor", "support", "centre"].map(boxes));
  const { geometry } = await page.evaluate(() => JSON.parse(document.getElementById("data").textContent)), of = (name) => geometry[name].value;
  const scale = walls[0].width / of("tube.station").at(-1), at = (x) => walls[0].x + scale * x, middle = ({ x, width }) => x + width / 2;
  const rear = middle(adaptors[0]), bore = Math.abs(walls[1].y - walls[0].y) / scale, [, radius, outer] = of("tube.section");
  check("the drawing's bore has the scale of its length", near(bore, radius + outer, 1e-2), `${bore} m between walls`);
  check("so have the adaptors, each in its place", adaptors.length === 3 && adaptors.every((box, i) =>
    near(box.height / scale, 2 * (radius - of("rocket.clearance")[i]), 1e-2) && Math.abs(middle(box) - rear - scale * of("rocket.adaptor")[i]) < 0.2));
  check("and the supports", supports.length === 2 && supports.every((box, i) => Math.abs(middle(box) - at(of("tube.support")[i])) < 0.2));
  check("and the mass centre", Math.abs(middle(centre) - rear - scale * of("rocket.center")[0]) < 0.2);
}

async function checkLaunch(browser) {
  const run = runOf("fixed.yaml");
  console.log("fixed.yaml");
  const page = await open(browser, run.file, { width: 1400 });
  await checkFirstScreen(page, run);
  await unfold(page);
  const counts = await page.evaluate(() =>
    [".panel", ".plot canvas"].map((selector) => document.querySelectorAll(selector).length));
  check("plots, each with a canvas", counts[0] >= 30 && counts[0] === counts[1], counts);
  await checkNoneEmpty(page);
  await checkOrigin(page, run);
  await checkFigures(page, run);
  await checkErrors(page, run);
  await checkCursor(page, run, "#table0-tip .panel", [["tip.y", 1e3], ["tip.z", 1e3]]);
  await checkCursor(page, run, "#table0-contact .panel",
    [["contact.rear.force", 1e-3], ["contact.middle.force", 1e-3], ["contact.front.force", 1e-3]]);
  const shared = await page.$$eval(".uplot .u-legend tr:first-child .u-value",
    (cells) => [...new Set(cells.map((cell) => cell.textContent))]);
  check("all plots show the same instant", shared.length === 1, shared);
  await picture(page, "launch.png");
  await checkKeys(page, run);
  await checkReplay(page, run);
  await checkLoadedForPaper(browser, run);
  await leave(page);
  await checkWithoutGeometry(browser, run);
}

async function checkKeys(page, run) {
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
  const path = (await page.locator("#table0-phase .reading").first().textContent()).match(/t (\S+) s +x (\S+) +y (\S+)/).slice(1).map(Number);
  const row = rowNear(run.column.get("t"), path[0]);
  check("and on the paths too, x across, y up", path[0] === await time() &&
    ["rocket.y", "rocket.y_dot"].every((name, i) => near(1e3 * run.column.get(name)[row], path[i + 1], 1e-3)), path.join(" "));
  const drawing = () => page.$eval("#table0-travel canvas", (canvas) => canvas.toDataURL());
  const whole = await drawing();
  await press("+");
  check("+ zooms the other plots", (await drawing()) !== whole);
  await press("Escape");
  check("Escape shows all again", (await drawing()) === whole);
}

// ---- the replay ----

// Draws an instant, in seconds from ignition, and reads the picture: how many of its points look
// like the tube and like the rocket, a sum that distinguishes pictures.
function look(page, code = "") {
  return page.evaluate((change) => {
    const replay = window.launchdyn.current, gl = replay.stage.renderer.getContext();
    new Function("replay", change)(replay);
    replay.stage.draw();
    replay.stage.render();
    const { drawingBufferWidth: width, drawingBufferHeight: height } = gl;
    const data = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, data);
    let tube = 0, rocket = 0, sum = 0;
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
      tube += b > r + 60 && b > g + 15;
      rocket += r > b + 70 && g < 0.72 * r;
      sum = (31 * sum + r + 7 * g + 13 * b) % 4294967291;
    }
    return { tube, rocket, sum, points: width * height };
  }, code);
}

const show = (time) => `replay.show(${time} + replay.zero, true);`;

async function checkPicture(page) {
  const first = await look(page, "replay.look('tube');" + show(0.08));
  check("the tube is seen, points of the picture", first.tube > 0.004 * first.points, `${first.tube} of ${first.points}`);
  check("the rocket is seen", first.rocket > 0.002 * first.points, first.rocket);
  const later = await look(page, show(0.12));
  check("the picture moves", later.sum !== first.sum, `${first.sum} and ${later.sum}`);
  check("and comes back the same", (await look(page, show(0.08))).sum === first.sum);
  const bare = await look(page, "replay.stage.bodies[0].group.visible = false;");
  check("without the rocket none of it is seen", bare.rocket < 0.05 * first.rocket, bare.rocket);
  const empty = await look(page, "replay.stage.tube.group.visible = false;");
  check("nor of the tube", empty.tube < 0.05 * first.tube, empty.tube);
  await look(page, "replay.stage.tube.group.visible = true;" + show(0.08));
}

// Where the tip's and the adaptors' vertices are drawn, over the scale: that is what the results say.
async function checkDrawn(page, run, adaptors) {
  const t = run.column.get("t"), most = Math.max(...run.column.get("tip.y").map(Math.abs));
  for (const [time, scale] of [[0.02, 200], [0.07, 1], [0.125, 1000]]) {
    const row = rowNear(t, time), at = (name) => run.column.get(name)[row];
    const shown = await page.evaluate(([now, amount]) => {
      const replay = window.launchdyn.current, { stage } = replay;
      replay.setScale(amount);
      replay.show(now, true);
      const [, y, z] = stage.tube.tip(), body = stage.bodies[stage.state.number];
      return { y, z, gap: stage.gap, adaptors: stage.motion.adaptors.map((l, i) => {
        const { centre, radius } = body.adaptor(i), x = stage.motion.deflection(stage.state, centre[0]);
        return { y: centre[1] - amount * x[1], z: centre[2] - amount * x[2], radius };
      }), bore: stage.motion.guide.radius, clearances: stage.motion.guide.clearances[0] };
    }, [t[row], scale]);
    const error = Math.hypot(shown.y / scale - at("tip.y"), shown.z / scale - at("tip.z"));
    check(`t ${t[row]} s, deflection x ${scale}: tip drawn where tip.y, tip.z of the results are`,
      error < Math.max(2e-6 * most, 3e-7 / scale), `${error.toExponential(1)} m off of ${most.toExponential(1)} m`);
    const wrong = adaptors.map((name, i) => Math.hypot(shown.adaptors[i].y / shown.gap - at(`contact.${name}.y`),
      shown.adaptors[i].z / shown.gap - at(`contact.${name}.z`))).filter(Number.isFinite);
    // sections roll by some 0.1 mrad against the undeformed tube, in whose axes it is drawn
    check(`gaps x ${shown.gap.toPrecision(3)}: ${wrong.length} adaptors drawn where the results say`,
      Math.max(...wrong) < 1e-7, `${Math.max(...wrong).toExponential(1)} m off`);
    const gaps = adaptors.map((name, i) => (shown.bore - shown.adaptors[i].radius) / shown.gap - shown.clearances[i]);
    check("and their clearances", Math.max(...gaps.map(Math.abs)) < 1e-6 / shown.gap + 1e-8,
      `${Math.max(...gaps.map(Math.abs)).toExponential(1)} m off`);
  }
}

// What is said while it plays is what the results have, rounded, in words of one width.
async function checkReading(page, run) {
  const times = Array.from({ length: 24 }, (_, i) => -0.004 + 0.0071 * i);
  const said = await page.evaluate((list) => list.map((time) => {
    const replay = window.launchdyn.current;
    replay.show(replay.zero + time, true);
    return replay.reading.textContent;
  }), times);
  const launch = said.filter((text) => text.includes("travel")), widths = new Set(launch.map((text) => text.length)), t = run.column.get("t");
  check("the words of the replay keep their width", launch.length > 20 && widths.size === 1, launch[9]);
  check("with a minus for a hyphen", !said.join().includes("-") && launch.some((text) => text.includes("−")));
  const kinds = { travel: ["rocket.s", "m"], speed: ["rocket.s_dot", "m/s"], "tip y": ["tip.y", "mm"], "tip z": ["tip.z", "mm"] };
  const wrong = launch.filter((text) => {
    const number = (name) => text.match(new RegExp(`(?:^|· )${name} \u2007*(−?)([\\d.]+) (\\S+)`))?.slice(1) ?? [];
    const [sign, at] = number("t"), row = rowNear(t, Number(`${sign ? "-" : ""}${at}`));
    return Object.entries(kinds).some(([name, [column, wanted]]) => {
      const [minus, digits, unit] = number(name), value = run.column.get(column)[row] * (unit === "mm" ? 1e3 : 1);
      const last = 10 ** -(digits?.split(".")[1]?.length ?? 0), near = [-1, 0, 1].map((k) => run.column.get(column)[row + k] ?? 0);
      const step = (Math.max(...near) - Math.min(...near)) * (unit === "mm" ? 1e3 : 1);
      return unit !== wanted || !(Math.abs((minus ? -1 : 1) * digits - value) <= 0.51 * last + step);
    });
  });
  check("and are the results, rounded", wrong.length === 0, wrong[0]);
}

// How much of the rear adaptor is seen, of what would be if it stood there alone: points of the picture that change with it.
async function checkRearAdaptor(page) {
  for (const view of ["launcher", "tube", "rocket"]) {
    const [seen, alone] = await page.evaluate(([name, time]) => {
      const replay = window.launchdyn.current, { stage } = replay, gl = stage.renderer.getContext();
      replay.look(name);
      replay.show(time + replay.zero, true);
      const body = stage.bodies[0], ring = [body.rings[0].mesh, body.ghosts[0].ghost];
      const picture = () => {
        stage.render();
        const { drawingBufferWidth: width, drawingBufferHeight: height } = gl, data = new Uint8Array(4 * width * height);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, data);
        return data;
      };
      const changed = () => {
        const whole = picture();
        for (const mesh of ring) mesh.visible = false;
        const without = picture();
        for (const mesh of ring) mesh.visible = true;
        let count = 0;
        for (let i = 0; i < whole.length; i += 4)
          count += Math.abs(whole[i] - without[i]) + Math.abs(whole[i + 1] - without[i + 1]) + Math.abs(whole[i + 2] - without[i + 2]) > 40;
        return count;
      };
      const others = [...stage.scene.children, ...body.group.children].filter((child) => (child.isGroup || child.isMesh) && child !== body.group && !ring.includes(child));
      const now = changed(), visible = others.map((child) => child.visible);
      others.forEach((child) => { child.visible = false; });
      const bare = changed();
      others.forEach((child, i) => { child.visible = visible[i]; });
      return [now, bare];
    }, [view, 0.02]);
    check(`nothing hides the rear adaptor: ${view}`, alone > 8 && seen > 0.8 * alone, `${seen} of ${alone} points`);
  }
}

// The gauge's pixels a metre are those of the camera, its lengths and forces round and of a size that can be read.
async function checkGauge(page) {
  const { found, wanted, least, points } = await page.evaluate(() => {
    const { stage, gauge } = window.launchdyn.current, { camera, controls } = stage, seen = stage.measured();
    const at = (v) => {
      const p = v.clone().project(camera);
      return [(p.x / 2) * stage.renderer.domElement.clientWidth, (p.y / 2) * stage.renderer.domElement.clientHeight];
    };
    const right = controls.target.clone().fromArray(camera.matrixWorld.elements, 0), [a, b] = [controls.target, controls.target.clone().add(right)].map(at);
    const { data } = gauge.getContext("2d").getImageData(0, 0, gauge.width, gauge.height);
    let count = 0;
    for (let i = 3; i < data.length; i += 4) count += data[i] > 100;
    const length = seen.axes.map(([x, y]) => x * x + y * y).reduce((sum, v) => sum + v);
    return { found: seen.perMetre, wanted: Math.hypot(b[0] - a[0], b[1] - a[1]), least: length, points: count };
  });
  check("the scale is the camera's", near(found, wanted, 1e-3), `${found} and ${wanted} pixels a metre`);
  check("the axes are", near(least, 2, 1e-6), least); // of three axes at right angles as seen
  check("both are drawn", points > 300, points);
  await checkGaugeForce(page);
}

// The gauge's arrow of so many newtons is as long as one at the rocket that shows so many, and as its text says.
async function checkGaugeForce(page) {
  const { arrow, force, text, pixels } = await page.evaluate(() => {
    const replay = window.launchdyn.current, { stage, gauge } = replay, { forces } = stage, ctx = gauge.getContext("2d"), texts = [];
    replay.show(replay.zero + 0.1, true);
    ctx.fillText = (words, ...more) => { texts.push(words); return CanvasRenderingContext2D.prototype.fillText.call(ctx, words, ...more); };
    replay.measure();
    delete ctx.fillText;
    const greatest = stage.state.forces.reduce((best, f, i, all) => (f > all[best] ? i : best), 0), { shaft, head, scale } = forces.arrows[greatest];
    const ends = [shaft.position.y - shaft.scale.y / 2, head.position.y + head.scale.y * 0.045], { data, width } = ctx.getImageData(0, 0, gauge.width, gauge.height);
    const columns = new Set();
    for (let i = 0; i < data.length; i += 4)
      if (data[i + 3] > 100 && data[i + 1] > data[i] + 90 && i / 4 / width > gauge.height - 20) columns.add((i / 4) % width);
    const from = Math.min(...columns), to = Math.max(...columns);
    return { arrow: (ends[1] - ends[0]) * scale.y * stage.measured().perMetre, force: stage.state.forces[greatest], text: texts.at(-1), pixels: to - from };
  });
  const [, number, unit] = /^([\d.]+) (MN|kN|N)$/.exec(text) ?? [], shown = number * { N: 1, kN: 1e3, MN: 1e6 }[unit];
  check("the gauge's force is as long as the arrows' forces", Math.abs(pixels - (shown / force) * arrow) < 1.5 && pixels > 20,
    `${text} in ${pixels} pixels of ${(shown / force) * arrow}`);
}

async function saved(page, name) {
  const [file] = await Promise.all([page.waitForEvent("download"), page.click(`.saving button:text-is("${name}")`)]);
  return { name: file.suggestedFilename(), bytes: readFileSync(await file.path()) };
}

// What glTF 2.0 asks of a file, for those parts of it that ours has.
function gltfFaults(g, buffer) {
  const faults = [], size = { SCALAR: 1, VEC3: 3 }, need = (fine, what) => { if (!fine) faults.push(what); };
  need(g.asset.version === "2.0" && g.scenes[g.scene].nodes.length === g.nodes.length, "asset, scene");
  need(buffer.length === g.buffers[0].byteLength, "length of the buffer");
  const read = (index) => {
    const a = g.accessors[index], view = g.bufferViews[a.bufferView], whole = new (a.componentType === 5126 ? Float32Array : Uint32Array)(
      buffer.buffer.slice(buffer.byteOffset + view.byteOffset, buffer.byteOffset + view.byteOffset + view.byteLength));
    need([5126, 5125].includes(a.componentType) && whole.length === a.count * size[a.type] && view.byteOffset % 4 === 0, `accessor ${index}`);
    need(whole.every(Number.isFinite), `numbers of accessor ${index}`);
    return whole;
  };
  for (const { mesh, matrix } of g.nodes) {
    need(matrix.length === 16 && matrix.every(Number.isFinite) && matrix[15] === 1, "matrix");
    for (const { attributes, indices, material, mode } of g.meshes[mesh].primitives) {
      const position = read(attributes.POSITION), count = position.length / 3, { min, max } = g.accessors[attributes.POSITION];
      need([0, 1, 2].every((k) => position.every((v, i) => i % 3 !== k || (v >= min[k] && v <= max[k]))), "bounds");
      for (const other of Object.values(attributes)) need(g.accessors[other].count === count, "attributes of one length");
      if (attributes.NORMAL !== undefined) read(attributes.NORMAL).forEach((v, i, all) =>
        i % 3 === 0 && need(Math.abs(Math.hypot(v, all[i + 1], all[i + 2]) - 1) < 5e-3, "a normal's length"));
      if (indices !== undefined) need(read(indices).every((i) => i < count), "an index");
      need([1, 2, 3, 4].includes(mode) && (mode !== 4 || (indices === undefined ? count : g.accessors[indices].count) % 3 === 0), "mode");
      need(g.materials[material].pbrMetallicRoughness.baseColorFactor.every((v) => v >= 0 && v <= 1), "colour");
    }
  }
  return [...new Set(faults)];
}

// The picture, the bodies and a film, as files.
async function checkSaved(page) {
  const png = await saved(page, "PNG"), [width, height] = [16, 20].map((at) => png.bytes.readUInt32BE(at));
  const canvas = await page.$eval(".stage", ({ width: w, height: h }) => [w, h]);
  check("the picture as PNG", png.name.endsWith(".png") && png.bytes.subarray(1, 4).toString() === "PNG" && width === canvas[0] && height === canvas[1] &&
    png.bytes.length > 5000, `${png.name}, ${width} by ${height}`);
  const gltf = await saved(page, "glTF"), g = JSON.parse(gltf.bytes), buffer = Buffer.from(g.buffers[0].uri.split(",")[1], "base64");
  const faults = gltfFaults(g, buffer);
  check("the scene as glTF 2.0", gltf.name.endsWith(".gltf") && g.nodes.length > 20 && faults.length === 0, `${g.nodes.length} nodes, ${gltf.bytes.length} bytes ${faults}`);
  const tip = await page.evaluate(() => {
    const { tube } = window.launchdyn.current.stage, at = tube.whole.mesh.position.clone().fromArray(tube.whole.centre(tube.whole.rings - 1));
    return at.applyMatrix4(tube.group.matrixWorld).toArray();
  });
  const found = g.nodes.some(({ mesh, matrix: m }) => {
    const a = g.accessors[g.meshes[mesh].primitives[0].attributes.POSITION], from = g.bufferViews[a.bufferView].byteOffset, ring = 33;
    if (a.count % ring !== 0 || a.count < 10 * ring) return false;
    const at = [0, 0, 0];
    for (let i = a.count - ring; i < a.count - 1; i++)
      for (let k = 0; k < 3; k++) at[k] += buffer.readFloatLE(from + 4 * (3 * i + k)) / (ring - 1);
    const seen = [0, 1, 2].map((k) => m[k] * at[0] + m[4 + k] * at[1] + m[8 + k] * at[2] + m[12 + k]);
    return Math.hypot(...seen.map((v, k) => v - tip[k])) < 1e-5;
  });
  check("with the tube's tip where it is drawn", found, tip);
  await page.selectOption(".controls select", String(1 / 1000));
  await page.click('.saving button:text-is("WebM")');
  await page.waitForFunction(() => window.launchdyn.current.film?.parts.reduce((sum, { size }) => sum + size, 0) > 2000);
  const [film] = await Promise.all([page.waitForEvent("download"), page.evaluate(() => {
    const replay = window.launchdyn.current;
    replay.show(replay.clock.last);
    replay.advance(0.01);
  })]);
  const bytes = readFileSync(await film.path());
  check("a film as WebM, to the end of the replay", film.suggestedFilename() === "launch.webm" && bytes.readUInt32BE(0) === 0x1a45dfa3 && bytes.length > 2000, bytes.length);
  await page.selectOption(".controls select", "auto");
}

async function checkControls(page, run) {
  const now = () => page.evaluate(() => window.launchdyn.current.time - window.launchdyn.current.zero);
  await page.evaluate(() => {
    const replay = window.launchdyn.current;
    replay.show(replay.opening());
    replay.play.click();
    replay.play.click();
  });
  check("from where it stands at first it plays from before ignition", (await now()) === Math.max(run.column.get("t")[0], -0.005), await now());
  await look(page, show(0.05));
  await page.focus(".stage");
  const before = await now();
  await page.keyboard.press("ArrowRight");
  check("an arrow moves the replay by a row", near((await now()) - before, 1e-4, 0.01), `${before} to ${await now()}`);
  await page.keyboard.press("3");
  check("a number chooses what is looked at",
    (await page.getAttribute(".controls button[value=rocket]", "aria-pressed")) === "true");
  await page.keyboard.press(" ");
  await page.waitForFunction((from) => window.launchdyn.current.time - window.launchdyn.current.zero > from + 5e-4, before);
  await page.keyboard.press(" ");
  const stood = await now();
  await drawn(page);
  check("the space bar starts it and stops it", stood > before && (await now()) === stood, `${before} to ${stood}`);
  for (const [speed, share] of [["auto", 1 / 50], [String(1 / 1000), 1 / 1000], ["1", 1]]) {
    await page.selectOption(".controls select", speed);
    const step = await page.evaluate(() => {
      const replay = window.launchdyn.current, from = replay.zero + 0.05;
      replay.show(from);
      replay.advance(0.01);
      return replay.time - from;
    });
    check(`a hundredth of a second at the speed ${speed}`, near(step, 0.01 * share, 1e-6), step);
  }
  check("no name of an instant stands beyond the slider", await page.$$eval(".tick", (ticks) =>
    ticks.every((tick) => tick.getBoundingClientRect().right <= tick.closest(".track").getBoundingClientRect().right + 1)));
  check("no instant's mark goes through the name of another", await page.$$eval(".tick", (ticks) => {
    const box = ticks.map((tick) => tick.getBoundingClientRect());
    return box.every((a, i) => box.every((b, k) => k <= i || a.right <= b.left || b.right <= a.left ||
      a.bottom <= b.top || b.bottom <= a.top));
  }));
  await page.locator(".amount").fill("2");
  check("the slider scales the deflection", (await page.evaluate(() => window.launchdyn.current.stage.scale)) === 100 &&
    (await page.textContent(".scale")).startsWith("× 100"));
  await page.locator(".time").fill("5000");
  const led = await now();
  check("the time slider leads the plots' cursor", near((await legend(page, "#table0-tip .uplot"))[0],
    run.column.get("t")[rowNear(run.column.get("t"), led)], 1e-5), led);
  const over = page.locator("#table0-tip .u-over").first();
  await over.hover({ position: { x: 200, y: 50 } });
  await drawn(page);
  const pointed = (await legend(page, "#table0-tip .uplot"))[0];
  check("the plots' cursor leads the replay", Math.abs((await now()) - pointed) < 3e-4, `${pointed} and ${await now()}`);
  await page.locator(".stage").scrollIntoViewIfNeeded();
  await page.waitForFunction(() => window.launchdyn.current.stage.seen);
  const box = await page.locator(".stage").boundingBox(), still = await look(page);
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 120, box.y + box.height / 2 + 30, { steps: 3 });
  await page.mouse.up();
  const turned = await look(page);
  check("the mouse turns it", turned.sum !== still.sum && turned.tube > 500, `${turned.tube} points of the tube`);
  await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  check("a picture is there for paper",
    await page.$eval(".photo", (photo) => photo.src.startsWith("data:image/png") && photo.src.length > 5000));
  const wide = () => page.$$eval(".of5 .u-wrap", (plots) => plots.map((plot) => parseFloat(plot.style.width)));
  const printed = await wide();
  await page.evaluate(() => dispatchEvent(new Event("afterprint")));
  const after = await wide();
  check("the third of five is drawn as wide as its row of paper, and as before after it", printed[2] === 680 && printed[1] < 500 && after[2] === after[1],
    `${printed}, ${after}`);
}

// A page that is loaded for paper, before which nothing is printed, shows the launcher, too.
async function checkLoadedForPaper(browser, run) {
  console.log("loaded for paper");
  const page = await open(browser, run.file, { media: "print" });
  await page.$eval(".photo", (photo) => photo.decode().catch(() => undefined));
  const { width, tube, paper } = await page.$eval(".photo", (photo) => {
    const { naturalWidth: width, naturalHeight: height } = photo, canvas = document.createElement("canvas"), ctx = canvas.getContext("2d");
    if (width === 0) return { width, tube: 0, paper: 0 };
    Object.assign(canvas, { width, height });
    ctx.drawImage(photo, 0, 0);
    const { data } = ctx.getImageData(0, 0, width, height);
    let tube = 0;
    for (let i = 0; i < data.length; i += 4) tube += data[i + 3] > 200 && data[i + 2] > data[i] + 50 && data[i + 2] > data[i + 1] + 20;
    return { width, tube, paper: photo.getClientRects().length };
  });
  check("the launcher is on it", paper > 0 && width > 500 && tube > 500, `${tube} points of the tube, ${width} pixels wide`);
  await picture(page, "paper.png");
  await leave(page);
}

// The page is already there, as wide as its plots have been viewed.
async function checkReplay(page, run) {
  console.log("its replay");
  await page.evaluate(() => document.querySelectorAll("details").forEach((node) => { node.open = false; }));
  await page.setViewportSize({ width: 500, height: 900 });
  await page.locator(".stage").scrollIntoViewIfNeeded();
  await drawn(page);
  await checkPicture(page);
  await checkDrawn(page, run, ["rear", "middle", "front"]);
  await checkReading(page, run);
  await checkRearAdaptor(page);
  await checkGauge(page);
  await checkControls(page, run);
  await checkSaved(page);
}

// The plots alone, with a warning, where there is no geometry in the results.
async function checkWithoutGeometry(browser, run) {
  const old = join(run.out, "old.html");
  writeFileSync(old, readFileSync(run.file, "utf8").replace(/<script type="text\/plain" id="replay">[^<]*<\/script>/, ""));
  const page = await open(browser, old), note = await page.textContent(".replay");
  check("without geometry a note says so", note.includes("geometry"), note);
  await leave(page);
}

// Of two launches one fills the slider, the plots and the names of instants, the first at first; a button shows the other
// in both, or all.
async function checkChoice(page, rockets) {
  const shown = () => page.evaluate(() => {
    const { clock, time, zero, stage, choice } = window.launchdyn.current;
    return { from: clock.first - zero, launched: clock.last - zero, at: time - zero, number: stage.state.number, choice: choice.value,
      names: [...document.querySelectorAll(".tick")].map(({ title }) => title).join(),
      pressed: document.querySelector('.windows [aria-pressed="true"]').textContent };
  });
  const names = (i) => ["ignition", "release", "front", "middle", "rear"].map((name) => `${name} ${i}`).join(), [one, two] = rockets;
  const begins = two.t_ignition - one.t_ignition, at = (state, of, i) => state.number === i && state.choice === String(i) &&
    near(state.at, of.t_ignition - one.t_ignition + 0.75 * of.t_rear, 1e-6) && state.names === names(i + 1) && state.pressed === `Rocket ${i + 1}`;
  const first = await shown();
  check("of two launches the replay shows the first, all its instants named", at(first, one, 0) && first.launched < begins, JSON.stringify(first));
  const drawing = () => page.$eval("#table0-travel canvas", (canvas) => canvas.toDataURL());
  const before = await drawing();
  await page.click('.windows button:text-is("Rocket 2")');
  await drawn(page);
  const second = await shown(), after = await drawing();
  check("a button shows the second, in the plots too", at(second, two, 1) && second.from < begins && second.from >= one.t_rear && before !== after,
    JSON.stringify(second));
  await page.selectOption(".controls select", "all");
  await drawn(page);
  const all = await shown(), whole = await drawing();
  check("the replay's own choice shows all, in the plots too", all.pressed === "All" && all.names === `${names(1)},${names(2)}` &&
    all.launched > begins && whole !== after && whole !== before, JSON.stringify(all));
  await page.selectOption(".controls select", "0");
}

// A ship floats: its hull goes from below the sea, which lies where I's y is 0, to above it, around the launcher.
async function checkShip(browser) {
  console.log("ship.yaml");
  const run = runOf("ship.yaml", "--set", "run.lead_in='0.05 s'", "--set", "firing={order: [1, 2], interval: 0.3 s}"), page = await open(browser, run.file, { width: 500 });
  const at = await page.evaluate(() => {
    const { stage } = window.launchdyn.current, low = [1e9, 1e9, 1e9], high = [-1e9, -1e9, -1e9];
    stage.scene.updateMatrixWorld();
    stage.base.group.traverse(({ geometry, matrixWorld }) => {
      const corners = geometry?.attributes.position;
      for (let i = 0; i < (corners?.count ?? 0); i++) {
        const corner = stage.camera.position.clone().fromBufferAttribute(corners, i).applyMatrix4(matrixWorld).toArray();
        corner.forEach((v, k) => {
          low[k] = Math.min(low[k], v + stage.anchor[k]);
          high[k] = Math.max(high[k], v + stage.anchor[k]);
        });
      }
    });
    return { low, high, sea: stage.sea.disc.position.y + stage.anchor[1], rear: stage.anchor, length: stage.motion.length };
  });
  const text = JSON.stringify(at);
  check("the sea lies where y is 0", Math.abs(at.sea) < 0.02, at.sea);
  check("the hull goes through it", at.low[1] < -0.3 && at.high[1] > 4, text);
  check("and around the launcher", at.low[0] < at.rear[0] - 3 * at.length && at.high[0] > at.rear[0] + 2 * at.length, text);
  const { all } = await spans(page, "launcher");
  check("it fills the picture's width, nothing of it cut off", all[0][1] - all[0][0] > 0.9 && all[1][0] > -0.5 && all[1][1] < 0.45, all);
  const whole = await look(page), bare = await look(page, "replay.stage.base.group.visible = false;");
  check("it is seen", whole.sum !== bare.sum);
  const cut = await page.$$eval(".plan text", (list) => list.filter((node) => {
    const { x, width } = node.getBBox();
    return x < 0 || x + width > node.ownerSVGElement.viewBox.baseVal.width;
  }).map((node) => node.textContent));
  check("no word of the drawing is cut off", cut.length === 0, cut.join("; "));
  await checkChoice(page, JSON.parse(readFileSync(join(run.out, "summary.json"), "utf8")).rockets);
  await picture(page, "ship.png");
  await leave(page);
}

// How high the launching guide is in the picture, and between what all stands that a view has to show: to the side, up; of
// its width and height.
const spans = (page, view) => page.evaluate((name) => {
  const replay = window.launchdyn.current, { stage } = replay, { motion, state, camera } = stage;
  replay.look(name);
  const seen = (list) => list.map((p) => camera.position.clone().set(...p).project(camera)).map(({ x, y }) => [x / 2, y / 2]);
  const ends = seen([0, motion.length].map((x) => [0, 3, 6].map((k, i) => state.tube.r[i] - stage.anchor[i] + state.tube.A[k] * x)));
  const all = seen(stage.shownPoints()), between = (k) => [Math.min(...all.map((p) => p[k])), Math.max(...all.map((p) => p[k]))];
  return { rail: Math.abs(ends[1][1] - ends[0][1]), all: [between(0), between(1)] };
}, view);

// A rail: its shoes are drawn off it by `gap` times what they are off it, in words of their own.
async function checkRail(browser) {
  console.log("a rail with a T-slot");
  const sets = ["tubes.guide={line: 160 0 mm, t_slot: {at: -90 0 mm, lips: 60 mm, gap: 0.5 mm, side_gap: 0.3 mm}}", "tubes.slot=none",
    "tubes.layout={rows: 1, columns: 1}", "firing.1.tube=1", "base.elevation=80 deg"];
  const run = runOf("fixed.yaml", ...sets.flatMap((set) => ["--set", set])), page = await open(browser, run.file, { width: 500 });
  const t = run.column.get("t"), row = rowNear(t, 0.09), at = (name) => run.column.get(name)[row];
  const shown = await page.evaluate((now) => {
    const replay = window.launchdyn.current, { stage } = replay, { motion } = stage;
    replay.setScale(1);
    replay.show(now, true);
    const body = stage.bodies[0];
    return motion.adaptors.map((l, i) => {
      const { centre: [x, y, z] } = body.adaptor(i), d = motion.moved(stage.state, motion.section(stage.state, x), -0.09, 0);
      return [y - 0.16 + 0.09 - d[1], z - d[2]].concat(stage.gap);
    });
  }, t[row]);
  const roll = at("rocket.gamma");
  const errors = ["rear", "middle", "front"].map((name, i) =>
    Math.hypot(shown[i][0] / shown[i][2] - at(`contact.${name}.y`), shown[i][1] / shown[i][2] - at(`contact.${name}.z`) - 0.09 * roll));
  check("shoes are drawn where the results say", Math.max(...errors) < 1e-6, JSON.stringify(errors));
  const words = await page.$eval("main", (main) => main.textContent);
  check("it is a rail with shoes, not a tube with adaptors", /Rocket on|Contact between shoes and rail/.test(words) &&
    !/between adaptors|rear adaptor leaves/.test(words));
  for (const [view, share] of [["launcher", 0.6], ["tube", 0.75]]) {
    const { rail, all } = await spans(page, view);
    check(`${view}: a steep one fills the picture's height`, rail > share && all[1][1] - all[1][0] > 0.85, `rail ${rail}, all ${all}`);
    check("and stays within it, below its words", all.every(([low, high]) => low > -0.5 && high < 0.5) && all[1][1] < 0.45, all);
  }
  const seen = await look(page, "replay.look('rocket');");
  check("rail and rocket are seen", seen.tube > 500 && seen.rocket > 500, `${seen.tube} and ${seen.rocket}`);
  await picture(page, "rail.png");
  await leave(page);
}

// Keeps the numbers along the upright axis of each plot, what is said at the axes, and the names in it with the places
// where they are drawn; code of the page.
function keepLabels() {
  const { clearRect, fillText } = CanvasRenderingContext2D.prototype;
  Object.assign(CanvasRenderingContext2D.prototype, {
    clearRect(...place) {
      Object.assign(this.canvas, { labels: [], names: [], axes: [] });
      clearRect.apply(this, place);
    },
    fillText(text, x, y, ...more) {
      if (this.textAlign === "right") this.canvas.labels?.push(text);
      if (this.textAlign === "left") this.canvas.names?.push({ text, left: x, right: x + this.measureText(text).width, y });
      if (this.textAlign === "center" && this.getTransform().b !== 0) this.canvas.axes?.push(text);
      fillText.call(this, text, x, y, ...more);
    },
  });
}

// What stands in the plots of the story: numbers that differ, axes that say what they show, names that do not meet.
async function checkTexts(page) {
  const drawn = await page.$$eval(".uplot canvas", (list) => list.map(({ labels, names, axes }) => ({ labels, names, axes })));
  check("each line of a plot has a number of its own", drawn.length > 15 &&
    drawn.every(({ labels }) => labels.length > 1 && new Set(labels).size === labels.length),
    drawn.filter(({ labels }) => new Set(labels).size < labels.length).map(({ labels }) => labels).join("; "));
  check("each upright axis says what it shows", drawn.every(({ axes }) => axes.length === 1 && /^[A-Za-z][^[]+( \[.+\])?$/.test(axes[0])),
    [...new Set(drawn.flatMap(({ axes }) => axes))].join(", "));
  const meeting = drawn.flatMap(({ names }) => names.flatMap((a, i) => names.slice(i + 1)
    .filter((b) => Math.abs(a.y - b.y) < 11 && a.left < b.right && b.left < a.right).map((b) => `${a.text} and ${b.text}`)));
  check("no name of an instant meets another", meeting.length === 0, meeting.join(", "));
  const named = drawn.map(({ names }) => names.map(({ text }) => text));
  const launch = named.filter((names) => names.includes("release")), flight = named.filter((names) => names.includes("apogee"));
  check("a launch has all five instants", launch.length > 10 && launch.every((names) => names.join() === "ignition,release,front,middle,rear"), launch.length);
  const moving = await page.$eval("#table0-chassis canvas", ({ names }) => names.map(({ text }) => text).join());
  check("a vehicle's motion the first and the last", moving === "ignition,rear", moving);
  check("a flight those of its own", flight.length > 5 && flight.every((names) => names.join() === "exit,burnout,apogee,landing"), flight.join("; "));
}

async function checkLooks(browser) {
  const run = runOf("reference.yaml");
  console.log("reference.yaml, dark, 400 pixels wide");
  const page = await open(browser, run.file, { width: 400, dark: true, before: keepLabels });
  await checkNoneEmpty(page);
  await checkFits(page);
  await checkTexts(page);
  const seen = await look(page, "replay.look('tube');" + show(0.1));
  check("tube and rocket are seen in the dark", seen.tube > 0.002 * seen.points && seen.rocket > 0.001 * seen.points,
    `${seen.tube} and ${seen.rocket} of ${seen.points}`);
  check("dark as the system says", (await paper(page)) === "rgb(20, 24, 28)");
  await picture(page, "narrow.png");
  await page.click("#theme");
  check("the switch makes it light", (await paper(page)) === "rgb(255, 255, 255)");
  await checkAllFigures(page);
  await page.setViewportSize({ width: 1400, height: 900 });
  await drawn(page);
  await checkHeight(page);
  await page.$eval(".grid.of4", (grid) => grid.lastChild.remove());
  await page.emulateMedia({ media: "print" });
  await checkRows(page, 3);
  await page.emulateMedia({ media: null });
  const entered = await page.evaluate(() => {
    const replay = window.launchdyn.current, { from } = replay.clock.parts.find(({ name }) => name === "tube");
    replay.show(from - 0.004);
    replay.advance(0.1);
    return replay.time - from;
  });
  check("one step from before the tube into it, each at its speed", near(entered, 0.096 / 50, 1e-6), entered);
  await look(page, show(1000));
  const said = await page.textContent(".replay .reading");
  check("in flight nothing is said of the tube, on the ground the height is none",
    !/travel|tip/.test(said) && /height \u2007*0\.0+ k?m/.test(said), said);
  await leave(page);
}

// How far the rocket on its path is inside the picture where a flight begins and where it ends [pixels]; below 0: cut off.
const roomAtEnds = (page) => page.evaluate(() => {
  const replay = window.launchdyn.current, { stage, canvas, flights: [{ t }] } = replay;
  return [t[0], t.at(-1)].map((time) => {
    replay.show(time, true);
    const [body] = stage.bodies;
    body.group.updateMatrixWorld(true);
    return Math.min(...[0.5, -0.5].flatMap((share) => {
      const { x, y } = body.group.localToWorld(stage.camera.position.clone().set(share * body.length, 0, 0)).project(stage.camera);
      return [0.5 * canvas.clientWidth * (1 - Math.abs(x)), 0.5 * canvas.clientHeight * (1 - Math.abs(y))];
    }));
  });
});

// A flight alone: its way, and the rocket where the results have it.
async function checkFlight(browser) {
  console.log("flight.yaml");
  const run = runOf("flight.yaml"), page = await open(browser, run.file, { width: 500 });
  const before = await look(page), bare = await look(page, "replay.stage.paths[0].group.visible = replay.stage.bodies[0].group.visible = false;");
  check("its way is seen", before.rocket > 200 && bare.rocket < 0.2 * before.rocket, `${before.rocket} points, ${bare.rocket} without`);
  const said = await page.textContent(".replay .reading");
  const views = await page.$$eval(".controls button[value]", (list) => list.map(({ value }) => value));
  check("it is looked at by its way and from beside it", views.join() === "rocket,path" && /height .* rocket enlarged/.test(said), `${views}: ${said}`);
  for (const width of [1400, 1000, 500]) {
    await page.setViewportSize({ width, height: 900 });
    await drawn(page);
    const room = await roomAtEnds(page);
    check(`${width} pixels: the rocket is whole where its path begins and ends`, Math.min(...room) > 0, room);
  }
  await page.keyboard.press("Tab");
  const rocket = await look(page, "replay.stage.paths[0].group.visible = replay.stage.bodies[0].group.visible = true; replay.look('rocket');");
  check("the rocket is seen", rocket.rocket > 500, rocket.rocket);
  const [shown, pitch] = await page.evaluate(() => {
    const { stage, time, flights: [{ t, column }] } = window.launchdyn.current, row = t.findIndex((at) => at >= time);
    return [Math.asin(stage.flying[0].A[3]), column.get("rocket.pitch").value.find((v, i) => i >= row && v !== undefined)];
  });
  check("its nose points up by the pitch of the results", Math.abs(pitch) > 0.05 && Math.abs(shown - pitch) < 0.02, `${shown} and ${pitch} rad`);
  await leave(page);
}

// A lorry has a cab above its deck; short or small on wheels, it is a trailer with a drawbar before it, and all of that in the picture.
async function checkTrailer(browser) {
  console.log("a truck, and a trailer");
  const wheels = [[1.2, -0.8], [1.2, 0.8], [-1, -0.8], [-1, 0.8]].flatMap(([x, z], i) => ["--set", `base.wheels.${i + 1}.mount=${x} -0.5 ${z} m`]);
  const shape = async (...options) => {
    const run = runOf("rail/truck.yaml", ...options), page = await open(browser, run.file, { width: 500 });
    const found = await page.evaluate(() => {
      const { stage, motion } = window.launchdyn.current, { chassis } = stage.base, corners = [];
      stage.scene.updateMatrixWorld();
      const back = chassis.matrixWorld.clone().invert();
      chassis.traverse(({ geometry, matrixWorld }) => {
        const at = geometry?.attributes.position;
        for (let i = 0; i < (at?.count ?? 0); i++) {
          const { x, y } = stage.camera.position.clone().fromBufferAttribute(at, i).applyMatrix4(matrixWorld).applyMatrix4(back);
          corners.push([x, y]);
        }
      });
      return { above: Math.max(...corners.map(([, y]) => y)) - motion.azimuthHinge[1], before: Math.max(...corners.map(([x]) => x)) - Math.max(...motion.mounts.map(([x]) => x)) };
    });
    const { all } = await spans(page, "launcher");
    check("all of it is in the picture", all.flat().every((v) => Math.abs(v) <= 0.5), JSON.stringify(all));
    await picture(page, `wheels-${options.length}.png`);
    await leave(page);
    return found;
  };
  const lorry = await shape(), trailer = await shape(...wheels);
  check("a lorry has a cab", lorry.above > 0.4 && lorry.before < 1, JSON.stringify(lorry));
  check("a trailer has none, but a drawbar", trailer.above < 0.3 && trailer.before > 1.5, JSON.stringify(trailer));
}

// The student rocket's numbers: tip 2 m before the lower button, 203 mm thick, fins 165 mm beyond a radius of 77.5 mm to
// 1.202 m behind the button, between which the rail lies.
async function checkOutline(page) {
  const [[body], fins, [rear]] = await Promise.all([".body", ".fin", ".adaptor"].map((kind) => page.$$eval(`.plan ${kind}`, (list) =>
    list.map((node) => node.getBBox()).map(({ x, y, width, height }) => ({ x, y, width, height })))));
  const scale = Number(await page.$eval(".plan svg", (svg) => svg.dataset.scale)), button = rear.x + rear.width / 2, close = (pixels, metres) => Math.abs(pixels / scale - metres) < 1e-3;
  const said = `body ${body.width / scale} by ${body.height / scale} m`;
  check("the drawing has the rocket's length and thickness", close(body.width, 3.202) && close(body.height, 0.203) && close(body.x + body.width - button, 2), said);
  const middle = body.y + body.height / 2, out = (0.0775 + 0.165) * Math.SQRT1_2;
  check("and its fins", fins.length === 4 && fins.every(({ x, y, width, height }) => close(width, 0.152) && close(button - x, 1.202) &&
    (close(middle - y, out) || close(y + height - middle, out))), JSON.stringify(fins.map(({ y }) => (middle - y) / scale)));
  const text = (await page.textContent(".plan")).replaceAll("\u00a0", " ");
  check("which it says", text.includes("rail 3.35 m, rocket 3.2 m long, 203 mm thick") && (await page.$$(".plan .made-up")).length === 0, text);
  const solid = await page.evaluate(() => {
    const [body] = window.launchdyn.current.stage.bodies, { profile } = body;
    const at = body.fins.children[0].geometry.attributes.position, corners = [0, 1, 2, 3].map((i) => [at.getX(i), Math.hypot(at.getY(i), at.getZ(i))]);
    return { length: body.length, rear: profile[2].l, fins: body.fins.children.length, corners, most: Math.max(...profile.map(({ r }) => r)), radius: body.bodyRadius };
  });
  const slim = solid.radius / 0.1015, wanted = [[-1.05, 0.0775], [-1.088093, 0.2425], [-1.164293, 0.2425], [-1.202, 0.0775]];
  check("the replay's rocket too, slimmer", solid.length === 2 && near(solid.rear, -1.202, 1e-6) && solid.fins === 4 && near(solid.most, solid.radius, 1e-6) &&
    wanted.every(([x, r], i) => near(solid.corners[i][0], x, 1e-5) && near(solid.corners[i][1], slim * r, 1e-5)), JSON.stringify(solid));
}

// A canopy is where and as large as the results have it, and moves on with its rocket enlarged about the mass centre. Names
// below the slider, also those that stand before their instants at its end, do not meet.
async function checkDescent(browser) {
  const lines = "canopy: {mass: 0.4 kg, line_length: 6 m, line_stiffness: 20 kN, at: 2.4 0 0 m, ejection: 8 0 0 m/s}";
  const run = runOf("parachutes.yaml", "--set", `rocket.parachutes={drogue: {${lines}}, main: {${lines}, filling: , filling_distance: 20 m}}`);
  const page = await open(browser, run.file, { width: 400, replay: true }), { rockets: [{ parachute }] } = JSON.parse(readFileSync(join(run.out, "summary.json"), "utf8"));
  const opened = parachute.main.t_open, value = (name, row) => run.column.get(name)[row];
  for (const late of [-25, 0.4, 1.2, 20]) {
    const row = rowNear(run.column.get("t"), opened + late);
    const found = await page.evaluate((time) => {
      const replay = window.launchdyn.current, [canopy] = replay.stage.canopies;
      replay.look("path");
      replay.show(time, true);
      return { seen: canopy.dome.visible && canopy.lines.visible, offset: canopy.offset, radius: canopy.radius, times: canopy.dome.scale.x / canopy.radius,
        drawn: ["x", "y", "z"].map((axis, i) => canopy.dome.position[axis] - canopy.center[i]) };
    }, value("t", row));
    const apart = ["x", "y", "z"].map((axis) => value(`canopy.${axis}`, row) - value(`center.${axis}`, row)), size = Math.max(0.08, Math.sqrt((4 * value("drag_area", row)) / (0.75 * Math.PI)) / 3);
    const far = Math.hypot(...apart.map((v, i) => v - found.offset[i])), moved = Math.hypot(...found.drawn.map((v, i) => v / found.times - found.offset[i]));
    check(`${late} s from its opening the canopy is seen where the results have it`, found.seen && far < 1e-3 && near(found.radius, size, 1e-6) && found.times > 10 && moved < 1e-6,
      `${far} m off, radius ${found.radius} of ${size} m, ${found.times} times as large, ${moved} m beside that`);
  }
  const before = await page.evaluate(() => { const replay = window.launchdyn.current; replay.show(1, true); return replay.stage.canopies[0].dome.visible; });
  check("but not before", before === false);
  await page.evaluate((time) => { const replay = window.launchdyn.current; replay.look("rocket"); replay.show(time, true); }, opened + 3);
  await picture(page, "canopy.png");
  const meet = await page.$$eval(".tick", (list) => list.map((node) => [node.textContent, node.getBoundingClientRect()]).filter(([text]) => text)
    .flatMap(([text, a], i, all) => all.slice(0, i).filter(([, b]) => a.left < b.right - 1 && b.left < a.right - 1 && Math.abs(a.bottom - b.bottom) < 4)
      .map(([other]) => `${other} and ${text}`)));
  check("no names meet below the slider", meet.length === 0, meet);
  await leave(page);
}

// The whole path is in the picture and fills its width or height at every size; the flight's instants are named where they
// are; the rocket flies along it, as large as can be seen.
async function checkPath(browser) {
  console.log("a path: the student rocket's");
  const run = runOf("student-rocket/student-rocket.yaml"), page = await open(browser, run.file);
  await checkOutline(page);
  const [{ flight: of }] = JSON.parse(readFileSync(join(run.out, "summary.json"), "utf8")).rockets;
  for (const width of [1400, 1000, 400]) {
    await page.setViewportSize({ width, height: 900 });
    await drawn(page);
    const { all: [[left, right], [low, high]] } = await spans(page, "path");
    const { seen, names, key } = await page.evaluate(([apogee, landing]) => {
      const replay = window.launchdyn.current, { stage, flights: [{ t, column }] } = replay, { clientWidth, clientHeight } = replay.canvas;
      const place = (row) => ["x", "y", "z"].map((name, i) => column.get(`center.${name}`).value[row] - stage.anchor[i]);
      const pixel = (row) => {
        const { x, y } = stage.camera.position.clone().set(...place(row)).project(stage.camera);
        return [0.5 * clientWidth * (1 + x), 0.5 * clientHeight * (1 - y)];
      };
      const rowAt = (time) => t.reduce((best, at, i) => (Math.abs(at - time) < Math.abs(t[best] - time) ? i : best), 0);
      const off = ([time, name]) => {
        const [x, y] = pixel(rowAt(time + replay.zero)), mark = stage.measured().names.find((one) => one.name === name);
        return Math.hypot(mark.x - x, mark.y - y);
      };
      const known = t.map((_, row) => row).filter((row) => place(row).every(Number.isFinite)).map(pixel);
      return { seen: known.every(([x, y]) => x >= 0 && x <= clientWidth && y >= 0 && y <= clientHeight), key: replay.colourKey.hidden,
        names: { said: stage.measured().names.map(({ name }) => name).join(), off: Math.max(...[[apogee, "apogee"], [landing, "landing"]].map(off)) } };
    }, [of.t_apogee, of.t_impact]);
    check(`${width} pixels: all of the path is seen`, seen && left >= -0.5 && right <= 0.5 && low >= -0.5 && high <= 0.5, `${left} to ${right}, ${low} to ${high}`);
    check("and fills the picture's width or height", Math.max(right - left, high - low) > 0.75, `${right - left}, ${high - low}`);
    check("its instants are named where they are", names.said === "exit,burnout,apogee,drogue,main,landing" && names.off < 4 && key, JSON.stringify(names));
    await picture(page, `path-${width}.png`);
  }
  const covered = await page.evaluate(() => {
    const { clock, zero } = window.launchdyn.current, names = [...document.querySelectorAll(".tick")].map(({ title }) => title).join();
    return { from: clock.first - zero, to: clock.last - zero, names, parts: clock.parts.length, pace: (clock.last - clock.first) / clock.automatic.flight };
  });
  check("the slider has the flight and its instants", near(covered.to, of.t_impact, 1e-9) && covered.from < 0.3 && covered.parts === 1 &&
    covered.names === "exit,burnout,apogee,drogue,main,landing", JSON.stringify(covered));
  check("which plays in 20 seconds at most", covered.pace < 20.001 && covered.pace > 5, covered.pace);
  const whole = await look(page, show(30)), bare = await look(page, "replay.stage.bodies[0].group.visible = false;"), at = await page.evaluate(() => {
    const { stage } = window.launchdyn.current, [body] = stage.bodies, end = (l) => body.group.localToWorld(stage.camera.position.clone().set(l, 0, 0));
    const pixels = (p) => [p.project(stage.camera)].map(({ x, y }) => [0.5 * stage.renderer.domElement.clientWidth * x, 0.5 * stage.renderer.domElement.clientHeight * y])[0];
    body.group.updateMatrixWorld(true);
    const [tail, nose, middle] = [-0.5, 0.5, 0].map((share) => pixels(end(share * body.length)));
    const { x, y } = stage.camera.position.clone().set(...stage.flying[0].center.map((v, i) => v - stage.anchor[i])).project(stage.camera);
    return { long: Math.hypot(nose[0] - tail[0], nose[1] - tail[1]), off: Math.hypot(middle[0] - 0.5 * stage.renderer.domElement.clientWidth * x, middle[1] - 0.5 * stage.renderer.domElement.clientHeight * y) };
  });
  check("the rocket flies along it and is seen", whole.rocket - bare.rocket > 60 && at.off < 0.5 && at.long > 15 && at.long < 60, `${whole.rocket - bare.rocket} points, ${JSON.stringify(at)}`);
  const back = await page.evaluate(() => {
    const replay = window.launchdyn.current;
    replay.look("launcher");
    return { from: replay.clock.first <= replay.zero, key: replay.colourKey.hidden, large: replay.stage.bodies[0].group.matrix.elements.slice(0, 3) };
  });
  check("the launcher's view has the whole launch again, the rocket of its own size", back.from && !back.key && near(Math.hypot(...back.large), 1, 1e-6), JSON.stringify(back));
  await leave(page);
}

// The line that a rocket pulls lies where the results have it, in a colour of its own, which the legend of the path says, too;
// it is said that the launcher, from which the line's container goes on, is drawn as at the end of its history.
async function checkLine(browser) {
  console.log("line-thrower.yaml on a ship");
  const run = runOf("line-thrower.yaml", "--set", "base.kind=prescribed", "--set", "base.looks=ship", "--set", "run.lead_in='0.1 s'",
    "--set", "base.motion.heave=[{amplitude: 1 m, frequency: 0.2 Hz}]"), flight = readCsv(join(run.out, "flights.csv"));
  for (const dark of [false, true]) {
    const page = await open(browser, run.file, { width: 700, dark }), t = flight.get("t"), row = rowNear(t, 0.6 * t.at(-1));
    const found = await page.evaluate((time) => {
      const replay = window.launchdyn.current, { stage } = replay, [{ drawn }] = stage.lines, { array } = drawn.geometry.attributes.position;
      const said = (view) => {
        replay.look(view);
        replay.show(replay.zero + time, true);
        const items = [...replay.colourKey.children].filter((node) => node.checkVisibility());
        return { view, names: items.map((node) => node.textContent).join(), reading: replay.reading.textContent,
          colour: items.map((node) => getComputedStyle(node.firstChild).backgroundColor).at(-1) };
      };
      const views = ["launcher", "path"].map(said);
      return { views, drawn: `#${drawn.material.color.getHexString()}`, seen: drawn.visible, places: Array.from(array, (v, i) => v + stage.anchor[i % 3]) };
    }, t[row]);
    const off = found.places.map((v, i) => Math.abs(v - flight.get(`line.${1 + Math.floor(i / 3)}.${"xyz"[i % 3]}`)[row]));
    check("the line lies where the results have it", found.seen && off.length === 36 && Math.max(...off) < 1e-3, `${Math.max(...off)} m off`);
    const [near, far] = found.views, text = JSON.stringify(found.views);
    check("the legend has it", near.names.endsWith("contact forces,line") && far.names === "rocket,line", text);
    const hex = (colour) => `#${colour.match(/\d+/g).map((v) => Number(v).toString(16).padStart(2, "0")).join("")}`;
    check("in its colour", found.views.every(({ colour }) => hex(colour) === found.drawn), `${found.drawn} ${text}`);
    check("the launcher is said to be that of the end of its history", found.views.every(({ reading }) => reading.endsWith("launcher at the end of its history")), text);
    await picture(page, `line-${dark ? "dark" : "light"}.png`);
    await leave(page);
  }
}

async function checkHostile(browser) {
  console.log("a title that would be code");
  const title = "</title></script><script>window.owned=1</script><img src=x onerror=window.owned=1>";
  const run = runOf("straight.yaml", "--set", `title='${title}'`);
  const page = await open(browser, run.file, { replay: false }), note = await page.textContent(".replay");
  check("without WebGL a note says so", note.includes("no WebGL"), note);
  await checkNoneEmpty(page);
  check("the title is text", (await page.textContent("h1")) === title);
  check("nothing of it ran", await page.evaluate(() => window.owned === undefined && !document.querySelector("img:not(.photo)")));
  await checkInjected(browser, run.file);
  writeFileSync(join(run.out, "summary.json"), "{\"title\": ");
  launchdynEnding([2], "report", run.out);
  await leave(page);
  const broken = await open(browser, run.file, { replay: false });
  check("a broken summary is said", (await broken.textContent("body")).includes("No summary: "));
  await leave(broken);
}

// A launch near the vertical: what is singular is marked in the table, below what is not, and the answer warns of it.
async function checkVertical(browser) {
  console.log("a launch near the vertical");
  const run = runOf("fixed.yaml", "--set", "base.elevation=89.99 deg"), page = await open(browser, run.file, { replay: false });
  const rows = await page.$$eval("#tables th[scope=row]", (heads) => heads.map((node) => node.textContent));
  const mark = " (near the vertical: not meaningful)", marked = rows.filter((row) => row.endsWith(mark)).map((row) => row.slice(0, -mark.length));
  check("yaw and rates of the ground frame are marked", marked.join() === "yaw, ground frame,pitch rate, ground frame,yaw rate, ground frame", marked);
  check("below those of the launcher's axes", rows.indexOf("yaw rate, launcher's axes at ignition") >= 0 &&
    rows.indexOf("yaw rate, launcher's axes at ignition") < rows.indexOf("pitch, ground frame"));
  check("the answer notes it", (await page.textContent(".answer .warning")).includes("near the vertical"));
  await leave(page);
}

await inBrowser(async (browser) => {
  await checkLaunch(browser);
  await checkShip(browser);
  await checkRail(browser);
  await checkLooks(browser);
  await checkFlight(browser);
  await checkTrailer(browser);
  await checkPath(browser);
  await checkDescent(browser);
  await checkLine(browser);
  await checkVertical(browser);
  await checkHostile(browser);
});

// Launchers of one's own in the replay and in the drawing: what joints hold together is drawn together, what stands does so
// on the ground, nothing is cut off.
import { check, drawn, inBrowser, leave, open, picture, runOf } from "./support.mjs";

// What is drawn of the base: origins and axes of the bodies, the end of each beam, the middle of each joint's mark, all in I;
// how low any of it is, and how far from the picture's middle, as a share of half its width and height.
const drawnBase = (page) => page.evaluate(() => {
  const { stage } = window.launchdyn.current, { base, motion, camera, anchor } = stage, { bodies } = motion.mechanism;
  const point = camera.position.clone(), inI = () => point.toArray().map((x, i) => x + anchor[i]), spread = [0, 0];
  let low = 1e9;
  stage.scene.updateMatrixWorld(true);
  base.group.traverse((node) => {
    const corners = node.geometry?.attributes.position;
    for (let i = 0; node.isMesh && node.visible && i < corners.count; i++) {
      point.fromBufferAttribute(corners, i).applyMatrix4(node.matrixWorld);
      low = Math.min(low, inI()[1]);
      point.project(camera);
      spread[0] = Math.max(spread[0], Math.abs(point.x));
      spread[1] = Math.max(spread[1], Math.abs(point.y));
    }
  });
  const middle = (points) => points.reduce((sum, p) => sum.map((x, k) => x + p[k] / points.length), [0, 0, 0]);
  const heads = base.beams.map(({ mesh }, i) => {
    const corners = mesh.geometry.attributes.position, around = corners.count / motion.mechanism.beams[i].radii.length;
    return middle(Array.from({ length: around - 1 }, (_, k) => { // a ring ends where it begins
      point.fromBufferAttribute(corners, corners.count - 1 - k);
      return inI();
    }));
  });
  return {
    heads, low, spread,
    body: Object.fromEntries(bodies.map(({ name }, i) => {
      base.bodies[i].getWorldPosition(point);
      return [name, { r: inI(), axes: base.bodies[i].matrixWorld.toArray() }];
    })),
    marks: base.joints.map(({ joint, mark }) => {
      mark.getWorldPosition(point);
      return { kind: joint.kind, body: bodies[joint.body]?.name, at: inI() };
    }),
  };
});

// Triangles, colours and corners, in I, of what a body is drawn as.
const meshOf = (page, name) => page.evaluate((wanted) => {
  const { base, motion, camera, anchor } = window.launchdyn.current.stage, point = camera.position.clone();
  const own = motion.mechanism.bodies.findIndex((body) => body.name === wanted), found = [];
  base.bodies[own].traverse((node) => { if (node.isMesh && node.geometry.attributes.color) found.push(node); });
  const { position, color } = found[0].geometry.attributes, points = [], colours = new Set();
  for (let i = 0; i < position.count; i++) {
    points.push(point.fromBufferAttribute(position, i).applyMatrix4(found[0].matrixWorld).toArray().map((x, k) => x + anchor[k]));
    colours.add([color.getX(i), color.getY(i), color.getZ(i)].join(" "));
  }
  return { triangles: position.count / 3, colours: [...colours], points };
}, name);

const apart = (a, b) => Math.hypot(...a.map((x, k) => x - b[k]));
// A point of a body in I.
const pointOf = ({ r, axes }, p) => r.map((x, k) => x + axes[k] * p[0] + axes[4 + k] * p[1] + axes[8 + k] * p[2]);

async function opened(browser, name, ...options) {
  console.log(name);
  const page = await open(browser, runOf(`multibody/${name}.yaml`, ...options).file, { width: 500 });
  await page.evaluate(() => window.launchdyn.current.show(0.1, true));
  await drawn(page);
  const found = await drawnBase(page), { spread } = found;
  check("nothing of it is cut off", spread[0] < 1 && spread[1] < 1 && Math.max(...spread) > 0.5, spread);
  const cut = await page.$$eval(".plan .part, .plan .joint, .plan .strut, .plan .mast", (list) => list.filter((node) => {
    const { x, y, width, height } = node.getBBox(), box = node.ownerSVGElement.viewBox.baseVal;
    return x < 0 || y < 0 || x + width > box.width || y + height > box.height;
  }).length);
  check("nor of the drawing", cut === 0, cut);
  return { page, found, count: (selector) => page.$$eval(`.plan ${selector}`, (list) => list.length) };
}

async function close(page, name) {
  await picture(page, `${name}.png`);
  await leave(page);
}

// Boom, cylinder and rod close a loop: the rod's eye is where the boom's is.
async function checkErector(browser) {
  const { page, found: { body, marks, low }, count } = await opened(browser, "erector");
  const boom = pointOf(body.boom, [1.6, -0.15, 0]), rod = pointOf(body.rod, [1.7, 0, 0]), eye = marks.at(-1);
  check("the rod's eye is the boom's", apart(boom, rod) < 1e-5, apart(boom, rod));
  check("the joint's mark is there", eye.kind === "universal" && apart(eye.at, boom) < 1e-9, apart(eye.at, boom));
  check("the pivot is where the scenario says", apart(marks[1].at, [0, 1.6, 0]) < 1e-9, marks[1].at);
  check("every joint has its mark, the drawing too", marks.length === 5 && (await count(".joint")) === 4, marks.length);
  check("the drawing has all bodies, the boom as a mesh", (await count(".part")) === 4 && (await count(".face")) === 1);
  const mesh = await meshOf(page, "boom"), corner = pointOf(body.boom, [2.3 + 2.6 + 0.035, 0.15 + 0.035, 0.2]);
  check("the boom has its 432 triangles in two colours", mesh.triangles === 432 && mesh.colours.length === 2, mesh);
  check("its truss reaches to where the file and `at` put it", mesh.points.some((r) => apart(r, corner) < 1e-4));
  check("it stands on the ground", low > -0.1 && low < 0.2, low);
  await close(page, "erector");
}

// A beam is drawn to where it carries the cradle.
async function checkMast(browser) {
  const { page, found: { body, heads }, count } = await opened(browser, "mast");
  check("the mast reaches the cradle", apart(heads[0], body.cradle.r) < 1e-5, apart(heads[0], body.cradle.r));
  check("it is in the drawing", (await count(".mast")) === 1);
  await close(page, "mast");
}

// Jacks and tyres on the ground.
async function checkTrailer(browser) {
  const { page, found: { low }, count } = await opened(browser, "trailer");
  check("it stands on the ground", Math.abs(low) < 0.05, low);
  check("the drawing has jacks and wheels", (await count(".wheel")) === 4 && (await count(".body, .support")) >= 4);
  await close(page, "trailer");
}

// A vehicle without an azimuth platform: its hinge on the chassis, the tube on it.
async function checkSingleHinge(browser) {
  const { file, column } = runOf("firm.yaml", "--set", "platform.azimuth=none", "--set", "run.end=tip");
  const page = await open(browser, file);
  const hinge = await page.evaluate(() => {
    const { motion } = window.launchdyn.current.stage;
    return { sum: motion.azimuthHinge.map((x, i) => x + motion.elevationHinge[i]), turns: motion.turns };
  });
  check("both hinges make the elevation's", apart(hinge.sum, [-0.6, 0.7, 0]) < 1e-9, hinge.sum);
  check("the platform does not turn", !hinge.turns && !column.has("azimuth.angle"));
  await close(page, "single-hinge");
}

// A rail that is not straight: bends, a step and a kink are drawn as much larger as deflections are.
async function checkBentRail(browser) {
  const { file, column } = runOf("rail/pad.yaml", "--set", "run.end=tip", "--set", "tubes.initial_shape={random: {deviation: 3 mm, terms: 4}," +
    " joints: [{at: 2.6 m, step: 1 -0.5 mm, kink: 0.1 0 deg, length: 40 mm}]}");
  const page = await open(browser, file), times = column.get("t"), wrong = [];
  await page.evaluate(() => window.launchdyn.current.look("tube"));
  for (const row of [3, 0.3, 0.6, 0.8].map((share) => (share > 1 ? share : Math.round(share * times.length)))) {
    const shoes = await page.evaluate((t) => {
      const replay = window.launchdyn.current, { stage } = replay, { motion } = stage;
      replay.show(t, true);
      return motion.adaptors.map((l) => {
        const p = stage.state.rocket.point(l), at = motion.deflection(stage.state, p[0]);
        return motion.guide.line.map((o, i) => p[i + 1] - o - at[i + 1]);
      });
    }, times[row]);
    ["rear", "front"].forEach((name, i) => ["y", "z"].forEach((axis, k) =>
      wrong.push(Math.abs(shoes[i][k] - column.get(`contact.${name}.${axis}`)[row]))));
  }
  const found = wrong.filter(Number.isFinite);
  check("shoes are drawn where the results have them on the bent rail [m]", found.length > 8 && Math.max(...found) < 1e-6, found);
  const drawn = await page.evaluate(() => {
    const replay = window.launchdyn.current, { stage } = replay, { motion } = stage, [oy, oz] = motion.guide.line;
    replay.setScale(50);
    replay.show(replay.zero - 0.01, true);
    const off = motion.stations.map((_, k) => motion.drawnGuide(stage.state, k, 0, 0, 50)).map(([, y, z]) => Math.hypot(y - oy, z - oz));
    return { most: Math.max(...off), said: document.body.textContent.includes("50") };
  });
  check("bends of 3 mm are drawn 50 times as large [m]", drawn.most > 0.1 && drawn.most < 0.3 && drawn.said, drawn.most);
  await close(page, "bent-rail");
}

await inBrowser(async (browser) => {
  await checkBentRail(browser);
  await checkSingleHinge(browser);
  await checkErector(browser);
  await checkMast(browser);
  await checkTrailer(browser);
});

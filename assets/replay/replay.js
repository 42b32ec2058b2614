// The replay of a launch: its stage, its clock, what leads them. A bundle of its own, which the
// report takes in where the results can be replayed and the browser has WebGL.
import { drawGauge } from "./gauge.js";
import { Flight, FreeMotion, Motion } from "./motion.js";
import { Stage } from "./stage.js";
import { add } from "./vector.js";

const SLIDER = 10000, LARGEST = 1000;
const SPEEDS = [["auto", "automatic"], [1, "1"], [1 / 3, "1/3"], [1 / 10, "1/10"], [1 / 30, "1/30"],
  [1 / 100, "1/100"], [1 / 300, "1/300"], [1 / 1000, "1/1000"]];
const AUTOMATIC = { before: 1, tube: 1 / 50, after: 1, flight: 4 };
const MOST_DOTS = 200; // of a measured path
const LONGEST = 20; // seconds that a whole flight takes at most

const capital = (word) => word[0].toUpperCase() + word.slice(1);

// The time slider gives each phase a share of its width: the tube half of it. `chosen`: the rocket whose launch and flight
// it covers, null for all; `aloft`: it covers the flight alone.
class Clock {
  constructor(motion, flights, chosen, aloft) {
    const all = motion.segments.map(({ name, first, end, number }) => ({ name, number, from: motion.t[first], to: motion.t[end - 1] }));
    all.forEach((part, i) => { if (all[i + 1]) part.to = all[i + 1].from; });
    const own = all.filter(({ number }) => number === chosen), launch = own.length > 0 ? own : all;
    const flown = flights.filter((flight, i) => flight && (chosen === null || i === chosen)).map(({ t }) => t);
    const end = Math.max(...flown.map((t) => t.at(-1)));
    const begin = aloft && flown.length > 0 ? Math.min(...flown.map(([t]) => t)) : launch.at(-1).to;
    const flight = end > begin ? [{ name: "flight", from: begin, to: end }] : [], parts = aloft && flight.length > 0 ? flight : [...launch, ...flight];
    const weight = ({ name, from, to }) => (to > from ? { tube: 4, before: 1.6, after: 0.4, flight: 2.4 }[name] : 0);
    const sum = parts.reduce((before, part) => before + weight(part), 0);
    let at = 0;
    this.parts = parts.map((part) => ({ ...part, low: at, high: (at += weight(part) / sum) }));
    this.first = parts[0].from;
    this.last = parts.at(-1).to;
    this.automatic = { ...AUTOMATIC, flight: Math.max(AUTOMATIC.flight, aloft ? (this.last - this.first) / LONGEST : 0) };
  }
  partAt(time) {
    return this.parts.find(({ to }) => time < to) ?? this.parts.at(-1);
  }
  share(time) {
    const { low, high, from, to } = this.partAt(time);
    return Math.min(1, Math.max(0, low + ((high - low) * (time - from)) / (to - from || 1)));
  }
  time(share) {
    const { low, high, from, to } = this.parts.find((part) => share < part.high) ?? this.parts.at(-1);
    return from + ((to - from) * (share - low)) / (high - low || 1);
  }
}

// A round scale with which the largest deflection is drawn as a twelfth of the tube.
function usualScale(motion) {
  const most = Math.max(motion.largest("tip.y"), motion.largest("tip.z"), motion.bent);
  const wanted = most > 0 ? motion.length / 12 / most : 1, power = 10 ** Math.floor(Math.log10(wanted));
  return Math.min(LARGEST, Math.max(1, [5, 2, 1].map((f) => f * power).find((s) => s <= wanted)));
}

class Replay {
  // `given`: table of the launch, its flights by rocket, geometry, rockets, marks in seconds from
  // `zero`, the page's helpers, and what to call at a new instant.
  constructor(host, given) {
    Object.assign(this, given);
    this.motion = this.table.kind === "flight" ? new FreeMotion(this.table, this.tools)
      : new Motion(this.table, this.geometry, this.rockets, this.tools);
    this.ways = this.rockets.map(({ ignition }, i) => this.flights[i] && new Flight(this.flights[i], ignition ?? 0, this.tools));
    this.pulled = this.ways.some((way) => way?.line.length > 0); // a line
    this.chosen = this.rockets.length > 1 ? 0 : null; // of several launches the one that is shown, null: all
    this.build(host);
    this.stage = new Stage(this.canvas, this.motion, this.ways, this.rockets);
    this.stage.rendered = () => this.measure();
    this.stage.setDots(this.dots());
    if (this.stage.dots.length > 0) this.stage.look("path"); // what was measured is what one wants to see
    this.stage.chosen = this.chosen;
    this.setClock();
    this.speed = "auto";
    this.playing = null;
    this.setScale(usualScale(this.motion));
    new ResizeObserver(() => this.fit()).observe(this.canvas);
    new IntersectionObserver(([entry]) => {
      this.stage.seen = entry.isIntersecting;
      if (this.stage.seen) this.redraw();
    }).observe(this.canvas);
    this.tools.onColours(() => this.paint());
    addEventListener("beforeprint", () => this.photograph(), { signal: this.tools.life() });
    this.paper = matchMedia("print"); // of a page that is loaded for paper nothing is printed before
    this.paper.addEventListener("change", () => this.fit(), { signal: this.tools.life() });
    this.stage.paint(this.tools.colour);
    this.time = this.opening();
    this.fit();
  }
  // Where the first rocket was measured on its flight, so many points at most.
  dots() {
    const [way] = this.ways, zero = this.rockets[0]?.ignition ?? 0;
    if (!way) return [];
    const all = (this.measured ?? []).filter(({ t }) => t + zero >= way.t[0] && t + zero <= way.t.at(-1));
    const step = Math.ceil(all.length / MOST_DOTS) || 1;
    return all.filter((_, i) => i % step === 0).map(({ t, off }) => add(way.at(t + zero).center, off));
  }
  // The launch of one rocket, or of all (null), fills the time slider.
  choose(rocket) {
    this.pause();
    this.chosen = this.stage.chosen = rocket;
    this.setClock();
    this.choice.value = rocket ?? "all";
    this.show(this.opening());
  }
  // Who looks at the path plays the flight.
  setClock() {
    const aloft = this.stage.view === "path";
    this.clock = new Clock(this.motion, this.ways, this.chosen, aloft);
    this.colourKey.hidden = aloft && !this.pulled;
    for (const item of this.colourKey.children) item.hidden = aloft && !["rocket", "line"].includes(item.firstChild.className);
    this.nameInstants(this.ticks.clientWidth);
  }
  // Where the replay stands at first: the rocket on its way through the tube. It plays from shortly
  // before its ignition then, as after its end.
  opening() {
    const { ignition, rear } = this.rockets[this.chosen ?? 0] ?? {};
    if (this.motion.free || this.stage.view === "path") return this.clock.time(0.3);
    return Number.isFinite(ignition) ? ignition + 0.75 * (rear ?? 0) : this.clock.first;
  }

  // ---- the page ----

  build(host) {
    const { element } = this.tools, button = (text, onclick, more = {}) =>
      element("button", { type: "button", onclick, ...more }, text);
    this.canvas = element("canvas", { className: "stage", tabIndex: 0 });
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", "Replay of the launch in three dimensions");
    this.canvas.addEventListener("keydown", (event) => this.key(event));
    this.gauge = element("canvas", { className: "gauge" });
    this.gauge.setAttribute("aria-hidden", "true");
    this.photo = element("img", { className: "photo", alt: "The launch at the instant shown" });
    this.play = button("Play", () => this.toggle(), { className: "play" });
    this.slider = element("input", { type: "range", min: 0, max: SLIDER, step: 1, className: "time",
      oninput: () => { this.pause(); this.show(this.clock.time(this.slider.value / SLIDER)); } });
    this.slider.setAttribute("aria-label", "Time");
    this.ticks = element("div");
    const speed = element("select", { onchange: () => { this.speed = speed.value === "auto" ? "auto" : Number(speed.value); } },
      ...SPEEDS.map(([value, name]) => element("option", { value }, name)));
    this.choice = element("select", { onchange: () => this.chose(this.choice.value === "all" ? null : Number(this.choice.value)) },
      ...this.rockets.map((_, i) => element("option", { value: i }, `rocket ${i + 1}`)), element("option", { value: "all" }, "all"));
    this.amount = element("input", { type: "range", min: 0, max: 3, step: 0.01, className: "amount",
      oninput: () => { this.setScale(10 ** Number(this.amount.value)); this.redraw(); } });
    this.amountText = element("output", { className: "scale" });
    this.views = [...(this.motion.free ? [] : ["launcher", "tube"]), "rocket", ...(this.ways.some(Boolean) ? ["path"] : [])].map((view) =>
      button(capital(view === "tube" ? this.motion.guide.words.guide : view), () => this.look(view), { value: view }));
    this.reading = element("output", { className: "reading" });
    host.append(
      element("div", { className: "screen" }, this.canvas, this.gauge, this.photo, this.colourKey = this.legend(), this.saving(button)),
      this.reading,
      element("div", { className: "timeline" }, this.play, element("div", { className: "track" }, this.slider, this.ticks)),
      element("div", { className: "controls" },
        this.chosen === null ? null : element("label", {}, "Launch ", this.choice),
        element("span", { role: "group" }, "Look at ", ...this.views),
        element("label", {}, "Speed ", speed),
        this.motion.free ? null : element("label", {}, "Deflection ", this.amount, this.amountText)));
  }
  // Buttons in the picture's corner.
  saving(button) {
    return this.tools.element("div", { className: "saving", role: "group", ariaLabel: "Save" },
      button("PNG", () => this.savePicture(), { title: "Save the picture that is shown" }),
      window.MediaRecorder ? this.filming = button("WebM", () => this.toggleFilm(), { title: "Save a film of the replay, up to its end or a second click" }) : null,
      button("glTF", () => this.saveScene(), { title: "Save the bodies shown, for programs that draw in three dimensions" }));
  }
  legend() {
    const { element } = this.tools, item = (name, text) =>
      element("span", {}, element("i", { className: name }), text);
    const pulled = this.pulled ? [item("line", "line")] : [];
    if (this.motion.free) return element("div", { className: "key" }, item("rocket", "rocket, of an assumed size, and its path"), ...pulled);
    const { guide, shoes } = this.motion.guide.words;
    return element("div", { className: "key" }, item("tube", guide), item("rocket", "rocket"),
      item("adaptor", shoes), item("force", "contact forces"), ...(this.motion.clamps.length > 0 ? [item("clamp", "clamps")] : []),
      ...(this.motion.mechanism ? [item("joint", "joints")] : []), ...pulled);
  }
  // What the clock covers of the launches' instants and, of one flight, of its own; the launch's own name of the exit is `rear`.
  instants() {
    const { first, last, parts } = this.clock, launch = this.motion.free ? [] : this.marks, number = this.ways.length > 1 ? this.chosen : 0;
    const aloft = parts[0].name === "flight", flight = (this.ways[number]?.marks ?? []).filter(({ name }) => aloft || name !== "exit");
    return [...launch.filter(({ rocket }) => !aloft && (this.chosen === null || rocket === this.chosen)).map(({ name, t }) => ({ name, t: t + this.zero })),
      ...flight].filter(({ t }) => t > first - 1e-6 && t < last + 1e-6);
  }
  // The key instants below the slider, their names in two lines where the ones before leave room,
  // before the line where there is none behind it.
  nameInstants(width) {
    const { element } = this.tools, free = [-1, -1];
    const one = this.chosen !== null, text = (name) => (one ? name.replace(/ \d+$/, "") : name);
    this.ticks.replaceChildren(...this.instants().map(({ name, t }) => {
      const at = width * this.clock.share(t), room = 8 + 6.5 * text(name).length, side = at + room > width ? " end" : "";
      const from = side ? at - room : at, row = free.findIndex((end) => from >= end);
      if (row >= 0) free[row] = from + room;
      const kind = ["tick bare", "tick", "tick low"][row + 1];
      return element("span", { className: kind + side, title: name, style: `left:${at.toFixed(1)}px` },
        row >= 0 ? text(name) : "");
    }));
  }
  key(event) {
    const row = this.motion.place(this.time).row, step = event.shiftKey ? 10 : 1;
    const go = (to) => {
      this.pause();
      this.show(this.motion.t[Math.min(this.motion.t.length - 1, Math.max(0, to))]);
    };
    const actions = {
      " ": () => this.toggle(), ArrowLeft: () => go(row - step), ArrowRight: () => go(row + step),
      Home: () => go(0), End: () => { this.pause(); this.show(this.clock.last); },
      "+": () => this.nearer(0.8), "-": () => this.nearer(1.25),
    };
    const view = this.views[Number(event.key) - 1]?.value;
    if (!actions[event.key] && !view) return;
    event.preventDefault();
    if (view) this.look(view);
    else actions[event.key]();
  }
  nearer(factor) {
    const { position } = this.stage.camera, { target } = this.stage.controls;
    position.sub(target).multiplyScalar(factor).add(target);
    this.redraw();
  }
  look(view) {
    this.stage.look(view);
    this.setClock();
    this.show(this.time);
  }
  setScale(scale) {
    this.stage.setScale(scale);
    const text = (v) => `× ${this.tools.readable(v, 3)}`;
    this.amount.value = Math.log10(scale);
    this.amountText.textContent = this.stage.gap < scale ? `${text(scale)}, gaps ${text(this.stage.gap)}` : text(scale);
  }

  // ---- time ----

  toggle() {
    if (this.playing) this.pause();
    else this.start();
  }
  start() {
    if (this.time >= this.clock.last || this.time === this.opening())
      this.time = Math.max(this.clock.first, (this.rockets[this.chosen ?? 0]?.ignition ?? 0) - 0.005);
    this.play.textContent = "Pause";
    let before = performance.now();
    const step = (now) => {
      if (this.playing !== step) return;
      const passed = Math.min(0.1, Math.max(0, now - before) / 1000);
      before = now;
      this.advance(passed);
      requestAnimationFrame(step);
    };
    this.playing = step; // the one that continues
    requestAnimationFrame(step);
  }
  pause() {
    this.playing = null;
    this.play.textContent = "Play";
  }
  // Continues by a time of the clock on the wall, each phase at its own speed.
  advance(passed) {
    let time = this.time;
    for (const { name, to } of this.clock.parts) {
      if (time >= to) continue;
      const speed = this.speed === "auto" ? this.clock.automatic[name] : this.speed, used = Math.min(passed, (to - time) / speed);
      time = used < passed ? to : time + speed * used;
      passed -= used;
    }
    this.show(Math.min(this.clock.last, time));
    if (time < this.clock.last) return;
    this.pause();
    if (this.film?.recorder.state === "recording") this.film.recorder.stop();
  }
  // Shows an instant on the run's clock; `quiet`: without calls.
  show(time, quiet = false) {
    this.time = Math.min(this.clock.last, Math.max(this.clock.first, time));
    this.stage.show(this.time);
    this.slider.value = Math.round(SLIDER * this.clock.share(this.time));
    this.read();
    for (const button of this.views) button.setAttribute("aria-pressed", button.value === this.stage.view);
    if (!quiet) this.shown(this.time);
  }
  read() {
    const { fixed, playing } = this.tools, { state } = this.stage, flies = this.clock.partAt(this.time).name === "flight";
    const between = [this.clock.first, this.clock.last].map((time) => time - this.zero);
    const words = [`t ${fixed(this.time - this.zero, flies ? 2 : 4, between)} s`];
    const say = (name, column, unit, ...alike) => words.push(`${name} ${playing(state.read(column), unit, this.motion.range(column, ...alike))}`);
    if (state.rocket && !flies) {
      say("travel", "rocket.s", "m");
      say("speed", "rocket.s_dot", "m/s");
    }
    const watched = this.stage.watched(), flying = this.stage.flying[watched];
    if (flying) words.push(`height ${playing(flying.center[1], "m", this.ways[watched].heights, 4)}`);
    if (!flies) {
      say("tip y", "tip.y", "m", "tip.z");
      say("tip z", "tip.z", "m", "tip.y");
      for (const name of this.motion.slides) say("recoil", `recoil.${name}.travel`, "m");
    }
    if (this.stage.view === "path") words.push(this.stage.dots.length > 0 ? "rocket enlarged, dots: measured" : "rocket enlarged");
    if (!this.motion.free && this.motion.t.at(-1) < this.time) words.push("launcher at the end of its history");
    this.reading.textContent = words.join(" · ");
    this.canvas.setAttribute("aria-label", `Replay of the launch: ${words.join(", ")}`);
  }

  // Hands its share of the graphics memory back, before another takes its place.
  end() {
    this.pause();
    this.stage.renderer.dispose();
    this.stage.renderer.forceContextLoss();
  }

  // ---- looks ----

  fit() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.stage.resize(width, height);
    const scale = Math.min(devicePixelRatio, 2);
    Object.assign(this.gauge, { width: width * scale, height: height * scale });
    this.nameInstants(this.ticks.clientWidth);
    this.show(this.time, true);
    if (this.paper.matches) this.photograph();
  }
  paint() {
    this.stage.paint(this.tools.colour);
    this.redraw();
  }
  redraw() {
    if (this.stage.state) this.show(this.time, true);
  }
  // Axes, length and force over what has just been drawn; a film takes both.
  measure() {
    const { colour } = this.tools;
    drawGauge(this.gauge, this.stage.measured(), { ink: colour("ink"), paper: colour("card") }, Math.min(devicePixelRatio, 2));
    if (this.film) this.compose(this.film.canvas);
  }

  // ---- what is handed out ----

  // The picture with what is drawn over it, on a canvas of its own or a given one.
  compose(canvas = document.createElement("canvas")) {
    const { width, height } = this.canvas, ctx = canvas.getContext("2d");
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    ctx.drawImage(this.canvas, 0, 0);
    ctx.drawImage(this.gauge, 0, 0, width, height);
    return canvas;
  }
  name(ending) {
    return `launch-${(this.time - this.zero).toFixed(4)}s.${ending}`;
  }
  savePicture() {
    this.stage.render();
    this.compose().toBlob((blob) => this.tools.download(this.name("png"), blob, "image/png"), "image/png");
  }
  saveScene() {
    this.tools.download(this.name("gltf"), JSON.stringify(this.stage.gltf(`launchdyn ${this.version}`)), "model/gltf+json");
  }
  // Records what is played from here, or from the start where it stands at first or at its end.
  toggleFilm() {
    if (this.film) {
      this.film.recorder.stop();
      return;
    }
    this.stage.render();
    const canvas = this.compose(), recorder = new MediaRecorder(canvas.captureStream(30), { mimeType: "video/webm" }), parts = [];
    recorder.ondataavailable = ({ data }) => parts.push(data);
    recorder.onstop = () => {
      this.film = null;
      this.filming.textContent = "WebM";
      this.pause();
      this.tools.download("launch.webm", new Blob(parts, { type: "video/webm" }), "video/webm");
    };
    this.film = { canvas, recorder, parts };
    this.filming.textContent = "Stop";
    recorder.onstart = () => { if (!this.playing) this.start(); };
    recorder.start(200); // hands out what it has each 200 ms
  }
  // A picture for paper, where a canvas would stay empty.
  photograph() {
    this.stage.render();
    this.photo.src = this.compose().toDataURL("image/png");
  }
}

window.launchdyn = { ...window.launchdyn, replay: (host, given) => new Replay(host, given) };

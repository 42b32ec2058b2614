// The page that simulates: fields of a scenario's main numbers, a core that launches it, the report's scripts that show it.
"use strict";
(() => {
  const { show, element, download, inflated, themeSwitch } = window.launchdyn;
  const MOST_EARLIER = 3, HASH = "#scenario=";
  const read = (id) => document.getElementById(id).textContent;

  // Key, what it is called, unit, factor from SI, and where no share of its value is of use the ends of its slider.
  const FIELDS = [
    ["base.elevation", "Elevation", "deg", 180 / Math.PI, 0, 90],
    ["base.azimuth", "Azimuth", "deg", 180 / Math.PI, -180, 180],
    ["base.speed", "Speed of the vehicle", "km/h", 3.6, 0, 60],
    ["flight.speed", "Speed at the start", "m/s", 1],
    ["flight.attitude.pitch", "Pitch at the start", "deg", 180 / Math.PI, 0, 90],
    ["tubes.length", "Length of the tube", "m", 1],
    ["tubes.modes.damping", "Damping of the tube", "%", 100],
    ["rocket.mass", "Mass of the rocket", "kg", 1],
    ["rocket.center.x", "Mass centre, along the rocket", "m", 1],
    ["rocket.eccentricity.y", "Mass centre, off the axis", "mm", 1e3, -2, 2],
    ["rocket.motor.thrust_scale", "Thrust, times", "", 1],
    ["rocket.motor.misalignment.y", "Thrust, misaligned about y", "mrad", 1e3, -5, 5],
    ["rocket.adaptors.rear.clearance", "Clearance of the rear adaptor", "mm", 1e3],
    ["rocket.adaptors.front.clearance", "Clearance of the front adaptor", "mm", 1e3],
    ["rocket.contact.friction", "Friction in the tube", "", 1, 0, 0.5],
    ["rocket.lock.release_force", "Release force of the lock", "kN", 1e-3],
    ["environment.wind.speed", "Wind", "m/s", 1, 0, 20],
  ];
  const PATHS = FIELDS.map(([path]) => path);

  const examples = JSON.parse(read("examples")); // {choices: [[name, title]], files: {name: text}, sets: what is set at first}
  let state = { text: "", sets: {}, files: {} }, given = []; // `given`: values of the fields without overrides
  let shown = null, earlier = [], counted = 0, waiting = null;
  let asked = "", kept = new Set(); // the state that was asked for last; those that stay as earlier runs

  // ---- the core: in a worker, as WebAssembly, where the page has it inside, else behind the server that the page is from ----

  function coreInWorker() {
    const worker = new Worker(URL.createObjectURL(new Blob([read("worker")], { type: "text/javascript" })));
    const wasm = inflated(read("core")).buffer;
    worker.postMessage({ wasm }, [wasm]);
    worker.onerror = ({ message }) => complain(`The core has stopped: ${message}. Reload the page.`);
    worker.onmessage = ({ data }) => settle(data);
    return (what) => worker.postMessage(what);
  }

  // Names and texts go, texts come, a zero after each.
  async function askServer({ text, sets, paths, files, ...told }) {
    const named = Object.entries(files).map(([name, content]) => [`file ${name}`, content]);
    const body = [["text", text], ["sets", sets], ["paths", paths], ...named].flat().map((part) => `${part}\0`).join("");
    const begun = performance.now();
    try {
      const response = await fetch("launch", { method: "POST", body });
      const [status, messages, scenario, summary, data, values] = (await response.text()).split("\0");
      if (!response.ok) throw new Error(status.trim());
      settle({ ...told, took: performance.now() - begun, status: Number(status), messages, scenario, summary, data,
        values: values ? values.split("\n") : [] });
    } catch ({ message }) {
      settle({ ...told, status: -1, messages: `launchdyn live has not answered: ${message}`, data: "", values: [] });
    }
  }

  const within = document.getElementById("core") !== null, launch = within ? coreInWorker() : askServer;
  let busy = within; // at first until the core is ready

  const setsOf = (sets) => Object.entries(sets).map(([path, value]) => `${path}=${value}`);

  // One runs, the latest other one waits; of those between nobody waits for an answer. What `settles` stays as an earlier run.
  function request(settles) {
    const key = JSON.stringify(state);
    if (settles) kept.add(key);
    if (key === asked) return;
    asked = key;
    const what = { number: ++counted, key, text: state.text, sets: setsOf(state.sets).join("\n"), files: { ...examples.files, ...state.files },
      paths: PATHS.join("\n"), label: labelOf(state.sets) };
    if (busy) waiting = what;
    else send(what);
  }
  function send(what) {
    busy = true;
    waiting = null;
    launch(what);
  }
  function settle(result) {
    busy = false;
    if (waiting) send(waiting);
    if (!result.ready) take(result);
  }

  // ---- what a run came to ----

  const messages = element("pre", { id: "messages", className: "warning", hidden: true });
  const took = element("output", { id: "took" });

  function complain(text) {
    messages.textContent = text.trim();
    messages.hidden = messages.textContent === "";
  }

  // What is set over the scenario, as a run is told from others.
  const labelOf = (sets) => setsOf(sets).map((set) => set.replace(/^.*\.(\w+\.?\w*=)/, "$1").replace("=", " ")).join(", ") || "as it was read";

  function take(result) {
    complain(result.messages);
    if (result.values.length > 0) showValues(result.values);
    document.documentElement.dataset.status = result.status;
    if (!result.data) {
      took.textContent = "";
      document.documentElement.dataset.run = result.number;
      return;
    }
    if (shown && kept.has(shown.key)) earlier = [shown, ...earlier].slice(0, MOST_EARLIER);
    window.launchdyn.result = result; // for tests, and for whoever looks into the page
    display();
    took.textContent = `${result.label}: launched in ${Math.round(result.took)} ms`;
    document.documentElement.dataset.run = result.number;
  }

  // The page below stands where it stood, and so does the replay.
  function display() {
    const scrolled = scrollY, time = window.launchdyn.current?.time, { key, label, data, summary } = window.launchdyn.result;
    const tables = show({ data: JSON.parse(data), summary, origin: null, theme, label, earlier: keep.checked ? earlier : [] });
    shown = { key, label, ...tables };
    scrollTo(0, scrolled);
    if (time !== undefined) window.launchdyn.current?.show(time, true);
  }

  // ---- fields ----

  const fields = element("div", { className: "fields" });
  const digits = (value) => String(Number(value.toPrecision(6)));

  function setField(path, unit, value, settles) {
    if (!Number.isFinite(value)) return;
    state.sets[path] = unit === "" ? String(value) : `${value} ${unit}`;
    share();
    request(settles);
  }

  // A slider with a number beside it; the number may lie outside the slider's range.
  function fieldOf([path, label, unit, factor, low, high], si) {
    const value = si * factor, ends = low === undefined ? [0.5 * value, 1.5 * value] : [Math.min(low, value), Math.max(high, value)];
    const number = element("input", { type: "number", step: "any", value: digits(value), ariaLabel: unit ? `${label}, ${unit}` : label });
    const slider = element("input", { type: "range", min: ends[0], max: ends[1], step: (ends[1] - ends[0]) / 200, value, ariaLabel: label });
    const change = (from, to, settles) => {
      to.value = digits(Number(from.value));
      setField(path, unit, Number(digits(Number(from.value))), settles);
    };
    slider.addEventListener("input", () => change(slider, number, false));
    slider.addEventListener("change", () => change(slider, number, true));
    number.addEventListener("change", () => change(number, slider, true));
    return element("div", { className: "field", "data-path": path, title: path }, element("span", {}, label), slider,
      element("span", { className: "value" }, number, unit));
  }

  // Fields are made once for a scenario, from its values before anything is set over them.
  function showValues(values) {
    if (given.length > 0) return;
    given = values.map(parseFloat);
    const some = FIELDS.map((field, i) => (Number.isFinite(given[i]) && !(field[4] === undefined && given[i] === 0) ? fieldOf(field, given[i]) : null));
    fields.replaceChildren(...some.filter(Boolean));
    for (const [path, value] of Object.entries(state.sets)) {
      const field = fields.querySelector(`[data-path="${CSS.escape(path)}"]`);
      for (const input of field?.querySelectorAll("input") ?? []) input.value = digits(parseFloat(value));
    }
  }

  // ---- scenarios in and out ----

  const editor = element("textarea", { id: "scenario", spellcheck: false, rows: 18, ariaLabel: "Scenario" });

  // Another scenario; what was set over the one before is gone.
  function load(text, files = {}, sets = {}) {
    state = { text, files, sets };
    given = [];
    earlier = [];
    shown = null;
    asked = "";
    kept = new Set();
    editor.value = text;
    choice.value = examples.choices.find(([name]) => examples.files[name] === text)?.[0] ?? "";
    share();
    request(true);
  }

  const through = async (bytes, stream) => new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
  async function packed(value) {
    const bytes = await through(new TextEncoder().encode(JSON.stringify(value)), new CompressionStream("deflate-raw"));
    return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
  }
  async function unpacked(text) {
    const bytes = Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (letter) => letter.charCodeAt(0));
    return JSON.parse(new TextDecoder().decode(await through(bytes, new DecompressionStream("deflate-raw"))));
  }

  // The address of what is shown, as short as it gets: an example by its name.
  let address = "", sharing = 0;
  async function share() {
    const number = ++sharing, { text, sets, files } = state;
    const name = Object.keys(examples.files).find((one) => examples.files[one] === text);
    const hash = HASH + await packed(name ? { name, sets, files } : { text, sets, files });
    if (number !== sharing) return;
    address = hash;
    history.replaceState(null, "", hash);
  }

  async function loadShared() {
    if (!location.hash.startsWith(HASH) || location.hash === address) return false;
    try {
      const { name, text, sets, files } = await unpacked(location.hash.slice(HASH.length));
      load(text ?? examples.files[name], files ?? {}, sets ?? {});
      return true;
    } catch {
      complain("The address holds no scenario that this page can read.");
      return false;
    }
  }
  addEventListener("hashchange", loadShared);

  async function loadFiles(list) {
    const texts = await Promise.all([...list].map(async (file) => [file.name, await file.text()]));
    const scenario = texts.find(([name]) => /\.ya?ml$/i.test(name));
    const files = Object.fromEntries(texts.filter((one) => one !== scenario));
    if (scenario) load(scenario[1], files);
    else load(state.text, { ...state.files, ...files });
  }
  addEventListener("dragover", (event) => event.preventDefault());
  addEventListener("drop", (event) => {
    event.preventDefault();
    if (event.dataTransfer.files.length > 0) loadFiles(event.dataTransfer.files);
  });
  addEventListener("paste", (event) => {
    const text = event.clipboardData.getData("text/plain");
    if (!event.target.closest?.("input, textarea") && /^launchdyn:/m.test(text)) load(text);
  });

  // ---- the page ----

  const button = (text, onclick, more = {}) => element("button", { type: "button", onclick, ...more }, text);
  const theme = themeSwitch();
  const keep = element("input", { type: "checkbox", checked: true });
  keep.addEventListener("change", () => window.launchdyn.result && display());
  const choice = element("select", { id: "example", ariaLabel: "Example", onchange: () => load(examples.files[choice.value]) },
    ...examples.choices.map(([name, title]) => element("option", { value: name }, title)));
  const opened = element("input", { type: "file", multiple: true, accept: ".yaml,.yml,.csv,.eng,.txt,.rse", ariaLabel: "Scenario and its files",
    onchange: () => loadFiles(opened.files) });
  document.getElementById("report").before(element("section", { id: "bench" },
    element("div", { className: "bar" }, element("strong", {}, "launchdyn"), choice,
      button("As it was read", () => load(state.text, state.files), { title: "Take back what the fields have changed" }),
      button("Save as YAML", () => download("scenario.yaml", window.launchdyn.result?.scenario ?? state.text, "text/yaml"), { id: "save" }),
      button("Copy address", () => navigator.clipboard?.writeText(location.href), { title: "The address of this page holds the scenario" }),
      element("label", {}, keep, "curves of the last runs"), took),
    fields,
    element("details", { className: "text" }, element("summary", {}, "Scenario: write, paste, open or drop one here, with the files that it names"),
      editor, element("div", { className: "bar" }, button("Launch", () => load(editor.value, state.files), { id: "launch" }), opened)),
    messages));
  loadShared().then((found) => found || load(examples.files[examples.choices[0][0]], {}, examples.sets));
})();

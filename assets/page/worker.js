// The worker of the page that simulates: behind the core's own script, which it starts with the bytes that the page hands over.
const MESSAGES = 0, SCENARIO = 1, SUMMARY = 2, DATA = 3, VALUES = 4;
let core = null;

// Runs a scenario with what is set over it; what came of it, as text, and the values that its keys have without.
function simulate({ text, sets, files, paths }) {
  for (const [name, content] of Object.entries(files)) core.module.FS.writeFile(`/${name.replaceAll("/", "_")}`, content);
  const begun = performance.now(), readable = core.values(text, "", paths) === 0, values = core.text(VALUES);
  const status = core.run(text, sets);
  return { status, took: performance.now() - begun, messages: core.text(MESSAGES), scenario: core.text(SCENARIO), summary: core.text(SUMMARY),
    data: core.text(DATA), values: readable ? values.split("\n") : [] };
}

self.onmessage = async ({ data }) => {
  if (data.wasm) {
    const module = await self.launchdynCore({ wasmBinary: data.wasm });
    const page = module.cwrap("page_new", "number", ["string"])("/");
    const call = (name, result, ...types) => module.cwrap(name, result, ["number", ...types]).bind(null, page);
    core = { module, run: call("page_run", "number", "string", "string"), text: call("page_text", "string", "number"),
      values: call("page_values", "number", "string", "string", "string") };
    self.postMessage({ ready: true });
  } else {
    self.postMessage({ number: data.number, key: data.key, label: data.label, ...simulate(data) });
  }
};

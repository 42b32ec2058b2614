// The core as WebAssembly, in Node: columns and summary of examples are those of the command, to the bit. Skipped (77) where
// the page has not been built (scripts/build-page). LD_PAGE_EXAMPLES="examples/fixed.yaml ...": these instead, with the hashes
// that scripts/hash-results gives their columns.
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const build = resolve(process.argv[2]), examples = join(dirname(fileURLToPath(import.meta.url)), "../../examples");
if (!existsSync(join(build, "page/core.wasm"))) {
  console.log("skipped: no page has been built (scripts/setup page, cmake --build build --target page)");
  process.exit(77);
}
const folder = mkdtempSync(join(tmpdir(), "launchdyn-core-"));
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));

const make = createRequire(import.meta.url)(join(build, "page/core.js"));
const core = await make({ wasmBinary: readFileSync(join(build, "page/core.wasm")) });
const page = core.cwrap("page_new", "number", ["string"])("/");
const call = (name, result, ...types) => core.cwrap(name, result, ["number", ...types]).bind(null, page);
const run = call("page_run", "number", "string", "string"), text = call("page_text", "string", "number");
const writeCsv = call("page_write_csv", "number", "number", "string");
const MESSAGES = 0, SCENARIO = 1, SUMMARY = 2, DATA = 3;
for (const name of readdirSync(examples, { recursive: true }))
  if (/\.(yaml|csv|eng|glb)$/.test(name)) {
    core.FS.mkdirTree(dirname(`/${name}`));
    core.FS.writeFile(`/${name}`, readFileSync(join(examples, name)));
  }

let wrong = 0;
function check(what, fine, measured = "") {
  console.log(`    ${fine ? "ok   " : "WRONG"} ${what} ${measured}`);
  wrong += !fine;
}

function csv(rocket) {
  if (writeCsv(rocket, "/columns.csv") !== 0) return null;
  return core.FS.readFile("/columns.csv", { encoding: "utf8" });
}

// flights.csv has the rocket's number before each row of its flight.
function flightOf(file, rocket) {
  const [head, ...rows] = readFileSync(file, "utf8").split("\n");
  return [head, ...rows.filter((row) => row.startsWith(`${rocket},`))].map((row) => `${row.slice(row.indexOf(",") + 1)}\n`).join("");
}

// What differs between two summaries: keys with their values.
function differences(a, b, path = "") {
  if (a === null || b === null || typeof a !== "object" || typeof b !== "object") return a === b ? [] : [path];
  return [...new Set([...Object.keys(a), ...Object.keys(b)])].flatMap((key) => differences(a[key], b[key], `${path}.${key}`));
}

// Who has computed it, how long, and what files lie beside it.
const OTHER = /^\.(program\.|statistics\.cpu_seconds|files\.|source\.files\.0\.name$|digest$)/;

function compare(name, flights, ...sets) {
  const out = join(folder, name), status = run(readFileSync(join(examples, name), "utf8"), sets.join("\n"));
  execFileSync(join(build, "launchdyn"), ["run", join(examples, name), "--out", out, "--csv", "--quiet", ...sets.flatMap((set) => ["--set", set])]);
  const columns = readFileSync(join(out, "history.csv"), "utf8"), rows = columns.split("\n").length - 2;
  check(`${name}: ${rows} rows of ${columns.split("\n")[0].split(",").length} columns`, status === 0 && rows > 0 && csv(0) === columns,
    text(MESSAGES));
  for (let rocket = 1; rocket <= flights; rocket++) {
    const flight = flightOf(join(out, "flights.csv"), rocket);
    check(`${name}: flight of rocket ${rocket}, ${flight.split("\n").length - 2} rows`, flight.split("\n").length > 10 && csv(rocket) === flight);
  }
  const numbers = JSON.parse(readFileSync(join(out, "summary.json"), "utf8"));
  const differ = differences(JSON.parse(text(SUMMARY)), numbers).filter((path) => !OTHER.test(path));
  check(`${name}: summary of ${JSON.stringify(numbers).split(",").length} members`, differ.length === 0, differ.join(" "));
  check(`${name}: what the report shows is there`, JSON.parse(text(DATA)).tables.length > 0);
}

// Columns of an example, also in a folder of its own, and of its flights; of a study those of its nominal launch.
function compareColumns(name) {
  const out = join(folder, "example"), status = run(`include: ${name}\n`, "");
  rmSync(out, { recursive: true, force: true });
  execFileSync(join(build, "launchdyn"), ["run", join(examples, name), "--out", out, "--csv", "--quiet"]);
  const files = readdirSync(out).filter((file) => file.endsWith(".csv")).sort(), hash = createHash("sha256");
  for (const file of files) hash.update(readFileSync(join(out, file)));
  const flights = join(out, "flights.csv"), rockets = existsSync(flights)
    ? [...new Set(readFileSync(flights, "utf8").split("\n").slice(1, -1).map((row) => row.split(",", 1)[0]))] : [];
  const same = status === 0 && csv(0) === readFileSync(join(out, "history.csv"), "utf8")
    && rockets.every((rocket) => csv(Number(rocket)) === flightOf(flights, rocket));
  const other = files.filter((file) => file !== "history.csv" && file !== "flights.csv").join(" ");
  check(`${hash.digest("hex").slice(0, 16)} ${name}`, same && other === "", other + text(MESSAGES));
}

if (process.env.LD_PAGE_EXAMPLES) {
  for (const example of process.env.LD_PAGE_EXAMPLES.split(/\s+/).filter(Boolean)) compareColumns(example.replace(/^examples\//, ""));
  process.exit(wrong > 0 ? 1 : 0);
}

compare("fixed.yaml", 0);
compare("sequence.yaml", 2, "firing=[{tube: 8, at: 0 s}, {tube: 9, at: 0.3 s}]", "run.output_step=5 ms");
compare("ship.yaml", 0, "run.output_step=1 ms");
compare("parachutes.yaml", 0, "run.output_step=20 ms");

// The scenario as it was understood gives the same run, a wrong one the command's words.
check("the scenario that is handed out is the command's", text(SCENARIO) === JSON.parse(text(SUMMARY)).scenario);
const bad = readFileSync(join(examples, "fixed.yaml"), "utf8").replace("mass: 60 kg", "mas: 60 kg");
writeFileSync(join(folder, "scenario.yaml"), bad);
check("a wrong scenario is refused", run(bad, "") === 1);
let said = "";
try {
  execFileSync(join(build, "launchdyn"), ["run", "scenario.yaml"], { cwd: folder, stdio: ["ignore", "ignore", "pipe"] });
} catch ({ stderr }) {
  said = String(stderr);
}
check("and why is said as the command says it", said.includes("did you mean") && text(MESSAGES) === said, text(MESSAGES));
process.exitCode = wrong > 0 ? 1 : 0;

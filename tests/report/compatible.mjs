// Scripts of this tree use what Node 18.20 (Debian 12) and browsers of the autumn of 2023 have: ECMAScript 2022, and of the
// environment what each has. Firefox 115 is the long-term release of that time. ESLint reads the syntax, eslint-plugin-es-x
// knows what came with which edition, eslint-plugin-compat what browsers have, eslint-plugin-n what Node has. Before it looks
// at the tree, the check must see each of some faults. Run by the script `browser` beside it. A new version of one of these:
// npm install --package-lock-only, then jq 'del(.packages[] | .resolved, .funding)' on the lock file.
import { createRequire } from "node:module";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const edition = 2022, node = ">=18.20.0", browsers = ["chrome >= 118", "firefox >= 115", "safari >= 17"];

const installed = createRequire(join(process.env.LD_MODULES, "package.json"));
const { ESLint } = installed("eslint"), editions = installed("eslint-plugin-es-x");
const environment = installed("eslint-plugin-compat").configs["flat/recommended"], nodes = installed("eslint-plugin-n");

// A method counts whatever it is called on; those whose names older objects have, too, where the object is seen to be of that kind.
const shared = /-(iterator-prototype-|set-prototype-(union|difference)$|arraybuffer-prototype-transfer$|resizable-)/;
const late = { ...editions.configs[`flat/restrict-to-es${edition}`].rules, ...editions.configs["flat/no-new-in-esnext"].rules };
const rules = Object.fromEntries(Object.keys(late).map((name) => [name, ["error", ...(shared.test(name) ? [{ aggressive: false }] : [])]]));

const eslint = new ESLint({
  cwd: fileURLToPath(new URL("../../", import.meta.url)), overrideConfigFile: true,
  overrideConfig: [
    { ignores: ["build*/", "out/"] },
    { linterOptions: { noInlineConfig: true, reportUnusedDisableDirectives: "off" } },
    { plugins: { "es-x": editions }, rules, settings: { "es-x": { aggressive: true } }, languageOptions: { ecmaVersion: edition } },
    { ...environment, files: ["assets/**", "tests/**"], settings: { targets: browsers } },
    { files: ["tests/**"], plugins: { n: nodes }, settings: { node: { version: node } },
      rules: { "n/no-unsupported-features/node-builtins": ["error", { allowExperimental: true }], "n/no-unsupported-features/es-builtins": "error" } },
    // three.js asks whether there are such before it makes one.
    { files: ["assets/bundle/replay.js"], settings: { polyfills: ["XRWebGLBinding"] }, rules: { "es-x/no-float16array": "off" } },
  ],
});

// Faults: of a script, where it lies, what sees it (null: ESLint's parser).
const faults = [
  ["export const back = (names) => names.toReversed();", "assets/report", "es-x/no-array-prototype-toreversed"],
  ["(()=>{for(let n of names?.toReversed())n.left=1})()", "assets/bundle", "es-x/no-array-prototype-toreversed"],
  ["export const last = (names) => names.findLast((name) => name.left);", "assets/replay", "es-x/no-array-prototype-findlast-findlastindex"],
  ["export const groups = Object.groupBy([], (row) => row.kind);", "tests/report", "es-x/no-object-groupby"],
  ["export const all = await Array.fromAsync([]);", "tests/report", "es-x/no-array-fromasync"],
  ["const seen = new Set(), more = seen.union(new Set());", "assets/report", "es-x/no-set-prototype-union"],
  ["export const inside = (a, b) => a.isSubsetOf(b);", "assets/report", "es-x/no-set-prototype-issubsetof"],
  ["const { promise } = Promise.withResolvers();", "assets/manual", "es-x/no-promise-withresolvers"],
  ["const pattern = new RegExp(`[${letters}--q]`, 'v');", "assets/report", "es-x/no-regexp-v-flag"],
  ["const pattern = /[a-z--q]/v;", "assets/report", null],
  ["import data from './data.json' with { type: 'json' };", "tests/report", null],
  ["{ using file = open(); }", "tests/report", null],
  ["requestIdleCallback(paint);", "assets/report", "compat/compat"],
  ["const here = import.meta.dirname;", "tests/report", "n/no-unsupported-features/node-builtins"],
  ["import { globSync } from 'node:fs'; globSync('*');", "tests/report", "n/no-unsupported-features/node-builtins"],
];
let wrong = 0;
for (const [text, folder, rule] of faults) {
  const [{ messages }] = await eslint.lintText(text, { filePath: `${folder}/fault.mjs` });
  if (messages.some(({ ruleId, severity }) => ruleId === rule && severity === 2)) continue;
  console.log(`not seen in ${folder}: ${text} (${messages.map(({ message }) => message).join("; ") || "no message"})`);
  wrong += 1;
}

// What is older passes, the newest of that edition too.
const fine = "export class A { static { A.all = [].concat([3]).map(String).at(-1); } #x = 1; has(o) { return #x in o && Object.hasOwn(o, 'x'); } }";
for (const { message } of (await eslint.lintText(fine, { filePath: "assets/report/fine.js" }))[0].messages) {
  console.log(`wrongly seen: ${message}`);
  wrong += 1;
}

const files = await eslint.lintFiles(["**/*.{js,mjs,cjs}"]);
for (const { filePath, messages } of files)
  for (const { line, column, message } of messages) {
    console.log(`${filePath}:${line}:${column}: ${message}`);
    wrong += 1;
  }
console.log(`${files.length} scripts, ${faults.length} faults, ${wrong} wrong`);
process.exit(files.length > 50 && wrong === 0 ? 0 : 1);

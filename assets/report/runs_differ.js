// In what runs differ: the keys of their scenarios, as they were understood, and the names that follow.
import { readable } from "./data.js";

const SHORT = 40;

// "60 kg" as a person reads it; a list of members as it is.
export const shownValue = (text) => text.replace(/-?\d+\.?\d*(e[-+]?\d+)?/gi, (number) => readable(Number(number), 5));

// The entries of "{name: rear, at: 0 m}", or nothing where one of them holds a list or a block.
function membersOf(text) {
  if (!/^\{[^{}[\]]*\}$/.test(text)) return null;
  return text.slice(1, -1).split(", ").map((entry) => [entry.split(":")[0], entry.split(":").slice(1).join(":").trim()]);
}

// The values of a scenario by the paths of their keys; entries of lists by their name, else by number.
export function valuesOf(scenario) {
  const values = new Map(), keys = [], counts = new Map();
  for (const line of scenario.split("\n")) {
    const depth = line.search(/\S/) / 2, text = line.trim();
    if (depth < 0) continue;
    if (text.startsWith("- ")) {
      const parent = keys.slice(0, depth).join("."), members = membersOf(text.slice(2));
      const number = (counts.get(parent) ?? 0) + 1, named = members?.find(([key]) => key === "name");
      counts.set(parent, number);
      for (const [key, value] of members ?? [["", text.slice(2)]])
        values.set([parent, named?.[1] ?? number, key].filter((part) => part !== "").join("."), value);
    } else {
      const end = text.indexOf(":");
      keys[depth] = text.slice(0, end);
      if (end + 1 < text.length) values.set(keys.slice(0, depth + 1).join("."), text.slice(end + 1).trim());
    }
  }
  return values;
}

// The keys, but for the title, whose values are not the same in all scenarios: [path, values].
export function differences(scenarios) {
  if (scenarios.some((scenario) => typeof scenario !== "string")) return [];
  const all = scenarios.map(valuesOf);
  return [...new Set(all.flatMap((values) => [...values.keys()]))]
    .map((path) => [path, all.map((values) => values.get(path) ?? "–")])
    .filter(([path, values]) => path !== "title" && new Set(values).size > 1);
}

const distinct = (texts) => new Set(texts).size === texts.length && texts.every(Boolean);

// What is left of texts without the words that all of them begin with.
function ends(texts) {
  const words = texts.map((text) => text.split(/\s+/));
  let same = 0;
  while (words.every((list) => same < list.length - 1 && list[same] === words[0][same])) same++;
  return words.map((list) => list.slice(same).join(" "));
}

// A short name for each run, all different: by title, else by up to two keys, else by folder.
export function labelsOf(runs, keys) {
  const cut = (text) => (text.length > SHORT ? `${text.slice(0, SHORT - 1)}…` : text);
  const byTitle = ends(runs.map(({ title }) => title)).map(cut);
  if (distinct(byTitle)) return byTitle;
  const byKeys = runs.map((_, i) => cut(keys.slice(0, 2).map(([path, values]) =>
    `${path.split(".").pop()} ${shownValue(values[i])}`).join(", ")));
  if (keys.length <= 2 && distinct(byKeys)) return byKeys;
  const byFolder = runs.map(({ folder }) => cut(folder));
  return distinct(byFolder) ? byFolder : byFolder.map((name, i) => `${i + 1}: ${name}`);
}

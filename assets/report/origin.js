// Where results come from: the program, the scenario as it was understood, the texts that it was read from.
import { element } from "./page.js";

const LONG = "Too long for a report; it is in the results' folder.";

function folded(name, text) {
  return element("details", {}, element("summary", {}, name), element("pre", { tabIndex: 0 }, text ?? LONG));
}

function program(facts) {
  return element("div", { className: "scroll" }, element("table", {}, ...facts.map(([name, text]) =>
    element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, text)))));
}

// The block of one run or study; `again` is the command that repeats it.
export function originBlock(origin, again) {
  const drawn = [origin.point > 0 ? `point ${origin.point} of the sweep` : "", origin.sample > 0 ? `sample ${origin.sample}` : ""]
    .filter(Boolean).join(", ");
  return element("section", { className: "origin" },
    element("div", { className: "rest" }, element("details", {}, element("summary", {}, "Program and libraries"), program(origin.program)),
    folded("Scenario in SI", origin.scenario),
    ...origin.files.map(([name, text]) => folded(`File ${name}`, text)),
    origin.set.length ? folded("Overrides", origin.set.map((set) => `--set ${set ?? LONG}`).join("\n")) : null),
    element("p", { className: "shown" }, `${drawn ? `This is ${drawn}. ` : ""}${origin.files.length
      ? `launchdyn ${again} FOLDER repeats it from its folder alone.` : "Its model was not read from a scenario."}`));
}

// Small helpers for the page. Text from the results goes in as text, never as HTML.

export function element(tag, properties = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(properties))
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (name in node && name !== "list") node[name] = value;
    else node.setAttribute(name, value);
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

// A colour of the style sheet, as the theme has it now.
let colours = new Map();
export function colour(name) {
  if (!colours.has(name))
    colours.set(name, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
  return colours.get(name);
}

export function curveColour(index) {
  return colour(`curve${index % 8}`);
}

// Hands a text, or a blob, to the user as a file.
export function download(name, content, type = "text/csv") {
  const url = URL.createObjectURL(new Blob([content], { type }));
  const link = element("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

// What wants to draw itself again when colours change.
const painters = [];
export function onColours(paint) {
  painters.push(paint);
}

// What is shown lives until something else takes its place: then its painters go, and what listens with this signal.
let living = new AbortController();
export const life = () => living.signal;
export function renew() {
  living.abort();
  living = new AbortController();
  painters.length = 0;
}

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  colours = new Map();
  for (const paint of painters) paint();
}

// Light or dark as the system says, until the switch is used; light on paper.
export function themeSwitch() {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const button = element("button", {
    id: "theme", type: "button",
    onclick: () => {
      setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark");
      name();
    },
  });
  const name = () => {
    button.textContent = document.documentElement.dataset.theme === "dark" ? "Light" : "Dark";
  };
  const follow = () => {
    setTheme(dark.matches ? "dark" : "light");
    name();
  };
  dark.addEventListener("change", follow);
  let before;
  addEventListener("beforeprint", () => {
    before = document.documentElement.dataset.theme;
    setTheme("light");
  });
  addEventListener("afterprint", () => setTheme(before));
  follow();
  return button;
}

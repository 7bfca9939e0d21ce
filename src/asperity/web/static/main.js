// The page: what its buttons do, and how designs, form and panels hang together.

import { CaseBox } from "/static/casebox.js";
import { Design, canonical, read, written } from "/static/design.js";
import { copied, copyCase, download, opened } from "/static/files.js";
import { Form, idOf } from "/static/form.js";
import { AdhesionMap } from "/static/map.js";
import { Panels } from "/static/panels.js";
import { getting } from "/static/server.js";
import { Top } from "/static/verdict.js";

const FILES = ["motion.png", "forces.png", "energy.png", "curve.png", "motion.csv", "curve.csv", "record.nc", "curve.nc", "summary.txt"];
const TICK = 200; // ms between two looks at what is waited for

const by = (id) => document.getElementById(id);
const say = (words) => { by("notice").textContent = words; };

let designs = [];
let active = 0;
let form, panels, map, top, box, linking, ticking;
const latencies = []; // ms from a change to its picture, for whoever measures

const current = () => designs[active];

function show(what) {
  work();
  if (what === "measures") panels.measured(designs);
  if (what !== "answer") return;
  said();
  panels.show(designs);
  map?.show(designs);
  for (const one of designs) if (one.answeredSince) {
    const since = one.answeredSince;
    one.answeredSince = null;
    requestAnimationFrame(() => latencies.push(performance.now() - since)); // once it is drawn
  }
  document.body.dataset.shown = designs.map((one) => `${one.shown}/${one.asked}`).join(" ");
}

// Verdicts, warnings, and what is refused, at the top and in the form.
function said() {
  top.show(designs);
  form.refuse(current(), mended);
  for (const one of designs) if (one.refusal && !one.refusal.remedies) {
    one.mend().then(() => form.refuse(current(), mended), () => {}); // without remedies it is told too
  }
}

function work() {
  clearTimeout(ticking);
  if (top.work(designs)) ticking = setTimeout(work, TICK);
}

function ask(design = current(), since = performance.now()) {
  design.ask(show, since);
  box.show(current());
  link(300);
}

function link(after) {
  clearTimeout(linking);
  linking = setTimeout(() => history.replaceState(null, "", `#${written(designs)}`), after);
}

// Form

function changed(path, key, value, since) {
  const before = JSON.stringify(current().tables);
  current().set(path, key, value);
  if (JSON.stringify(current().tables) === before) return;
  current().touched = "";
  say("");
  ask(current(), since);
}

// A choice may ask for other keys, which are filled in before it is computed.
async function chosen(path, key, value) {
  const design = current();
  const before = design.tables;
  design.set(path, key, value);
  await completed(design, before, `${path}.${key}`, idOf("field", path) + `-${key}`);
}

async function tabled(table, used) {
  const design = current();
  const before = design.tables;
  const given = Object.fromEntries(table.keys.filter((key) => key.shown && key.example !== null).map((key) => [key.key, key.example]));
  if (used) design.put(table.name, design.kept[table.name] ?? given);
  else design.remove(table.name);
  form.show(design);
  const place = by(idOf("table", table.name));
  for (let around = place; around; around = around.parentElement) if (around.tagName === "DETAILS") around.open = true;
  const focus = place ? by(idOf("use", table.name)) ?? place.querySelector("input") : by(idOf("new", table.name.split(".")[0]));
  focus.focus();
  await completed(design, before, table.name, focus.id);
}

async function completed(design, before, touched, focus) {
  design.touched = touched;
  const completing = design.complete(before);
  work(); // it is busy from now on
  let filled = [];
  try {
    filled = await completing;
  } catch {
    // what is missing is told by the question itself
  }
  asked(design);
  design.filled[touched] = filled.map((key) => [...halves(key), design.get(...halves(key))]);
  if (filled.length && design === current()) {
    form.show(design);
    for (const key of filled) form.reveal(key);
    form.reveal(touched);
    by(focus)?.focus({ preventScroll: true });
    say(`Filled in as well: ${filled.map((key) => `${form.name(key)} ${design.get(...halves(key))}`).join(", ")}.`);
  }
}

const halves = (key) => [key.slice(0, key.lastIndexOf(".")), key.slice(key.lastIndexOf(".") + 1)];

// Set what mends a refused case.
function mended({ key, value }) {
  const design = current();
  const before = design.tables;
  if (key.includes(".")) design.set(...halves(key), value ?? undefined);
  else design.put(key, value ?? undefined);
  form.show(design);
  return completed(design, before, key, "");
}

// Ask anew where what was refused is no longer what is asked for.
function asked(design) {
  design.refusal = null;
  say("");
  ask(design);
  said();
}

// Designs

function replace(name, tables, source = name) {
  const fresh = new Design(current()?.letter ?? "A", name, tables, {}, source);
  current()?.cancel();
  fresh.asked = fresh.shown = current()?.asked ?? 0;
  fresh.answer = current()?.answer ?? null;
  designs[active] = fresh;
  form.show(fresh);
  asked(fresh);
}

function compare() {
  if (designs.length > 1) {
    designs[1].cancel();
    designs = [designs[0]];
    link(0);
  } else {
    designs.push(designs[0].copy("B"));
    ask(designs[1]);
  }
  choose(designs.length - 1);
  show("answer");
}

function choose(number) {
  active = number;
  by("designs").hidden = designs.length < 2;
  by("compare").setAttribute("aria-pressed", String(designs.length > 1));
  document.querySelectorAll("input[name=design]").forEach((one) => { one.checked = Number(one.value) === number; });
  form.show(current());
  form.refuse(current(), mended);
  box.show(current());
}

const told = (action) => (...given) => Promise.resolve(action(...given)).catch((error) => say(error.message));

// Take measured surfaces in place of the numbers.
function dropped(design, files) {
  const { asperity_density, asperity_radius, rms_height, ...rest } = design.tables.roughness ?? {};
  design.tables = { ...design.tables, roughness: { ...rest, files } };
  design.touched = "roughness";
  form.show(current());
  by("table-roughness").open = true;
  asked(design);
}

// Look

function dress(dark) {
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  by("theme").setAttribute("aria-pressed", String(dark));
  panels?.restyle();
  map?.restyle();
  if (designs.length) show("answer");
}

async function start() {
  dress(matchMedia("(prefers-color-scheme: dark)").matches);
  const { tables, cases, first } = await getting("/api/form");
  form = new Form(by("tables"), tables, { changed, chosen: told(chosen), tabled: told(tabled) });
  panels = new Panels();
  top = new Top((design, key) => {
    choose(designs.indexOf(design));
    form.reveal(key);
  });
  box = new CaseBox(by("case"), [...new Set([first, ...cases])]);
  let from = null;
  if (location.hash.length > 1) {
    try {
      from = read(location.hash.slice(1));
    } catch {
      say("The link does not hold a whole state; the page begins with its case.");
    }
  }
  designs = from ?? [await builtin(first)];
  for (const one of designs) if (one.linked && box.has(one.source)) one.base = canonical((await builtin(one.source)).tables);
  choose(0);
  designs.forEach((one) => ask(one));
  listen();
  map = new AdhesionMap("map", await getting("/api/map"));
  map.show(designs);
}

async function builtin(name) {
  const { tables } = await getting(`/api/cases/${encodeURIComponent(name)}`);
  return new Design("A", name, tables);
}

const page = { current, replace, dropped, say };

function listen() {
  const on = (id, event, action) => by(id).addEventListener(event, told(action));
  on("case", "change", async () => {
    if (!by("case").value) return;
    const { name, tables } = await builtin(by("case").value);
    replace(name, tables);
  });
  on("skip", "click", () => by("answer").focus());
  let below = false; // whether the form is what is looked at
  new IntersectionObserver(([{ isIntersecting }]) => {
    below = isIntersecting;
    by("to-form").textContent = below ? "Back to the answer" : "Change the case";
  }, { rootMargin: "-40% 0px -40% 0px" }).observe(by("form"));
  on("to-form", "click", () => (below ? scrollTo(0, 0) : by("form").scrollIntoView()));
  for (const id of ["own-case", "own-surface"]) on(id, "change", async ({ target }) => {
    await opened([...target.files], page);
    target.value = "";
  });
  on("compare", "click", compare);
  on("copy-case", "click", () => copyCase(current(), say));
  on("text-close", "click", () => by("text").close());
  on("copy-link", "click", async () => {
    history.replaceState(null, "", `#${written(designs)}`);
    say((await copied(location.href)) ? "The link is copied." : "The link is in the address bar.");
  });
  on("theme", "click", () => dress(document.documentElement.dataset.theme !== "dark"));
  on("cancel", "click", () => {
    designs.forEach((one) => one.cancel());
    work();
    said();
    panels.show(designs);
    say("Cancelled; the last picture stays.");
  });
  document.querySelectorAll("input[name=design]").forEach((one) => one.addEventListener("change", () => choose(Number(one.value))));
  panels.button.addEventListener("click", () => {
    panels.whole = !panels.whole;
    panels.button.setAttribute("aria-pressed", String(panels.whole));
    panels.show(designs);
  });
  by("download-list").append(...FILES.map((name) => {
    const button = Object.assign(document.createElement("button"), { type: "button", textContent: name });
    button.addEventListener("click", told(() => download(name, current(), say)));
    return button;
  }));
  by("form").addEventListener("submit", (event) => event.preventDefault());
  document.addEventListener("dragover", (event) => { event.preventDefault(); document.body.classList.add("dropping"); });
  document.addEventListener("dragleave", (event) => { if (!event.relatedTarget) document.body.classList.remove("dropping"); });
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("dropping");
    opened([...event.dataTransfer.files], page);
  });
}

// A link of ours that is opened in the open page.
addEventListener("hashchange", () => location.reload());

window.asperity = { latencies, designs: () => designs };
start().catch((error) => say(`The page cannot start: ${error.message}`));

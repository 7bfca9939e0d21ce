// The page: what its buttons do, and how designs, form and panels hang together.

import { Design, read, written } from "/static/design.js";
import { Form, idOf } from "/static/form.js";
import { AdhesionMap } from "/static/map.js";
import { Panels } from "/static/panels.js";
import { fileOf, getting, posting } from "/static/server.js";

const FILES = ["motion.png", "forces.png", "energy.png", "curve.png", "motion.csv", "curve.csv", "record.nc", "curve.nc", "summary.txt"];
const SLOW = 400; // ms until a computation shows its progress

const by = (id) => document.getElementById(id);
const say = (words) => { by("notice").textContent = words; };

let designs = [];
let active = 0;
let form, panels, map, linking, ticking;
const latencies = []; // ms from a change to its picture, for whoever measures

const current = () => designs[active];

function show(what) {
  work();
  if (what === "measures") panels.measured(designs);
  if (what !== "answer") return;
  const design = current();
  form.refuse(design.refusal);
  panels.show(designs);
  map?.show(designs);
  for (const one of designs) if (one.answeredSince) {
    const since = one.answeredSince;
    one.answeredSince = null;
    requestAnimationFrame(() => latencies.push(performance.now() - since)); // once it is drawn
  }
  document.body.dataset.shown = designs.map((one) => `${one.shown}/${one.asked}`).join(" ");
}

function work() {
  const busy = designs.find((one) => one.work);
  by("work").hidden = !(busy?.running && performance.now() - busy.running.begun > SLOW);
  if (document.body.dataset.busy !== (busy ? "yes" : "no")) document.body.dataset.busy = busy ? "yes" : "no";
  if (!busy) return;
  by("progress").value = busy.work.fraction;
  by("progress-text").textContent = busy.work.text;
  clearTimeout(ticking);
  ticking = setTimeout(work, SLOW);
}

function ask(design = current(), since = performance.now()) {
  design.ask(show, since);
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
  by("case").selectedIndex = -1; // no longer the case of that name
  ask(current(), since);
}

function tabled(table, used) {
  const given = Object.fromEntries(table.keys.filter((key) => key.shown && key.example !== null).map((key) => [key.key, key.example]));
  current().put(table.name, used ? given : undefined);
  form.show(current());
  const box = by(idOf("table", table.name));
  if (box) {
    for (let around = box; around; around = around.parentElement) if (around.tagName === "DETAILS") around.open = true;
    (by(idOf("use", table.name)) ?? box.querySelector("input")).focus();
  } else {
    by(idOf("new", table.name.split(".")[0])).focus();
  }
  ask();
}

// Designs

function replace(name, tables, surfaces = {}) {
  const fresh = new Design(current()?.letter ?? "A", name, tables, surfaces);
  current()?.cancel();
  fresh.asked = fresh.shown = current()?.asked ?? 0;
  fresh.answer = current()?.answer ?? null;
  designs[active] = fresh;
  by("case").value = name; // none, where it is no built-in case
  form.show(fresh);
  ask(fresh);
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
  form.refuse(current().refusal);
}

// Files

async function opened(files) {
  for (const file of files) {
    try {
      if (file.name.toLowerCase().endsWith(".toml")) await openedCase(file);
      else await openedSurface(file, files);
    } catch (error) {
      say(`${file.name}: ${error.message}`);
    }
  }
}

async function openedCase(file) {
  if (file.size > 1 << 20) throw new Error("a case must be at most 1 MiB");
  const { tables } = await posting("/api/read", await file.text(), "text/plain");
  replace(file.name.replace(/\.toml$/i, "").slice(0, 100), tables);
  say(`${file.name} is open.`);
}

async function openedSurface(file, among) {
  say(`${file.name} is being read.`);
  const design = current();
  const { name, token } = await posting(`/api/surfaces/${encodeURIComponent(file.name)}`, file, "application/octet-stream");
  const dropped = [...among].filter((one) => !one.name.toLowerCase().endsWith(".toml")).length > 1;
  const before = dropped ? (design.get("roughness", "files") ?? []).filter((one) => design.surfaces[one] && one !== name) : [];
  design.surfaces = { ...design.surfaces, [name]: token };
  const { asperity_density, asperity_radius, rms_height, ...rest } = design.tables.roughness ?? {};
  design.tables = { ...design.tables, roughness: { ...rest, files: [...before, name].slice(-2) } };
  form.show(current());
  by("table-roughness").open = true;
  say(`${name} is the surface now.`);
  ask(design);
}

async function copyCase() {
  const { toml } = await posting("/api/toml", JSON.stringify(current().question()));
  by("text-content").value = toml;
  by("text").showModal();
  by("text-content").select();
  say((await copied(toml)) ? "The case is copied." : "Copy the text from the box.");
}

async function copied(words) {
  try {
    await navigator.clipboard.writeText(words);
    return true;
  } catch {
    return false;
  }
}

async function download(name) {
  say(`${name} is being made.`);
  const design = current();
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(await fileOf(name, design.question())), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  say(`${name} is downloaded.`);
}

const told = (action) => (...given) => Promise.resolve(action(...given)).catch((error) => say(error.message));

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
  form = new Form(by("tables"), tables, { changed, tabled });
  panels = new Panels();
  by("case").append(...[...new Set([first, ...cases])].map((name) => new Option(name, name)));
  let from = null;
  if (location.hash.length > 1) {
    try {
      from = read(location.hash.slice(1));
    } catch {
      say("The link does not hold a whole state; the page begins with its case.");
    }
  }
  designs = from ?? [await builtin(first)];
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

function listen() {
  const on = (id, event, action) => by(id).addEventListener(event, told(action));
  on("case", "change", async () => {
    const { name, tables } = await builtin(by("case").value);
    replace(name, tables);
  });
  for (const id of ["own-case", "own-surface"]) on(id, "change", async ({ target }) => {
    await opened([...target.files]);
    target.value = "";
  });
  on("compare", "click", compare);
  on("copy-case", "click", copyCase);
  on("text-close", "click", () => by("text").close());
  on("copy-link", "click", async () => {
    history.replaceState(null, "", `#${written(designs)}`);
    say((await copied(location.href)) ? "The link is copied." : "The link is in the address bar.");
  });
  on("theme", "click", () => dress(document.documentElement.dataset.theme !== "dark"));
  on("cancel", "click", () => {
    designs.forEach((one) => one.cancel());
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
    button.addEventListener("click", told(() => download(name)));
    return button;
  }));
  by("form").addEventListener("submit", (event) => event.preventDefault());
  document.addEventListener("dragover", (event) => { event.preventDefault(); document.body.classList.add("dropping"); });
  document.addEventListener("dragleave", (event) => { if (!event.relatedTarget) document.body.classList.remove("dropping"); });
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("dropping");
    opened([...event.dataTransfer.files]);
  });
}

// A link of ours that is opened in the open page.
addEventListener("hashchange", () => location.reload());

window.asperity = { latencies, designs: () => designs };
start().catch((error) => say(`The page cannot start: ${error.message}`));

// The form, made from the case schema that the server sends: a new key appears by itself.

import { parted, short } from "/static/units.js";

const STEPS = 1000;
const LONGEST = 60; // of a name
const FACTOR = 10; // a slider without ends goes from a tenth of the value to ten times it

const element = (tag, properties = {}, ...children) => {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
};

// A path as part of an id, which must hold no blanks.
export const idOf = (kind, path) => `${kind}-${encodeURIComponent(path)}`;

const sentence = (words) => words.charAt(0).toUpperCase() + words.slice(1);
// A key small beside its name; it may be broken at its dots.
const hint = (words) => element("code", { className: "key" }, ...words.split(/(?<=\.)/).flatMap((part) => [part, element("wbr")]));

export class Form {
  // `changed(path, key, value, since)`: value undefined takes the key away; `chosen(path, key, value)`
  // where it may ask for other keys; `tabled(table, used)`.
  constructor(place, tables, { changed, chosen, tabled }) {
    this.place = place;
    this.tables = tables;
    this.changed = changed;
    this.chosen = chosen;
    this.tabled = tabled;
    this.fields = new Map();
    this.boxes = new Map(); // of tables
    this.rest = { wrong: element("div", { className: "wrong", hidden: true }) }; // of what has neither
    place.before(this.rest.wrong);
  }

  // Draw the form anew for a design.
  show(design) {
    const open = new Set([...this.place.querySelectorAll("details[open]")].map((one) => one.id));
    this.fields.clear();
    this.boxes.clear();
    this.own = Object.keys(design.tables.materials ?? {}); // which can be named as those of the catalogue
    this.place.replaceChildren(...this.tables.map((table) => (table.named ? this.named : this.table).call(this, table, design, open)));
  }

  // Tables under names of the user's own, each with its fields, and a place for one more.
  named(table, design, open) {
    const own = Object.keys(design.tables[table.name] ?? {});
    const box = element("details", { id: `table-${table.name}` }, element("summary", {}, sentence(table.label), hint(`[${table.name}.NAME]`)));
    box.open = open.has(box.id) || own.length > 0;
    if (table.help) box.append(element("p", { className: "about", textContent: table.help }));
    for (const name of own) box.append(this.table({ ...table, name: `${table.name}.${name}` }, design, open));
    const id = `new-${table.name}`;
    const input = element("input", { id, type: "text", maxLength: LONGEST, placeholder: "e.g. my glass" });
    const add = element("button", { type: "button", textContent: "add" });
    const begin = () => {
      const name = input.value.trim();
      const path = `${table.name}.${name}`;
      if (own.includes(name)) document.getElementById(idOf("table", path)).scrollIntoView(); // it is there
      else if (name) this.tabled({ ...table, name: path }, true);
      else input.focus();
    };
    add.addEventListener("click", begin);
    input.addEventListener("keydown", (event) => { if (event.key === "Enter") begin(); });
    box.append(element("div", { className: "field" }, element("label", { htmlFor: id, textContent: "one more, by name" }), input, add));
    return box;
  }

  table(table, design, open) {
    const given = design.table(table.name);
    const used = given !== undefined || table.needed;
    const box = element("details", { id: idOf("table", table.name) });
    const roomy = matchMedia("(min-width: 60rem)").matches; // on a telephone the tables begin closed
    box.open = open.size ? open.has(box.id) : roomy && used && !["numerics", "publication"].includes(table.name);
    box.append(table.named
      ? element("summary", { textContent: table.name.slice(table.name.indexOf(".") + 1) })
      : element("summary", {}, sentence(table.label), hint(`[${table.name}]`)));
    if (table.help && !table.named) box.append(element("p", { className: "about", textContent: table.help }));
    if (table.named) {
      const remove = element("button", { type: "button", textContent: "remove", id: idOf("remove", table.name) });
      remove.addEventListener("click", () => this.tabled(table, false));
      box.append(element("p", { className: "about" }, remove));
    } else if (!table.needed) {
      const use = element("input", { type: "checkbox", checked: given !== undefined, id: idOf("use", table.name) });
      use.addEventListener("change", () => this.tabled(table, use.checked));
      box.append(element("label", { className: "use" }, use, " in this case"));
    }
    const wrong = element("div", { className: "wrong", hidden: true });
    box.append(wrong);
    this.boxes.set(table.name, { box, wrong });
    if (!used) return box;
    const [shown, more] = [[], []];
    for (const key of table.keys) {
      const value = given?.[key.key];
      (value !== undefined || key.needed ? shown : more).push(this.field(table, key, value, given));
    }
    box.append(...shown);
    if (more.length) {
      const rest = element("details", { id: idOf("more", table.name) }, element("summary", { textContent: "more keys" }), ...more);
      rest.open = open.has(rest.id);
      box.append(rest);
    }
    return box;
  }

  field(table, key, value, given) {
    const path = `${table.name}.${key.key}`;
    const id = `${idOf("field", table.name)}-${key.key}`;
    const input = this.input(key, id, value);
    const label = element("label", { htmlFor: id, textContent: sentence(key.label), title: key.help });
    const wrong = element("div", { className: "wrong", id: `${id}-wrong`, hidden: true });
    const alone = key.beside && value === undefined && given?.[key.beside] === undefined;
    input.disabled = Boolean(alone);
    const about = [path, key.span, alone ? `only with ${key.beside}` : ""].filter(Boolean).join(", ");
    const box = element("div", { className: "field" }, element("div", {}, label, hint(about)), input);
    const field = { box, input, wrong, slider: null };
    input.addEventListener("change", () => {
      this.tell(table, key, field, performance.now());
      if (field.slider) this.fit(field, key);
    });
    if (key.slider && !alone && !["numerics", "publication"].includes(table.name) && key.kind !== "whole") this.slide(table, key, field);
    box.append(wrong);
    this.fields.set(path, field);
    return box;
  }

  input(key, id, value) {
    const described = { id, title: key.help };
    if (key.kind === "choice" || key.kind === "switch") {
      const choices = key.kind === "switch" ? ["true", "false"] : key.choices;
      const select = element("select", described);
      if (!key.needed) select.append(element("option", { value: "", textContent: key.default === null ? "–" : `– (${key.default})` }));
      select.append(...choices.map((choice) => element("option", { value: choice, textContent: choice })));
      select.value = value === undefined ? "" : String(value);
      return select;
    }
    const shown = value === undefined ? "" : Array.isArray(value) ? value.join(", ") : String(value);
    const example = Array.isArray(key.example) ? key.example.join(", ") : String(key.example ?? "");
    const input = element("input", { ...described, type: "text", value: shown, placeholder: String(key.default ?? `e.g. ${example}`) });
    if (key.among.length) {
      const list = element("datalist", { id: `${id}-list` }, ...[...(key.key === "material" ? this.own : []), ...key.among].map((one) => element("option", { value: one })));
      document.getElementById(list.id)?.remove();
      document.body.append(list);
      input.setAttribute("list", list.id);
    }
    return input;
  }

  slide(table, key, field) {
    const slider = element("input", { type: "range", min: 0, max: STEPS, step: 1, id: `${field.input.id}-slider` });
    const whose = table.named ? ` of ${table.name.slice(table.name.indexOf(".") + 1)}` : "";
    slider.setAttribute("aria-label", sentence(key.label) + whose);
    field.slider = slider;
    field.box.append(slider);
    this.fit(field, key);
    slider.addEventListener("input", () => {
      const since = performance.now();
      const value = short(field.span.value(slider.value / STEPS), 4);
      field.input.value = field.span.unit ? `${value} ${field.span.unit}` : value;
      slider.setAttribute("aria-valuetext", field.input.value);
      this.tell(table, key, field, since);
    });
  }

  // The slider's span about what the field holds; no slider for what is no number above 0.
  fit(field, key) {
    const { slider, input } = field;
    const given = parted(input.value || key.default || key.example); // unset, it starts there
    field.span = given && span(key.slider, ...given);
    slider.hidden = !field.span;
    if (!field.span) return;
    slider.value = Math.round(STEPS * field.span.share(given[0]));
    slider.setAttribute("aria-valuetext", input.value);
  }

  tell(table, key, field, since) {
    const value = valueOf(key, field.input.value);
    if (key.kind === "choice") this.chosen(table.name, key.key, value);
    else this.changed(table.name, key.key, value, since);
  }

  // Say at every field, and every table, what is wrong with it; `mend(remedy)` does what mends it.
  refuse({ refusal, touched }, mend) {
    for (const { input, wrong } of [...this.fields.values(), ...this.boxes.values(), this.rest]) {
      wrong.hidden = true;
      wrong.replaceChildren();
      input?.removeAttribute("aria-invalid");
      input?.removeAttribute("aria-describedby");
    }
    if (!refusal) return;
    const { problems } = refusal;
    const remedies = refusal.remedies ?? [];
    const buttons = (key) => remedies.filter((one) => one.at === key).map((one) => {
      const button = element("button", { type: "button", textContent: this.remedy(one) });
      button.addEventListener("click", () => mend(one));
      return button;
    });
    for (const { key, message } of problems) this.mark(key, plain(key, message), buttons(key));
    // What was just chosen and is not itself at fault says what it does not go with.
    const [{ key, message }] = problems;
    if (touched && key && !problems.some((one) => one.key === touched || one.key?.startsWith(`${touched}.`))) {
      this.mark(touched, `Does not go with ${this.name(key)}: ${plain(key, message)}`, buttons(key));
    }
  }

  // The field, or the table, of a key.
  at(key) {
    return this.fields.get(key) ?? this.boxes.get(key) ?? this.boxes.get(key?.split(".")[0]) ?? this.rest;
  }

  mark(key, words, buttons) {
    const place = this.at(key);
    if (place.input && !place.wrong.hidden) return; // of two problems of a field the first
    place.wrong.append(element("div", {}, words, ...buttons));
    place.wrong.hidden = false;
    place.input?.setAttribute("aria-invalid", "true");
    place.input?.setAttribute("aria-describedby", place.wrong.id);
    opened(place.box);
  }

  // Show the field, or the table, of a key, and have the keyboard there.
  reveal(key) {
    const place = this.at(key);
    if (!place.box) return;
    opened(place.box);
    place.box.scrollIntoView({ block: "center" });
    (place.input ?? place.box.querySelector("input, summary")).focus({ preventScroll: true });
  }

  // A key, or a table, in words.
  name(path) {
    const [outer, ...rest] = path.split(".");
    const table = this.tables.find((one) => one.name === outer);
    const key = table?.keys.find((one) => one.key === rest.at(-1));
    return key?.label ?? table?.label ?? path;
  }

  remedy({ key, value }) {
    return value === null ? `Take ${this.name(key)} out` : `Set ${this.name(key)} to ${value}`;
  }
}

function opened(box) {
  for (let around = box; around; around = around.parentElement) if (around.tagName === "DETAILS") around.open = true;
}

// A message without the key that it stands beside.
export const plain = (key, message) => (key && message.startsWith(`${key}: `) ? message.slice(key.length + 2) : message);

function valueOf(key, text) {
  if (text.trim() === "") return undefined;
  if (key.kind === "switch") return text === "true";
  if (key.kind === "list") return text.split(",").map((one) => one.trim()).filter(Boolean);
  const percent = /^\s*([\d.]+)\s*%\s*$/.exec(text);
  if (key.kind === "number" && percent) return Number((Number(percent[1]) / 100).toPrecision(12));
  const number = Number(text);
  if (["number", "whole", "name or number"].includes(key.kind) && Number.isFinite(number)) return number;
  return text;
}

// How a slider's share, 0 to 1, and a value belong together; null where it cannot slide.
function span(spec, value, unit) {
  if (spec.scale === "linear" && unit === spec.unit) {
    const edge = 0.005 * (spec.high - spec.low); // the ends are other kinds of case: dry, saturated
    return linear(spec.low + edge, spec.high - edge, unit);
  }
  if (!(value > 0)) return null;
  const low = Math.max(value / FACTOR, spec.low ?? 0);
  const high = Math.min(value * FACTOR, spec.high ?? Infinity);
  if (spec.scale === "linear") return linear(0.5 * value, 1.5 * value, unit);
  const decades = Math.log(high / low);
  return { unit, value: (share) => low * Math.exp(share * decades), share: (one) => clip(Math.log(one / low) / decades) };
}

const linear = (low, high, unit) => ({
  unit, value: (share) => low + share * (high - low), share: (one) => clip((one - low) / (high - low)),
});

const clip = (share) => Math.min(Math.max(share, 0), 1);

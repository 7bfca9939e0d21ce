// The designs on the page: their cases, their answers, and the one newest question of each.

import { explored, posting, unpacked } from "/static/server.js";

const PATIENT = 600; // ms that a running question may take before a newer one replaces it
const CALM = 400; // ms after an answer until its critical velocity is asked for
const page = Math.random().toString(36).slice(2);

export class Design {
  // `source`: what its user calls the case that it began with: a built-in one, or a file.
  constructor(letter, name, tables, surfaces = {}, source = name) {
    this.letter = letter;
    this.name = name;
    this.source = source;
    this.base = canonical(tables); // the case that it began with; null where that is not known
    this.linked = false; // whether it came by a link
    this.touched = ""; // the table or the key that was chosen last
    this.kept = {}; // tables that were taken away, as they were
    this.filled = {}; // by a table or key that was chosen, what it asked for: [path, key, value]
    this.completing = 0; // choices whose consequences are asked for
    this.tables = tables;
    this.surfaces = surfaces;
    this.answer = null;
    this.refusal = null;
    this.work = null; // {fraction, text} while it is computed
    this.asked = 0; // number of the newest question
    this.shown = 0; // number of the question that the answer belongs to
    this.running = null;
    this.sought = null; // {begun, abort} while the critical velocity is computed
    this.waiting = false;
  }

  get changed() {
    return canonical(this.tables) !== this.base;
  }

  // Whether what is shown is of an older case, and nothing newer is coming.
  get stale() {
    return Boolean(this.refusal) || (!this.running && this.shown < this.asked);
  }

  question() {
    return { case: this.tables, name: this.name, asker: `${page}-${this.letter}`, surfaces: this.surfaces };
  }

  // A table by its path: a name, or that of a table within it, "materials.my.steel".
  table(path) {
    const [outer, inner] = split(path);
    return inner === undefined ? this.tables[outer] : this.tables[outer]?.[inner];
  }

  get(path, key) {
    return this.table(path)?.[key];
  }

  set(path, key, value) {
    this.put(path, withKey(this.table(path), key, value));
  }

  // Have a table, or none: undefined.
  put(path, table) {
    const [outer, inner] = split(path);
    const whole = inner === undefined ? table : withKey(this.tables[outer], inner, table);
    const empty = inner !== undefined && !Object.keys(whole).length;
    this.tables = withKey(this.tables, outer, empty ? undefined : whole);
  }

  // Take a table away, with what was filled in for it alone.
  remove(path) {
    this.kept[path] = this.table(path);
    for (const [table, key, value] of this.filled[path] ?? []) if (this.get(table, key) === value) this.set(table, key, undefined);
    this.filled[path] = [];
    this.put(path, undefined);
  }

  // Fill in what a choice asks for, at the values of the schema's examples; the keys that were.
  async complete(before) {
    const after = this.tables;
    this.completing += 1;
    try {
      const { tables } = await posting("/api/complete", JSON.stringify({ case: after, before }));
      if (this.tables !== after) return []; // something newer was chosen
      this.tables = tables;
      return differing(after, tables);
    } finally {
      this.completing -= 1;
    }
  }

  // Ask what would mend a case that is refused.
  async mend() {
    const { refusal, tables } = this;
    if (refusal?.kind !== "input" || refusal.remedies) return;
    refusal.remedies = [];
    refusal.remedies = (await posting("/api/complete", JSON.stringify({ case: tables, before: tables }))).remedies;
  }

  // Ask for the case as it is now; `show()` is called when anything changes.
  ask(show, since = performance.now()) {
    this.asked += 1;
    this.since = since;
    this.leave();
    if (this.running && performance.now() - this.running.begun < PATIENT) {
      this.waiting = true; // the newest goes when this one is through
      return;
    }
    this.running?.abort.abort();
    this.send(show);
  }

  async send(show) {
    const number = this.asked;
    const mine = { abort: new AbortController(), begun: performance.now(), since: this.since };
    this.running = mine;
    this.waiting = false;
    this.work = { fraction: 0, text: "asking" };
    show("work");
    // A question that grew old while it waits goes, so that the newest is not kept waiting.
    const impatient = setInterval(() => {
      if (this.waiting && performance.now() - mine.begun > PATIENT) mine.abort.abort();
    }, 100);
    try {
      const answer = await explored(this.question(), mine.abort.signal, (fraction, text) => {
        if (this.running === mine) {
          this.work = { fraction, text };
          show("work");
        }
      });
      if (answer && number > this.shown) this.take(answer, number, mine.since);
    } catch (error) {
      if (error.name !== "AbortError" && number > this.shown) {
        this.refusal = error;
        this.shown = number;
      }
    } finally {
      clearInterval(impatient);
      if (this.running === mine) {
        this.running = null;
        this.work = null;
        if (this.waiting) this.send(show);
        else if (!mine.abort.signal.aborted) this.seek(show);
        show("answer");
      }
    }
  }

  // What takes longer than the rest, once nothing newer was asked for a while.
  seek(show) {
    clearTimeout(this.seeking);
    this.seeking = setTimeout(async () => {
      const { answer } = this;
      if (!answer || this.refusal || this.running) return;
      const sought = this.sought = { begun: performance.now(), abort: new AbortController() };
      show("work");
      let found;
      try {
        found = await posting("/api/critical", JSON.stringify(this.question()), undefined, sought.abort.signal);
      } catch (error) {
        found = { critical_velocity: null, critical_velocity_note: error.message };
      }
      if (this.sought !== sought) return; // left
      this.sought = null;
      Object.assign(answer.measures, found);
      show("measures");
    }, CALM);
  }

  take(answer, number, since) {
    const { motion, curve, capture } = answer;
    for (const key of ["time", "separation", "central_separation", "speed"]) motion[key] = unpacked(motion[key]);
    for (const part of [motion.forces, motion.energies]) for (const key in part) part[key] = unpacked(part[key]);
    for (const key of ["separation", "loading", "unloading"]) curve[key] = unpacked(curve[key]);
    if (capture) for (const key of ["speed", "share", "low", "high", "lowest", "median", "highest"]) capture[key] = unpacked(capture[key]);
    this.answer = answer;
    this.refusal = null;
    this.shown = number;
    this.answeredSince = since;
  }

  // Seek the critical velocity of the case before no longer.
  leave() {
    clearTimeout(this.seeking);
    this.sought?.abort.abort();
    this.sought = null;
    const measures = this.answer?.measures;
    if (measures && measures.critical_velocity === undefined) Object.assign(measures, { critical_velocity: null, critical_velocity_note: "not sought" });
  }

  cancel() {
    this.waiting = false;
    this.running?.abort.abort();
    this.leave();
  }

  copy(letter) {
    const made = new Design(letter, this.name, structuredClone(this.tables), { ...this.surfaces }, this.source);
    return Object.assign(made, { base: this.base, linked: this.linked });
  }

  toJSON() {
    return { name: this.name, source: this.source, changed: this.changed, tables: this.tables, surfaces: this.surfaces };
  }
}

// A case as text that is the same for the same case, in whatever order its keys stand.
export function canonical(value) {
  if (Array.isArray(value)) return `[${value.map(canonical).join()}]`;
  if (value === null || typeof value !== "object") return JSON.stringify(value) ?? "";
  return `{${Object.keys(value).sort().map((key) => `${JSON.stringify(key)}:${canonical(value[key])}`).join()}}`;
}

// Dotted keys that the second tables have and the first have not.
function differing(before, after) {
  return Object.entries(after).flatMap(([table, keys]) => Object.keys(Object(keys))
    .filter((key) => before[table]?.[key] === undefined).map((key) => `${table}.${key}`));
}

function split(path) {
  const dot = path.indexOf(".");
  return dot < 0 ? [path] : [path.slice(0, dot), path.slice(dot + 1)];
}

function withKey(table, key, value) {
  const { [key]: gone, ...rest } = table ?? {};
  return value === undefined ? rest : { ...(table ?? {}), [key]: value };
}

// The page's state as the part of a link behind "#", and back.
export function written(designs) {
  const bytes = new TextEncoder().encode(JSON.stringify(designs));
  let letters = "";
  for (const byte of bytes) letters += String.fromCharCode(byte);
  return btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

export function read(hash) {
  const letters = atob(hash.replaceAll("-", "+").replaceAll("_", "/"));
  const given = JSON.parse(new TextDecoder().decode(Uint8Array.from(letters, (one) => one.charCodeAt(0))));
  if (!Array.isArray(given) || !given.length || given.length > 2) throw new Error("no designs");
  return given.map(({ name, tables, surfaces, source, changed }, number) => {
    if (typeof name !== "string" || typeof tables !== "object" || tables === null) throw new Error("no design");
    Object.keys(tables.materials ?? {}).forEach(encodeURIComponent); // throws at half a character
    const made = new Design("AB"[number], name, tables, surfaces ?? {}, typeof source === "string" ? source : name);
    return Object.assign(made, { linked: true, base: changed ? null : made.base });
  });
}

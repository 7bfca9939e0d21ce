// The designs on the page: their cases, their answers, and the one newest question of each.

import { explored, posting, unpacked } from "/static/server.js";

const PATIENT = 600; // ms that a running question may take before a newer one replaces it
const CALM = 400; // ms after an answer until its critical velocity is asked for
const page = Math.random().toString(36).slice(2);

export class Design {
  constructor(letter, name, tables, surfaces = {}) {
    this.letter = letter;
    this.name = name;
    this.tables = tables;
    this.surfaces = surfaces;
    this.answer = null;
    this.refusal = null;
    this.work = null; // {fraction, text} while it is computed
    this.asked = 0; // number of the newest question
    this.shown = 0; // number of the question that the answer belongs to
    this.running = null;
    this.waiting = false;
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

  // Ask for the case as it is now; `show()` is called when anything changes.
  ask(show, since = performance.now()) {
    this.asked += 1;
    this.since = since;
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
        else this.seek(show);
        show("answer");
      }
    }
  }

  // What takes longer than the rest, once nothing newer was asked for a while.
  seek(show) {
    clearTimeout(this.seeking);
    this.seeking = setTimeout(async () => {
      const { answer, shown } = this;
      if (!answer || this.running) return;
      let found;
      try {
        found = await posting("/api/critical", JSON.stringify(this.question()));
      } catch (error) {
        found = { critical_velocity: null, critical_velocity_note: error.message };
      }
      if (this.shown !== shown || this.answer !== answer) return;
      Object.assign(answer.measures, found);
      show("measures");
    }, CALM);
  }

  take(answer, number, since) {
    const { motion, curve } = answer;
    for (const key of ["time", "separation", "central_separation", "speed"]) motion[key] = unpacked(motion[key]);
    for (const part of [motion.forces, motion.energies]) for (const key in part) part[key] = unpacked(part[key]);
    for (const key of ["separation", "approach", "parting"]) curve[key] = unpacked(curve[key]);
    this.answer = answer;
    this.refusal = null;
    this.shown = number;
    this.answeredSince = since;
  }

  cancel() {
    this.waiting = false;
    clearTimeout(this.seeking);
    this.running?.abort.abort();
  }

  copy(letter) {
    return new Design(letter, this.name, structuredClone(this.tables), { ...this.surfaces });
  }

  toJSON() {
    return { name: this.name, tables: this.tables, surfaces: this.surfaces };
  }
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
  return given.map(({ name, tables, surfaces }, number) => {
    if (typeof name !== "string" || typeof tables !== "object" || tables === null) throw new Error("no design");
    Object.keys(tables.materials ?? {}).forEach(encodeURIComponent); // throws at half a character
    return new Design("AB"[number], name, tables, surfaces ?? {});
  });
}

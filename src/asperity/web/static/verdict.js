// The top of the page: verdicts, what is refused, warnings, and what is waited for.

import { plain } from "/static/form.js";

const SLOW = 400; // ms until a computation dims what is old, and says what it does
const FEW = 2; // warnings that are shown before the rest is asked for
const MOST = 3; // problems that are told at the top; the fields tell of all

const WAITS = [
  [/^asking/, "Asking the program"],
  [/^loading/, "Loading the program, once after its start"],
  [/^tracing/, "Preparing these models for the first time: some seconds"],
  [/^compilation of (.*)/, "Compiling for the first time with these models: "],
  [/^compilation/, "Compiling for the first time with these models: some seconds"],
  [/^force curves/, "Computing the force curves"],
  [/^impact (\d+)/, "Computing the motion, impact "],
  [/^(motion|first impact)/, "Computing the motion"],
  [/^unloading/, "Computing the unloading"],
  [/^measures/, "Computing the measures"],
];

const by = (id) => document.getElementById(id);
const made = (tag, words, properties = {}) => Object.assign(document.createElement(tag), { textContent: words, ...properties });

export class Top {
  // `reveal(design, key)`: show the field of a key.
  constructor(reveal) {
    this.reveal = reveal;
    this.told = "";
    this.all = false; // whether all warnings are shown
    by("more-warnings").addEventListener("click", () => {
      this.all = !this.all;
      this.fold();
    });
  }

  show(designs) {
    const two = designs.length > 1;
    const lines = designs.flatMap((design) => {
      const who = two ? `${design.letter}: ` : "";
      const said = design.answer ? [[`${who}${design.answer.verdict}`, design.stale ? "said stale" : "said", design, null]] : [];
      return [...said, ...refused(design).map(([words, key]) => [who + words, "wrong", design, key])];
    });
    const now = JSON.stringify(lines.map(([words, kind]) => [words, kind]));
    if (now !== this.told) by("verdicts").replaceChildren(...lines.map((one) => this.line(...one)));
    this.told = now;
    this.warnings(designs.filter((one) => one.answer), two);
  }

  line(words, kind, design, key) {
    const line = made("p", words, { className: kind });
    line.dataset.letter = design.letter;
    if (key) {
      const button = made("button", "show", { type: "button", className: "show" });
      button.setAttribute("aria-label", `Show ${key}`);
      button.addEventListener("click", () => this.reveal(design, key));
      line.append(" ", button);
    }
    return line;
  }

  // Every warning once, with the designs that it holds for.
  warnings(answered, two) {
    by("warnings").hidden = !answered.length;
    const whose = new Map();
    for (const { answer, letter } of answered) for (const one of answer.warnings) whose.set(one, [...(whose.get(one) ?? []), letter]);
    const lines = [...whose].map(([one, letters]) => (two ? `${letters.join(", ")}: ${one}` : one));
    by("warnings-title").textContent = lines.length ? `${lines.length} warning${lines.length > 1 ? "s" : ""}: know before believing it` : "";
    by("warning-list").replaceChildren(...(lines.length ? lines : ["No warnings: the models hold here."]).map((one) => made("li", one)));
    by("warnings").classList.toggle("none", !lines.length);
    by("warnings").classList.toggle("stale", answered.some((one) => one.stale));
    this.fold();
  }

  fold() {
    const lines = [...by("warning-list").children];
    const hidden = lines.length > FEW + 1 ? lines.slice(FEW) : []; // one alone is shown, not folded
    for (const one of hidden) one.hidden = !this.all;
    const button = by("more-warnings");
    button.hidden = !hidden.length;
    button.textContent = this.all ? "fewer" : `${hidden.length} more`;
    button.setAttribute("aria-expanded", String(this.all));
  }

  // Say what is computed, and dim what is older than it; whether anything is waited for.
  work(designs) {
    const slow = ({ begun }) => performance.now() - begun > SLOW;
    const busy = designs.filter((one) => one.work || one.completing);
    const waits = busy.filter((one) => one.running && slow(one.running));
    const seeks = designs.filter((one) => one.sought && slow(one.sought));
    by("work").hidden = !waits.length && !seeks.length;
    const { body } = document;
    if (waits.length) body.dataset.waiting = waits.map((one) => one.letter).join(" ");
    else delete body.dataset.waiting;
    if (body.dataset.busy !== (busy.length ? "yes" : "no")) body.dataset.busy = busy.length ? "yes" : "no";
    if (waits.length) {
      by("progress").value = waits[0].work?.fraction ?? 0;
      by("progress-text").textContent = `${wait(waits[0].work?.text ?? "")} …`;
    } else if (seeks.length) {
      by("progress").removeAttribute("value");
      by("progress-text").textContent = "Seeking the critical velocity; all else is there …";
    }
    return busy.length > 0 || designs.some((one) => one.sought);
  }
}

// What is refused of a design, as [words, key]: the first few, and how many more.
function refused({ refusal }) {
  if (!refusal) return [];
  const lines = refusal.problems.slice(0, MOST).map(({ key, message }) => [key ? `${key}: ${plain(key, message)}` : message, key]);
  const more = refusal.problems.length - lines.length;
  return more > 0 ? [...lines, [`and ${more} more, marked in the form`, null]] : lines;
}

// What is waited for, in words, by what the solver tells of its progress.
export function wait(text) {
  for (const [pattern, words] of WAITS) {
    const found = pattern.exec(text);
    if (found) return words.endsWith(" ") ? words + found[1] : words;
  }
  return text;
}

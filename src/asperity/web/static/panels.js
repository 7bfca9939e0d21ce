// What shows answers: charts, ledger, measures.

import { Chart, tint } from "/static/charts.js";
import { amount, shares } from "/static/units.js";

const MEASURES = [
  ["impact speed", (a) => amount(a.measures.impact_speed, "m/s")],
  ["first restitution", (a) => amount(a.measures.restitution[0])],
  ["captured at first impact", (a) => (a.measures.captured ? "yes" : "no")],
  ["critical velocity", critical],
  ["contact time", (a) => amount(a.measures.contact_time, "s")],
  ["largest force", (a) => amount(a.measures.maximum_force, "N")],
  ["pull-off force", (a) => amount(a.measures.pull_off, "N") + preload(a)],
  ["work of separation", (a) => amount(a.measures.work_of_separation, "J") + preload(a)],
  ["asperities that carry the load", (a) => amount(a.regime.loaded_asperities)],
  ["impacts", (a) => amount(a.motion.impacts)],
  ["time to capture", (a) => amount(a.measures.capture_time, "s")],
  ["time to rest", (a) => amount(a.measures.time_to_rest, "s")],
  ["loss in and out", (a) => amount(a.curve.loss, "J")],
  ["energy at release", (a) => amount(a.ledger.initial, "J")],
  ["balance closes to", (a) => `${(a.ledger.energy_balance_error ?? NaN).toExponential(1)} of the impact energy or of that lost`],
  ["adhesion law", (a) => a.regime.adhesion_law ?? "–"],
  ["liquid", (a) => a.regime.liquid_regime ?? "–"],
];

const text = (tag, words, properties = {}) => Object.assign(document.createElement(tag), { textContent: words, ...properties });

// The critical velocity, or why there is none; it is asked for after the rest.
function critical({ measures }) {
  if (measures.critical_velocity === undefined) return "being sought";
  if (measures.critical_velocity === null) return measures.critical_velocity_note;
  const note = measures.critical_velocity_note ? ` (${measures.critical_velocity_note})` : "";
  return amount(measures.critical_velocity, "m/s") + note;
}

// The load that pull-off and work depend on.
function preload({ measures }) {
  return measures.preload === null ? "" : ` after ${amount(measures.preload, "N")}`;
}

export class Panels {
  constructor() {
    this.charts = Object.fromEntries(["motion", "curve", "forces", "energy", "rebounds", "capture"].map((id) => [id, new Chart(id)]));
    this.whole = false; // whether forces are shown over the whole motion
    this.button = text("button", "whole motion", { type: "button" });
    this.button.setAttribute("aria-pressed", "false");
    document.querySelector("#forces figcaption").append(this.button);
  }

  restyle() {
    Object.values(this.charts).forEach((chart) => chart.restyle());
  }

  show(designs) {
    const answered = designs.filter((one) => one.answer);
    if (!answered.length) return;
    const two = answered.length > 1;
    const named = (label, design) => (two ? `${design.letter} ${label}` : label);
    const group = (design, x, series) => ({
      x, lines: series.map(([label, y, colour]) => ({ label: named(label, design), y, colour, dashed: design.letter === "B" })),
    });
    captions(answered);
    this.motion(answered, group);
    this.forces(answered, group);
    this.energies(answered, group);
    this.curve(answered, group);
    this.rebounds(answered, group);
    this.capture(answered.filter((one) => one.answer.capture), group);
    ledger(answered, two);
    measures(answered, two);
    document.querySelectorAll("#panels figure, #ledger, #numbers").forEach((one) => one.classList.toggle("stale", designs.some((d) => d.stale)));
  }

  measured(designs) {
    const answered = designs.filter((one) => one.answer);
    measures(answered, answered.length > 1);
  }

  motion(answered, group) {
    const told = answered.map(({ answer, letter }) => `${letter}: ${answer.motion.drawn} of ${answer.motion.impacts} impacts drawn`);
    this.charts.motion.show({
      groups: answered.map((d) => group(d, d.answer.motion.time, [["separation", d.answer.motion.separation, "#0072B2"]])),
      axes: { x: ["time", "s"], y: ["separation", "m"] }, spoken: told.join("; "),
    });
  }

  forces(answered, group) {
    const windows = answered.map((d) => d.answer.motion.first_contact);
    const range = this.whole ? null : [Math.min(...windows.map((w) => w[0])), Math.max(...windows.map((w) => w[1]))];
    document.querySelector("#forces .name").textContent = this.whole ? "Forces" : "Forces, first contact";
    this.charts.forces.show({
      groups: answered.map((d) => group(d, d.answer.motion.time, colours(d, d.answer.motion.forces, ["total"]))),
      axes: { x: ["time", "s"], y: ["force", "N"] }, range, spoken: "Positive forces push the body away.",
    });
  }

  energies(answered, group) {
    this.charts.energy.show({
      groups: answered.map((d) => group(d, d.answer.motion.time, colours(d, d.answer.motion.energies))),
      axes: { x: ["time", "s"], y: ["energy", "J"] }, spoken: "Kinetic, potential, stored, and lost by mechanism.",
    });
  }

  curve(answered, group) {
    const told = answered.map(({ answer, letter }) => `${letter}: pull-off ${amount(answer.curve.pull_off, "N")}, loss ${amount(answer.curve.loss, "J")}`);
    this.charts.curve.show({
      groups: answered.map((d) => group(d, d.answer.curve.separation, [
        ["loading", d.answer.curve.loading, "#0072B2"], ["unloading", d.answer.curve.unloading, "#D55E00"],
      ])),
      axes: { x: ["rigid separation", "m"], y: ["force", "N"] }, spoken: told.join("; "),
    });
  }

  // The share of single bodies, where a case has them.
  capture(placed, group) {
    this.charts.capture.figure.hidden = !placed.length;
    if (!placed.length) return;
    const told = placed.map(({ answer, letter }) => `${letter}: ${answer.capture.bodies} bodies at each speed`);
    this.charts.capture.show({
      groups: placed.map((d) => group(d, d.answer.capture.speed, [
        ["captured share", d.answer.capture.share, "#0072B2"],
        ["lower bound (95 %)", d.answer.capture.low, "#E69F00"], ["upper bound (95 %)", d.answer.capture.high, "#E69F00"],
      ])),
      axes: { x: ["speed", "m/s"], y: ["captured share", ""] }, points: true, spoken: told.join("; "),
    });
  }

  rebounds(answered, group) {
    this.charts.rebounds.show({
      groups: answered.map((d) => {
        const heights = d.answer.measures.rebound_height.map((one) => one ?? NaN);
        return group(d, heights.map((_, number) => number + 1), [["height", heights, "#E69F00"]]);
      }),
      axes: { x: ["impact", ""], y: ["rebound height", "m"] }, points: true, spoken: "Above static equilibrium.",
    });
  }
}

// Say where not all impacts are drawn.
function captions(answered) {
  const told = answered.filter(({ answer: { motion } }) => motion.drawn < motion.impacts)
    .map(({ answer: { motion } }) => `${motion.drawn} of ${motion.impacts}`);
  const words = told.length ? `first ${[...new Set(told)].join("; ")} impacts` : "";
  document.querySelectorAll(".drawn").forEach((one) => { one.textContent = words; });
}

// Series of a part of the answer; a force that is nothing throughout is left out.
function colours(design, part, without = []) {
  return Object.entries(part)
    .filter(([name, values]) => !without.includes(name) && values.some((value) => value !== 0))
    .map(([name, values]) => [name.replace("lost_", "lost to ").replaceAll("_", " "), values, design.answer.colours[name]]);
}

function ledger(answered, two) {
  document.getElementById("bars").replaceChildren(...answered.flatMap(({ answer, letter }) => {
    const { initial, lost } = answer.ledger;
    const parts = Object.entries(lost).map(([name, energy]) => [`lost to ${name}`, energy, tint(answer.colours[`lost_${name}`])]);
    const gone = parts.reduce((sum, [, energy]) => sum + energy, 0);
    const whole = Math.max(initial, gone);
    if (gone <= initial) parts.push(["kept", initial - gone, "transparent"]);
    const told = shares(Object.values(lost));
    const bar = text("div", "", { className: "bar" });
    bar.setAttribute("aria-hidden", "true");
    const list = document.createElement("ul");
    for (const [number, [name, energy, colour]] of parts.entries()) {
      const share = text("span", "");
      share.style.width = `${whole > 0 ? (100 * energy) / whole : 0}%`;
      share.style.background = colour;
      bar.append(share);
      const mark = document.createElement("i");
      mark.style.background = colour;
      const item = document.createElement("li");
      const about = number < told.length && energy > 0 ? ` (${told[number]} of the energy lost)` : "";
      item.append(mark, `${name}: ${amount(energy, "J")}${about}`);
      list.append(item);
    }
    const source = `whole bar: ${amount(initial, "J")} at the release`;
    const bound = gone > initial ? ` and ${amount(gone - initial, "J")} that attraction gave in the end` : "";
    list.append(text("li", source + bound));
    return [...(two ? [text("strong", letter)] : []), bar, list];
  }));
}

function measures(answered, two) {
  const rows = MEASURES.map(([name, of]) => {
    const row = document.createElement("tr");
    row.append(text("th", name, { scope: "row" }), ...answered.map(({ answer }) => text("td", of(answer))));
    return row;
  });
  const head = document.createElement("tr");
  head.append(text("td", ""), ...answered.map(({ letter, answer }) => text("th", `${letter}: ${answer.name}`, { scope: "col" })));
  const [top, body] = ["thead", "tbody"].map((tag) => document.createElement(tag));
  if (two) top.append(head);
  body.append(...rows);
  document.getElementById("measures").replaceChildren(...(two ? [top] : []), body);
}

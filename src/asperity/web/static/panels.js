// What shows answers: charts, ledger, measures.

import { Chart, tint } from "/static/charts.js";
import { amount, shares } from "/static/units.js";

const MEASURES = [
  ["impact speed", (a) => amount(a.measures.impact_speed, "m/s")],
  ["first restitution", (a) => amount(a.measures.restitution[0])],
  ["captured at first impact", (a) => (a.measures.captured ? "yes" : "no")],
  ["critical velocity", critical],
  ["half of single bodies are captured at", half],
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

const BODIES = "#CC79A7"; // single bodies, as in the pictures of the program

const text = (tag, words, properties = {}) => Object.assign(document.createElement(tag), { textContent: words, ...properties });

// The critical velocity, or why there is none; it is asked for after the rest.
function critical({ measures }) {
  if (measures.critical_velocity === undefined) return "being sought";
  if (measures.critical_velocity === null) return measures.critical_velocity_note;
  const note = measures.critical_velocity_note ? ` (${measures.critical_velocity_note})` : "";
  return amount(measures.critical_velocity, "m/s") + note;
}

// The speed at which half of single bodies are captured; null where the case has none.
function half({ capture }) {
  if (!capture) return null;
  const { half_velocity, half_interval: [low, high], speed, bodies } = capture;
  const words = (value, beyond = "") => (value === null ? beyond : amount(value, "m/s"));
  if (half_velocity === null) return `no speed that was tried, ${words(speed[0])} to ${words(speed.at(-1))}`;
  const interval = `${words(low, "below those tried")} to ${words(high, "above those tried")}`;
  return `${words(half_velocity)} (95 % interval: ${interval}; ${bodies} bodies at each speed)`;
}

// The load that pull-off and work depend on.
function preload({ measures }) {
  return measures.preload === null ? "" : ` after ${amount(measures.preload, "N")}`;
}

export class Panels {
  constructor() {
    this.charts = Object.fromEntries(["motion", "curve", "forces", "energy", "rebounds", "capture", "restitution"].map((id) => [id, new Chart(id)]));
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
      x, lines: series.map(([label, y, colour, band]) => ({ label: named(label, design), y, colour, band, dashed: design.letter === "B" })),
    });
    captions(answered);
    this.motion(answered, group);
    this.forces(answered, group);
    this.energies(answered, group);
    this.curve(answered, group);
    this.rebounds(answered, group);
    this.bodies(answered.filter((one) => one.answer.capture), group);
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

  // What single bodies do against speed, where a case has them.
  bodies(placed, group) {
    const { capture, restitution } = this.charts;
    for (const { figure } of [capture, restitution]) figure.hidden = !placed.length;
    if (!placed.length) return;
    const drawn = (chart, name, lines, spoken) => chart.show({
      groups: placed.flatMap((d) => lines(d.answer).filter(([x]) => x.length).map(([x, ...series]) => group(d, x, series))),
      axes: { x: ["speed", "m/s"], y: [name, ""] }, points: true,
      spoken: placed.map(({ answer, letter }) => `${letter}: ${spoken(answer)}`).join("; "),
    });
    drawn(capture, "captured share", ({ capture: { speed, share, low, high, half_velocity, half_interval } }) => {
      const bar = half_velocity === null ? [] : [half_interval[0], half_velocity, half_interval[1]].filter((one) => one !== null);
      return [
        [speed, ["captured share", share, BODIES], ["", low, BODIES, "lower"], ["95 % interval", high, BODIES, "upper"]],
        [bar, ["half are captured, 95 % interval", bar.map(() => 0.5), "#000000"]],
      ];
    }, (answer) => `half of the bodies are captured at ${half(answer)}`);
    drawn(restitution, "restitution", ({ measures, capture: { speed, lowest, median, highest } }) => [
      [speed, ["median", median, BODIES], ["", lowest, BODIES, "lower"], ["10 to 90 % of the bodies", highest, BODIES, "upper"]],
      [[measures.impact_speed], ["mean field, this case", [measures.restitution[0] ?? NaN], "#0072B2"]],
    ], ({ measures, capture: { bodies, lowest, median, highest } }) => {
      const [low, middle, high] = [lowest, median, highest].map((values) => amount(values[values.length >> 1]));
      return `${bodies} bodies at each speed; at ${amount(measures.impact_speed, "m/s")} 80 % of them have ${low} to ${high}, the median is ${middle}`;
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
  const rows = MEASURES.filter(([, of]) => answered.some(({ answer }) => of(answer) !== null)).map(([name, of]) => {
    const row = document.createElement("tr");
    row.append(text("th", name, { scope: "row" }), ...answered.map(({ answer }) => text("td", of(answer) ?? "–")));
    return row;
  });
  const head = document.createElement("tr");
  head.append(text("td", ""), ...answered.map(({ letter, answer }) => text("th", `${letter}: ${answer.name}`, { scope: "col" })));
  const [top, body] = ["thead", "tbody"].map((tag) => document.createElement(tag));
  if (two) top.append(head);
  body.append(...rows);
  document.getElementById("measures").replaceChildren(...(two ? [top] : []), body);
}

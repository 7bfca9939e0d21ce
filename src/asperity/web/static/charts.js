// Line charts: one look, axes with units, one design solid and the other dashed.

import { largest, scaled } from "/static/units.js";

const HEIGHT = 250;
const WIDEST = 1400;

export const ink = () => getComputedStyle(document.documentElement).getPropertyValue("--ink").trim();
const quiet = () => getComputedStyle(document.documentElement).getPropertyValue("--quiet").trim();
const line = () => getComputedStyle(document.documentElement).getPropertyValue("--line").trim();

// The house's colours where they are too pale, or too dark, for a screen's paper.
const LIGHT = { "#F0E442": "#857A00", "#56B4E9": "#2A86BD", "#E69F00": "#A66F00", "#CC79A7": "#B8558D", "#F5D0B5": "#A0522D", "#009E73": "#008060", "#C8C8C8": "#444444" };
const DARK = { "#7F3C8D": "#C58AD3", "#661100": "#D9826B", "#0072B2": "#4AA3DF", "#8C6D31": "#B8934B", "#A05195": "#C77BBB" };

// The colour of a thing on this page's paper: black is the colour of the ink.
export function tint(colour) {
  if (!colour || colour === "#000000") return ink();
  return (document.documentElement.dataset.theme === "dark" ? DARK : LIGHT)[colour] ?? colour;
}

// A band lets what lies behind it shine through.
const paint = (colour, band) => (band ? `${tint(colour)}55` : tint(colour));

export class Chart {
  constructor(id) {
    this.figure = document.getElementById(id);
    this.legend = Object.assign(document.createElement("div"), { className: "legend" });
    this.place = Object.assign(document.createElement("div"), { className: "plot" });
    this.place.setAttribute("role", "img");
    this.figure.append(this.legend, this.place);
    this.kind = "";
    new ResizeObserver(() => this.fit()).observe(this.figure);
  }

  fit() {
    const width = Math.min(this.figure.clientWidth - 16, WIDEST);
    if (this.plot && width > 0 && width !== this.plot.width) this.plot.setSize({ width, height: HEIGHT });
  }

  // Draw groups of lines {x, lines: [{label, y, colour, dashed, band}]}; axes {x: [name, unit], y: [name, unit]}.
  // A line whose band is "upper" has it down to the line before it, whose band is "lower".
  show({ groups, axes, range, logarithmic = false, points = false, spoken }) {
    const lines = groups.flatMap((group) => group.lines);
    const [acrossBy, acrossUnit] = axes.x[1] ? scaled(largest(range ? [range] : groups.map((g) => g.x)), axes.x[1]) : [1, ""];
    const [upBy, upUnit] = axes.y[1] ? scaled(largest(lines.map((one) => one.y)), axes.y[1]) : [1, ""];
    const titles = [`${axes.x[0]}${acrossUnit && ` [${acrossUnit}]`}`, `${axes.y[0]} [${upUnit || "–"}]`];
    const tables = groups.map((g) => [shrunk(g.x, acrossBy), ...g.lines.map((one) => shrunk(one.y, upBy, logarithmic))]);
    const data = tables.length === 1 ? tables[0] : uPlot.join(tables);
    const kind = JSON.stringify([titles, logarithmic, points, lines.map((one) => [one.label, tint(one.colour), one.dashed])]);
    if (kind !== this.kind) this.build(kind, titles, lines, { logarithmic, points });
    this.plot.setData(data, false);
    this.plot.setScale("x", range ? { min: range[0] / acrossBy, max: range[1] / acrossBy } : ends(data[0]));
    this.place.setAttribute("aria-label", `${titles[1]} against ${titles[0]}. ${spoken}`);
  }

  build(kind, titles, lines, { logarithmic, points }) {
    this.kind = kind;
    this.plot?.destroy();
    const series = lines.map(({ label, colour, dashed, band }) => ({
      label, stroke: paint(colour, band), width: band ? 1 : 1.6, dash: dashed ? [7, 4] : undefined, spanGaps: true,
      points: { show: points && !band, size: 5, fill: tint(colour) },
    }));
    const options = {
      width: Math.max(this.figure.clientWidth - 16, 200), height: HEIGHT, legend: { show: false },
      scales: { x: { time: false }, y: logarithmic ? { distr: 3 } : {} },
      cursor: { drag: { x: true, y: false } },
      series: [{ label: titles[0] }, ...series],
      bands: lines.flatMap(({ colour, band }, at) => (band === "upper" ? [{ series: [at + 1, at], fill: paint(colour, band) }] : [])),
      axes: [axis(titles[0], 30), axis(titles[1], 62)],
    };
    this.plot = new uPlot(options, [[0], ...lines.map(() => [null])], this.place);
    const named = lines.filter(({ band }) => band !== "lower");
    this.legend.replaceChildren(...named.map(({ label, colour, dashed, band }) => chip(label, paint(colour, band), dashed)));
  }

  restyle() {
    this.kind = "";
  }
}

export function chip(label, colour, dashed) {
  const mark = document.createElement("i");
  mark.className = dashed ? "dashed" : "";
  mark.style.borderTopColor = colour;
  const box = document.createElement("span");
  box.append(mark, label);
  return box;
}

export function axis(label, size) {
  return {
    label, size, labelSize: 20, labelGap: 2, stroke: quiet(), font: "12px system-ui", labelFont: "13px system-ui",
    grid: { stroke: line(), width: 0.5 }, ticks: { stroke: line(), width: 0.5, size: 5 },
    values: (plot, ticks) => ticks.map((tick) => (tick === null ? "" : String(Number(tick.toPrecision(6))))),
  };
}

function shrunk(values, by, logarithmic = false) {
  return Float64Array.from(values, (value) => (logarithmic && !(value > 0) ? NaN : value / by));
}

// One point alone still has an axis.
function ends(values) {
  const [min, max] = [values[0], values[values.length - 1]];
  return max > min ? { min, max } : { min: min - 1, max: min + 1 };
}

// The adhesion map, with the designs on it.

import { axis, chip, ink, tint } from "/static/charts.js";
import { unpacked } from "/static/server.js";

const HEIGHT = 250;
const NAMES = { Bradley: [0.0045, 1.5], DMT: [0.033, 6], "Maugis-Dugdale": [0.55, 6], JKR: [22, 6], Hertz: [0.15, 2e4] };
const MARKS = ["#0072B2", "#D55E00"];

export class AdhesionMap {
  constructor(id, given) {
    this.figure = document.getElementById(id);
    this.ends = [given.elasticity, given.load];
    this.lines = given.lines.map(({ between, elasticity, load }) => [between, unpacked(elasticity), unpacked(load)]);
    this.legend = Object.assign(document.createElement("div"), { className: "legend" });
    this.place = Object.assign(document.createElement("div"), { className: "plot" });
    this.place.setAttribute("role", "img");
    this.figure.append(this.legend, this.place);
    this.spots = [];
    this.build();
    new ResizeObserver(() => this.fit()).observe(this.figure);
  }

  fit() {
    const width = this.figure.clientWidth - 16;
    if (width > 0 && width !== this.plot.width) this.plot.setSize({ width, height: HEIGHT });
  }

  build() {
    this.plot?.destroy();
    const [across, up] = this.ends;
    this.plot = new uPlot({
      width: Math.max(this.figure.clientWidth - 16, 200), height: HEIGHT, legend: { show: false }, cursor: { show: false },
      scales: { x: { time: false, distr: 3, range: () => across }, y: { distr: 3, range: () => up } },
      series: [{}, { show: true, points: { show: false }, width: 0 }],
      axes: [decades("elasticity parameter λ [–]", 30), decades("load parameter [–]", 62)],
      hooks: { draw: [(plot) => this.draw(plot)] },
    }, [across, up], this.place);
  }

  draw(plot) {
    const { ctx } = plot;
    const at = (x, y) => [plot.valToPos(x, "x", true), plot.valToPos(y, "y", true)];
    ctx.save();
    ctx.beginPath();
    ctx.rect(plot.bbox.left, plot.bbox.top, plot.bbox.width, plot.bbox.height);
    ctx.clip();
    ctx.strokeStyle = ctx.fillStyle = ink();
    ctx.lineWidth = 1.2 * devicePixelRatio;
    const limit = this.lines.find(([between]) => between.includes("Hertz"));
    for (const [between, x, y] of this.lines) this.path(ctx, at, x, y, between.includes("Hertz") ? null : limit);
    ctx.font = `${11 * devicePixelRatio}px system-ui`;
    ctx.textAlign = "center";
    for (const [name, place] of Object.entries(NAMES)) name.split("-").forEach((word, row) => {
      const [x, y] = at(...place);
      ctx.fillText(word, x, y + 13 * row * devicePixelRatio);
    });
    this.spots.forEach(({ place, letter, colour }) => mark(ctx, plot, at, place, letter, colour));
    ctx.restore();
  }

  // A line, below the line where adhesion no longer matters.
  path(ctx, at, x, y, limit) {
    ctx.beginPath();
    let down = false;
    for (let number = 0; number < x.length; number += 1) {
      const seen = Number.isFinite(x[number]) && Number.isFinite(y[number]) && (!limit || y[number] < heightAt(limit, x[number]));
      if (seen) ctx[down ? "lineTo" : "moveTo"](...at(x[number], y[number]));
      down = seen;
    }
    ctx.stroke();
  }

  show(designs) {
    this.spots = designs.filter((one) => one.answer?.place).map(({ answer, letter }) => ({
      place: answer.place, letter, colour: tint(MARKS["AB".indexOf(letter)]),
    }));
    const told = this.spots.map(({ place, letter }) => `${letter}: ${place.region}`);
    this.legend.replaceChildren(...this.spots.map(({ letter, colour, place }) => chip(`${letter}: ${place.region}`, colour, false)));
    if (!told.length && designs.some((one) => one.answer)) this.legend.textContent = "No place on the map: nothing adheres, or nothing touches.";
    this.place.setAttribute("aria-label", `Adhesion map, load parameter against elasticity parameter. ${told.join("; ")}`);
    this.plot.redraw();
  }

  restyle() {
    this.build();
  }
}

function mark(ctx, plot, at, place, letter, colour) {
  const clip = (value, low, high) => Math.min(Math.max(value, low), high);
  const { left, top, width, height } = plot.bbox;
  const [x, y] = at(place.elasticity, Math.max(place.load, 1e-30));
  const reach = 6 * devicePixelRatio;
  ctx.fillStyle = colour;
  ctx.beginPath();
  ctx.arc(clip(x, left + reach, left + width - reach), clip(y, top + reach, top + height - reach), reach, 0, 7);
  ctx.fill();
  ctx.font = `bold ${12 * devicePixelRatio}px system-ui`;
  const side = letter === "A" ? 2 : -2; // two designs may lie on one place
  ctx.fillText(letter, clip(x, left + 3 * reach, left + width - 3 * reach) + side * reach, clip(y, top + 2 * reach, top + height - reach) + 4);
}

function heightAt([, x, y], value) {
  let number = x.findIndex((one) => one >= value);
  if (number < 0) number = x.length - 1;
  return y[number];
}

function decades(label, size) {
  return {
    ...axis(label, size),
    values: (plot, ticks) => ticks.map((tick) => (Number.isInteger(Math.round(1e6 * Math.log10(tick)) / 1e6) ? tick.toExponential().replace("e+", "e") : "")),
  };
}

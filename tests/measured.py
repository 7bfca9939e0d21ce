"""Published measurements, and what the program gives over the inputs that were not published.

The test of the measurements asserts on these rows and the page `docs/measurements.md` prints them.
No factor is fitted: an input is either published, or from a catalogue or handbook, or swept.
"""

import csv
from collections.abc import Iterable
from functools import cache
from itertools import product
from math import cos, pi, radians
from pathlib import Path
from typing import NamedTuple

import equinox as eqx
import numpy as np
from scipy.optimize import brentq

from asperity._jax import jnp
from asperity.interface.interface import Interface
from asperity.laws import Bradley, ByContact, ByKelvinGap, Hertz, KelvinFilling, Meniscus
from asperity.laws.liquid.meniscus import Formation
from asperity.materials.liquids import LIQUIDS, kelvin_radius
from asperity.materials.solids import SOLIDS, Solid, contact_modulus
from asperity.surfaces.heights import Gaussian

FILE = Path(__file__).parent / "data" / "measurements.csv"
_LINES = [line for line in FILE.read_text().splitlines() if not line.startswith("#")]
ROWS = {row["id"]: row for row in csv.DictReader(_LINES)}

PRODUCT = 0.05  # rms height x tip radius x density of summits, of many random surfaces
TIPS = (1e-9, 30e-9, 1e-6)  # m
SUMMITS = "summit radius 1 nm to 1 um with rms x radius x density = 0.05"
SPACINGS = (0.2e-9, 0.4e-9)  # m
WATER = LIQUIDS["water"]
DIAMOND = Solid("diamond", 1140e9, 0.07, 3515.0, source="handbook value")


def value(name: str) -> float:
    """A published number, in its own unit."""
    return float(ROWS[name]["value"])


class Comparison(NamedTuple):
    """A published number beside the range of ours.

    Attributes
    ----------
    row
        Where it stands in the file of measurements.
    target
        What was measured.
    low, high
        Least and largest of ours over the swept inputs, in the published unit.
    swept
        The inputs and their ranges.
    reason
        Why the verdict is what it is.
    """

    row: str
    target: str
    low: float
    high: float
    swept: str
    reason: str

    @property
    def published(self) -> float:
        return value(self.row)

    @property
    def relation(self) -> str:
        return ROWS[self.row]["relation"]

    @property
    def factor(self) -> float:
        """How many times the published number lies beyond our range; 1 where it lies inside."""
        if self.relation == "<":
            return max(1.0, self.high / self.published)
        if self.relation == ">":
            return max(1.0, self.published / self.low)
        return max(1.0, self.published / self.high, self.low / self.published)

    @property
    def verdict(self) -> str:
        if self.relation == "~" and 1.0 < self.factor < 1.1:
            return f"at the edge, {self.factor - 1.0:.0%} beyond our range"
        if self.factor > 1.0:
            return f"outside by a factor of {self.factor:.3g}"
        if self.relation in "<>":
            return "agrees: all of our range does"
        span = self.high / self.low
        return f"inside; our range spans a factor of {span:.{0 if span > 10.0 else 1}f}"


class PullOff(NamedTuple):
    """Of a rigid rough sphere of radius R: its force over 2 pi R, and where.

    Attributes
    ----------
    work
        Force over 2 pi R [J/m^2]: the effective work of adhesion.
    contacting
        Expected number of summits in contact, over R [1/m].
    """

    work: float
    contacting: float


@eqx.filter_jit
def _lifted(layers, places):
    means = [layer.measure(places, layer.initial_memory(), integrated=1) for layer in layers]
    return sum(jnp.sum(one.parts, axis=0) for one in means), 2.0 * pi * means[0].contacting


def filling(humidity: float, degrees: float, formation: Formation) -> KelvinFilling:
    """Water in every gap that the vapour fills, at 20 degrees Celsius."""
    r_k = kelvin_radius(WATER, humidity, 293.15)
    return KelvinFilling(WATER.tension, radians(degrees), r_k, formation)


@cache
def pull_off(
    rms: float, tip: float, work: float, modulus: float, spacing: float, humidity: float = 0.0
) -> PullOff:
    """Hertz and Bradley summits, and water in the gaps between; the least force of three grids."""
    law = Hertz(tip, modulus) + Bradley(tip, work, spacing)
    layers = [Interface(law, Gaussian(rms), PRODUCT / (rms * tip))]
    if humidity > 0.0:
        water = filling(humidity, 20.0, ByKelvinGap())
        layers.append(Interface(water, Gaussian(rms), 1.0))
    low, high = -3.0 * rms - 5.0 * spacing, 9.0 * rms + 10.0 * spacing
    for _ in range(3):
        places = np.linspace(low, high, 121)
        force, contacting = (np.asarray(a) for a in _lifted(layers, jnp.asarray(places)))
        k = int(np.argmin(force))
        low, high = places[max(k - 1, 0)], places[min(k + 1, 120)]
    return PullOff(-float(force[k]), float(contacting[k]))


def falls(smooth: float, rough: float, inputs: list[tuple[float, ...]]) -> list[float]:
    """How many times the pull-off falls between two rms heights [m], for each of the inputs."""
    return [pull_off(smooth, *given).work / pull_off(rough, *given).work for given in inputs]


def alumina_inputs() -> list[tuple[float, ...]]:
    modulus = contact_modulus(SOLIDS["alumina"], SOLIDS["alumina"])
    return list(product(TIPS, (0.05, 0.15), (modulus,), SPACINGS))


def alumina() -> list[Comparison]:
    """Pull-off from 1.5 to 12.0 nm rms: the mean over many places, dry and wet, and one summit."""
    found = falls(1.5e-9, 12e-9, alumina_inputs())
    target = "alumina probe on alumina: fall of the pull-off from 1.5 to 12.0 nm rms"
    mean = f"{SUMMITS}, w 0.05 to 0.15 J/m^2, spacing 0.2 to 0.4 nm"
    why = (
        "less than a tenth of a summit touches a probe of 10 um, and the mean is then the far "
        "tail of the attraction, about as rms^-2; a probe that is pressed on always finds a summit"
    )
    air = [(*given, humidity) for given in alumina_inputs() for humidity in (0.2, 0.6, 0.9)]
    wet = falls(1.5e-9, 12e-9, air)
    humid = "as above, in air of 20 to 90 % humidity, angle 20 degrees"
    worse = "water fills the gaps of the smooth plate at a humidity at which the rough one is dry"
    one = "same radius at both rms heights, to same density (radius as 1/rms)"
    single = "one summit carries the force, 2 pi w radius: a bound, hardly a test"
    return [
        Comparison("LAI1", target, min(found), max(found), mean, why),
        Comparison("LAI1", f"{target}; with water", min(wet), max(wet), humid, worse),
        Comparison("LAI1", f"{target}; one summit", 1.0, 12.0 / 1.5, one, single),
    ]


def ruby_inputs() -> list[tuple[float, ...]]:
    rigid = SOLIDS["sapphire"].youngs_modulus / (1.0 - SOLIDS["sapphire"].poisson ** 2)
    soft = contact_modulus(SOLIDS["sapphire"], DIAMOND)
    return list(product(TIPS, (1e-3 * value("THI3"),), (soft, rigid), (1e-9 * value("THI4"),)))


def ruby() -> list[Comparison]:
    """Effective work of adhesion on the roughest and on the smoothest coating."""
    found = [1e3 * pull_off(s * 1e-9, *given).work for s in (3.0, 50.0) for given in ruby_inputs()]
    swept = f"rms 3 to 50 nm, {SUMMITS}; w 46.3 mJ/m^2 and range 5.6 nm as published"
    rows = []
    for name, which in (("THI2", "smoothest"), ("THI1", "roughest")):
        needed = [ruby_rms(value(name), given) for given in ruby_inputs()]
        why = (
            f"the rms heights were not read: it needs {min(needed):.2g} to {max(needed):.2g} nm, "
            "so this is a range of roughness, not a test"
        )
        target = f"0.5 mm ruby on diamond coatings: effective work, {which}"
        rows.append(Comparison(name, target, min(found), max(found), swept, why))
    return rows


@cache
def ruby_rms(work: float, given: tuple[float, ...]) -> float:
    """The rms height [nm] that gives an effective work of adhesion [mJ/m^2]."""
    return brentq(
        lambda s: np.log(1e3 * pull_off(s * 1e-9, *given).work / work), 1.0, 100.0, rtol=1e-3
    )


def tips_in_microscope() -> list[Comparison]:
    inputs = list(product((1e-9, 50e-9), (0.05, 0.3), (100e9, 500e9), SPACINGS))
    found = falls(0.18e-9, 1.58e-9, inputs)
    swept = "summit radius 1 to 50 nm, w 0.05 to 0.3 J/m^2, E* 100 to 500 GPa, spacing as above"
    why = "the mean over many places; the tips are single ones, with few summits"
    target = "diamond-like tips on diamond: fall of the adhesion from 0.18 to 1.58 nm rms"
    return [Comparison("JAC1", target, min(found), max(found), swept, why)]


def meniscus_pull(radius: float, degrees: float) -> float:
    """Largest force of a meniscus on a smooth sphere [nN]; it does not know the humidity."""
    r_k = kelvin_radius(WATER, 0.5, 293.15)
    return 1e9 * float(Meniscus(radius, WATER.tension, radians(degrees), r_k).pull)


def humid_tips() -> list[Comparison]:
    rows = []
    wet = meniscus_pull(20e-9, 40.0), meniscus_pull(20e-9, 0.0)
    dry = 1e9 * 2.0 * pi * 20e-9 * 0.05
    target = "silicon tip, 20 nm, in humid air: pull-off"
    why = "no humidity in the pull at touch, while the measured one grows with it"
    rows.append(Comparison("JON1", f"{target}; meniscus alone", *wet, "angle 0 to 40 degrees", why))
    swept = "angle 0 to 40 degrees, dry work of adhesion 0 to 0.05 J/m^2"
    rows.append(
        Comparison("JON1", f"{target}; with dry adhesion", wet[0], wet[1] + dry, swept, why)
    )
    small = meniscus_pull(7e-9, 60.0), meniscus_pull(7e-9, 0.0)
    why = "published as an order of magnitude; which solids is not said"
    target = "tip of 7 nm in humid air: pull-off"
    return [*rows, Comparison("VTT1", target, *small, "angle 0 to 60 degrees", why)]


def wet_work(humidity: float, rms: float, degrees: float, reduced: float = 3.0) -> float:
    """Work [mJ/m^2] that parts filled rough surfaces from a separation of some rms heights."""
    layer = Interface(filling(humidity, degrees, ByContact()), Gaussian(rms), 1.0)
    return -1e3 * float(layer.energy(jnp.asarray(reduced * rms), layer.saturated_memory()))


def cantilevers() -> list[Comparison]:
    """The limit of much water, 2 gamma cos(angle), at 20 and 25 degrees Celsius."""
    work = [
        2e3 * WATER.at(kelvin).tension * cos(radians(degrees))
        for kelvin in (293.15, 298.15)
        for degrees in (0.0, 20.0)
    ]
    why = "2 gamma cos(angle), whatever the roughness; 143.9 at 25 degrees Celsius and full wetting"
    swept = "angle 0 to 20 degrees, 20 to 25 degrees Celsius"
    target = "micro-cantilevers: adhesion energy in much vapour"
    return [Comparison("DEL1", target, min(work), max(work), swept, why)]


def table(comparisons: Iterable[Comparison]) -> str:
    """Comparisons as a Markdown table."""
    lines = [
        "| measured | source | published | ours | over | verdict | because |",
        "|" + "---|" * 7,
    ]
    for one in comparisons:
        row = ROWS[one.row]
        unit = "" if row["unit"] == "1" else f" {row['unit']}"
        sign = {"=": "", "->": "tends to "}.get(one.relation, f"{one.relation} ")
        ends = list(dict.fromkeys((f"{one.low:.3g}", f"{one.high:.3g}")))
        lines.append(
            f"| {one.target} | {row['paper']} ({row['evidence']}) | {sign}{row['value']}{unit} "
            f"| {' to '.join(ends)}{unit} | {one.swept} | {one.verdict} | {one.reason} |"
        )
    return "\n".join(lines)


def statics() -> list[Comparison]:
    return [*alumina(), *ruby(), *tips_in_microscope(), *humid_tips(), *cantilevers()]

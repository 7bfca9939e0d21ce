"""The data of the publication's figures, from the model's own numbers."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import pi, sin, sqrt
from typing import TYPE_CHECKING

import numpy as np

from .. import regimes
from ..results.result import Result
from ..surfaces.generation.synthetic import gaussian_surface, length_for_density, summits
from .evidence import Evidence
from .figure_data import Columns, Drawing, gaussian, map_columns, map_lines

if TYPE_CHECKING:
    from ..surfaces.measured_surface import Pair

_SEED = 2014
_SHOWN_HUMIDITY = 0.6
"""Relative humidity of the meniscus that is drawn: at 100 % it would have no end."""

_SUMMITS = 9


def drawings(evidence: Evidence, measured: Pair | None = None) -> dict[str, Drawing]:
    """Data of Figures 1 to 9, by file name without its ending.

    Parameters
    ----------
    evidence
        What the figures stand on.
    measured
        The surfaces of Figures 2 and 3; a synthetic pair where there is none.
    """
    makers: dict[str, Callable[[Evidence], Drawing]] = {
        "figure-1": _bodies,
        "figure-2": _heights,
        "figure-3": _distribution,
        "figure-4": _map,
        "figure-5": _meniscus,
        "figure-6": _conjunction,
        "figure-7a": _wet_and_dry,
        "figure-7b": _forces,
        "figure-8": partial(_by_table, table=2, title="Figure 8: asperity radius and the motion"),
        "figure-9": partial(_by_table, table=3, title="Figure 9: rms height and the motion"),
    }
    drawn = {name: make(evidence) for name, make in makers.items()}
    if measured is not None:
        # Here, since SciPy's signal processing takes a second to import and is needed for no other.
        from . import surface_figures

        drawn["figure-2"] = surface_figures.heights(measured)
        drawn["figure-3"] = surface_figures.distribution(measured)
    return drawn


def _bodies(evidence: Evidence) -> Drawing:
    """The two bodies to scale; the publication shows micrographs of them."""
    radius = evidence.inputs.radius
    angle = np.linspace(0.0, 2.0 * pi, 361)
    deepest = evidence.closest
    inside = np.linspace(-1.0, 1.0, 201) * 2.5 * evidence.contact_radius
    return Drawing(
        "Figure 1: sphere and plane, to scale (the publication shows micrographs)",
        ("position [m]", "height [m]"),
        {
            "sphere": (radius * np.sin(angle), radius * (1.0 - np.cos(angle))),
            "sphere near the plane": (inside, deepest + inside**2 / (2.0 * radius)),
        },
        {"radius [m]": radius, "rms height [m]": evidence.rough.rms_height},
    )


def _surface(evidence: Evidence) -> tuple[np.ndarray, float]:
    """Composite of two synthetic surfaces of equal roughness, and its spacing [m]."""
    rms = evidence.rough.rms_height
    length = length_for_density(evidence.rough.asperity_density)
    spacing = 0.2 * length
    pair = [
        gaussian_surface((640, 640), spacing, rms / sqrt(2.0), length, _SEED + k) for k in (0, 1)
    ]
    return pair[0] + pair[1], spacing


def _heights(evidence: Evidence) -> Drawing:
    heights, spacing = _surface(evidence)
    rows, columns = 90, 150
    return Drawing(
        "Figure 2: heights of a synthetic composite surface (measured ones with --surfaces)",
        ("x [m]", "y [m]", "height [m]"),
        {"composite": map_columns(heights[:rows, :columns], (spacing, spacing))},
        {"rows": rows, "columns": columns, "rms height [m]": float(heights.std())},
    )


def _distribution(evidence: Evidence) -> Drawing:
    heights, _ = _surface(evidence)
    rms = evidence.rough.rms_height
    edges = np.linspace(-4.0, 4.5, 52) * rms
    middle = 0.5 * (edges[1:] + edges[:-1])
    tops = summits(heights)
    series: dict[str, Columns] = {
        name: (middle, np.histogram(values, edges, density=True)[0])
        for name, values in (("surface", heights.ravel()), ("summits", tops))
    }
    series["Gaussian"] = gaussian(edges[0], edges[-1], rms)
    return Drawing(
        "Figure 3: heights of the synthetic composite surface and of its summits (measured ones "
        "with --surfaces)",
        ("height [m]", "probability density [1/m]"),
        series,
        {"summits' mean [m]": float(tops.mean()), "summits' rms [m]": float(tops.std())},
    )


def _map(evidence: Evidence) -> Drawing:
    lines = regimes.adhesion_map(np.logspace(-3.0, 2.0, 160), np.logspace(-2.0, 6.0, 160))
    series = map_lines(lines)
    lam = np.array([evidence.wet.regime["elasticity_parameter"]])
    series["closest approach"] = (lam, np.array([evidence.wet.regime["load_parameter"]]))
    series["at rest, exact model"] = (lam, np.array([evidence.load_at_rest]))
    return Drawing(
        "Figure 4: adhesion map with the case on it (Johnson and Greenwood's, 5 % criteria)",
        ("elasticity parameter [1]", "load parameter [1]"),
        series,
        {},
    )


def _meniscus(evidence: Evidence) -> Drawing:
    """One asperity with its meniscus, and some asperities of the rough surface in their bands.

    The meniscus is the model's: an arc of the Kelvin radius between faces as good as parallel.
    """
    rough, angle = evidence.rough, evidence.inputs.contact_angle
    radius, flat = rough.asperity_radius, float(evidence.contact.pressure.end)
    kelvin = evidence.kelvin_radius(_SHOWN_HUMIDITY)
    interaction_range = evidence.interaction_range(_SHOWN_HUMIDITY)
    gap = 0.3 * interaction_range
    # The parabola meets the filled height where its own rise has used up the rest of the range.
    filled = sqrt(2.0 * radius * (interaction_range - gap))
    place = np.linspace(-1.6 * filled, 1.6 * filled, 161)
    turn = np.linspace(-1.0, 1.0, 61) * (0.5 * pi - angle)
    arc_y = 0.5 * interaction_range * (1.0 + np.sin(turn) / sin(0.5 * pi - angle))
    arc_x = filled - kelvin * (np.cos(turn) - np.cos(turn[0]))
    pitch = rough.spacing
    summits = pitch * (np.arange(_SUMMITS) - _SUMMITS // 2)
    heights = np.random.default_rng(_SEED).standard_normal(_SUMMITS) * rough.rms_height
    fine = np.linspace(summits[0] - pitch / 2.0, summits[-1] + pitch / 2.0, 1200)
    profile = np.max(heights[:, None] - (fine - summits[:, None]) ** 2 / (2.0 * radius), axis=0)
    waiting = (heights > 0.0) & (heights < flat)
    return Drawing(
        f"Figure 5: a meniscus at {100.0 * _SHOWN_HUMIDITY:g} % relative humidity, and asperities "
        "of a rough surface with those that have one at 100 % by eqs. 13-15",
        ("position [m]", "height [m]"),
        {
            "asperity": (place, gap + place**2 / (2.0 * radius)),
            "meniscus, right": (arc_x, arc_y),
            "meniscus, left": (-arc_x, arc_y),
            "rough surface": (fine, profile),
            "summits": (summits, heights),
            "summits with a meniscus": (summits[waiting], heights[waiting]),
        },
        {"gap [m]": gap, "Kelvin radius [m]": kelvin, "edge [m]": flat,
         "rms height [m]": rough.rms_height, "bands drawn": 8.0},
    )  # fmt: skip


def _conjunction(evidence: Evidence) -> Drawing:
    """Gap and displacement at the first closest approach, the latter by its own pressure."""
    return Drawing(
        "Figure 6: the conjunction at closest approach, and what its pressure would displace",
        ("radius [m]", "separation [m]", "displacement [m]", "pressure [Pa]"),
        {"closest approach": evidence.conjunction},
        {
            "edge [m]": float(evidence.contact.pressure.end),
            "rigid separation [m]": evidence.closest,
            "rms height [m]": evidence.rough.rms_height,
        },
    )


def _trajectory(motion: Result) -> Columns:
    return motion.time, motion.separation


_MOTION = ("time [s]", "separation [m]")


def _wet_and_dry(evidence: Evidence) -> Drawing:
    end = evidence.wet.time[-1] * 1.05
    shown = evidence.dry.time < end
    return Drawing(
        "Figure 7a: the motion with menisci at 100 % relative humidity and without",
        _MOTION,
        {
            "dry": tuple(values[shown] for values in _trajectory(evidence.dry)),
            "wet": _trajectory(evidence.wet),
        },
        {"edge [m]": float(evidence.contact.pressure.end)},
    )


def _forces(evidence: Evidence) -> Drawing:
    """With two values where the pulls set in, at each closest approach."""
    wet, turns = evidence.wet, evidence.wet.events["closest_approach_time"]
    begun = evidence.retraction_forces(wet.events["closest_approach_separation"]).T
    forces: dict[str, np.ndarray] = dict(
        zip(evidence.contact.components, begun, strict=True),
        weight=np.full(turns.size, -evidence.weight),
    )
    after = np.array([np.argmin(np.abs(wet.time - turn)) + 1 for turn in turns])
    names = ("elastic", "capillary", "adhesion", "weight")
    time = np.insert(wet.time, after, turns)
    return Drawing(
        "Figure 7b: the forces of the wet motion",
        ("time [s]", *(f"{name} [N]" for name in names)),
        {"wet": (time, *(np.insert(wet.forces[name], after, forces[name]) for name in names))},
        {"first closest approach [s]": float(wet.events["closest_approach_time"][0])},
    )


def _by_table(evidence: Evidence, table: int, title: str) -> Drawing:
    """The motions of a table, named by what differs; that of the case where it has none."""
    surfaces = sorted(
        {(r["asperity_radius"], r["rms_height"]) for r in evidence.rows if r["table"] == table}
    )
    found = {surface: evidence.surfaces[surface] for surface in surfaces}
    if not found:
        found = {(evidence.rough.asperity_radius, evidence.rough.rms_height): evidence.wet}
    differ = [len({surface[k] for surface in found}) > 1 for k in (0, 1)]
    shown = [k for k in (0, 1) if differ[k]] or [0, 1]

    def name(surface: tuple[float, float]) -> str:
        return ", ".join(f"{'βσ'[k]} = {1e9 * surface[k]:.4g} nm" for k in shown)

    series = {name(surface): _trajectory(motion) for surface, motion in found.items()}
    return Drawing(title, _MOTION, series, {})

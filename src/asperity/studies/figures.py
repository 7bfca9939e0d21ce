"""The data of the publication's figures, from the model's own numbers."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, isclose, pi, sin, sqrt

import numpy as np

from .. import regimes
from .._jax import jnp
from ..halfspace import ring_mesh
from ..materials import contact_modulus, kelvin_radius
from ..result import Result
from ..roughness.synthetic import gaussian_surface, length_for_density, summits
from .drawing import Drawing
from .evidence import Evidence

Columns = tuple[np.ndarray, ...]

_SEED = 2014
_SHOWN_HUMIDITY = 0.6
"""Relative humidity of the menisci that are drawn: at 100 % they would have no end."""


def drawings(evidence: Evidence) -> dict[str, Drawing]:
    """Data of Figures 1 to 9, by file name without its ending."""
    makers: dict[str, Callable[[Evidence], Drawing]] = {
        "figure-1": _bodies,
        "figure-2": _heights,
        "figure-3": _distribution,
        "figure-4": _map,
        "figure-5": _meniscus,
        "figure-6": _conjunction,
        "figure-7a": _wet_and_dry,
        "figure-7b": _forces,
        "figure-8": _by_radius,
        "figure-9": _by_height,
    }
    return {name: make(evidence) for name, make in makers.items()}


def _rough(evidence: Evidence) -> tuple[float, float, float]:
    """Density [1/m^2], radius [m] and rms height [m] of the asperities."""
    rough = evidence.case.roughness
    assert rough is not None
    return rough.asperity_density, rough.asperity_radius, rough.rms_height


def _bodies(evidence: Evidence) -> Drawing:
    """The two bodies to scale; the publication shows micrographs of them."""
    radius = evidence.case.body.radius
    angle = np.linspace(0.0, 2.0 * pi, 361)
    deepest = float(evidence.wet.events["deepest_separation"][0])
    inside = np.linspace(-1.0, 1.0, 201) * 2.5 * _contact_radius(evidence)
    return Drawing(
        "Figure 1: sphere and plane, to scale (the publication shows micrographs)",
        ("place [m]", "height [m]"),
        {
            "sphere": (radius * np.sin(angle), radius * (1.0 - np.cos(angle))),
            "sphere near the plane": (inside, deepest + inside**2 / (2.0 * radius)),
        },
        {"radius [m]": radius, "rms height [m]": evidence.rms_height},
    )


def _contact_radius(evidence: Evidence) -> float:
    """Radius of the conjunction at the first closest approach [m]."""
    low, end = evidence.wet.events["deepest_separation"][0], float(evidence.contact.pressure.end)
    return sqrt(2.0 * evidence.case.body.radius * (end - low))


def _surface(evidence: Evidence) -> tuple[np.ndarray, float]:
    """Composite of two synthetic surfaces of equal roughness, and its spacing [m]."""
    density, _, rms = _rough(evidence)
    length = length_for_density(density)
    spacing = 0.2 * length
    pair = [
        gaussian_surface((640, 640), spacing, rms / sqrt(2.0), length, _SEED + k) for k in (0, 1)
    ]
    return pair[0] + pair[1], spacing


def _heights(evidence: Evidence) -> Drawing:
    heights, spacing = _surface(evidence)
    rows, columns = 90, 150
    y, x = np.meshgrid(np.arange(rows) * spacing, np.arange(columns) * spacing, indexing="ij")
    piece = heights[:rows, :columns]
    return Drawing(
        "Figure 2: heights of a composite surface (synthetic, until the program reads files)",
        ("x [m]", "y [m]", "height [m]"),
        {"composite": (x.ravel(), y.ravel(), piece.ravel())},
        {"rows": rows, "columns": columns, "rms height [m]": float(heights.std())},
    )


def _distribution(evidence: Evidence) -> Drawing:
    heights, _ = _surface(evidence)
    rms = evidence.rms_height
    edges = np.linspace(-4.0, 4.5, 52) * rms
    middle = 0.5 * (edges[1:] + edges[:-1])
    tops = summits(heights)
    series: dict[str, Columns] = {
        name: (middle, np.histogram(values, edges, density=True)[0])
        for name, values in (("surface", heights.ravel()), ("summits", tops))
    }
    fine = np.linspace(edges[0], edges[-1], 301)
    series["Gaussian"] = (fine, np.exp(-0.5 * (fine / rms) ** 2) / (rms * sqrt(2.0 * pi)))
    return Drawing(
        "Figure 3: heights of the synthetic composite surface and of its summits",
        ("height [m]", "probability density [1/m]"),
        series,
        {"summits' mean [m]": float(tops.mean()), "summits' rms [m]": float(tops.std())},
    )


def _map(evidence: Evidence) -> Drawing:
    rough, case = evidence.case.roughness, evidence.case
    assert rough is not None
    assert case.adhesion.work is not None
    lines = regimes.adhesion_map(np.logspace(-3.0, 2.0, 160), np.logspace(-2.0, 6.0, 160))
    series: dict[str, Columns] = {
        f"{line.between[0]} | {line.between[1]}": _finite(line.elasticity, line.load)
        for line in lines
    }
    lam = np.array([evidence.wet.regime["elasticity_parameter"]])
    at_rest = evidence.exact_state(evidence.exact_rest)
    load = regimes.load_parameter(
        float(at_rest.elastic), float(at_rest.touching), case.adhesion.work, rough.asperity_radius
    )
    series["closest approach"] = (lam, np.array([evidence.wet.regime["load_parameter"]]))
    series["at rest, exact model"] = (lam, np.array([load]))
    return Drawing(
        "Figure 4: adhesion map with the case on it (Johnson and Greenwood's, 5 % criteria)",
        ("elasticity parameter [1]", "load parameter [1]"),
        series,
        {},
    )


def _finite(*arrays: np.ndarray) -> Columns:
    keep = np.all([np.isfinite(values) for values in arrays], axis=0)
    return tuple(values[keep] for values in arrays)


def _meniscus(evidence: Evidence) -> Drawing:
    """One asperity with its meniscus, and some asperities of the rough surface in their bands."""
    case, (density, radius, rms) = evidence.case, _rough(evidence)
    liquid, angle = case.liquid, case.capillary.contact_angle
    assert liquid is not None
    assert angle is not None
    assert case.capillary.temperature is not None
    kelvin = kelvin_radius(liquid, _SHOWN_HUMIDITY, case.capillary.temperature)
    reach = 2.0 * kelvin * cos(angle)
    gap = 0.3 * reach
    # The parabola meets the filled height where its own rise has used up the rest of the reach.
    filled = sqrt(2.0 * radius * (reach - gap))
    place = np.linspace(-1.6 * filled, 1.6 * filled, 161)
    turn = np.linspace(-1.0, 1.0, 61) * (0.5 * pi - angle)
    arc_y = 0.5 * reach * (1.0 + np.sin(turn) / sin(0.5 * pi - angle))
    arc_x = filled - kelvin * (np.cos(turn) - np.cos(turn[0]))
    heights = np.random.default_rng(_SEED).standard_normal(9) * rms
    pitch = density**-0.5
    return Drawing(
        f"Figure 5: a meniscus at {100.0 * _SHOWN_HUMIDITY:g} % relative humidity, and asperities "
        "of a rough surface",
        ("place [m]", "height [m]"),
        {
            "asperity": (place, gap + place**2 / (2.0 * radius)),
            "meniscus, right": (arc_x, arc_y),
            "meniscus, left": (-arc_x, arc_y),
            "summits": (pitch * (np.arange(9.0) - 4.0), heights),
        },
        {"gap [m]": gap, "Kelvin radius [m]": kelvin, "separation [m]": 3.0 * rms,
         "bands drawn": 8.0, "asperity spacing [m]": pitch},
    )  # fmt: skip


def _conjunction(evidence: Evidence) -> Drawing:
    """Gap and displacement at the first closest approach, the latter by its own pressure."""
    case, pressure = evidence.case, evidence.contact.pressure
    low = float(evidence.wet.events["deepest_separation"][0])
    radius, edge = case.body.radius, float(pressure.end)
    mesh = ring_mesh(200)
    size = _contact_radius(evidence)
    place = mesh.radius * size
    gap = low + place**2 / (2.0 * radius)
    pressures = np.asarray(pressure.contact(jnp.asarray(gap)))
    modulus = contact_modulus(case.body_solid, case.counterface_solid)
    lift = mesh.compliance @ pressures * size / modulus
    return Drawing(
        "Figure 6: the conjunction at closest approach, and what its pressure would displace",
        ("radius [m]", "separation [m]", "displacement [m]", "pressure [Pa]"),
        {"closest approach": (place, gap, lift, pressures)},
        {"edge [m]": edge, "rigid separation [m]": low, "rms height [m]": evidence.rms_height},
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
    wet, turns = evidence.wet, evidence.wet.events["deepest_time"]
    begun = evidence.parting_forces(wet.events["deepest_separation"]).T
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
        {"first closest approach [s]": float(wet.events["deepest_time"][0])},
    )


def _by_radius(evidence: Evidence) -> Drawing:
    rms = evidence.rms_height
    found = {s: m for s, m in evidence.surfaces.items() if isclose(s[1], rms)}
    return Drawing(
        "Figure 8: asperity radius and the motion",
        _MOTION,
        {f"β = {1e9 * s[0]:.4g} nm": _trajectory(found[s]) for s in sorted(found)},
        {"rms height [m]": rms},
    )


def _by_height(evidence: Evidence) -> Drawing:
    _, radius, _ = _rough(evidence)
    found = {s: m for s, m in evidence.surfaces.items() if isclose(s[0], radius)}
    return Drawing(
        "Figure 9: rms height and the motion",
        _MOTION,
        {f"σ = {1e9 * s[1]:.4g} nm": _trajectory(found[s]) for s in sorted(found)},
        {"asperity radius [m]": radius},
    )

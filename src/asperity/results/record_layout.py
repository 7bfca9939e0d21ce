"""What a record holds: the variables and attributes of a result, and its JSON."""

from __future__ import annotations

import functools
import hashlib
import importlib.metadata
import json
import math
import platform
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from asperity.results.realisations import KINDS, Realisations
from asperity.results.result_data import CurveData, ResultData

KIND = "asperity_record"
"""Attribute that marks a record; "run" or "curve"."""

VERSION = 2
"""Version of this layout."""

BODY, SUMMIT = "body_", "summit_"
"""What the names of variables of single bodies begin with, and those of the first one's summits."""

MOTION = {
    "time": ("s", "time since the release"),
    "separation": ("m", "rigid separation"),
    "central_separation": ("m", "separation at the centre, with the bodies' deformation"),
    "speed": ("m/s", "rate of the rigid separation"),
}
"""Unit and meaning of what a motion has at each of its times."""

_FORCES = {
    "weight": "weight",
    "contact": "contact force, all mechanisms together",
    "total": "all forces, weight included",
}
_ENERGIES = {
    "kinetic": "kinetic energy",
    "potential": "potential energy of weight and spring",
    "stored": "energy stored in the contact",
}
EVENTS = {
    "closest_approach_time": ("s", "time of closest approach"),
    "closest_approach_separation": ("m", "rigid separation at closest approach"),
    "apex_time": ("s", "time of the rebound's turning point"),
    "apex_separation": ("m", "rigid separation at the rebound's turning point"),
}
"""Unit and meaning of what is known of each impact."""

_PULL = {
    "pull_off": ("N", "largest tension while unloading from the first turn"),
    "pull_off_separation": ("m", "rigid separation at pull-off"),
    "work_of_separation": ("J", "work against tension while unloading"),
    "preload": ("N", "load at the first turn, where pull-off and work depend on it"),
}
_MEASURES = {
    "impact_speed": ("m/s", "speed of approach at the first impact, where forces begin"),
    "maximum_speed": ("m/s", "largest speed on the first way in"),
    "critical_velocity": ("m/s", "speed of approach below which the first impact captures"),
    "contact_time": ("s", "time in contact at the first impact"),
    "maximum_force": ("N", "largest contact force of the first impact"),
    **_PULL,
    "capture_time": ("s", "time from release to capture"),
    "time_to_rest": ("s", "time from release to rest"),
    "rebound_height": ("m", "height of rebound above static equilibrium"),
    "restitution": ("1", "coefficient of restitution"),
    "log_decrement": ("1", "logarithmic decrement of the height"),
    "rebound_period": ("s", "time from one turning point to the next"),
    "power_loss": ("W", "energy lost over the impact time"),
    "power_loss_published": ("W", "one-way work over the impact time, as the publication counts"),
}
CURVE = {
    "minimum_separation": ("m", "closest rigid separation"),
    **_PULL,
    "loss": ("J", "energy lost over in and out"),
}
"""Unit and meaning of the numbers of a curve."""

PARTS = ("regime", "measures", "ledger", "warnings")
"""What a record of a run holds as JSON."""

ALONG_CURVE = {
    "rigid_separation": ("m", "rigid separation"),
    "central_separation": (
        "m", "separation at the centre on the way in, with the bodies' deformation"
    ),
    "force_loading": ("N", "contact force, loading, positive apart"),
    "force_unloading": ("N", "contact force, unloading, positive apart"),
}  # fmt: skip
"""Unit and meaning of what a curve has at each of its points."""


class Variable(NamedTuple):
    """One variable of a record; no dimensions where the value is a single number."""

    name: str
    dimensions: tuple[str, ...]
    values: np.ndarray
    units: str
    long_name: str


def variables(result: ResultData | CurveData) -> list[Variable]:
    """The variables of a result, in the order of its record."""
    if isinstance(result, CurveData):
        return _curve_variables(result)
    bodies = [] if result.realisations is None else _bodies(result.realisations)
    return [*_motion(result), *_impacts(result), *_ledger(result.ledger), *bodies]


def attributes(result: ResultData | CurveData) -> dict[str, str | int]:
    """What else a record says: the case, the input's hash, the versions, the measures as JSON."""
    resolved = result.case.toml()
    found: dict[str, str | int] = {
        KIND: "curve" if isinstance(result, CurveData) else "run",
        "layout_version": VERSION,
        "title": f"asperity: {result.name}",
        "name": result.name,
        "case": resolved,
        "input_sha256": result.input_sha256 or hashlib.sha256(resolved.encode()).hexdigest(),
        **versions(),
    }
    if result.case_file is not None:
        found["case_file"] = result.case_file
    if isinstance(result, ResultData):
        found["outcome"] = result.outcome.value
    for part in ("warnings", "jumps") if isinstance(result, CurveData) else PARTS:
        if (said := getattr(result, part)) is not None:
            found[part] = json.dumps(plain(said), allow_nan=False)
    if result.surface is not None:
        found["surface"] = json.dumps(plain(result.surface), allow_nan=False)
    return found


@functools.cache
def versions() -> dict[str, str]:
    """Versions of what computes a result."""
    packages = ("asperity", "jax", "jaxlib", "numpy")
    found = {f"{name}_version": importlib.metadata.version(name) for name in packages}
    return {**found, "python_version": platform.python_version()}


def json_object(result: ResultData | CurveData) -> dict[str, Any]:
    """What ``--json`` prints: plain Python values in SI, None where a value does not apply."""
    if isinstance(result, CurveData):
        jumps = () if result.jumps is None else ("jumps",)
        names = (*ALONG_CURVE, *CURVE, *jumps, "warnings")
        return {name: plain(getattr(result, name)) for name in names}
    found = {name: plain(getattr(result, name)) for name in PARTS}
    if result.surface is not None:
        found["surface"] = plain(result.surface)
    if result.realisations is not None:
        found["realisations"] = plain(result.realisations.plain())
    return {"outcome": result.outcome.value, **found}


def plain(value: Any) -> Any:
    """A value as strict JSON has it: no arrays, no NaN, no infinity."""
    if isinstance(value, Mapping):
        return {str(key): plain(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(inner) for inner in value]
    if hasattr(value, "tolist"):  # a NumPy or JAX array or scalar
        return plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def _motion(result: ResultData) -> list[Variable]:
    if not result.case.output.motion:
        return []
    along = ("time",)
    found = [Variable(n, along, getattr(result, n), *about) for n, about in MOTION.items()]
    for name, values in result.forces.items():
        meaning = _FORCES.get(name, f"{name} force") + ", positive apart"
        found.append(Variable(f"force_{name}", along, values, "N", meaning))
    for name, values in result.energies.items():
        meaning = _ENERGIES.get(name, f"energy lost to {name.removeprefix('lost_')} since release")
        found.append(Variable(f"energy_{name}", along, values, "J", meaning))
    return found


def _impacts(result: ResultData) -> list[Variable]:
    found = []
    count = np.size(result.events.get("closest_approach_time", ()))
    for held, table in ((result.events, EVENTS), (result.measures, _MEASURES)):
        for name, about in table.items():
            if name not in held:
                continue
            values = _numbers(held[name])
            found.append(Variable(name, _dimension(name, values, count), values, *about))
    return found


def _dimension(name: str, values: np.ndarray, count: int) -> tuple[str, ...]:
    """Impacts where there is one value for each; else a dimension of its own."""
    if values.ndim == 0:
        return ()
    return ("impact",) if values.size == count else (f"{name}_number",)


def _ledger(ledger: Mapping[str, Any]) -> list[Variable]:
    found = [
        Variable("energy_initial", (), _numbers(ledger.get("initial")), "J", "energy at release")
    ]
    for name, value in (ledger.get("lost") or {}).items():
        meaning = f"energy lost to {name} over the whole motion"
        found.append(Variable(f"total_lost_{name}", (), _numbers(value), "J", meaning))
    energy_balance_error = _numbers(ledger.get("energy_balance_error"))
    meaning = "largest departure of the energy balance over the impact energy or that lost"
    found.append(Variable("energy_balance_error", (), energy_balance_error, "1", meaning))
    return found


def _bodies(found: Realisations) -> list[Variable]:
    """One value for each of the single bodies."""
    along = ("realisation",)
    captured = found.captured.astype(float)
    rows = [Variable(f"{BODY}captured", along, captured, "1", "1 where the body is captured")]
    for name, values in found.values.items():
        units, meaning = KINDS[name]
        rows.append(Variable(f"{BODY}{name}", along, values, units, f"{meaning}, of a single body"))
    for name, values in found.lost.items():
        meaning = f"energy that a single body loses, {name}"
        rows.append(Variable(f"{BODY}lost_{name}", along, values, "J", meaning))
    summits = {"x": "coordinate from the axis", "y": "other coordinate", "gap": "gap"}
    for name, meaning in summits.items():
        meaning += " of a summit under the first body, at its turning point"
        rows.append(Variable(f"{SUMMIT}{name}", ("summit",), found.first[name], "m", meaning))
    return rows


def _curve_variables(curve: CurveData) -> list[Variable]:
    along, found = ("point",), []
    for name, about in ALONG_CURVE.items():
        found.append(Variable(name, along, getattr(curve, name), *about))
        way = name.removeprefix("force_")
        for part, values in getattr(curve, f"components_{way}", {}).items():
            meaning = f"{part} force, {way}, positive apart"
            found.append(Variable(f"{name}_{part}", along, values, "N", meaning))
    for name, about in CURVE.items():
        found.append(Variable(name, (), _numbers(getattr(curve, name)), *about))
    return found


def _numbers(value: Any) -> np.ndarray:
    """A number or a list of numbers as an array, NaN where there is none."""
    if isinstance(value, (list, tuple, np.ndarray)):
        return np.array([math.nan if one is None else one for one in value], dtype=float)
    return np.array(math.nan if value is None else value, dtype=float)

"""What the program answers, by its public Python interface alone, in the four kinds of `rules`."""

from __future__ import annotations

import math
import threading
from collections.abc import Mapping
from typing import Any

import numpy as np

import asperity

from .changing import Change
from .rules import sentence

Answer = dict[str, Any]

SAMPLES = 12
"""Elements that are kept of a longer list, evenly spread."""

PLACES = tuple(round((i / 12) ** 2, 4) for i in range(13))
"""Where a force curve is sampled, as fractions of its separations, dense at the closest ones."""

KEPT = (
    "impact_speed",
    "maximum_speed",
    "captured",
    "capture_time",
    "time_to_rest",
    "last_apex_time",
    "minimum_separation",
    "contact_time",
    "maximum_force",
    "pull_off",
    "pull_off_separation",
    "work_of_separation",
    "preload",
    "energy_lost",
    "lost_adhesion",
    "lost_capillary",
    "lost_plastic",
    "lost_gas",
    "lost_waves",
    "lost_viscous",
    "rebound_height",
    "restitution",
    "log_decrement",
    "rebound_period",
    "power_loss",
)
"""Measures that a study keeps."""

CRITICAL = "critical_velocity"
IMPACTS = 3
FAILURES = (asperity.InputError, asperity.SimulationError)


def empty() -> Answer:
    """An answer without quantities."""
    return {"values": {}, "bounds": {}, "exact": {}, "sentences": {}}


def failed(error: Exception) -> Answer:
    """The answer of a case that is not answered: the error's type."""
    return {**empty(), "exact": {"error": type(error).__name__}}


def run(case: asperity.Case, *, critical: bool) -> Answer:
    """Motion and force curve of a case."""
    try:
        result = asperity.solve(case, critical=critical, beside=False)
    except FAILURES as error:
        return failed(error)
    out = empty()
    ledger = {**result.ledger}
    out["bounds"]["ledger.energy_balance_error"] = number(ledger.pop("energy_balance_error"))
    _sort(out, "measures", result.measures)
    _sort(out, "regime", result.regime)
    _sort(out, "ledger", ledger)
    for name, events in result.events.items():
        out["values"][f"events.{name}"] = _sampled(events)
    out["values"]["end.time"] = number(result.time[-1])
    for name, energy in result.energies.items():
        out["values"][f"largest.energies.{name}"] = number(np.max(np.abs(energy)))
    for name, force in result.forces.items():
        out["values"][f"largest.forces.{name}"] = number(np.max(np.abs(force)))
    out["values"]["smallest.separation"] = number(np.min(result.separation))
    out["values"]["smallest.central_separation"] = number(np.min(result.central_separation))
    out["exact"]["outcome"] = result.outcome.value
    out["exact"]["impacts"] = len(result.measures["restitution"])
    out["sentences"]["warnings"] = sorted(sentence(text) for text in result.warnings)
    _curve(out, case)
    return out


def _curve(out: Answer, case: asperity.Case) -> None:
    """Add the force curve of a case to an answer."""
    try:
        curve = asperity.curve(case)
    except FAILURES as error:
        out["exact"]["curve.error"] = type(error).__name__
        return
    separation = np.asarray(curve.rigid_separation)
    order = np.argsort(separation, kind="stable")
    near, far = separation[order[0]], separation[order[-1]]
    places = near + np.asarray(PLACES) * (far - near)
    for name, drawn in (
        ("force_loading", curve.force_loading),
        ("force_unloading", curve.force_unloading),
        ("central_separation", curve.central_separation),
    ):
        known = np.asarray(drawn)[order]
        sampled = np.interp(places, separation[order], known)
        out["values"][f"curve.{name}"] = [number(value) for value in sampled]
    out["values"]["curve.rigid_separation"] = [number(value) for value in (near, far)]
    scalars = {
        "minimum_separation": curve.minimum_separation,
        "pull_off": curve.pull_off,
        "pull_off_separation": curve.pull_off_separation,
        "work_of_separation": curve.work_of_separation,
        "preload": curve.preload,
        "loss": curve.loss,
    }
    _sort(out, "curve", scalars)
    out["sentences"]["curve.warnings"] = sorted(sentence(text) for text in curve.warnings)


def sweep(
    case: asperity.Case, axes: Mapping[str, list[float]], *, critical: bool
) -> dict[str, Answer]:
    """Answers of a study's cases, by the numbers of their values along the axes, in their order."""
    keep = (*KEPT, CRITICAL) if critical else KEPT
    try:
        found = asperity.sweep(case, axes, keep=keep, impacts=IMPACTS)
    except FAILURES as error:
        return {"study": failed(error)}
    whole = empty()
    whole["sentences"]["warnings"] = sorted({sentence(text) for text in found.attrs["warnings"]})
    whole["exact"]["failed"] = int(found.attrs["failed"])
    out = {"study": whole}
    ends = found["outcome"].attrs["flag_meanings"].split()
    for place in np.ndindex(*(len(values) for values in axes.values())):
        answer = out["study-" + "-".join(map(str, place))] = empty()
        for name, column in found.data_vars.items():
            value = column.values[place]
            if name == "outcome":
                answer["exact"]["outcome"] = ends[int(value)]
            elif name == "reason":
                answer["sentences"]["reason"] = sentence(str(value))
            elif name == "energy_balance_error":
                answer["bounds"]["energy_balance_error"] = number(value)
            elif np.issubdtype(column.dtype, np.integer):
                answer["exact"][name] = int(value)
            elif np.any(np.isfinite(value)):
                answer["values"][name] = _sampled(value) if np.ndim(value) else number(value)
    return out


def publication(change: Change) -> Answer:
    """The publication's numbers, with changed surfaces where there is a change."""
    rows = _reproduced(None).rows
    made = _reproduced(change.table(rows))
    out = empty()
    for row in made.rows:
        nm = [f"{row[key] * 1e9:.4g}" for key in ("asperity_radius", "rms_height")]
        name = ".".join((f"table-{row['table']}", *nm, row["quantity"])).replace(" ", "")
        out["values"][name] = number(row["computed"])
    _sort(out, "found", made.found)
    return out


def _reproduced(tables: str | None) -> asperity.Reproduction:
    """The tables alone, without audit and figures."""
    stop = threading.Event()
    return asperity.reproduce(tables=tables, stop=stop, keep=lambda _: stop.set())


def number(value: Any) -> Any:
    """A number as JSON can hold it: None of what is not a number, text of an infinite one."""
    if value is None:
        return None
    value = float(value)
    if math.isnan(value):
        return None
    return value if math.isfinite(value) else str(value)


def _sampled(values: Any) -> list[Any]:
    """Numbers of a list, of a long one some."""
    known = [number(value) for value in np.ravel(np.asarray(values, dtype=float))]
    if len(known) <= SAMPLES:
        return known
    return [known[round(i * (len(known) - 1) / (SAMPLES - 1))] for i in range(SAMPLES)]


def _sort(out: Answer, prefix: str, quantities: Mapping[str, Any]) -> None:
    """Add quantities to an answer, each to its kind."""
    for key, value in quantities.items():
        name = f"{prefix}.{key}"
        if isinstance(value, Mapping):
            _sort(out, name, value)
        elif isinstance(value, bool) or (isinstance(value, int) and value == int(value)):
            out["exact"][name] = value
        elif isinstance(value, str):
            kind = "sentences" if " " in value else "exact"
            out[kind][name] = sentence(value) if kind == "sentences" else value
        elif isinstance(value, list | tuple | np.ndarray):
            if all(each is None or isinstance(each, int | float) for each in value):
                out["values"][name] = _sampled([np.nan if v is None else v for v in value])
        else:
            out["values"][name] = number(value)

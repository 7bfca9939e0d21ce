"""A result as the page shows it: numbers in SI, arrays packed, words."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from asperity.regimes import Frame, Place, region
from asperity.results.colours import colour
from asperity.results.contact_window import contact_window
from asperity.results.record_layout import json_object, plain
from asperity.results.result import Curve, Result
from asperity.results.verdict import sentence

if TYPE_CHECKING:
    from asperity.sweeps.capture_probability import CaptureProbability

DRAWN = 12
"""Impacts whose course the page draws."""

_SWING = 30
"""Points drawn while something goes once through its whole range; all of the first contact's."""


def answer(
    result: Result, curve: Curve, bodies: tuple[np.ndarray, CaptureProbability] | None = None
) -> dict[str, Any]:
    """All that the page shows of a case.

    Parameters
    ----------
    result, curve
        Motion and force curve of the case.
    bodies
        Speeds [m/s], and what its single bodies do there.

    Returns
    -------
    Plain values; arrays are packed by :func:`packed`, all of one length within a part.
    """
    contact = contact_window(result) or (0.0, float(result.events["apex_time"][0]))
    parts = {"forces": result.forces, "energies": result.energies}
    seen = _seen(result, contact)
    return {
        **json_object(result),
        "name": result.name,
        "message": result.outcome.message,
        "verdict": sentence(result),
        "motion": {
            **{
                name: packed(getattr(result, name)[seen])
                for name in ("time", "separation", "central_separation", "speed")
            },
            **{
                part: {name: packed(values[seen]) for name, values in series.items()}
                for part, series in parts.items()
            },
            "impacts": int(np.size(result.events["apex_time"])),
            "drawn": _drawn(result),
            "first_contact": list(contact),
        },
        "curve": {
            "separation": packed(curve.rigid_separation),
            "loading": packed(curve.force_loading),
            "unloading": packed(curve.force_unloading),
            **{
                name: plain(getattr(curve, name))
                for name in (
                    "minimum_separation",
                    "pull_off",
                    "work_of_separation",
                    "preload",
                    "loss",
                )
            },
        },
        "capture": None if bodies is None else _capture(*bodies),
        "place": _place(result),
        "colours": {name: colour(name) for name in _names(result)},
    }


def _capture(speed: np.ndarray, found: CaptureProbability) -> dict[str, Any]:
    """What single bodies do against speed: the captured share, and quantiles of restitution."""
    series = {"speed": speed, "share": found.probability, "low": found.low, "high": found.high}
    series |= zip(("lowest", "median", "highest"), found.restitution.T, strict=True)
    return {
        "bodies": found.bodies,
        "half_velocity": found.half_velocity,
        "half_interval": list(found.half_interval),
        **{name: packed(values) for name, values in series.items()},
    }


def packed(values: np.ndarray) -> str:
    """Numbers as base64 of little-endian 32-bit floats: what a screen can show, and no more."""
    return base64.b64encode(np.asarray(values, "<f4").tobytes()).decode("ascii")


def _names(result: Result) -> list[str]:
    return [*result.forces, *result.energies, *(f"lost_{name}" for name in result.ledger["lost"])]


def _drawn(result: Result) -> int:
    """Impacts up to whose last apex the motion is drawn."""
    last = result.time[-1] * (1.0 + 1e-9)  # the time of a sample is summed up in another order
    return int(np.sum(np.asarray(result.events["apex_time"]) <= last))


def _seen(result: Result, contact: Sequence[float]) -> np.ndarray:
    """Indices of the samples that a picture of the whole needs, and of all in the first contact.

    Ends, what turns, both sides of jumps, and in between a sample for each share of a range that
    anything goes through; of the separation, of that between two turns.
    """
    series = np.nan_to_num([result.separation, result.speed, *result.forces.values()])
    steps, count = np.diff(series, axis=1), result.time.size
    if count < 3:
        return np.arange(count)
    turns = np.zeros(series.shape, bool)
    turns[:, 1:-1] = steps[:, 1:] * steps[:, :-1] < 0.0
    span = np.repeat(np.ptp(series, axis=1, keepdims=True), count - 1, axis=1)
    swings = np.append(0, np.flatnonzero(turns[0]))
    span[0] = np.repeat(np.abs(np.add.reduceat(steps[0], swings)), np.diff([*swings, count - 1]))
    moved = np.max(np.abs(steps) / np.where(span > 0.0, span, np.inf), axis=0)
    gone = np.concatenate([[0.0], np.cumsum(moved)])
    kept = np.diff(np.floor(gone * _SWING), prepend=-1.0) > 0.0
    kept[:-1] |= moved * _SWING > 1.0
    kept |= np.any(turns, axis=0)
    kept |= (contact[0] <= result.time) & (result.time <= contact[1])
    kept[[0, -1]] = True
    found: np.ndarray = np.flatnonzero(kept)
    return found


def _place(result: Result) -> dict[str, Any] | None:
    """Where the case lies on the adhesion map; None where it has no place there."""
    elasticity, load = (result.regime[key] for key in ("elasticity_parameter", "load_parameter"))
    if elasticity is None or load is None:
        return None
    return {"elasticity": elasticity, "load": load, "region": region(elasticity, load)}


def adhesion_map() -> dict[str, Any]:
    """The lines of the adhesion map over its usual frame; arrays packed, NaN where none."""
    frame = Frame.around([Place("", 1.0, 1.0)])
    return {
        "elasticity": list(frame.elasticity),
        "load": list(frame.load),
        "lines": [
            {
                "between": list(line.between),
                "elasticity": packed(line.elasticity),
                "load": packed(line.load),
            }
            for line in frame.boundaries()
        ],
    }

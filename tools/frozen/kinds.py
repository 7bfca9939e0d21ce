"""What a structure is, and what structures are made of: changes of a case, ranges to draw from."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
MEASURED = str(ROOT / "examples" / "measured-surface.toml")
SPHERE = str(ROOT / "examples" / "jkr-bounce.toml")

Changes = dict[str, Any]
Ranges = dict[str, tuple[float, float]]


@dataclass(frozen=True)
class Structure:
    """A kind of case.

    Attributes
    ----------
    name
        What it is called.
    base
        Name or path of the case that it is made of; "publication" is the reproduction's tables.
    changes
        What is changed in it, by dotted keys.
    ranges
        What is drawn, by dotted keys in SI, each between two values, evenly in its logarithm.
    runs
        How many cases are drawn and run, each with its force curve.
    study
        How many of the drawn keys, the first by name, are the axes of a study of two values each;
        0 for no study.
    critical
        Whether the critical velocity is sought.
    """

    name: str
    base: str
    changes: Changes = field(default_factory=dict)
    ranges: Ranges = field(default_factory=dict)
    runs: int = 2
    study: int = 0
    critical: bool = False


DRY: Changes = {"capillary": None}
NO_WEIGHT: Changes = {"impact.gravity": 0.0}
FAST: Changes = {"impact.release_separation": None, **NO_WEIGHT}
FEW: Changes = {"numerics.max_impacts": 4}
BULK: Changes = {
    "counterface.deformation": "half-space",
    "numerics.rings": 32,
    "numerics.max_impacts": 2,
}
SMOOTH: Changes = {"impact.gravity": 9.81, "impact.release_separation": 2e-6, **FEW}

DROP: Ranges = {
    "impact.release_separation": (3e-7, 3e-6),
    "roughness.rms_height": (1.2e-9, 2.5e-9),
    "body.radius": (2e-5, 8e-5),
    "roughness.asperity_radius": (2e-7, 6e-7),
}
WORK: Ranges = {"adhesion.work": (0.01, 0.08)}
AIR: Ranges = {"capillary.humidity": (0.35, 0.8)}
SPEED: Ranges = {"impact.speed": (2e-3, 2e-2)}
TIP: Ranges = {"roughness.rms_height": (1.2e-9, 2.5e-9), "roughness.asperity_radius": (2e-7, 6e-7)}


def adhesion(model: str) -> Changes:
    """A law of dry adhesion in place of the base's."""
    if model == "none":
        return {"adhesion": None}
    return {"adhesion": {"model": model, "work": 0.03, "equilibrium_spacing": 2e-10}}


def drawn_work(model: str) -> Ranges:
    """Range of the work of adhesion, where there is any."""
    return {} if model == "none" else WORK


def water(model: str, formation: str = "on-contact", **keys: Any) -> Changes:
    """Menisci in place of the base's."""
    table = {
        "model": model,
        "formation": formation,
        "liquid": "water",
        "humidity": 0.6,
        "temperature": 293.15,
        "contact_angle": 0.5,
    }
    return {"capillary": {**table, **keys}}

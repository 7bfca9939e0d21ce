"""The structures of the frozen set."""

from __future__ import annotations

from dataclasses import replace

from .forces import laws, liquids, yielding
from .kinds import (
    AIR,
    BULK,
    DROP,
    DRY,
    FAST,
    FEW,
    MEASURED,
    ROOT,
    SPEED,
    SPHERE,
    TIP,
    WORK,
    Structure,
    adhesion,
    water,
)

STUDIED = frozenset(
    {
        "rough-rigid-dmt",
        "rough-rigid-maugis",
        "rough-bulk-dmt",
        "smooth-dmt",
        "smooth-jkr",
        "rough-rigid-equilibrium-contact",
        "rough-rigid-equilibrium-kelvin",
        "rough-rigid-constant-volume-contact",
        "rough-rigid-kelvin-filling-contact",
        "rough-bulk-equilibrium-contact",
        "smooth-equilibrium-contact",
        "rough-rigid-kogut-etsion-wet",
        "smooth-thornton-ning-jkr-wet",
        "rough-rigid-gas-wet",
        "rough-rigid-waves",
        "measured-summits-dmt",
    }
)
"""Structures that are computed by a study too."""


def _rates() -> list[Structure]:
    """Gas, waves, bulks that relax and menisci that take time."""
    air = {"gas": {"name": "air", "pressure": 101325.0, "temperature": 293.15}}
    thick = {"gas": {"viscosity": 1.8e-5, "slip_length": 7e-8, "cutoff_separation": 2e-9}}
    close = {"impact.release_separation": 2e-7, "impact.speed": 6e-3}
    gust = {"impact.speed": (4e-3, 1.5e-2), "gas.pressure": (3e4, 1.5e5), **TIP}
    waves = {"waves": {"model": "hunter"}}
    creep = {
        "viscoelasticity": {
            "model": "standard-linear-solid",
            "relaxed_modulus_ratio": 0.4,
            "relaxation_time": 5e-7,
        }
    }
    relaxing = {
        "viscoelasticity.relaxation_time": (1e-7, 2e-6),
        "viscoelasticity.relaxed_modulus_ratio": (0.2, 0.8),
    }
    late = {"capillary.formation_time": (3e-7, 1e-4)}
    soft = {"roughness.asperity_density": 1e13, "roughness.asperity_radius": 1e-7}
    rough = {**soft, "roughness.rms_height": 5e-9, "numerics.rings": 24, "numerics.max_impacts": 1}
    on_rings = {**BULK, "numerics.rings": 24, "numerics.max_impacts": 1}
    made = [
        ("rough-rigid-gas-wet", "glass-bead", {**air, **close}, gust),
        ("rough-rigid-gas-dry", "glass-bead", {**air, **close, **DRY, **FEW}, gust),
        ("rough-bulk-gas", "glass-bead", {**air, **close, **BULK}, gust),
        (
            "smooth-gas",
            SPHERE,
            {**thick, **FEW, "impact.release_separation": 2e-7},
            {"impact.speed": (0.1, 0.5), "gas.slip_length": (3e-8, 1e-7)},
        ),
        ("rough-rigid-waves", "glass-bead", {**waves}, {**SPEED, **AIR, **TIP}),
        (
            "smooth-waves-jkr",
            SPHERE,
            {**waves, **FEW},
            {"impact.speed": (0.1, 2.0), "adhesion.work": (0.03, 0.1)},
        ),
        ("rough-rigid-waves-gas", "glass-bead", {**waves, **air, **close}, gust),
        (
            "smooth-creep",
            SPHERE,
            {**adhesion("none"), **creep, **FEW},
            {"impact.speed": (0.05, 0.5), **relaxing},
        ),
        (
            "rough-creep-dry",
            SPHERE,
            {**adhesion("none"), **creep, **rough},
            {"impact.speed": (0.02, 0.2), **relaxing},
        ),
        (
            "rough-creep-wet",
            SPHERE,
            {**adhesion("dmt"), **water("equilibrium"), **creep, **rough},
            {"impact.speed": (0.02, 0.2), **relaxing},
        ),
        ("rough-rigid-late", "glass-bead", {**FEW}, {**late, **DROP}),
        ("rough-bulk-late", "glass-bead", {**FAST, **on_rings}, {**late, **SPEED}),
        (
            "smooth-late",
            SPHERE,
            {**adhesion("dmt"), **water("equilibrium"), **FEW},
            {**late, "impact.speed": (0.05, 0.5)},
        ),
    ]
    slow = ("rough-creep-dry", "rough-creep-wet", "rough-bulk-late")
    return [Structure(n, b, c, r, runs=1 if n in slow else 2) for n, b, c, r in made]


def _measured() -> list[Structure]:
    """Both uses of measured surfaces."""
    drawn = {"impact.release_separation": (5e-7, 3e-6), **AIR, "body.radius": (2e-5, 8e-5)}
    made = [
        ("summits-dmt", {**FEW}, drawn),
        ("summits-jkr", {**adhesion("jkr"), **FEW}, drawn),
        ("summits-maugis-dry", {**adhesion("maugis"), **DRY, **FEW}, {**WORK, **drawn}),
        ("gaussian-fit", {"roughness.source": "gaussian", **FEW}, drawn),
        (
            "summits-bulk",
            {**BULK, **FAST, "impact.speed": 0.01},
            {**SPEED, **AIR},
        ),
    ]
    out = []
    for name, changes, ranges in made:
        dry = "capillary" in changes
        known = {k: v for k, v in ranges.items() if not (dry and k in AIR)}
        out.append(Structure(f"measured-{name}", MEASURED, changes, known))
    return out


def structures() -> list[Structure]:
    """All of them: the publication, examples, built-in cases, and structures of drawn cases."""
    own = {"runs": 1, "critical": True}
    out = [Structure("publication", "publication")]
    out += [
        Structure(f"example-{path.stem}", str(path), **own)
        for path in sorted((ROOT / "examples").glob("*.toml"))
    ]
    out += [
        Structure(f"built-in-{name}", name, **own)
        for name in ("glass-bead", "published", "published-exact")
    ]
    out += [*laws(), *liquids(), *yielding(), *_rates(), *_measured()]
    studied = [each for each in out if each.name in STUDIED]
    return [*out, *(replace(s, name=f"study-{s.name}", runs=0, study=2) for s in studied)]

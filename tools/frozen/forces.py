"""Structures of laws, liquids and yield: what acts between the surfaces."""

from __future__ import annotations

from .kinds import (
    AIR,
    BULK,
    DROP,
    DRY,
    FAST,
    FEW,
    SPEED,
    SPHERE,
    TIP,
    WORK,
    Structure,
    adhesion,
    drawn_work,
    water,
)


def laws() -> list[Structure]:
    """Each law of adhesion: rough on a rigid and on an elastic bulk, and a smooth sphere."""
    out = [
        Structure(
            f"rough-rigid-{law}",
            "glass-bead",
            {**DRY, **adhesion(law), **FEW},
            {**drawn_work(law), **DROP},
            critical=law == "maugis",
        )
        for law in ("none", "dmt", "maugis", "jkr", "auto")
    ]
    out.append(  # whose force reaches too far for a release by gap
        Structure(
            "rough-rigid-bradley",
            "glass-bead",
            {**DRY, **adhesion("bradley"), **FAST, "impact.speed": 0.01, **FEW},
            {**SPEED, **WORK, **TIP},
        )
    )
    out += [
        Structure(
            f"rough-bulk-{law}",
            "glass-bead",
            {**DRY, **adhesion(law), **FAST, **BULK},
            {**SPEED, **drawn_work(law), **TIP},
        )
        for law in ("none", "dmt", "maugis", "jkr")
    ]
    out += [
        Structure(
            f"smooth-{law}",
            SPHERE,
            {**adhesion(law), **FEW, "impact.speed": 0.1},
            {"impact.speed": (0.05, 0.5), **drawn_work(law), "body.radius": (5e-6, 2e-5)},
            critical=law == "jkr",
        )
        for law in ("none", "bradley", "dmt", "maugis", "jkr")
    ]
    return out


_FORMATIONS = {"on-contact": "contact", "capillary-condensation": "kelvin"}


def liquids() -> list[Structure]:
    """Each liquid and formation: rough on a rigid and on an elastic bulk, and a smooth sphere."""
    ways = [
        ("equilibrium", "on-contact"),
        ("equilibrium", "capillary-condensation"),
        ("constant-volume", "on-contact"),
        ("constant-volume", "capillary-condensation"),
        ("kelvin-filling", "on-contact"),
        ("kelvin-filling", "capillary-condensation"),
    ]
    out = []
    for model, formation in ways:
        rms = {"surface_rms_height": 2e-9} if model == "kelvin-filling" else {}
        liquid = water(model, formation, **rms)
        name = f"{model}-{_FORMATIONS[formation]}"
        out.append(
            Structure(
                f"rough-rigid-{name}",
                "glass-bead",
                {**adhesion("dmt"), **liquid},
                {**AIR, **DROP},
                critical=name == "kelvin-filling-contact",
            )
        )
        if name not in ("constant-volume-kelvin", "kelvin-filling-kelvin"):
            out.append(
                Structure(
                    f"rough-bulk-{name}",
                    "glass-bead",
                    {**adhesion("dmt"), **liquid, **FAST, **BULK},
                    {**SPEED, **AIR, **TIP},
                )
            )
        if name not in ("constant-volume-kelvin", "kelvin-filling-kelvin"):
            out.append(
                Structure(
                    f"smooth-{name}",
                    SPHERE,
                    {**adhesion("dmt"), **water(model, formation), **FEW},
                    {"impact.speed": (0.05, 0.5), **AIR, **WORK},
                )
            )
    thin = water("equilibrium", humidity=1.0, adsorbed_film_thickness=5e-10, tension=0.06)
    drawn = {"capillary.adsorbed_film_thickness": (3e-10, 9e-10), **DROP}
    out.append(Structure("rough-rigid-film-jkr", "glass-bead", {**adhesion("jkr"), **thin}, drawn))
    return out


def yielding() -> list[Structure]:
    """Each law of yielding: rough, dry and wet, and smooth, with what may pull beside it."""
    sharp = {"roughness.asperity_density": 3.75e14, "roughness.rms_height": 2e-9, **FEW}
    start = {"impact.release_separation": 1e-7, "impact.speed": 0.01}
    drawn = {
        "impact.speed": (5e-3, 2e-2),
        "roughness.asperity_radius": (5e-8, 9e-8),
        "plasticity.hardness": (4e9, 9e9),
    }
    out = [
        Structure(
            f"rough-rigid-{law}-{'wet' if wet else 'dry'}",
            "glass-bead",
            {
                **sharp,
                **start,
                **adhesion("dmt" if wet else "none"),
                **(water("equilibrium") if wet else DRY),
                "plasticity": {"model": law, "hardness": 6e9},
            },
            drawn,
        )
        for law in ("kogut-etsion", "jackson-green", "thornton-ning")
        for wet in (True, False)
        if wet or law == "kogut-etsion"
    ]
    for law, pull, wet in (
        ("kogut-etsion", "none", False),
        ("jackson-green", "dmt", True),
        ("thornton-ning", "dmt", False),
        ("thornton-ning", "jkr", True),
    ):
        out.append(
            Structure(
                f"smooth-{law}-{pull}-{'wet' if wet else 'dry'}",
                SPHERE,
                {
                    **adhesion(pull),
                    **(water("equilibrium") if wet else {}),
                    **FEW,
                    "plasticity": {"model": law, "yield_strength": 5e7},
                },
                {
                    "impact.speed": (0.5, 5.0),
                    "plasticity.yield_strength": (4e7, 9e7),
                    **drawn_work(pull),
                },
            )
        )
    return out

"""Published pull-off forces of single bodies: their level where few asperities hold, their scatter.

Each body stands on summits of its own, drawn at random; no factor is fitted.
"""

from functools import cache
from math import pi

import numpy as np

from asperity._jax import jnp
from asperity.contact.asperity_table import asperity_table
from asperity.dynamics import Body
from asperity.dynamics.single_impact import single_impacts
from asperity.dynamics.summit_path import Launch
from asperity.interface.summit_field import GaussianField
from asperity.laws import Bradley, Hertz, Maugis
from asperity.laws.law import Law, Sum
from asperity.materials.solids import SOLIDS, contact_modulus
from measured import PRODUCT, SPACINGS, Comparison

BODIES = 64
_PRESSED = 40.0  # times w tip spacing: on how many summits bonds form; nothing without bonds
_WORK = 0.1  # J/m^2


def pull_offs(law: Law, tip: float, radius: float, rms: float, summits: int) -> np.ndarray:
    """Pull-off forces [N] of bodies that were pressed on, each on its highest summits."""
    field = GaussianField(radius, PRODUCT / (rms * tip), rms)
    offsets = field.summits(0, 0, summits)[0][:BODIES]
    energy = _PRESSED * pi * _WORK * tip * SPACINGS[0]
    launches = Launch(np.full(BODIES, energy), np.full(BODIES, np.inf))
    classes = jnp.zeros(offsets.shape, jnp.int32)
    table = asperity_table([law], 4.0 * energy)
    found = single_impacts(table, Body(1.0, 0.0, 0.0), launches, jnp.asarray(offsets), classes)
    assert np.all(np.isfinite(found.closest_approach))
    return np.asarray(found.pull_off)


def fall(tip: float, spacing: float) -> float:
    """How many times the median pull-off of alumina probes of 10 um falls, 1.5 to 12 nm rms.

    Summits of 30 nm on the smooth plate attract across the gap in such numbers that 1024 of them
    leave out 6 to 11 %; less than 3 % elsewhere.
    """
    modulus = contact_modulus(SOLIDS["alumina"], SOLIDS["alumina"])
    law = Sum([Hertz(tip, modulus), Bradley(tip, _WORK, spacing)])
    smooth = np.median(pull_offs(law, tip, 10e-6, 1.5e-9, 1024 if tip < 100e-9 else 256))
    return float(smooth / np.median(pull_offs(law, tip, 10e-6, 12e-9, 256)))


@cache
def alumina_falls() -> dict[float, list[float]]:
    """That fall by tip radius [m], at each spacing."""
    return {tip: [fall(tip, spacing) for spacing in SPACINGS] for tip in (30e-9, 1e-6)}


def alumina() -> Comparison:
    falls = [one for some in alumina_falls().values() for one in some]
    return Comparison(
        "LAI1",
        "alumina probe on alumina: fall of the pull-off from 1.5 to 12.0 nm rms; single bodies",
        min(falls),
        max(falls),
        "median of 64 probes of 10 um (assumed), summit radius 30 nm to 1 um with rms x radius x "
        "density = 0.05, w 0.1 J/m^2, spacing 0.2 to 0.4 nm",
        "each probe is carried by summits of its own, and those beside them pull across the gap",
    )


@cache
def scatters() -> list[float]:
    """Pull-off that 95 % of bodies stay below over that of 5 %, polystyrene on gold."""
    modulus = contact_modulus(SOLIDS["polystyrene"], SOLIDS["gold"])
    found = []
    for tip, rms, radius in ((30e-9, 2e-9, 0.5e-6), (30e-9, 2e-9, 5e-6), (300e-9, 10e-9, 5e-6)):
        pulls = pull_offs(Maugis(tip, modulus, _WORK, 0.3e-9), tip, radius, rms, 256)
        low, high = np.quantile(pulls, [0.05, 0.95])
        found.append(float(high / low))
    return found


def pairs() -> Comparison:
    return Comparison(
        "AUP1",
        "pairs of polystyrene and gold spheres: spread of the pull-off; single bodies",
        min(scatters()),
        max(scatters()),
        "95 % over 5 % of 64 pairs, reduced radius 0.5 and 5 um, rms 2 nm with a summit radius of "
        "30 nm to rms 10 nm with 300 nm, w 0.1 J/m^2, spacing 0.3 nm",
        "where summits stand is random; roughness that differs from pair to pair is not in it",
    )


def bodies() -> list[Comparison]:
    return [alumina(), pairs()]

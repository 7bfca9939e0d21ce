"""Asperities beyond yield: how many they are, and what keeping them elastic would have said."""

from __future__ import annotations

import numpy as np

from .._jax import jax, jnp
from ..config import Case
from ..config.bodies import named
from ..config.plastic_law import plastic_contact
from ..config.plasticity import Plasticity
from ..errors import InputError
from ..laws.law import as_float64
from ..laws.plastic import KogutEtsion, PlasticContact
from ..materials.solids import Solid
from ..numerics.compilation import AT_ONCE, Program
from ..surfaces.heights import Gaussian

FITTED = 110.0
"""Overlap over that of yield up to which the laws were fitted."""

SHARE = 0.01
"""Share of the contacting asperities beyond yield from which it is said."""


def kept_elastic(case: Case, restitution: float, elastic: float | None) -> list[str]:
    """A line on what a case that yields would have returned, had nothing yielded.

    Parameters
    ----------
    case
        The case.
    restitution, elastic
        Restitution of its first impact, and of that without yielding where it is known.
    """
    if case.plasticity_model == "none" or elastic is None:
        return []
    found = f"{float(restitution):.3g}" if np.isfinite(restitution) else "nothing"
    without = "what the first impact would have returned could not be computed"
    if np.isfinite(elastic):
        without = f"the first impact would have returned e = {elastic:.5g}"
    return [f"without yielding {without}; with it ({case.plasticity_model}) it returns {found}"]


def yielded(case: Case, modulus: float, central: float) -> list[str]:
    """Lines on the share of contacting asperities that is beyond yield, and how far they are.

    And on what is taken to yield, or cannot be judged, where that is not known.

    Parameters
    ----------
    case
        The case.
    modulus
        Contact modulus E* [Pa].
    central
        Separation at the axis at closest approach [m].
    """
    beyond = _beyond(case, modulus, central)
    if beyond or case.plasticity_model != "none":
        return [*beyond, *_taken(case)]
    return _not_judged(case)


def _beyond(case: Case, modulus: float, central: float) -> list[str]:
    """Lines on asperities beyond yield, as for :func:`yielded`."""
    rough = case.asperities
    if rough is None or not case.has_strength:
        return []
    law = _law(case, rough.asperity_radius, modulus)
    heights = Gaussian(rough.rms_height, rough.mean_height)
    overlap, contacting, beyond, whole = (
        float(x) for x in _tails(law, heights, as_float64(central))
    )
    share = beyond / contacting if contacting > 0.0 else 0.0
    if share < SHARE:
        return []
    advice = ": [plasticity] lets them yield" if _could_yield(case) else ""
    out = [
        f"{100.0 * share:.3g} % of the contacting asperities are beyond yield at closest approach "
        f"(overlaps above {overlap * 1e9:.3g} nm, by {_model(case)}){advice}"
    ]
    mean, tip = whole / contacting, rough.asperity_radius
    if case.plasticity_model != "none" and mean > min(FITTED * overlap, tip):
        out.append(
            f"the mean overlap of contacting asperities, {mean * 1e9:.3g} nm, is "
            f"{mean / overlap:.3g} times that of yield and {mean / tip:.3g} tip radii: the laws "
            f"were fitted up to {FITTED:g} times, on tips much larger than the overlap"
        )
    return out


def _counted(
    law: PlasticContact, heights: Gaussian, central: jax.Array
) -> tuple[jax.Array, jax.Array, jax.Array, jax.Array]:
    """Overlap at yield [m], asperities that touch and that yield, and the former's overlaps."""
    overlap = jnp.asarray(law.yield_overlap)
    contacting, beyond = heights.tail(2, central), heights.tail(2, central + overlap)
    return overlap, contacting, beyond, heights.tail(3, central)


_tails = Program(_counted, AT_ONCE)


def _not_judged(case: Case) -> list[str]:
    """A line where the strength of a solid is not known, and nothing else says so.

    A solid that never yields leaves nothing to judge.
    """
    solids = {named(solid): solid for solid in (case.body_solid, case.counterface_solid)}
    known = {name: _judged(solid) for name, solid in solids.items() if not solid.never_yields}
    if all(known.values()):
        return []
    unknown = " and ".join(name for name, knows in known.items() if not knows)
    if any(known.values()):
        judge = next(name for name, knows in known.items() if knows)
        return [
            f"yielding was judged by {judge} alone: no hardness or yield strength of {unknown} is "
            "known"
        ]
    return [f"yielding not judged: no hardness or yield strength of {unknown} is known"]


def _judged(solid: Solid) -> bool:
    """Whether the strength of a solid is known."""
    return solid.hardness is not None or solid.yield_strength is not None


def _taken(case: Case) -> list[str]:
    """A line where one solid counts as the softer because nothing is known of the other."""
    table, solids = case.plasticity, (case.body_solid, case.counterface_solid)
    if table and (table.hardness or table.yield_strength or table.yield_pressure):
        return []
    known = [_judged(solid) for solid in solids]
    if all(known) or not any(known) or any(solid.never_yields for solid in solids):
        return []
    softer, other = (solids[known.index(knows)].name for knows in (True, False))
    return [
        f"{softer} is taken to be the softer solid, which yields: neither hardness nor yield "
        f"strength of {other} is known, and were it softer the contact would yield sooner"
    ]


def _model(case: Case) -> str:
    """Name of the law in use, or of the one by which the share is told where nothing yields."""
    return "kogut-etsion" if case.plasticity_model == "none" else case.plasticity_model


def _law(case: Case, tip: float, modulus: float) -> PlasticContact:
    """The law in use, or Kogut and Etsion's where nothing yields."""
    if case.plasticity_model != "none":
        return plastic_contact(case, tip, modulus)
    soft = case.yielding
    return KogutEtsion(tip, modulus, soft.hardness, soft.poisson)


def _could_yield(case: Case) -> bool:
    """Whether a [plasticity] table would be taken by a case that has none."""
    if case.plasticity_model != "none":
        return False
    table = Plasticity(model="kogut-etsion")
    try:
        table.refuse_beside(case.adhesion, case.capillary, case.roughness, case.publication)
        table.refuse_under(case.counterface, case.roughness)
    except InputError:
        return False
    return True

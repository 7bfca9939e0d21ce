"""Asperities beyond yield: how many they are, and what keeping them elastic would have said."""

from __future__ import annotations

import numpy as np

from ..asperity_laws import plastic_law
from ..inputs import Inputs
from ..materials.solids import Solid, named
from .model_domain import tails

FITTED = 110.0
"""Overlap over that of yield up to which the laws were fitted."""

SHARE = 0.01
"""Share of the contacting asperities beyond yield from which it is said."""


def kept_elastic(inputs: Inputs, restitution: float, elastic: float | None) -> list[str]:
    """A line on what a case that yields would have returned, had nothing yielded.

    Parameters
    ----------
    inputs
        The quantities of a case.
    restitution, elastic
        Restitution of its first impact, and of that without yielding where it is known.
    """
    if not inputs.yields or elastic is None:
        return []
    found = f"{float(restitution):.3g}" if np.isfinite(restitution) else "nothing"
    without = "what the first impact would have returned could not be computed"
    if np.isfinite(elastic):
        without = f"the first impact would have returned e = {elastic:.5g}"
    return [
        f"without yielding {without}; with it ({inputs.structure.plasticity}) it returns {found}"
    ]


def yielded(inputs: Inputs, central: float) -> list[str]:
    """Lines on the share of contacting asperities that is beyond yield, and how far they are.

    And on what is taken to yield, or cannot be judged, where that is not known.

    Parameters
    ----------
    inputs
        The quantities of a case.
    central
        Separation at the axis at closest approach [m].
    """
    beyond = _beyond(inputs, central)
    if beyond or inputs.yields:
        return [*beyond, *_taken(inputs)]
    return _not_judged(inputs)


def _beyond(inputs: Inputs, central: float) -> list[str]:
    """Lines on asperities beyond yield, as for :func:`yielded`."""
    rough = inputs.asperities
    if rough is None or inputs.yielding is None:
        return []
    # Where nothing yields, the share is told by Kogut and Etsion's law.
    name = inputs.structure.plasticity if inputs.yields else "kogut-etsion"
    overlap = float(plastic_law(inputs, name).yield_overlap)
    _, contacting, whole = tails(rough, central)
    _, beyond, _ = tails(rough, central + overlap)
    share = beyond / contacting if contacting > 0.0 else 0.0
    if share < SHARE:
        return []
    advice = ": [plasticity] lets them yield" * (inputs.plasticity_allowed and not inputs.yields)
    out = [
        f"{100.0 * share:.3g} % of the contacting asperities are beyond yield at closest approach "
        f"(overlaps above {overlap * 1e9:.3g} nm, by {name}){advice}"
    ]
    mean, tip = whole / contacting, rough.asperity_radius
    if inputs.yields and mean > min(FITTED * overlap, tip):
        out.append(
            f"the mean overlap of contacting asperities, {mean * 1e9:.3g} nm, is "
            f"{mean / overlap:.3g} times that of yield and {mean / tip:.3g} tip radii: the laws "
            f"were fitted up to {FITTED:g} times, on tips much larger than the overlap"
        )
    return out


def _not_judged(inputs: Inputs) -> list[str]:
    """A line where the strength of a solid is not known, and nothing else says so.

    A solid that never yields leaves nothing to judge.
    """
    solids = {named(solid): solid for solid in (inputs.body, inputs.counterface)}
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


def _taken(inputs: Inputs) -> list[str]:
    """A line where one solid counts as the softer because nothing is known of the other."""
    solids = (inputs.body, inputs.counterface)
    if inputs.strength_given:
        return []
    known = [_judged(solid) for solid in solids]
    if all(known) or not any(known) or any(solid.never_yields for solid in solids):
        return []
    softer, other = (solids[known.index(knows)].name for knows in (True, False))
    return [
        f"{softer} is taken to be the softer solid, which yields: neither hardness nor yield "
        f"strength of {other} is known, and were it softer the contact would yield sooner"
    ]

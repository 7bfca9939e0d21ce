"""Summits under single bodies: of the distribution of a case, or of its map."""

from __future__ import annotations

from math import exp, log
from typing import Any, NamedTuple

import numpy as np

from ..asperity_laws import asperity_law, laws_beside, plastic_law
from ..errors import InputError
from ..inputs import Inputs, Placement
from ..integration.batch_motion import RELEASE_KEY
from ..interface.radius_classes import members
from ..interface.summit_field import GaussianField, MeasuredField, SampledField, SummitField
from ..laws.law import Law, Sum
from ..laws.plastic import PlasticContact


class Placed(NamedTuple):
    """The summits of a case.

    Attributes
    ----------
    field
        Where they are.
    tips
        Tip radius [m] of each class of them.
    laws
        The laws of each class; of tips that yield, those beside their contact.
    contacts
        That contact of each class; none of elastic tips.
    """

    field: SummitField
    tips: list[float]
    laws: list[Law]
    contacts: list[PlasticContact]


def place_summits(inputs: Inputs, placed: Placement, lowest: float) -> Placed:
    """The summits of a case, by class of tip radius.

    Parameters
    ----------
    inputs
        The quantities of a case with single bodies.
    placed
        Where they are to stand.
    lowest
        Offset [m] of a summit that is just within range of a body.

    Raises
    ------
    InputError
        If a map is smaller than the summits within range of a body spread, or most bodies have no
        summit under them.
    """
    rough = inputs.asperities
    assert rough is not None
    radius, density = inputs.radius, rough.asperity_density
    if rough.summits is None or not (placed.measured or inputs.structure.heights == "summits"):
        gaussian = GaussianField(radius, density, rough.rms_height, rough.mean_height)
        return _of_classes(gaussian, inputs, [rough.asperity_radius])
    found = rough.summits
    order = np.argsort(-found.heights, kind="stable")
    classes = np.zeros(found.count, np.int32)
    tips = []
    for number, chosen in enumerate(members(found.radii, inputs.radius_classes)):
        classes[chosen] = number
        tips.append(float(found.radii[chosen].mean()))
    heights, classes = found.heights[order], classes[order]
    if not placed.measured:
        sampled = SampledField(radius, density, heights, classes)
        return _of_classes(sampled, inputs, tips, float(found.radii.min()))
    rows, columns = found.positions[order].T
    positions = np.stack([columns * found.pixel_size[0], rows * found.pixel_size[1]], axis=1)
    assert rough.surface is not None
    within = _positions(rough.surface.physical_size, (2.0 * radius * (heights[0] - lowest)) ** 0.5)
    field = MeasuredField(radius, density, heights, classes, positions, within)
    return _of_classes(field, inputs, tips, float(found.radii.min()))


def _of_classes(
    field: SummitField, inputs: Inputs, tips: list[float], smallest: float | None = None
) -> Placed:
    """With the laws of each tip radius [m], the smallest of all being that [m]."""
    assert inputs.asperities is not None
    _refuse_bare(field, measured=inputs.asperities.summits is not None)
    if not inputs.yields:
        return Placed(field, tips, [asperity_law(inputs, tip, smallest) for tip in tips], [])
    laws: list[Law] = [Sum(laws_beside(inputs, tip, smallest)) for tip in tips]
    contacts = [plastic_law(inputs, inputs.structure.plasticity, tip) for tip in tips]
    return Placed(field, tips, laws, contacts)


def _positions(size: tuple[float, float], away: float) -> np.ndarray:
    """Where the axis of a body may lie on a map [m]: summits within range are not beyond its edges.

    Raises
    ------
    InputError
        If there is no such position.
    """
    if min(size) <= 2.0 * away:
        raise InputError(
            "`placement` must be 'random' where the map is smaller than the summits within range "
            f"of a body spread, {2e6 * away:.3g} um; got one of {size[0] * 1e6:.3g} um x "
            f"{size[1] * 1e6:.3g} um",
            key="roughness.placement",
        )
    return np.array([[away, away], [size[0] - away, size[1] - away]])


def _refuse_bare(field: SummitField, *, measured: bool) -> None:
    """Refuse summits so few that most bodies would fall on the surface between them."""
    under = float(field.expected_above(field.base))
    if under < log(2.0):
        key = "placement" if measured else "asperity_density"
        raise InputError(
            f"single bodies need summits under them: of {field.density:.3g} 1/m^2 "
            f"{100 * exp(-under):.3g} % would meet none above {field.base * 1e9:.3g} nm, and fall "
            "on the surface between, which is not described; "
            f"{field.density * log(2.0) / under:.2g} 1/m^2 or more carry most",
            key=f"roughness.{key}",
        )


def refuse_inside(release: Any, highest: np.ndarray) -> None:
    """Refuse bodies that would be released [m] on a summit, by their highest offsets [m]."""
    inside = np.asarray(release) <= highest
    if np.any(inside):
        raise InputError(
            "`release_separation` must lie above the highest summit of every single body, that of "
            f"one at {np.max(highest[inside]) * 1e9:.4g} nm; got "
            f"{np.min(release[inside]) * 1e9:.4g} nm",
            key=RELEASE_KEY,
        )

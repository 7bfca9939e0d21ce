"""Summits under single bodies: of the distribution of a case, or of its map."""

from __future__ import annotations

import numpy as np

from ..asperity_laws import asperity_law, laws_beside
from ..errors import InputError
from ..inputs import Inputs
from ..interface.radius_classes import members
from ..interface.summit_field import GaussianField, MeasuredField, SampledField, SummitField
from ..laws.law import Law, Sum


def place_summits(inputs: Inputs, lowest: float) -> tuple[SummitField, list[Law], list[float]]:
    """The summits of a case, and by class of tip radius their laws and that radius [m].

    Of tips that yield, the laws beside their contact.

    Parameters
    ----------
    inputs
        The quantities of a case with single bodies.
    lowest
        Offset [m] of a summit that is just within range of a body.

    Raises
    ------
    InputError
        If a map is smaller than the summits within range of a body spread.
    """
    rough, placed = inputs.asperities, inputs.placement
    assert rough is not None
    assert placed is not None
    radius, density = inputs.radius, rough.asperity_density
    if rough.summits is None or not (placed.measured or inputs.structure.heights == "summits"):
        tip = rough.asperity_radius
        law = Sum(laws_beside(inputs, tip)) if inputs.yields else asperity_law(inputs, tip)
        field = GaussianField(radius, density, rough.rms_height, rough.mean_height)
        return field, [law], [tip]
    found = rough.summits
    order = np.argsort(-found.heights, kind="stable")
    classes = np.zeros(found.count, np.int32)
    laws, tips = [], []
    for number, chosen in enumerate(members(found.radii, inputs.radius_classes)):
        classes[chosen] = number
        tips.append(float(found.radii[chosen].mean()))
        laws.append(asperity_law(inputs, tips[-1], float(found.radii.min())))
    heights, classes = found.heights[order], classes[order]
    if not placed.measured:
        return SampledField(radius, density, heights, classes), laws, tips
    rows, columns = found.positions[order].T
    positions = np.stack([columns * found.pixel_size[0], rows * found.pixel_size[1]], axis=1)
    assert rough.surface is not None
    within = _positions(rough.surface.physical_size, (2.0 * radius * (heights[0] - lowest)) ** 0.5)
    return MeasuredField(radius, density, heights, classes, positions, within), laws, tips


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

"""Which law of adhesion one asperity obeys, from its Tabor number."""

from __future__ import annotations

from math import pi
from typing import NamedTuple

from .boundaries import SHARE
from .dimensionless_numbers import ELASTICITY_PER_TABOR

DMT_BELOW = 0.1
"""Tabor number below which adhesion leaves the shape of a contact alone; the publication's rule."""

JKR_ABOVE = 5.0
"""Tabor number above which the range of adhesion does not matter; the publication's rule."""

RIGID_BELOW = SHARE * 2.0 / (pi * 2.0 ** (2.0 / 3.0))
"""Elasticity parameter below which an unloaded sphere's own pull, 2 pi w R, compresses it by less
than 5 % of the range: the foot of the map's border between Bradley and DMT."""

BORDER_FACTOR = 1.5
"""How near to a border both laws deserve a look."""

LAW_NAMES = {
    "none": "none",
    "hertz": "Hertz",
    "bradley": "Bradley",
    "dmt": "DMT",
    "maugis": "Maugis-Dugdale",
    "jkr": "JKR",
    "lennard-jones": "Lennard-Jones",
}
"""The laws as they are called in text, by their names in a case."""


class AdhesionChoice(NamedTuple):
    """The law of adhesion in use.

    Attributes
    ----------
    law
        Its name, as in a case file.
    reason
        Why this one, in a line; None where the case names the law.
    border_warnings
        A warning for each border between two laws that is near.
    """

    law: str
    reason: str | None = None
    border_warnings: tuple[str, ...] = ()


class _Border(NamedTuple):
    below: str
    above: str
    elasticity: float
    rule: str


_BORDERS = (
    _Border("bradley", "dmt", RIGID_BELOW,
            f"an unloaded tip is compressed by {100 * SHARE:g} % of the range there"),
    _Border("dmt", "maugis", ELASTICITY_PER_TABOR * DMT_BELOW,
            f"the Tabor number is {DMT_BELOW:g} there"),
    _Border("maugis", "jkr", ELASTICITY_PER_TABOR * JKR_ABOVE,
            f"the Tabor number is {JKR_ABOVE:g} there"),
)  # fmt: skip


CHOSEN = (*(border.below for border in _BORDERS), _BORDERS[-1].above)
"""The laws among which :func:`choose_adhesion` chooses, by growing Tabor number."""


def choose_adhesion(tabor: float) -> AdhesionChoice:
    """The law that holds at a Tabor number.

    DMT below 0.1 and JKR above 5, as the publication has it after Johnson and Greenwood (1997),
    and Maugis-Dugdale between. Within the first, Bradley where the pull alone does not compress
    the tip: the foot of their map's border, where it is not loaded. The load takes no part: it
    says whether adhesion matters beside contact, not which law it obeys.

    Parameters
    ----------
    tabor
        Tabor number of one asperity, or of the smooth body; positive.
    """
    elasticity = ELASTICITY_PER_TABOR * tabor
    if elasticity < RIGID_BELOW:
        law, why = "bradley", "the pull does not compress the tip"
        rule = f"elasticity parameter {elasticity:.3g} < {RIGID_BELOW:.3g}"
    elif tabor < DMT_BELOW:
        law, why = "dmt", "adhesion compresses the tip but does not bend the contact"
        rule = f"Tabor number {tabor:.3g} < {DMT_BELOW:g}, elasticity parameter "
        rule += f"{elasticity:.3g} >= {RIGID_BELOW:.3g}"
    elif tabor <= JKR_ABOVE:
        law, why = "maugis", "neither DMT nor JKR holds"
        rule = f"{DMT_BELOW:g} <= Tabor number {tabor:.3g} <= {JKR_ABOVE:g}"
    else:
        law, why = "jkr", "adhesion bends the contact over far more than its range"
        rule = f"Tabor number {tabor:.3g} > {JKR_ABOVE:g}"
    warnings = tuple(
        _near(elasticity, border, law)
        for border in _BORDERS
        if 1.0 / BORDER_FACTOR <= elasticity / border.elasticity <= BORDER_FACTOR
    )
    return AdhesionChoice(law, f"{rule}: {why}", warnings)


def _near(elasticity: float, border: _Border, law: str) -> str:
    other = border.above if law == border.below else border.below
    return (
        f"the elasticity parameter is {elasticity:.3g}, within a factor {BORDER_FACTOR:g} of the "
        f"border between {LAW_NAMES[border.below]} and {LAW_NAMES[border.above]} at "
        f"{border.elasticity:.3g} ({border.rule}): compare with model = '{other}'"
    )

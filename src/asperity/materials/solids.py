"""Solids, and a small catalogue of them and of the works of adhesion measured between some.

The numbers stand in ``solids.toml`` and ``adhesion.toml``, each with its source.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from asperity.errors import InputError
from asperity.materials.liquids import refuse_not_positive

HARDNESS_PER_YIELD_STRENGTH = 2.8
"""Indentation hardness over yield strength [-]. Tabor, The Hardness of Metals (1951)."""


@dataclass(frozen=True)
class Solid:
    """An isotropic elastic solid.

    Parameters
    ----------
    name : str
        What it is called.
    youngs_modulus : float
        Young's modulus [Pa].
    poisson : float
        Poisson's ratio [-], in (-1, 0.5].
    density : float or None
        Density [kg/m^3]; None where it is not known (a counterface needs none).
    hardness : float or None
        Indentation hardness [Pa], at least the yield strength; None where it is not known.
    yield_strength : float or None
        Yield strength in uniaxial tension [Pa]; None where it is not known.
    source : str
        Where the numbers come from.
    never_yields : str
        Why it does not yield, for a solid that does not, such as an elastomer; else empty.

    Raises
    ------
    InputError
        Where a number lies outside its range.
    """

    name: str
    youngs_modulus: float
    poisson: float
    density: float | None = None
    hardness: float | None = None
    yield_strength: float | None = None
    source: str = ""
    never_yields: str = ""

    def __post_init__(self) -> None:
        refuse_not_positive("youngs_modulus", self.youngs_modulus)
        if not -1.0 < self.poisson <= 0.5:
            raise InputError(f"`poisson` must lie in (-1, 0.5]; got {self.poisson!r}")
        for name in ("density", "hardness", "yield_strength"):
            if getattr(self, name) is not None:
                refuse_not_positive(name, getattr(self, name))
        refuse_softer_than_yield(self.hardness, self.yield_strength)


@dataclass(frozen=True)
class Adhesion:
    """A measured work of adhesion of two solids; no case takes one of itself.

    Parameters
    ----------
    pair : tuple of str
        The two solids.
    work : float
        Work of adhesion [J/m^2]: what it takes to part a unit area of contact.
    environment : str
        What it was measured in, with the relative humidity where that was given.
    method : str
        How it was measured, and what was done to the surfaces.
    source : str
        Where the number comes from.
    bounds : tuple of float or None
        Least and largest work that the source gives [J/m^2]; None where it gives one number.

    Raises
    ------
    InputError
        Where a work is not positive or lies outside its bounds.
    """

    pair: tuple[str, str]
    work: float
    environment: str
    method: str
    source: str
    bounds: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        refuse_not_positive("work", self.work)
        if self.bounds is None:
            return
        low, high = self.bounds
        refuse_not_positive("bounds", low)
        if not low <= self.work <= high:
            raise InputError(
                f"`work` must lie within its bounds, {low:g} to {high:g} J/m^2; got {self.work!r}"
            )


def refuse_softer_than_yield(
    hardness: float | None, yield_strength: float | None, *, key: str = "hardness"
) -> None:
    """Raise `InputError` where a hardness is below a yield strength [Pa]; None is not known."""
    if hardness is not None and yield_strength is not None and hardness < yield_strength:
        raise InputError(
            f"`hardness` must be at least the yield strength ({yield_strength / 1e6:.6g} MPa), "
            f"since an indentation that stays is made by yielding; got {hardness / 1e6:.6g} MPa",
            key=key,
        )


def named(solid: Solid) -> str:
    """What to call a solid in a sentence: its own name, or whose numbers it has."""
    return f"the {solid.name}" if solid.name in ("body", "counterface") else solid.name


def bar_wave_speed(solids: tuple[Solid, Solid]) -> tuple[float, Solid]:
    """Smaller speed [m/s] of waves in bars of two solids, sqrt(E/rho), and whose it is.

    A solid without a density does not count.
    """
    known = [
        ((solid.youngs_modulus / solid.density) ** 0.5, solid)
        for solid in solids
        if solid.density is not None
    ]
    return min(known, key=lambda each: each[0])


def contact_modulus(a: Solid, b: Solid) -> float:
    """Contact modulus E* of two solids [Pa]: 1/E* = (1 - nu_a^2)/E_a + (1 - nu_b^2)/E_b.

    Parameters
    ----------
    a, b : Solid
        The two solids; their order does not matter.

    Returns
    -------
    float
        E* [Pa]. Johnson, Contact Mechanics (1985), section 4.2.
    """
    return 1.0 / ((1.0 - a.poisson**2) / a.youngs_modulus + (1.0 - b.poisson**2) / b.youngs_modulus)


def _read(name: str) -> dict[str, Any]:
    """A file of the catalogue."""
    return tomllib.loads(Path(__file__).with_name(name).read_text(encoding="utf-8"))


def _measured(entry: dict[str, Any]) -> Adhesion:
    """A work of adhesion by its entry in the file, whose lists become tuples."""
    tuples = {key: tuple(value) for key, value in entry.items() if isinstance(value, list)}
    return Adhesion(**(entry | tuples))


SOLIDS: dict[str, Solid] = {
    name: Solid(name, **entry) for name, entry in _read("solids.toml").items()
}
"""The solids that a case can name."""

ADHESION: tuple[Adhesion, ...] = tuple(map(_measured, _read("adhesion.toml")["measured"]))
"""Works of adhesion as measured between pairs of solids, to choose the work of a case by."""

"""Surfaces of summits that were measured one by one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from .._jax import jax, jnp
from ..inputs import CLASSES
from ..laws.law import Law, Real, Sum, terms
from ..surfaces.heights import Sampled, Spread, spread_of
from .interface import Interface
from .layers import Layers
from .radius_classes import RadiusClasses, members
from .rough_planes import RoughPlanes

_SOME = 4096  # quantiles of radii


def measured_surface(
    make: Callable[[float], Law],
    heights: Real,
    radii: Real,
    density: Real,
    *,
    radius: float,
    classes: int | Sequence[np.ndarray] = CLASSES,
    spread: Spread | None = None,
) -> RoughPlanes:
    """A surface of measured summits, each with its own height and tip radius.

    Parameters
    ----------
    make
        The law of an asperity of a given tip radius [m].
    heights, radii
        Height [m] above the plane that separations count from, and tip radius [m], of each.
    density
        Summits per area [1/m^2].
    radius
        Tip radius [m] at which the laws that grow with a power of it are made.
    classes
        Into how many classes of radius the others are cut (static); or the summits of each
        class, by :func:`~asperity.interface.radius_classes.members`, which is needed where
        ``radii`` are traced.
    spread
        As for :class:`~asperity.surfaces.heights.Sampled`.

    Notes
    -----
    Laws that grow with a power of the radius are weighted summit by summit, exactly. The
    others have a memory for each class, with the mean radius of its summits; an equal share
    of the summed R^(2/3) falls to each class. See :func:`loss_error`.
    """
    laws = terms(make(radius))
    exact = [law for law in laws if law.radius_power > 0.0]
    parts: list[Interface | RadiusClasses] = []
    if exact:
        law = exact[0] if len(exact) == 1 else Sum(exact)
        parts.append(Interface(law, Sampled(heights, radii, radius, spread), density))
    if len(exact) < len(laws):
        chosen = [k for k, law in enumerate(laws) if law.radius_power == 0.0]

        def rest(radius: float) -> Law:
            made = [terms(make(radius))[k] for k in chosen]
            return made[0] if len(made) == 1 else Sum(made)

        parts.append(_in_classes(rest, heights, radii, density, classes, spread))
    return parts[0] if len(parts) == 1 else Layers(parts)


def _in_classes(
    make: Callable[[Any], Law],
    heights: Real,
    radii: Real,
    density: Real,
    classes: int | Sequence[np.ndarray],
    spread: Spread | None,
) -> RadiusClasses:
    on = spread or spread_of(np.asarray(heights))
    cut = members(np.asarray(radii), classes) if isinstance(classes, int) else classes
    # Not as arrays of JAX, which under ``jit`` would count as traced and compile each size.
    heights, radii = (
        x if isinstance(x, jax.Array) else np.asarray(x, float) for x in (heights, radii)
    )
    parts = []
    for chosen in cut:
        mean = radii[chosen].mean()
        sampled = Sampled(heights[chosen], radii[chosen], mean, on)
        parts.append(Interface(make(mean), sampled, density * len(chosen) / radii.size))
    return RadiusClasses(parts)


def loss_error(make: Callable[[Any], Law], radii: np.ndarray, classes: int = CLASSES) -> float:
    """Relative error that classes of radius make in the energy that bonds lose.

    Parameters
    ----------
    make
        As for :func:`measured_surface`; also of an array of radii.
    radii
        Tip radii [m] of the summits. Of more than 4096, as many quantiles stand for them.
    classes
        Number of classes.

    Returns
    -------
    Of the energy of one bond made and broken by each summit; negative where classes lose too
    little, 0 where no law needs them.
    """
    some = np.quantile(radii, (np.arange(_SOME) + 0.5) / _SOME) if radii.size > _SOME else radii
    cut = members(some, classes)
    means = np.array([some[chosen].mean() for chosen in cut])
    whole = float(np.sum(_bond_losses(make, some)))
    classed = float(np.sum(_bond_losses(make, means) * [len(chosen) for chosen in cut]))
    return classed / whole - 1.0 if whole > 0.0 else 0.0


def _bond_losses(make: Callable[[Any], Law], radii: np.ndarray) -> np.ndarray:
    """Energy [J] that one bond of each radius loses, over the laws that need classes."""
    laws = [law for law in terms(make(jnp.asarray(radii))) if law.radius_power == 0.0]
    lost = [jnp.sum(law.losses, axis=0) for law in laws if law.hysteretic]
    return np.asarray(sum(lost, jnp.zeros(radii.shape)))

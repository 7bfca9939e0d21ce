r"""By how much the mean over asperities is off from the mean of single bodies.

Offsets x of summits under a body are a Poisson process of the intensity lambda(x). With the work
w(g) that a summit takes to a gap g and the loss h(g) that it has once the body leaves, a body of
energy E turns where :math:`\sum w(d - x) = E` and loses :math:`\sum h(d - x)`. About the turning
point of the mean both are expanded to the second order in what the sums scatter by, whose means of
products are integrals by Campbell's theorem (Kingman, Poisson Processes, 1993, section 3.2). See
docs/single_bodies.md, "When the mean is enough".
"""

from __future__ import annotations

from math import pi
from typing import NamedTuple

import numpy as np
from scipy.special import ndtr

from .._jax import jax, jnp
from ..asperity_laws import asperity_law, laws_beside, plastic_law
from ..contact.asperity_work import approach_work
from ..contact.smooth import kinks_of
from ..inputs import Asperities, Inputs
from ..interface.residual_profile import flatness
from ..laws.law import Law, Sum, as_float64, terms
from ..laws.plastic import PlasticContact
from ..numerics.compilation import AT_ONCE, Program
from .loaded_asperities import LOADED_FOR_A_MEAN

MOST_OFF = 0.05
"""Relative error of the mean field's first restitution from which a mean is not enough."""

_SPREAD = 2.0  # standard deviations of single bodies from the border of capture
_GAPS = 4096
_HIGHEST = 8.5  # rms heights above the mean: the highest summits
_STEP = 0.1  # rms heights: of differences with the separation
_NORMAL = np.polynomial.hermite_e.hermegauss(41)


class LossesOfBodies(NamedTuple):
    """What summits take from single bodies, beside what they take in the mean.

    Attributes
    ----------
    excess
        By how much the mean over bodies is larger, over the mean field's [-].
    scatter
        Standard deviation over bodies, over the mean field's [-].
    """

    excess: float
    scatter: float

    def fewer(self, share: float) -> LossesOfBodies:
        """Of bodies on so small a share of independent summits."""
        return LossesOfBodies(self.excess / share, self.scatter / share**0.5)

    def error(self, kept: float, lost: float) -> float:
        """By how much the mean field's restitution is larger than that of bodies [-].

        Relative to the mean over bodies, whose losses are spread normally.

        Parameters
        ----------
        kept
            Share of the impact energy that is left at the end of contact [-], above 0.
        lost
            Share of it that summits take [-].
        """
        normal, weights = _NORMAL
        left = kept - self.excess * lost + self.scatter * lost * normal
        mean = float(weights @ np.sqrt(np.maximum(left, 0.0)) / np.sum(weights))
        return kept**0.5 / mean - 1.0 if mean > 0.0 else np.inf


def _of_summit(
    law: Law, contact: PlasticContact | None, deepest: jax.Array
) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Gaps down to the ``deepest`` [m], and work and loss [J] of a summit pressed to each.

    The law is beside the ``contact`` where tips yield; see :mod:`asperity.contact.pressed_summits`.
    """
    ends = [jnp.max(kinks_of(law)), *(jnp.asarray(one.interaction_range) for one in terms(law))]
    gaps = jnp.linspace(jnp.max(jnp.stack(ends)), deepest, _GAPS)
    beside = approach_work(law)
    if contact is None:
        return gaps, beside(gaps), _lost(law, gaps)
    overlap = jnp.maximum(-gaps, 0.0)
    residual = contact.residual(overlap)
    flat, there = flatness(overlap, overlap - residual), gaps + residual
    work = beside(gaps) + contact.loading_work(overlap)
    recovered = flat * beside(there) + contact.recoverable(-gaps, overlap)
    return gaps, work, flat * _lost(law, there) + work - recovered


def _lost(law: Law, gaps: jax.Array) -> jax.Array:
    """What the bonds take that form down to each gap [m], once all are broken [J]."""
    total = jnp.zeros_like(gaps)
    for one in terms(law):
        if one.hysteretic:
            total = total + jnp.where(gaps <= one.forming_gap, jnp.sum(one.losses), 0.0)
    return total


_work_and_loss = Program(_of_summit, AT_ONCE)


def losses_of_bodies(inputs: Inputs, central: float, contacting: float) -> LossesOfBodies:
    """What summits take from single bodies on a rigid bulk, beside what they take in the mean.

    By the law of the mean tip radius, with menisci that form at once. Infinite where summits do not
    push back at the turning point.

    Parameters
    ----------
    inputs
        The quantities of a case with asperities.
    central
        Separation of the mean planes at the axis, at the mean's turning point [m].
    contacting
        Expected number of summits that touch there, as few as there are on a half-space.
    """
    rough = inputs.asperities
    assert rough is not None
    tip, rms = rough.asperity_radius, rough.rms_height
    contact = plastic_law(inputs, inputs.structure.plasticity, tip) if inputs.yields else None
    law = Sum(laws_beside(inputs, tip)) if inputs.yields else asperity_law(inputs, tip)
    deepest = min(central - rough.mean_height - _HIGHEST * rms, 0.0)
    found = _work_and_loss(law, contact, as_float64(deepest))
    gaps, work, loss = map(np.asarray, found)
    slope = np.gradient(work, gaps)
    products = np.stack([work, loss, work**2, loss**2, loss * work, loss * slope])
    steps, width = (_STEP * rms) * np.array([-1.0, 0.0, 1.0]), gaps[0] - gaps[1]
    intensities = [_intensity(inputs, rough, central + step - gaps) for step in steps]
    touching = width * float(np.sum(intensities[1][gaps < 0.0]))
    below, here, above = width * (np.array(intensities) @ products.T)
    d_work, d_loss, d_squares, _, d_both, _ = (above - below) / (2.0 * steps[2])
    dd_work, dd_loss = ((above - 2.0 * here + below) / steps[2] ** 2)[:2]
    _, lost, squares, losses_squared, both, both_slope = here
    if lost == 0.0:
        return LossesOfBodies(0.0, 0.0)
    if not (lost > 0.0 and d_work < 0.0 and touching > 0.0 and contacting > 0.0):
        return LossesOfBodies(np.inf, np.inf)  # no turning point to expand about
    rate, shift = d_loss / d_work, squares / d_work**2  # of the turning point: its variance
    moved = -(0.5 * dd_work * shift - 0.5 * d_squares / d_work) / d_work
    excess = d_loss * moved + 0.5 * dd_loss * shift - (d_both - both_slope) / d_work
    variance = losses_squared - 2.0 * rate * both + rate**2 * squares
    losses = LossesOfBodies(float(excess / lost), float(max(variance, 0.0) ** 0.5 / lost))
    return losses.fewer(contacting / touching)


def mean_is_enough(loaded: float, losses: LossesOfBodies, kept: float, lost: float) -> bool:
    """Whether the mean field says what single bodies do at their first impact.

    It does not where fewer than `LOADED_FOR_A_MEAN` carry the load, where its restitution is off by
    more than `MOST_OFF`, or where the scatter of single bodies spans the border of capture.

    Parameters
    ----------
    loaded
        Effective number, as :func:`~asperity.regimes.loaded_asperities`.
    losses
        What summits take from single bodies, beside the mean.
    kept
        Share of the impact energy that is left at the end of contact [-]; negative where the body
        lacks so much to leave.
    lost
        Share of it that summits take [-].
    """
    if loaded < LOADED_FOR_A_MEAN or abs(kept) < _SPREAD * losses.scatter * lost:
        return False
    return kept <= 0.0 or abs(losses.error(kept, lost)) <= MOST_OFF


def _intensity(inputs: Inputs, rough: Asperities, offsets: np.ndarray) -> np.ndarray:
    """Expected number of summits over their offset, under a paraboloid [1/m]."""
    if inputs.structure.heights == "summits" and rough.summits is not None:
        heights = np.sort(rough.summits.heights)
        higher = 1.0 - np.searchsorted(heights, offsets) / heights.size
    else:
        higher = ndtr((rough.mean_height - offsets) / rough.rms_height)
    return 2.0 * pi * inputs.radius * rough.asperity_density * higher

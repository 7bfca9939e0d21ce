"""Summits on an elastic half-space: each is lowered by what the others carry."""

from __future__ import annotations

from typing import NamedTuple

from .._jax import jax, jnp
from ..halfspace import hertz_influence
from ..numerics.roots import fixed_point
from .asperity_table import Asperities

_ENOUGH = 1e-7  # of the shortest length of a law: the last change of a gap, the next its square
_WHOLE, _STEPS = 10, 80  # of Newton's method: whole ones, and all
_ROUNDING = 1e-15  # of a gap
_INSIDE = 1e-13  # of that length: within what a bond bears
_RAMP = 1.5  # times what attractions that end with contact move a summit: over which they rise


class SummitEquilibrium(NamedTuple):
    """Summits under a body at one separation.

    Attributes
    ----------
    gaps
        Gap of each [m], shape (n,).
    rates
        Its slope with the separation, shape (n,).
    forces
        Force on each [N], positive apart, shape (n,).
    stiffness
        Slope of their sum with the separation [N/m], but for attractions that rise at contact.
    energy
        Energy of all and of the half-space [J], with what bonds that hold have lost.
    solved
        Whether Newton's method arrived.
    """

    gaps: jax.Array
    rates: jax.Array
    forces: jax.Array
    stiffness: jax.Array
    energy: jax.Array
    solved: jax.Array

    @property
    def force(self) -> jax.Array:
        """Total force [N]."""
        return jnp.sum(self.forces)


class CoupledSummits(NamedTuple):
    r"""Summits under a body that feel one another through the half-space.

    Attributes
    ----------
    summits
        Their laws.
    offsets
        Separation at which each meets the plane [m], shape (n,).
    influence
        Displacement of one per load of another [m/N], shape (n, n): symmetric, 0 for itself.
    steps
        By how much the force of each rises where contact ends [N], shape (n,).
    ramp
        Depth [m] over which that attraction rises as contact begins, shape (n,): of two summits one
        that let go at once would lower the other and touch again.

    Notes
    -----
    The gap of a summit is :math:`g_i = d - x_i + \sum_j C_{ij} F_j(g_j)`. The own displacement of a
    contact is in its law. Between two changes of bonds forces are smooth, and the energy
    :math:`\sum_i U_i + F C F/2` has the slope :math:`-\sum_i F_i`.
    """

    summits: Asperities
    offsets: jax.Array
    influence: jax.Array
    steps: jax.Array
    ramp: jax.Array

    @classmethod
    def on(
        cls, summits: Asperities, offsets: jax.Array, influence: jax.Array, touching: jax.Array
    ) -> CoupledSummits:
        """Summits on a half-space of some ``influence``, of which some will be ``touching``."""
        steps = summits.step_at_contact()
        moved = influence @ jnp.where(touching, steps, 0.0)
        ramp = jnp.maximum(_RAMP * moved, _INSIDE * summits.scale)
        return cls(summits, offsets, influence, steps, ramp)

    @property
    def pull_off_gaps(self) -> jax.Array:
        """Gap [m] of the largest tension of each, shape (n,)."""
        within = jnp.minimum(self.summits.pull_off_gap, -self.ramp)
        return jnp.where(self.steps > 0.0, within, self.summits.pull_off_gap)

    def equilibrium(
        self, separation: jax.Array, bonded: jax.Array, guess: jax.Array
    ) -> SummitEquilibrium:
        """At a separation [m], by Newton's method from a ``guess`` of the gaps [m].

        With the bonds that ``bonded`` says, by law and summit, shape (laws, n). A law goes on
        beyond the gap at which its bond forms or breaks as it is there.
        """
        rigid, one = separation - self.offsets, jnp.ones_like(guess)

        def step(now: tuple[jax.Array, ...]) -> tuple[tuple[jax.Array, ...], jax.Array]:
            gaps, _, made = now
            _, forces, slopes = self._response(gaps, bonded)
            left = gaps - rigid - self.influence @ forces
            matrix = jnp.eye(gaps.shape[0]) - self.influence * slopes
            change, rates = jnp.linalg.solve(matrix, jnp.stack([left, one], axis=1)).T
            # Steps to and fro over an end of the piece of a law are halved.
            share = jnp.where(made < _WHOLE, 1.0, 0.5)
            beyond_rounding = jnp.abs(change) - _ROUNDING * jnp.abs(gaps)
            return (gaps - share * change, rates, made + 1), jnp.max(beyond_rounding)

        enough = _ENOUGH * self.summits.scale[0]
        (gaps, rates, _), change = fixed_point(step, (guess, one, jnp.asarray(0)), enough, _STEPS)
        work, forces, _ = self._response(gaps, bonded)
        energy = jnp.sum(work) + 0.5 * forces @ self.influence @ forces
        stiffness = -self._by_laws(gaps, bonded)[2] @ rates
        return SummitEquilibrium(gaps, rates, forces, stiffness, energy, change <= enough)

    def _response(
        self, gaps: jax.Array, bonded: jax.Array
    ) -> tuple[jax.Array, jax.Array, jax.Array]:
        """Work [J], force [N] and its slope [N/m] of each, shape (n,)."""
        work, slope, curvature = self._by_laws(gaps, bonded)
        depth = jnp.clip(-self._within(gaps, bonded), 0.0, self.ramp)
        missing = 1.0 - depth / self.ramp
        rises = (depth > 0.0) & (missing > 0.0)
        work = work + 0.5 * self.steps * depth * (1.0 + missing)
        slope = slope - jnp.where(rises, self.steps * missing, 0.0)
        curvature = curvature - jnp.where(rises, self.steps / self.ramp, 0.0)
        return work, -slope, -curvature

    def _within(self, gaps: jax.Array, bonded: jax.Array) -> jax.Array:
        """Gaps [m] at which the bonds can be as they are, shape (n,)."""
        some = self.summits
        inside = _INSIDE * some.scale
        low = jnp.max(jnp.where(bonded, -jnp.inf, some.forming), axis=0, initial=-jnp.inf)
        high = jnp.min(jnp.where(bonded, some.breaking - inside, jnp.inf), axis=0, initial=jnp.inf)
        return jnp.clip(gaps, low, high)

    def _by_laws(
        self, gaps: jax.Array, bonded: jax.Array
    ) -> tuple[jax.Array, jax.Array, jax.Array]:
        """Work [J], its slope [N] and the slope of that [N/m] of each by its laws, shape (n,)."""
        within = self._within(gaps, bonded)
        bits = 2 ** jnp.arange(bonded.shape[0])
        branch = jnp.tensordot(bits, bonded.astype(bits.dtype), axes=1)
        work, slope, curvature = self.summits.response(within, branch)
        work = work + slope * (gaps - within)
        return work, slope, jnp.where(within == gaps, curvature, 0.0)


def influence_between(
    positions: jax.Array, contact_radii: jax.Array, modulus: jax.Array
) -> jax.Array:
    """Displacement of summits per load of one another [m/N], shape (n, n).

    Parameters
    ----------
    positions
        Coordinates [m], shape (n, 2).
    contact_radii
        Contact radii [m], shape (n,).
    modulus
        Contact modulus E* of the bulk [Pa].

    Notes
    -----
    Both contacts are as wide as they are: to second order in the radii over the distance, a point
    load beside a contact of radius sqrt(a_i^2 + a_j^2). Where two are so near that one would sink
    under the other's load more than under its own, 1/(2 E* a), it sinks by that.
    """
    apart = positions[:, None] - positions
    squares = contact_radii[:, None] ** 2 + contact_radii**2
    widest = jnp.maximum(contact_radii[:, None], contact_radii)
    between = hertz_influence(jnp.sqrt(jnp.sum(apart**2, axis=-1)), jnp.sqrt(squares))
    between = jnp.minimum(between, jnp.where(widest > 0.0, 0.5 / widest, jnp.inf))
    return jnp.where(jnp.eye(len(positions), dtype=bool), 0.0, between / modulus)

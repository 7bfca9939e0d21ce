r"""One step in time of a rough body on a half-space that creeps.

The displacement of the rings is u = C p + (1/k - 1) C c, with C the compliance of the instantaneous
modulus and c the retarded pressure, dc/dt = (p - c) k/time. A step is implicit: a diagonal
Runge-Kutta method of order 4 that damps what is fast (Kennedy and Carpenter 2003, ARK4(3)6L[2]SA).
At each of its stages mass, creep and elasticity together are one stiffer or softer half-space, so
that the rings' separations alone are solved for, by Newton's method.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre

from ..._jax import jax, jnp
from ...contact.equilibrium import RingEquilibrium as Settled
from ...contact.equilibrium import asked_size, beyond
from ...contact.resolution import fills_by_contact
from ...contact.viscoelastic import Relaxation
from ...interface.rough_planes import Memory as Thresholds
from ...laws.law import Real
from ...numerics.compilation import kept
from ..record import Body
from .ring_system import Bulk, Rest, RingState, balanced, row_of

_DIAGONAL = 0.25
_STAGES = np.zeros((6, 6))
_STAGES[1, :1] = 1 / 4
_STAGES[2, :2] = 8611 / 62500, -1743 / 31250
_STAGES[3, :3] = 5012029 / 34652500, -654441 / 2922500, 174375 / 388108
_STAGES[4, :4] = (
    15267082809 / 155376265600, -71443401 / 120774400, 730878875 / 902184768, 2285395 / 8070912
)  # fmt: skip
_STAGES[5, :5] = 82889 / 524892, 0.0, 15625 / 83664, 69875 / 102672, -2260 / 8211
_WEIGHTS = np.append(_STAGES[5, :5], _DIAGONAL)
_LOWER = np.array(
    [
        4586570599 / 29645900160, 0.0, 178811875 / 945068544, 814220225 / 1159782912,
        -3700637 / 11593932, 61727 / 225920,
    ]
)  # fmt: skip
_TIMES = np.array([0.0, 0.5, 83 / 250, 31 / 50, 17 / 20, 1.0])
"""When the stages are, as fractions of the step."""

_ENERGY_SAMPLES = legendre.legvander(np.linspace(-1.0, 1.0, 65), 5) @ np.linalg.inv(
    legendre.legvander(2.0 * _TIMES - 1.0, 5)
)


@kept
class RingStep(NamedTuple):
    """A step in time.

    Attributes
    ----------
    here
        Its end.
    rates
        Acceleration [m/s^2] and power of the creep, or lost on delayed menisci [W], at its end.
    row
        Quantities of the contact at its end.
    lost
        Energy lost within it, by law, and by creep last where the bulk creeps [J].
    fit
        Size of the mesh that the pressure at its end asks for, over the present one.
    error
        Errors of separation [m], speed [m/s], displacement by creep [m] and energy [J].
    solved
        Whether all stages are solved.
    """

    here: RingState
    rates: Real
    row: Real
    lost: Real
    fit: Real
    error: Real
    solved: Real


class _Rates(NamedTuple):
    """Rates of separation, speed, retarded pressure, energy taken and thresholds, at each stage.

    The energy is that taken by creep, or on menisci that take time; there are thresholds of these
    alone.
    """

    separation: jax.Array
    speed: jax.Array
    retarded: jax.Array
    dissipated: jax.Array
    threshold: jax.Array

    def along(self, weights: jax.Array) -> _Rates:
        """Sums of the stages' rates."""
        return _Rates(*(weights @ rate for rate in self))

    def put(self, stage: Any, rates: _Rates) -> _Rates:
        """With those of a stage."""
        return _Rates(*(a.at[stage].set(b) for a, b in zip(self, rates, strict=True)))


def step(relaxation: Relaxation, body: Body, size: Real, here: RingState, span: Real) -> RingStep:
    """Go on for ``span`` [s] on a mesh of a ``size`` [m]."""
    bulk = Bulk.of(relaxation, jnp.asarray(size))
    first = _rates(bulk, body, here.speed, here.retarded, here.gaps, here.thresholds)
    blank = _Rates(*(jnp.zeros((6, *jnp.shape(rate))) for rate in first))

    def stage(carry: tuple[_Rates, jax.Array], job: tuple[jax.Array, jax.Array]) -> Any:
        rates, guess = carry
        number, weights = job
        known = rates.along(span * weights)
        gaps, now, solved = _solved(bulk, body, here, known, _DIAGONAL * span, guess)
        return (rates.put(number, now), gaps), (gaps, solved)

    jobs = jnp.arange(1, 6), jnp.asarray(_STAGES[1:])
    (rates, _), (gaps, solved) = jax.lax.scan(stage, (blank.put(0, first), here.gaps), jobs)
    change = rates.along(span * _WEIGHTS)
    off = rates.along(span * (_WEIGHTS - _LOWER))
    path = jnp.asarray(_ENERGY_SAMPLES) @ jnp.concatenate([here.gaps[None], gaps])
    thresholds, lost = _bonds(bulk, _waited(bulk, here.thresholds, change), path)
    end = RingState(
        here.separation + change.separation, here.speed + change.speed, gaps[-1],
        here.retarded + change.retarded, thresholds,
    )  # fmt: skip
    # Rings that turned within the step hold bonds that the stages did not know of.
    base = end.separation + bulk.profile + bulk.excess * (bulk.rows @ end.retarded)
    rest = Rest(base, bulk.rows, jnp.zeros(()))
    settled, agree = balanced(bulk, lambda gaps: thresholds, rest, gaps[-1])
    end, solved = end._replace(gaps=settled), jnp.append(solved, agree)
    pressure, _ = bulk.pressed(end.gaps, end.thresholds)
    bonds = bulk.contact.interface.hysteretic if bulk.delayed is None else bulk.delayed.laws
    more = beyond(bulk.contact, bulk.size, end.gaps[-1]) if fills_by_contact(bonds) else 0.0
    fit = asked_size(Settled(end.gaps, pressure, jnp.zeros(())), more)
    if bulk.delayed is None:
        lost = jnp.append(lost, change.dissipated)
    else:
        lost = lost.at[bulk.delayed.meniscus_index].add(change.dissipated)
    return RingStep(
        end, jnp.stack([rates.speed[-1], rates.dissipated[-1]]), row_of(bulk, end),
        lost, fit, _errors(bulk, end, off), jnp.all(solved),
    )  # fmt: skip


def _waited(bulk: Bulk, held: Thresholds, change: _Rates) -> Thresholds:
    """Memory in which the menisci that take time have gone on forming."""
    delayed = bulk.delayed
    if delayed is None:
        return held
    return delayed.with_threshold(held, held[delayed.meniscus_index] + change.threshold)


def _errors(bulk: Bulk, end: RingState, off: _Rates) -> jax.Array:
    """Errors of a step by those of its changes, see :class:`RingStep`."""
    pressed, dissipated = bulk.excess * off.retarded, off.dissipated
    if bulk.waiting is not None:
        pressed = bulk.waiting.pressing(end.gaps, end.thresholds, off.threshold)[:-1]
        # A threshold that is off leaves a force, over a way of about a rms height.
        way = jnp.asarray(bulk.contact.interface.scale.rms)
        dissipated = jnp.abs(dissipated) + way * jnp.abs(bulk.area @ pressed)
    displaced = jnp.max(jnp.abs(bulk.rows @ pressed))
    return jnp.abs(jnp.stack([off.separation, off.speed, displaced, dissipated]))


def _rates(
    bulk: Bulk,
    body: Body,
    speed: jax.Array,
    retarded: jax.Array,
    gaps: jax.Array,
    held: Thresholds,
) -> _Rates:
    pressure, force = bulk.pressed(gaps, held)
    falling, dissipated = jnp.zeros(0), bulk.dissipated(pressure, retarded)
    if bulk.waiting is not None:
        falling = bulk.waiting.rate(gaps, held)
        inside, outside = bulk.waiting.power(gaps, held, falling, bulk.around)
        dissipated = bulk.area @ inside + outside
    return _Rates(
        jnp.asarray(speed), force / body.mass - body.gravity, bulk.pace * (pressure - retarded),
        dissipated, falling,
    )  # fmt: skip


def _solved(
    bulk: Bulk, body: Body, here: RingState, known: _Rates, span: jax.Array, guess: jax.Array
) -> tuple[jax.Array, _Rates, jax.Array]:
    """Separations at a stage and the rates there, from what is known of its values."""
    gain = span * bulk.pace
    retarded = (here.retarded + known.retarded) / (1.0 + gain)
    speed = here.speed + known.speed - span * body.gravity
    place = here.separation + known.separation + span * speed
    base = place + bulk.profile + bulk.excess * (bulk.rows @ retarded)
    rows = bulk.rows * (1.0 + bulk.excess * gain / (1.0 + gain))
    rest = Rest(base, rows, span**2 / body.mass)

    def holding(gaps: jax.Array) -> Thresholds:
        if bulk.waiting is None:
            return here.thresholds
        return bulk.waiting.holding(here.thresholds, known.threshold, span)(gaps)

    gaps, solved = balanced(bulk, holding, rest, guess)
    held = holding(gaps)
    pressure, force = bulk.pressed(gaps, held)
    retarded = retarded + gain / (1.0 + gain) * pressure
    speed = speed + span * force / body.mass
    return gaps, _rates(bulk, body, speed, retarded, gaps, held), solved


def _bonds(bulk: Bulk, held: Thresholds, path: jax.Array) -> tuple[Thresholds, jax.Array]:
    """Memory after a path of the rings, and what its bonds have lost by law [J].

    A ring that turns within a step does so where it is farthest from its start and end.
    """
    surfaces = bulk.contact.interface
    if not surfaces.mechanisms:
        return held, jnp.zeros(0)
    formed, broken = surfaces.losses() if bulk.delayed is None else bulk.delayed.losses

    def count(gaps: jax.Array, held: Thresholds) -> tuple[jax.Array, jax.Array]:
        inside = surfaces.measure(gaps, held).bonds[:, :-1]
        last = tuple(b[-1:] for b in held)
        return inside * bulk.area, bulk.around * surfaces.measure(
            gaps[-1:], last, integrated=1
        ).bonds

    def along(carry: Any, gaps: jax.Array) -> Any:
        held, before, lost = carry
        held = surfaces.remember(held, gaps)
        now = count(gaps, held)
        for old, new in zip(before, now, strict=True):
            up, down = (jnp.sum(jnp.maximum(x, 0.0), axis=1) for x in (new - old, old - new))
            lost = lost + up * formed + down * broken
        return (held, now, lost), None

    first, last = path[0], path[-1]
    top, bottom = jnp.max(path, axis=0), jnp.min(path, axis=0)
    farthest = jnp.where(top > jnp.maximum(first, last), top, last)
    farthest = jnp.where(bottom < jnp.minimum(first, last), bottom, farthest)
    begin = (held, count(first, held), jnp.zeros_like(formed))
    (held, _, lost), _ = jax.lax.scan(along, begin, jnp.stack([farthest, last]))
    return held, lost

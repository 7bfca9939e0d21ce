"""One step in time of a body on a contact with delayed menisci.

The acceleration is a polynomial through Radau's points of the step, which meets the equation of
motion there; speed, separation and threshold follow from it. The end of a step is of order
2 STAGES - 1, and a formation time or a drag that is short beside the step does no harm
(Hairer and Wanner 1996, section IV.5).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre

from .._jax import jax, jnp
from ..contact.contact import Memory
from ..contact.delayed_formation import DelayedContact
from ..laws.law import Real
from ..numerics.compilation import kept
from ..numerics.roots import fixed_point
from ..numerics.trees import zeros_of
from .curve_table import rows_of
from .external_forces import Along
from .record import Body

STAGES = 8
_STEPS = 12  # of Newton's method
_CLOSE = 1e-12  # change of the accelerations that is small enough, relative to the motion's


def _radau() -> np.ndarray:
    """Points of Radau's right-hand rule in (0, 1]: zeros of P_s - P_(s-1)."""
    series = np.zeros(STAGES + 1)
    series[-2:] = -1.0, 1.0
    points: np.ndarray = 0.5 * (1.0 + np.sort(legendre.legroots(series)))
    points[-1] = 1.0
    return points


NODES_IN_TIME = _radau()
"""Places of a step, as fractions of it."""

_TO_SERIES = np.linalg.inv(legendre.legvander(2.0 * NODES_IN_TIME - 1.0, STAGES - 1))
_UNTIL: np.ndarray = 0.5 * (
    legendre.legvander(2.0 * NODES_IN_TIME - 1.0, STAGES)
    @ legendre.legint(_TO_SERIES, lbnd=-1, axis=0)
)
_TWICE = _UNTIL @ _UNTIL
_AT_START = (legendre.legvander(np.array([-1.0]), STAGES - 1) @ _TO_SERIES)[0]


@kept
class BodyState(NamedTuple):
    """Where a body is.

    Attributes
    ----------
    separation, speed
        [m] and, positive apart, [m/s].
    acceleration
        About what it will be [m/s^2]: a first guess.
    threshold
        Threshold of the menisci [m].
    memory
        Memory of the other bonds; of a smooth body, of all.
    forming
        Whether menisci form.
    """

    separation: Real
    speed: Real
    acceleration: Real
    threshold: Real
    memory: Memory
    forming: Real


@kept
class CollocationStep(NamedTuple):
    """A step in time, at its start and at NODES_IN_TIME of it.

    Attributes
    ----------
    separation, speed, acceleration, threshold, rate
        [m], [m/s], [m/s^2], threshold of the menisci [m] and how fast it falls (negative)
        [m/s], shape (STAGES + 1,).
    rows
        Quantities of the contact, shape (STAGES + 1, rows).
    delayed, dissipated, attraction
        Energy [J] lost since the start on menisci that formed, left in the gas, and work of
        the attractive forces.
    defect
        By how much the polynomials miss the start: times the span, of the acceleration [m/s]
        and of the power of both losses [J].
    solved
        Whether the equations are solved.
    """

    separation: Real
    speed: Real
    acceleration: Real
    threshold: Real
    rate: Real
    rows: Real
    delayed: Real
    dissipated: Real
    attraction: Real
    defect: Real
    solved: Real


def step(contact: DelayedContact, body: Body, here: BodyState, span: Real) -> CollocationStep:
    """Go on for ``span`` [s] in which no bond is made or broken at one stroke."""
    pace = jnp.where(here.forming, span / contact.time, 0.0)
    behind = jnp.linalg.inv(jnp.eye(STAGES) + pace * _UNTIL)
    goal = contact.law.forming_gap

    def path(acceleration: jax.Array) -> tuple[jax.Array, ...]:
        speed = here.speed + span * (_UNTIL @ acceleration)
        moved = span * NODES_IN_TIME * here.speed + span**2 * (_TWICE @ acceleration)
        separation = here.separation + moved
        threshold = behind @ (here.threshold + pace * (_UNTIL @ (separation - goal)))
        start = here.separation, here.speed, here.threshold
        nodes = separation, speed, threshold
        return tuple(jnp.append(a, b) for a, b in zip(start, nodes, strict=True))

    def newton(carry: tuple[jax.Array, Any]) -> tuple[tuple[jax.Array, _Forces], jax.Array]:
        before = carry[0]
        separation, speed, threshold = path(before[1:])
        forces = _forces_along(contact, body, here.memory, separation, speed, threshold)
        slope = (
            forces.by_separation[1:, None] * span**2 * _TWICE
            + forces.by_speed[1:, None] * span * _UNTIL
            + forces.by_threshold[1:, None] * span**2 * (behind @ (pace * _UNTIL @ _TWICE))
        )
        missed = before[1:] - forces.acceleration[1:]
        change = jnp.linalg.solve(jnp.eye(STAGES) - slope, missed[:, None])[:, 0]
        after = jnp.append(forces.acceleration[0], before[1:] - change)
        scale = jnp.max(jnp.abs(after)) + jnp.abs(here.speed) / span
        return (after, forces), jnp.max(jnp.abs(change)) / scale

    start = jnp.full(STAGES + 1, here.acceleration)
    blank = zeros_of(jax.eval_shape(newton, (start, None))[0][1])
    (acceleration, forces), change = fixed_point(newton, (start, blank), _CLOSE, _STEPS)
    places = path(acceleration[1:])
    followed = _Path(places[0], places[1], acceleration, places[2])
    return _finished(contact, here, span, followed, forces, change <= 10.0 * _CLOSE)


class _Path(NamedTuple):
    separation: jax.Array
    speed: jax.Array
    acceleration: jax.Array
    threshold: jax.Array


class _Forces(NamedTuple):
    """What acts at some places, and how it changes with them."""

    acceleration: jax.Array
    by_separation: jax.Array
    by_speed: jax.Array
    by_threshold: jax.Array
    bonds_by_threshold: jax.Array
    drag: jax.Array
    attraction: jax.Array
    rows: jax.Array


def _forces_along(
    contact: DelayedContact,
    body: Body,
    memory: Memory,
    separation: jax.Array,
    speed: jax.Array,
    threshold: jax.Array,
) -> _Forces:
    def contacts(place: jax.Array) -> tuple[jax.Array, tuple[jax.Array, jax.Array]]:
        state = contact.state(place[0], memory, place[1])
        bonds = state.bonds[contact.meniscus_index]
        return jnp.stack([state.force, bonds]), (
            jnp.stack([state.force, state.elastic]),
            rows_of(state),
        )

    def drag_at(place: jax.Array) -> jax.Array:
        return jnp.sum(body.resistances(Along.apart(place))) if body.damped else jnp.zeros(())

    slopes, (forces, rows) = jax.vmap(jax.jacfwd(contacts, has_aux=True))(
        jnp.stack([separation, threshold], axis=1)
    )
    drag, drag_slope = jax.vmap(jax.value_and_grad(drag_at))(separation)
    return _Forces(
        acceleration=(forces[:, 0] - body.weight - drag * speed) / body.mass,
        by_separation=(slopes[:, 0, 0] - drag_slope * speed) / body.mass,
        by_speed=-drag / body.mass,
        by_threshold=slopes[:, 0, 1] / body.mass,
        bonds_by_threshold=slopes[:, 1, 1],
        drag=drag,
        attraction=forces[:, 0] - forces[:, 1],
        rows=rows,
    )


def _finished(
    contact: DelayedContact,
    here: BodyState,
    span: jax.Array,
    followed: _Path,
    forces: _Forces,
    solved: jax.Array,
) -> CollocationStep:
    """What a step does to the energies."""
    separation, speed, acceleration, threshold = followed
    goal = separation - contact.law.forming_gap
    rate = jnp.where(here.forming, (goal - threshold) / contact.time, 0.0)
    delayed = forces.bonds_by_threshold * rate * contact.loss(separation - threshold)
    dissipated, attraction = forces.drag * speed**2, forces.attraction * speed
    until = [
        jnp.append(0.0, span * (_UNTIL @ power[1:])) for power in (delayed, dissipated, attraction)
    ]
    missed = [
        jnp.abs(p[0] - _AT_START @ p[1:]) * span for p in (acceleration, delayed + dissipated)
    ]
    made, dissipated, attraction = until
    return CollocationStep(
        *followed, rate, forces.rows, made, dissipated, attraction, jnp.stack(missed), solved
    )

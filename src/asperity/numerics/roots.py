"""Roots of a function of one variable between two places, and fixed points of many."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from .._jax import jax, jnp

_STEPS = 64  # at most: halvings alone come that far


class _Between(NamedTuple):
    """Two places, one where the function is positive; the best; its last move; steps made."""

    positive: jax.Array
    other: jax.Array
    at: jax.Array
    moved: jax.Array
    steps: jax.Array


def root_between(
    function: Callable[[jax.Array], jax.Array],
    positive: jax.Array,
    other: jax.Array,
    close: jax.Array | float,
    start: jax.Array | None = None,
) -> jax.Array:
    """Where a function is 0 between a place where it is positive and one where it is not.

    By Newton's method, which halves where a step would lead out. Without derivatives by what the
    function holds: the caller adds them by one more Newton step. Where the function is positive
    at both places, the root is that of halving towards ``other``.

    Parameters
    ----------
    function
        A function of a scalar that JAX can differentiate.
    positive, other
        The places, in either order.
    close
        A move that is lost in rounding: the last.
    start
        A first guess between the places; without it, half-way.
    """
    first = 0.5 * (positive + other) if start is None else start

    def go_on(now: _Between) -> jax.Array:
        return (now.moved > close) & (now.steps < _STEPS)

    def step(now: _Between) -> _Between:
        here, slope = jax.jvp(function, (now.at,), (jnp.ones_like(now.at),))
        positive = jnp.where(here > 0.0, now.at, now.positive)
        other = jnp.where(here > 0.0, now.other, now.at)
        target = now.at - here / jnp.where(slope == 0.0, 1.0, slope)
        inside = (target - positive) * (target - other) <= 0.0
        following = jnp.where(inside, target, 0.5 * (positive + other))
        return _Between(positive, other, following, jnp.abs(following - now.at), now.steps + 1)

    begin = _Between(positive, other, first, jnp.asarray(jnp.inf), jnp.asarray(0))
    return jax.lax.while_loop(go_on, step, begin).at


def fixed_point(
    step: Callable[[Any], tuple[Any, jax.Array]],
    start: Any,
    close: jax.Array | float,
    steps: jax.Array | int,
) -> tuple[Any, jax.Array]:
    """What a step leaves as it is, and by how much the last one changed it.

    Parameters
    ----------
    step
        The next value, any tree of arrays, and how far it is from the one given: of Newton's
        method, or of direct iteration.
    start
        The first value.
    close
        A change after which no further step is made.
    steps
        Steps at most.
    """

    def go_on(carry: Any) -> jax.Array:
        return (carry[1] > close) & (carry[2] < steps)

    def following(carry: Any) -> Any:
        return (*step(carry[0]), carry[2] + 1)

    begin = start, jnp.asarray(jnp.inf), jnp.asarray(0)
    value, last, _ = jax.lax.while_loop(go_on, following, begin)
    return value, last

"""The path of a body whose summits feel one another, from one change of a bond to the next.

A bond that forms or breaks moves the other summits, at fixed separation; the energy that this sets
free is lost, besides what the bond itself loses.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..contact.asperity_table import Asperities
from ..contact.coupled_summits import CoupledSummits, SummitEquilibrium
from ..laws.law import Real
from ..numerics.trees import choose
from .external_forces import Load
from .force_curve import CurvePoint, ForceCurve
from .summit_path import end_of

_CLOSE = 1e-10  # of the shortest length of a law: how near a bond is to its change
_LENGTH = 0.1  # of the depth of the first summit: over which forces change
_STEP, _SHARE = 0.25, 0.1  # of that length, and of the gap of the first summit: longest step
_MOST = 4096  # steps
_AT_ONE = 32  # changes at one separation: more, where summits force one another on and off
_BEYOND = 1e-3  # of a step, by which a body then goes on
_BETWEEN = np.linspace(0.0, 1.0, 17)[1:]  # of a step, where the least value of a cubic is sought


class Path(NamedTuple):
    """State of a body along its path.

    ``last`` is the last point from where on no bond was missed, ``missed`` a separation behind one
    that was. ``freed`` is the energy that the contact loses as bonds change, ``lost`` what
    those that broke lose themselves; ``least`` and ``tension`` the least kinetic energy and the
    largest tension on retraction. It is ``sound`` while all points that count are solved. The
    ``curve`` is of the points from where on no bond was missed, where it is asked for.
    """

    separation: jax.Array
    bonded: jax.Array
    state: SummitEquilibrium
    outward: jax.Array
    last: CurvePoint
    missed: jax.Array
    freed: jax.Array
    lost: jax.Array
    least: jax.Array
    tension: jax.Array
    turning_point: jax.Array
    at_turn: SummitEquilibrium
    bonded_at_turn: jax.Array
    arrived: jax.Array
    sound: jax.Array
    still: jax.Array
    steps: jax.Array
    curve: ForceCurve | None


class _Choice(NamedTuple):
    """What a body does next.

    It ``acts`` where it is: the bonds ``chosen`` change, or it ``turns``, or it has arrived. Else
    it goes on, and nothing happens until it has gone what is ``left``, negative where it went too
    far. ``good`` is a point behind which no bond was missed, ``stuck`` one that is passed by force.
    """

    left: jax.Array
    chosen: jax.Array
    acts: jax.Array
    turns: jax.Array
    good: jax.Array
    stuck: jax.Array


class _Motion(NamedTuple):
    """A body that comes by ``top`` with an ``energy``, and goes by steps of about a ``length``.

    It turns where that is spent, or at a separation ``turn`` that is prescribed, if it is finite.
    """

    coupled: CoupledSummits
    load: Load
    top: jax.Array
    energy: jax.Array
    stored: jax.Array
    length: jax.Array
    turn: jax.Array

    @property
    def close(self) -> jax.Array:
        """Separation [m] that a bond may be away from its change."""
        return _CLOSE * self.coupled.summits.scale[0]

    def point(
        self, separation: jax.Array, state: SummitEquilibrium, freed: jax.Array
    ) -> CurvePoint:
        done = state.energy + freed - self.stored
        kinetic = self.energy - self.load.potential_gain(self.top, separation - self.top) - done
        return CurvePoint(separation, kinetic, state.force, state.stiffness)

    def choose(self, path: Path, here: CurvePoint) -> _Choice:
        """By the separations left to each change of a bond, to the turning point, to the end."""
        ahead, close = _ahead(path), self.close
        bonds = _left_to_bonds(self.coupled.summits, path.state, path.bonded, ahead)
        to_turn = self._left_to_turn(here)
        end = end_of(self.coupled.summits, self.coupled.offsets, path.bonded_at_turn, self.top)
        to_end = jnp.maximum(end - path.separation, 0.0)
        to_end = jnp.where(jnp.any(path.bonded), jnp.inf, to_end)
        nearest = jnp.min(bonds, initial=jnp.inf)
        left = jnp.minimum(nearest, jnp.where(path.outward, to_end, to_turn))
        back = ahead * (path.separation - path.last.separation)
        between = ahead * (path.missed - path.last.separation)
        # Where a bond is missed however near one comes, its summits have no equilibrium with it.
        folds = (ahead * (path.missed - path.separation) <= close) & (left > close)
        near = (left >= -close) | (back <= close) | (between <= close)
        solved = path.state.solved
        stuck = (path.still >= _AT_ONE) | (~solved & (back == 0.0))
        stuck = stuck | (solved & folds & (nearest == jnp.inf))
        acts = (((left <= close) & near) | folds) & solved & ~stuck
        changes = acts & ((nearest <= left) | folds)
        chosen = (bonds == nearest) & changes
        chosen = chosen & (jnp.cumsum(chosen.ravel()).reshape(chosen.shape) == 1)
        turns = acts & ~changes & ~path.outward
        good = acts | ((left > close) & solved) | stuck
        return _Choice(left, chosen, acts, turns, good, stuck)

    def _left_to_turn(self, here: CurvePoint) -> jax.Array:
        slope = here.force - self.load.force(here.separation)
        spent = jnp.where(here.kinetic > 0.0, jnp.inf, -jnp.inf)
        left = jnp.where(slope > 0.0, here.kinetic / jnp.where(slope > 0.0, slope, 1.0), spent)
        return jnp.where(jnp.isfinite(self.turn), here.separation - self.turn, left)

    def move(self, path: Path, choice: _Choice) -> jax.Array:
        """How far it goes [m]: on, to where the next summit pulls most; or back."""
        ahead, gaps = _ahead(path), path.state.gaps
        longest = jnp.maximum(_STEP * self.length, _SHARE * jnp.abs(gaps[0]))
        to_peak = ahead * (self.coupled.pull_off_gaps - gaps) / path.state.rates
        to_peak = jnp.min(jnp.where(to_peak > self.close, to_peak, jnp.inf))
        onward = jnp.minimum(jnp.minimum(choice.left, longest), to_peak)
        to_missed = ahead * (path.missed - path.separation)
        onward = jnp.where(onward < to_missed, onward, 0.5 * to_missed)
        onward = jnp.where(choice.stuck, _BEYOND * longest, onward)
        half_back = -0.5 * ahead * (path.separation - path.last.separation)
        back = jnp.where(path.state.solved, jnp.maximum(choice.left, half_back), half_back)
        move = ahead * jnp.where(choice.good, onward, back)
        return jnp.where(choice.acts, 0.0, move)

    def start(self, *, recorded: bool) -> Path:
        summits, nothing = self.coupled.summits, jnp.zeros(())
        none = jnp.zeros(summits.forming.shape, bool)
        first = self.coupled.equilibrium(self.top, none, self.top - self.coupled.offsets)
        here = CurvePoint(self.top, self.energy, first.force, first.stiffness)
        return Path(
            separation=self.top,
            bonded=none,
            state=first,
            outward=jnp.asarray(False),
            last=here,
            missed=jnp.asarray(-jnp.inf),
            freed=nothing,
            lost=jnp.zeros(summits.forming.shape[0]),
            least=jnp.asarray(jnp.inf),
            tension=nothing,
            turning_point=nothing,
            at_turn=first,
            bonded_at_turn=none,
            arrived=jnp.isnan(self.energy),
            sound=first.solved,
            still=jnp.asarray(0),
            steps=jnp.asarray(0),
            curve=ForceCurve.of(2 * _MOST, here) if recorded else None,
        )

    def step(self, path: Path) -> Path:
        """One move, or one change of a bond at fixed separation."""
        state, bonded = path.state, path.bonded
        here = self.point(path.separation, state, path.freed)
        choice = self.choose(path, here)
        move, chosen, turns = self.move(path, choice), choice.chosen, choice.turns
        changes = jnp.any(chosen)
        separation = path.separation + move
        new = self.coupled.equilibrium(separation, bonded ^ chosen, state.gaps + state.rates * move)
        released = state.energy - new.energy - 0.5 * (state.force + new.force) * move
        freed = path.freed + jnp.where(changes | choice.stuck, released, 0.0)
        there = self.point(separation, new, freed)
        last = choose(choice.good, here, path.last)
        outward = path.outward | turns
        missed = jnp.where(choice.good, path.missed, path.separation)
        begun = jnp.where(outward, jnp.inf, -jnp.inf)
        counted = choice.good & path.outward & (here.separation > path.last.separation)
        least = _least_between(path.last, here, self.load)
        tension = -jnp.minimum(path.last.force, here.force)
        summits = self.coupled.summits
        return Path(
            separation=separation,
            bonded=bonded ^ chosen,
            state=new,
            outward=outward,
            last=choose(changes | choice.stuck, there, last),
            missed=jnp.where(choice.acts | choice.stuck, begun, missed),
            freed=freed,
            lost=path.lost + jnp.sum(jnp.where(chosen & bonded, summits.lost, 0.0), axis=1),
            least=jnp.where(counted, jnp.minimum(path.least, least), path.least),
            tension=jnp.where(counted, jnp.maximum(path.tension, tension), path.tension),
            turning_point=jnp.where(turns, path.separation, path.turning_point),
            at_turn=choose(turns, state, path.at_turn),
            bonded_at_turn=jnp.where(turns, bonded, path.bonded_at_turn),
            arrived=choice.acts & ~changes & ~turns,
            sound=path.sound & (state.solved | ~choice.good),
            still=jnp.where(changes, path.still + 1, 0),
            steps=path.steps + 1,
            curve=_recorded(path, choice, here, there),
        )


def _recorded(
    path: Path, choice: _Choice, here: CurvePoint, there: CurvePoint
) -> ForceCurve | None:
    """The curve with where a body is, and with where it is once a bond has changed."""
    if path.curve is None:
        return None
    moved = choice.good & (here.separation != path.last.separation)
    curve = path.curve.append(here, moved)
    curve = curve._replace(turn=jnp.where(path.outward, curve.turn, curve.size - 1))
    return curve.append(there, jnp.any(choice.chosen) | choice.stuck, steps=True)


def _ahead(path: Path) -> jax.Array:
    """1 outwards, -1 inwards."""
    return jnp.where(path.outward, 1.0, -1.0)


def _left_to_bonds(
    summits: Asperities, state: SummitEquilibrium, bonded: jax.Array, ahead: jax.Array
) -> jax.Array:
    """Separation [m] that is left until each bond forms or breaks, shape (laws, n).

    By the rate of its gap; negative where it was missed, infinite where it moves away.
    """
    edge = jnp.where(bonded, summits.breaking, summits.forming)
    sign = jnp.where(bonded, 1.0, -1.0)
    left, rate = sign * (edge - state.gaps), sign * ahead * state.rates
    missed = jnp.where(left <= 0.0, -jnp.inf, jnp.inf)
    return jnp.where(rate > 0.0, left / jnp.where(rate > 0.0, rate, 1.0), missed)


def _least_between(start: CurvePoint, end: CurvePoint, load: Load) -> jax.Array:
    """The least kinetic energy [J] between two points, by the cubic through both."""
    t, width = _BETWEEN, end.separation - start.separation
    slope, end_slope = (
        width * (point.force - load.force(point.separation)) for point in (start, end)
    )
    ends = start.kinetic * (1.0 + 2.0 * t) * (1.0 - t) ** 2
    ends = ends + end.kinetic * t**2 * (3.0 - 2.0 * t)
    return jnp.min(ends + slope * t * (1.0 - t) ** 2 - end_slope * t**2 * (1.0 - t))


def follow(
    coupled: CoupledSummits,
    load: Load,
    top: jax.Array,
    energy: jax.Array,
    depth: jax.Array,
    *,
    turn: Real = -np.inf,
    inward: jax.Array | bool = False,
    recorded: bool = False,
) -> Path:
    """A body down to its turning point and out again.

    Parameters
    ----------
    coupled
        Its summits.
    load
        What presses it towards the surface.
    top
        Separation at which it comes, and beyond which nothing is felt [m].
    energy
        Its kinetic energy there [J]; NaN for one that stays away.
    depth
        How deep its first summit will be pressed, about [m].
    turn
        Where it turns [m], where that is finite and not where its energy is spent.
    inward
        Whether its path ends where it turns.
    recorded
        Whether its curve is kept.

    Returns
    -------
    The end of its path; without ``arrived`` where that was not found.
    """
    length = jnp.maximum(coupled.summits.scale[0], _LENGTH * depth)
    motion = _Motion(coupled, load, top, energy, jnp.zeros(()), length, jnp.asarray(turn))
    start = motion.start(recorded=recorded)
    motion = motion._replace(stored=start.state.energy)

    def goes_on(path: Path) -> jax.Array:
        return ~(path.arrived | (path.outward & inward)) & (path.steps < _MOST)

    return jax.lax.while_loop(goes_on, motion.step, start)

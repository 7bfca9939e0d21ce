"""A phase of a motion with drag: it takes energy on the way.

Along a piece of the way the speed v obeys m v^2/2 + (work of the drag c v) = energy, E(x), that
the other forces give. With x = L sin^2(pi y/2) both ends of a phase, where v starts or ends as
the square root of the distance, are smooth in y: the equation is met at Gauss's points of each
piece, by Newton's method, one piece after the other.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from .._jax import jax, jnp
from ..laws.law import Real
from ..numerics.krylov import implicit_solve
from ..numerics.polynomials import DERIVATIVE, chebyshev_sum, local
from ..numerics.roots import fixed_point
from .curve_table import CENTRAL, FORCE
from .external_forces import Along, Load
from .phase import Work
from .phase_time import NEAR, missed_time
from .record import Body

POINTS = 24
_CLOSE = 1e-13  # relative change of the speeds that is small enough
_DIRECT = 20  # steps of direct iteration, before Newton's
_STEPS = 40
_TURNED = 1e-8  # of the energy of a piece: more than a turning place is off by

GAUSS = 0.5 * (np.polynomial.legendre.leggauss(POINTS)[0] + 1.0)
SHARES = np.sin(0.5 * np.pi * GAUSS) ** 2
"""Places on a piece, as fractions of what is passed of it."""
PACE = 0.5 * np.pi * np.sin(np.pi * GAUSS)
_DERIVATIVE = np.pad(DERIVATIVE, ((0, 1), (0, 0)))


def _integrals(ends: np.ndarray) -> np.ndarray:
    """Integrals from 0 to each end of the polynomials that are 1 at one Gauss point each."""
    series = np.linalg.inv(np.polynomial.legendre.legvander(2.0 * GAUSS - 1.0, POINTS - 1))
    whole = np.polynomial.legendre.legint(series, lbnd=-1, axis=0)
    sums: np.ndarray = np.polynomial.legendre.legvander(2.0 * ends - 1.0, POINTS) @ whole
    return 0.5 * sums


UNTIL = _integrals(GAUSS)
WHOLE = _integrals(np.ones(1))[0]
_FINE_PLACES = np.linspace(0.0, 1.0, 129)
_FINE = np.polynomial.legendre.legvander(2.0 * _FINE_PLACES - 1.0, POINTS - 1) @ np.linalg.inv(
    np.polynomial.legendre.legvander(2.0 * GAUSS - 1.0, POINTS - 1)
)


def whole_of(values: jax.Array) -> jax.Array:
    """Mean over a piece of what has these values at SHARES of it."""
    return jnp.dot(WHOLE, PACE * values)


class PieceMotion(NamedTuple):
    """One piece, or the part of it that is passed.

    Attributes
    ----------
    speed
        Speed [m/s] at SHARES of it.
    time, dissipated
        Time [s], and energy taken by each drag [J], shape (drags, POINTS), until there.
    duration, lost
        The same over all of it.
    kinetic
        Kinetic energy at its end [J].
    passed
        Whether the body comes to its end.
    maximum_kinetic
        Largest kinetic energy on it [J].
    """

    speed: jax.Array
    time: jax.Array
    dissipated: jax.Array
    duration: jax.Array
    lost: jax.Array
    kinetic: jax.Array
    passed: jax.Array
    maximum_kinetic: jax.Array

    @classmethod
    def none(cls, body: Body, kinetic: jax.Array) -> PieceMotion:
        """On a piece without length, of a body with a kinetic energy [J]."""
        still, drags = jnp.zeros(POINTS), jnp.zeros(len(body.drags))
        taken = jnp.zeros((len(body.drags), POINTS))
        return cls(still, still, taken, jnp.zeros(()), drags, kinetic, jnp.asarray(True), kinetic)


class Piece(Protocol):
    """A piece of a way, whose forces are known at every place of it."""

    @property
    def enter(self) -> jax.Array:
        """Where the body enters it [m]."""

    @property
    def leave(self) -> jax.Array:
        """Where it leaves it [m]."""

    @property
    def ahead(self) -> jax.Array:
        """1 outwards, -1 inwards, 0 for an empty piece."""

    def energy(self, places: jax.Array, load: Load) -> jax.Array:
        """What contact and load add to the kinetic energy from the entry to there [J]."""

    def push(self, place: jax.Array, load: Load) -> jax.Array:
        """Force of contact and load at a place [N], positive apart."""

    def drags(self, body: Body, places: jax.Array, speed: jax.Array) -> jax.Array:
        """Each drag [N s/m] at places [m] and about these speeds [m/s], (drags, places)."""


class DampedPiece(NamedTuple):
    """One of :class:`Pieces`, with the integral of its force, and that up to its entry [J]."""

    low: jax.Array
    high: jax.Array
    enter: jax.Array
    leave: jax.Array
    force: jax.Array
    integral: jax.Array
    central: jax.Array
    entry: jax.Array

    @classmethod
    def of(cls, work: Work, k: jax.Array) -> DampedPiece:
        """Piece ``k`` of those that work is done along."""
        p, integral = work.pieces, work.integral[:, k, 0]
        low, high, enter = p.low[k], p.high[k], p.enter[k]
        entry = chebyshev_sum(integral, local(low, high, enter))
        return cls(
            low, high, enter, p.leave[k], p.values[k, :, FORCE], integral,
            p.values[k, :, CENTRAL], entry,
        )  # fmt: skip

    def energy(self, places: jax.Array, load: Load) -> jax.Array:
        gain = chebyshev_sum(self.integral, local(self.low, self.high, places)) - self.entry
        return gain - load.potential_gain(self.enter, places - self.enter)

    def push(self, place: jax.Array, load: Load) -> jax.Array:
        return chebyshev_sum(self.force, local(self.low, self.high, place)) - load.force(place)

    def drags(self, body: Body, places: jax.Array, speed: jax.Array) -> jax.Array:
        x = local(self.low, self.high, places)
        width = self.high - self.low
        rate = jnp.where(width > 0.0, 2.0 / jnp.where(width > 0.0, width, 1.0), 0.0)
        slope = rate * (_DERIVATIVE @ self.force)
        along = jnp.stack([self.central, slope, rate * (_DERIVATIVE @ slope)], axis=1)
        central, stiffness, change = chebyshev_sum(along[:, :, None], x)
        return body.resistances(Along(central, stiffness, change, speed))

    @property
    def ahead(self) -> jax.Array:
        return jnp.sign(self.leave - self.enter)


def move_on(body: Body, piece: Piece, kinetic: jax.Array, stop: jax.Array) -> PieceMotion:
    """From where a piece is entered with a kinetic energy [J] to ``stop`` [m]."""
    span = stop - piece.enter
    places = piece.enter + span * SHARES
    energies = kinetic + piece.energy(jnp.append(places, stop), body.load)
    energy, last = energies[:-1], energies[-1]
    # A unit alone, without a derivative: that of a maximum divides by how many are equal to it,
    # which is none where XLA computes them once more with another rounding.
    most = jax.lax.stop_gradient(jnp.maximum(jnp.max(jnp.abs(energy)), jnp.abs(last)))
    most = jnp.where(most > 0.0, most, 1.0)
    unit = jnp.sqrt(2.0 * most / body.mass)
    length = jnp.abs(span) * PACE
    share = energy / most
    # The speed that it would have without drag on this piece: no more than a cut-off needs.
    free = unit * jnp.sqrt(jnp.where(share > 0.0, share, 1.0)) * (share > 0.0)
    drags = 2.0 * piece.drags(body, places, free) * length / (body.mass * unit)
    # u^2 + (the integral of the drags u) = share, in u = speed / unit. Where it is spent without
    # drag already nothing is solved.
    spent = jnp.any(share <= 0.0)
    drags = jnp.where(spent, 0.0, drags)
    share = jnp.where(spent, 1.0, share)
    u, solved = jnp.sqrt(share), jnp.asarray(True)
    if body.drags:
        u, solved = _reduced_speeds(share, jnp.sum(drags, axis=0))
    solved = solved & ~spent
    dissipated = most * ((drags * u) @ UNTIL.T)
    lost = most * ((drags * u) @ WHOLE)
    left = last - jnp.sum(lost)
    pace = jnp.where(u > 0.0, length / (unit * jnp.where(u > 0.0, u, 1.0)), 0.0)
    empty = span == 0.0
    return PieceMotion(
        speed=unit * u,
        time=jnp.asarray(UNTIL) @ pace,
        dissipated=dissipated,
        duration=WHOLE @ pace + _missed_time(body, piece, (kinetic, left), most * u**2, stop),
        lost=jnp.where(empty, 0.0, lost),
        kinetic=jnp.where(empty, kinetic, left),
        passed=empty | (solved & (left > 0.0)),
        maximum_kinetic=jnp.where(empty, kinetic, jnp.max(_FINE @ (most * u**2))),
    )


def _missed_time(
    body: Body,
    piece: Piece,
    ends: tuple[jax.Array, jax.Array],
    energies: jax.Array,
    stop: jax.Array,
) -> jax.Array:
    """Time [s] that the quadrature misses where the body is nearly at rest at either end.

    ``ends`` are its kinetic energies there, ``energies`` those at SHARES [J]. What is left at the
    end counts from a part of the energy on that no turning place is off by.
    """
    span = stop - piece.enter
    total = jnp.zeros(())
    for energy, place, towards, beside, least in (
        (ends[0], piece.enter, 1.0, energies[NEAR], 0.0),
        (ends[1], stop, -1.0, energies[-1 - NEAR], _TURNED),
    ):
        gain = towards * piece.push(place, body.load) * span
        grown = energy + gain * SHARES[NEAR]
        counts = (jnp.abs(beside - grown) < 0.1 * grown) & (energy > least * gain)
        missed = missed_time(energy, gain, SHARES, WHOLE * PACE)
        total = total + jnp.where(counts, missed, 0.0)
    return total * jnp.abs(span) * jnp.sqrt(0.5 * body.mass)


@jax.custom_jvp
def _reduced_speeds(share: jax.Array, drag: jax.Array) -> tuple[jax.Array, jax.Array]:
    """Solution u of u^2 + (the integral of drag u) = share, and whether it is one.

    Direct iteration converges faster than any power where the drag is weak; Newton's method
    takes over where it is strong. Where nothing but the drag acts, u falls by half its integral:
    they begin there where it is closer, since they do not find a body that the drag stops.
    """

    def direct(u: jax.Array) -> tuple[jax.Array, jax.Array]:
        return _compared(jnp.sqrt(jnp.maximum(share - UNTIL @ (drag * u), 0.0)), u)

    free = jnp.sqrt(jnp.maximum(share, 0.0))
    coasting = jnp.sqrt(jnp.maximum(share[0], 0.0)) - 0.5 * (UNTIL @ drag)
    coasts = jnp.all(coasting > 0.0) & (_off(coasting, share, drag) < _off(free, share, drag))
    start = jnp.where(coasts, coasting, free)
    turns = jnp.where(_off(start, share, drag) <= _CLOSE * POINTS, 0, _DIRECT)
    u, _ = fixed_point(direct, start, _CLOSE, turns)
    return _by_newton(u, start, share, drag, jnp.asarray(UNTIL))


@jax.custom_batching.sequential_vmap
def _by_newton(
    u: jax.Array, start: jax.Array, share: jax.Array, drag: jax.Array, until: jax.Array
) -> tuple[jax.Array, jax.Array]:
    """The same by Newton's method from ``start`` where ``u`` is no solution, and whether it is one.

    Of a batch those alone are solved that ask for it. ``until`` are the integrals: within a batch
    of batches JAX knows no constants here.
    """

    def newton(u: jax.Array) -> tuple[jax.Array, jax.Array]:
        slopes = jnp.diag(2.0 * u) + until * drag
        move = jnp.linalg.solve(slopes, _missed(u, share, drag, until)[:, None])[:, 0]
        # Never past a tenth of itself: a speed that has no solution falls to nothing.
        return _compared(jnp.maximum(u - move, 0.1 * u), u)

    def solved() -> tuple[jax.Array, jax.Array]:
        return fixed_point(newton, start + 1e-6, _CLOSE, _STEPS)

    unsolved = _off(u, share, drag, until) > _CLOSE * POINTS
    u, change = jax.lax.cond(unsolved, solved, lambda: (u, jnp.zeros(())))
    return u, (change <= 1e-9) & (_off(u, share, drag, until) < 1e-9)


def _compared(after: jax.Array, u: jax.Array) -> tuple[jax.Array, jax.Array]:
    """A next value, and by how much it differs from the last, of its largest."""
    most = jnp.max(jnp.abs(after))
    return after, jnp.max(jnp.abs(after - u)) / jnp.where(most > 0.0, most, 1.0)


def _off(u: jax.Array, share: jax.Array, drag: jax.Array, until: Real = UNTIL) -> jax.Array:
    return jnp.max(jnp.abs(_missed(u, share, drag, until)))


@_reduced_speeds.defjvp
def _reduced_speeds_jvp(primals, tangents):  # type: ignore[no-untyped-def]
    (share, drag), (dshare, ddrag) = primals, tangents
    u, close = _reduced_speeds(share, drag)
    sound = close & jnp.all(u > 0.0)  # else nothing moves, or nothing is solved
    matrix = jnp.where(sound, jnp.diag(2.0 * u) + UNTIL * drag, jnp.eye(POINTS))
    push = jnp.where(sound, dshare - UNTIL @ (ddrag * u), 0.0)
    return (u, close), (implicit_solve(matrix, push), np.zeros(close.shape, jax.dtypes.float0))


def _missed(u: jax.Array, share: jax.Array, drag: jax.Array, until: Real = UNTIL) -> jax.Array:
    return u**2 + until @ (drag * u) - share

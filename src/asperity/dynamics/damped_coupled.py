"""The path of a body that drags slow, on summits that feel one another through a half-space.

The forces on its way in do not depend on how fast it is, nor those on its way out but for where it
turns. So it is followed in without drags, which let it come no deeper; drags act along the curve of
its force; and it is followed once more, from where they let it turn.
"""

from __future__ import annotations

from typing import NamedTuple

from .._jax import jax, jnp
from ..contact.coupled_summits import CoupledSummits
from .coupled_path import Path, follow
from .damped_phase import PhaseProgress, over_piece
from .damped_summits import departed, fly
from .damped_turning_point import turn_on
from .force_curve import CurvePiece, ForceCurve
from .record import Body
from .summit_path import Arrival, Departure, Launch


class _Way(NamedTuple):
    """A body on its way in or out: its path, its progress, the last piece that it entered.

    And where it stops there [m], with what drags have taken until then [J].
    """

    path: Path
    progress: PhaseProgress
    last: CurvePiece
    stop: jax.Array
    taken: jax.Array


def _along(
    body: Body,
    curve: ForceCurve,
    within: tuple[jax.Array, jax.Array],
    kinetic: jax.Array,
) -> tuple[PhaseProgress, CurvePiece]:
    """From one point of a curve to another, and the last piece that it enters."""
    first, last = within
    begun = PhaseProgress.begun(body, kinetic)._replace(piece=first)

    def goes_on(now: tuple[PhaseProgress, jax.Array]) -> jax.Array:
        return now[0].going & (now[1] < last)

    def on(now: tuple[PhaseProgress, jax.Array]) -> tuple[PhaseProgress, jax.Array]:
        progress, start = now
        piece = curve.piece(start, last)
        return over_piece(body, progress, piece, start)[0], start + piece.intervals

    now, _ = jax.lax.while_loop(goes_on, on, (begun, first))
    return now, curve.piece(now.piece, last)


def damped_path(
    body: Body,
    coupled: CoupledSummits,
    launch: Launch,
    top: jax.Array,
    free: Arrival,
    depth: jax.Array,
) -> tuple[Path, Arrival, Departure]:
    """The path of a body, and how it comes and leaves.

    Parameters
    ----------
    body
        What moves.
    coupled
        Its summits.
    launch, top
        How it comes, and where their forces begin [m].
    free
        How it would come without drags on a rigid bulk.
    depth
        How deep its first summit will be pressed, about [m].
    """
    load, (flight, above) = body.load, fly(body, launch, top)
    energy = jnp.where(flight.going, free.before, jnp.nan)  # what stops above meets no summit

    def go(turn: jax.Array, outward: jax.Array) -> tuple[jax.Array, _Way]:
        path = follow(coupled, load, top, energy, depth, turn=turn, inward=~outward, recorded=True)
        curve = path.curve
        assert curve is not None
        first = jnp.where(outward, curve.turn, 0)
        last = jnp.where(outward, curve.size - 1, curve.turn)
        kinetic = jnp.where(outward, 0.0, flight.kinetic)
        now, piece = _along(body, curve, (first, last), kinetic)
        stops = ~outward & ~now.going

        def stopped() -> tuple[jax.Array, jax.Array]:
            place, moved = turn_on(body, piece, now.kinetic)
            return place, moved.lost

        nothing = path.separation, jnp.zeros_like(now.dissipated)
        place, lost = jax.lax.cond(stops, stopped, lambda: nothing)
        return place, _Way(path, now, piece, place, now.dissipated + lost)

    # In, and once more in and out: one program serves both.
    _, ways = jax.lax.scan(go, -jnp.asarray(jnp.inf), jnp.asarray([False, True]))
    inward, outward = (jax.tree_util.tree_map(lambda x, k=k: x[k], ways) for k in (0, 1))
    met, curve = flight.going, outward.path.curve
    back = inward.last.push(inward.stop, load) > 0.0
    back = jnp.where(met, inward.progress.going | back, load.force(above) < 0.0)
    # What the cubic between two points of its curve misses by where it turns is not lost.
    rest = flight.kinetic - energy + curve.points.kinetic[curve.turn] - jnp.sum(inward.taken)
    arrival = Arrival(
        before=jnp.where(met, flight.kinetic, 0.0),
        turning_point=jnp.where(met, inward.stop, above),
        kinetic=rest,
        taken=flight.dissipated + jnp.where(met, inward.taken, 0.0),
        met=met,
        stays=~back,
    )
    left = departed(body, outward.progress, outward.last)
    return outward.path, arrival, left._replace(after=left.after + rest)

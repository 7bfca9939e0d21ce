"""Pieces of a phase with drag, cut where the speed changes over less than a piece."""

from __future__ import annotations

from functools import reduce

import numpy as np

from .._jax import jax, jnp
from ..numerics.polynomials import chebyshev_sum, local
from ..numerics.roots import root_between
from .curve_table import CENTRAL, FORCE, Pieces
from .external_forces import Along
from .phase import work_along
from .record import Body

_CUTS, _RATIO = 12, 4.0  # of a phase by a film's gaps: how many, each so much wider
_SPAN = 1e-6  # of the widest gap: the narrowest that is cut, of a film that thins without end

_EQUILIBRIA = 2  # to which a body may creep in one phase: the first of them
_LOOKS = np.linspace(0.0, 1.0, 9)  # on a piece for them
_CLOSE = 1e-15  # of a look: a move that is lost in rounding
_NARROW = 1e-10  # of a separation: the places on so narrow a piece differ by rounding alone
_LIGHT = 0.5  # of the largest momentum: a drag that takes less over a phase turns no body slowly
_NEARER = 4.0 ** -np.arange(1.0, 11.0)  # of the distance: cuts about its start and about them


def resolved(
    body: Body, pieces: Pieces, kinetic: jax.Array, spent: jax.Array
) -> tuple[Pieces, jax.Array]:
    """Pieces cut where drags ask for it, and which one each is a part of.

    Those as narrow as rounding are parts of the ones beside them: such is the way back to the
    branch of a law that remembers, where a body turned far above contact.

    Parameters
    ----------
    body
        The body; without a drag outside contact nothing is cut.
    pieces
        The polynomials ahead of it.
    kinetic
        Kinetic energy at the start [J].
    spent
        Where drag has taken the body's momentum, if it goes on from there [m]; else NaN.
    """
    count = pieces.low.shape[0]
    ends = jnp.concatenate([pieces.enter[:1], pieces.leave])
    ahead = jnp.where(ends[-1] < ends[0], -1.0, 1.0)
    cuts = [*_in_film(body, pieces, ends, ahead), *_to_rest(body, pieces, kinetic, ahead)]
    if body.damped_apart and not body.forces:
        cuts = [*cuts, _about(spent, jnp.sort(ahead * jnp.concatenate([ends, *cuts])), ahead)]
    places = _without_narrow(jnp.sort(ahead * jnp.concatenate([ends, *cuts])))
    middles = 0.5 * (places[1:] + places[:-1])
    part = jnp.clip(jnp.searchsorted(ahead * pieces.leave, middles), 0, count - 1)
    low, high, _, _, values = (leaf[part] for leaf in pieces)
    return Pieces(low, high, ahead * places[:-1], ahead * places[1:], values), part


def _without_narrow(ends: jax.Array) -> jax.Array:
    """The ends of pieces, ascending, with those empty that are too narrow for drag.

    Each is a part of the next wide one, those behind the last of that.
    """
    last = ends.shape[0] - 1
    wide = jnp.diff(ends) > _NARROW * jnp.abs(ends[:-1])
    kept = jax.lax.cummax(jnp.where(wide, np.arange(1, last + 1), 0))
    return jnp.append(ends[0], ends[jnp.where(kept == kept[-1], last, kept)])


def _about(spent: jax.Array, ends: jax.Array, ahead: jax.Array) -> jax.Array:
    """Cuts closer and closer to where drag has taken a momentum, on both sides of it."""
    place = jnp.clip(jax.lax.stop_gradient(ahead * spent), ends[0], ends[-1])
    piece = jnp.clip(jnp.searchsorted(ends, place), 1, ends.shape[0] - 1)
    before, after = place - ends[piece - 1], ends[piece] - place
    cuts = jnp.concatenate([place[None], place - before * _NEARER, place + after * _NEARER])
    return ahead * jnp.where(jnp.isnan(place), ends[-1], cuts)


def _in_film(body: Body, pieces: Pieces, ends: jax.Array, ahead: jax.Array) -> list[jax.Array]:
    """Wide pieces are cut where a film thins by a factor.

    Its drag goes as one over the separation, which no polynomial follows over decades.
    """
    thinnest = [drag.thinnest for drag in body.drags if drag.thinnest is not None]
    if not thinnest:
        return []
    widest, count = jnp.max(ends), pieces.low.shape[0]
    narrow = jnp.maximum(reduce(jnp.minimum, thinnest), _SPAN * jnp.abs(widest))
    cuts = jax.lax.stop_gradient(narrow * _RATIO ** np.arange(_CUTS))
    cuts = jnp.clip(cuts, jnp.min(ends), widest)
    here = jnp.clip(jnp.searchsorted(ahead * pieces.leave, ahead * cuts), 0, count - 1)
    near = jnp.minimum(pieces.enter, pieces.leave)[here]
    far = jnp.maximum(pieces.enter, pieces.leave)[here]
    return [jnp.where(far > _RATIO * jnp.maximum(near, narrow), cuts, pieces.leave[here])]


def _to_rest(body: Body, pieces: Pieces, kinetic: jax.Array, ahead: jax.Array) -> list[jax.Array]:
    """Cuts closer and closer to where the speed of an overdamped body changes quickly.

    From its start, or from where drag has taken the momentum that it starts with, it goes on at a
    speed at which drag balances the other forces. This falls to nothing at an equilibrium. A body
    without a spring is at rest in contact alone, where pieces are short. Where drag takes little of
    the momentum nothing is cut.
    """
    if not (body.forces and body.damped_apart):
        return []
    pieces, body, kinetic = jax.lax.stop_gradient((pieces, body, kinetic))
    start, end = pieces.enter[0], pieces.leave[-1]
    both = np.array([0, -1])
    ends = local(pieces.low[both], pieces.high[both], jnp.stack([start, end]))
    central = jax.vmap(chebyshev_sum)(pieces.values[both, :, CENTRAL], ends)
    drags = jnp.sum(body.resistances(Along.apart(central)), axis=0)
    spent = start + ahead * jnp.sqrt(2.0 * body.mass * kinetic) / drags[0]
    energy = jnp.max(work_along(pieces, kinetic, body.load).kinetic)
    heavy = jnp.max(drags) * jnp.abs(end - start) > _LIGHT * jnp.sqrt(2.0 * body.mass * energy)
    places = jnp.append(_equilibria(body, pieces, ahead), spent)
    about = places[:, None] + jnp.abs(places - start)[:, None] * _NEARER
    before = places[:, None] - jnp.abs(places - start)[:, None] * _NEARER
    begin = start + (end - start) * _NEARER
    cuts = jnp.concatenate([places, about.ravel(), before.ravel(), begin])
    cuts = jnp.where(heavy, cuts, end)
    return [jnp.clip(cuts, jnp.minimum(start, end), jnp.maximum(start, end))]


def _equilibria(body: Body, pieces: Pieces, ahead: jax.Array) -> jax.Array:
    """The first places of a phase where a push ahead becomes one back [m]; else its end."""
    span, force = pieces.leave - pieces.enter, pieces.values[..., FORCE]

    def push(piece: jax.Array, place: jax.Array) -> jax.Array:
        x = local(pieces.low[piece], pieces.high[piece], place)
        return ahead * (chebyshev_sum(force[piece], x) - body.load.force(place))

    every = jnp.arange(span.shape[0])
    places = pieces.enter[:, None] + span[:, None] * _LOOKS
    pushes = jax.vmap(jax.vmap(push, in_axes=(None, 0)))(every, places)
    ends = (pushes[:, :-1] > 0.0) & (pushes[:, 1:] <= 0.0) & (span != 0.0)[:, None]
    (found,) = jnp.nonzero(ends.ravel(), size=_EQUILIBRIA, fill_value=-1)
    piece, look = found // (_LOOKS.size - 1), found % (_LOOKS.size - 1)

    def equilibrium(piece: jax.Array, near: jax.Array, far: jax.Array) -> jax.Array:
        close = _CLOSE * jnp.abs(far - near)
        return root_between(lambda place: push(piece, place), near, far, close)

    rests = jax.vmap(equilibrium)(piece, places[piece, look], places[piece, look + 1])
    return jnp.where(found >= 0, rests, pieces.leave[-1])

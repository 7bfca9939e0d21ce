"""Force against separation without motion: in to a depth, and out again."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import equinox as eqx
import numpy as np

from ._jax import jax, jnp
from .contact.base import Contact, State
from .impact.motion import Impacts
from .impact.table import Table

_POINTS = 240


def trace(contact: Contact, table: Table, impacts: Impacts) -> dict[str, Any]:
    """Both branches from where the forces begin to the depth of the first impact.

    Parameters
    ----------
    contact
        The contact.
    table
        Its curves; their panels say where the force changes fast.
    impacts
        A motion's impacts, of which the first is taken.

    Returns
    -------
    The arrays and numbers of :class:`asperity.result.Curve`.
    """
    deepest = float(impacts.deepest[0])
    reach = float(contact.reach)
    top = min(float(impacts.fall.start[0]), reach + 0.2 * (reach - deepest))
    places = _places(np.asarray(table.ends), deepest, top)
    approach = _states(contact, contact.fresh(), jnp.asarray(places))
    memory = _remember(contact, jnp.asarray(deepest))
    parting = _states(contact, memory, jnp.asarray(places))
    out = np.asarray(parting.force)
    names = contact.components
    return {
        "rigid_separation": places,
        "central_separation": np.asarray(approach.central),
        "force_approach": np.asarray(approach.force),
        "force_parting": out,
        "components_approach": _named(names, approach),
        "components_parting": _named(names, parting),
        "deepest": deepest,
        "pull_off": float(max(-out.min(), 0.0)),
        "work_of_separation": _tension_work(places, out),
        "loss": _loss(contact, approach, parting),
    }


@eqx.filter_jit
def _states(contact: Contact, memory: Any, places: jax.Array) -> State:
    return jax.lax.map(lambda d: contact.state(d, memory), places, batch_size=32)


@eqx.filter_jit
def _remember(contact: Contact, deepest: jax.Array) -> Any:
    return contact.remember(contact.fresh(), deepest)


def _named(names: tuple[str, ...], states: State) -> dict[str, np.ndarray]:
    return {name: np.asarray(states.parts[:, k]) for k, name in enumerate(names)}


def _places(ends: np.ndarray, deepest: float, top: float) -> np.ndarray:
    """Separations from the deepest point up: even on each panel of the curves."""
    inside = ends[(ends > deepest) & (ends < top)]
    ends = np.unique(np.concatenate([[deepest], inside, [top]]))
    share = max(3, _POINTS // (len(ends) - 1))
    steps = [np.linspace(a, b, share, endpoint=False) for a, b in pairwise(ends)]
    return np.concatenate([*steps, [top]])


def _tension_work(places: np.ndarray, force: np.ndarray) -> float:
    """Work against tension on the way out [J], by Simpson's rule."""
    from scipy.integrate import simpson

    return float(-simpson(np.minimum(force, 0.0), x=places))


def _loss(contact: Contact, approach: State, parting: State) -> float:
    """Energy lost in and out: bonds made on the way in, and broken on the way out."""
    formation, rupture = (np.asarray(x) for x in contact.losses())
    made = np.asarray(approach.bonds[0] - approach.bonds[-1])
    broken = np.asarray(parting.bonds[0] - parting.bonds[-1])
    return float(made @ formation + broken @ rupture)

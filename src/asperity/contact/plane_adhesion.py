"""How rough planes adhere as a whole, and whether they draw a body to a single contact."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..errors import InputError, SimulationError
from ..interface.rough_planes import RoughPlanes
from ..numerics.compilation import AT_ONCE, Program, kept
from .elastic import ElasticContact
from .resolution import LINEAR

LIMIT = 2.0
"""Tabor number of the planes above which the edge of a contact is sharper than rings resolve."""

FOLDS = 0.6
"""Tabor number of the planes above which equilibria are likely to fold: 0.7 with DMT's asperities,
0.9 to 1.5 with those of Maugis and of Johnson, Kendall and Roberts."""

_DEEP = 30.0  # rms heights below the mean planes, from which their work is counted
_PLACES = 600


@kept
class PlaneAdhesion(NamedTuple):
    """The adhesion of rough planes, without bonds and with all that can hold.

    Attributes
    ----------
    work
        Work against their attraction [J/m^2], shape (2,).
    pull
        Their largest tension [Pa], likewise.
    """

    work: jax.Array
    pull: jax.Array


def _adhesion(planes: RoughPlanes) -> PlaneAdhesion:
    scale = LINEAR * planes.scale.rms
    high = planes.scale.top + planes.interaction_range
    ends = jnp.arcsinh(-_DEEP / LINEAR), jnp.arcsinh(high / scale)
    places = scale * jnp.sinh(jnp.linspace(*ends, _PLACES))
    memory = planes.initial_memory(places), planes.saturated_memory(places)
    tension = jnp.stack([jnp.maximum(-planes.pressure(places, one), 0.0) for one in memory])
    work = jnp.sum(0.5 * (tension[:, 1:] + tension[:, :-1]) * jnp.diff(places), axis=1)
    return PlaneAdhesion(work, jnp.max(tension, axis=1))


_of, _of_each = Program(_adhesion, AT_ONCE), Program(jax.vmap(_adhesion), AT_ONCE)


def tabor_number_of_planes(contact: ElasticContact) -> float:
    """Tabor number of a body with its rough planes in place of atoms (Tabor 1977).

    (R W^2/(E*^2 d^3))^(1/3) with their own work W and its range d, that work over their largest
    tension; of the bonds that hold or not, whichever give the larger.

    Raises
    ------
    InputError
        If it is above the limit: the rough surfaces adhere as two smooth ones do.
    SimulationError
        If their adhesion is not a number.
    """
    work, pull = (np.asarray(x) for x in _of(contact.interface))
    if not np.all(np.isfinite([work, pull])):
        raise SimulationError("the adhesion of the rough planes is not a number")
    tabor = _tabor_numbers(contact, work, pull)
    worst = int(np.argmax(tabor))
    if tabor[worst] > LIMIT:
        raise InputError(
            "adhesion draws the rough surfaces together as one: their own work of adhesion is "
            f"{work[worst] * 1e3:.4g} mJ/m^2 and their Tabor number {tabor[worst]:.3g} (the limit "
            f"is {LIMIT:g}), so that the edge of the contact is sharper than its rings; take JKR's "
            "smooth sphere with that work, a case without [roughness]",
            key="adhesion.work" if "adhesion" in contact.components else None,
        )
    return float(tabor[worst])


def tabor_numbers_of_planes(contacts: ElasticContact) -> np.ndarray:
    """The larger Tabor number of each of a batch, shape (contacts,), NaN where there is none.

    Parameters
    ----------
    contacts
        Contacts whose arrays have an axis more, the first one.
    """
    work, pull = (np.asarray(x) for x in _of_each(contacts.interface))
    found: np.ndarray = np.max(_tabor_numbers(contacts, work, pull), axis=-1)
    return found


def _tabor_numbers(contact: ElasticContact, work: np.ndarray, pull: np.ndarray) -> np.ndarray:
    """Of the bonds that hold or not, along the last axis."""
    radius, modulus = (np.asarray(x)[..., None] for x in (contact.shape.radius, contact.modulus))
    cubes = radius * pull**3 / (modulus**2 * np.where(work > 0.0, work, 1.0))
    tabor: np.ndarray = np.where(work > 0.0, cubes, work) ** (1.0 / 3.0)
    return tabor

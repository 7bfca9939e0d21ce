"""The shapes of a contact's curves, known before anything of them is traced.

A motion can then be compiled while its curves still are.
"""

from __future__ import annotations

from typing import Any

from .._jax import jax, jnp
from ..contact.contact import Contact
from ..numerics.polynomials import NODES
from .curve_table import DRIVE, ENERGY_SAMPLES, TIME_NODES, Table, Works, quantities
from .scanning_table import RANGES, Reversals
from .static_equilibrium import Reference


def shapes_of_curves(contact: Contact, many: bool = False) -> tuple[Table, Reference] | None:
    """Shapes of the answer of :func:`.motion.prepare`.

    Parameters
    ----------
    contact
        The contact. Of one that yields they are not known: its first impact is part of its curves.
    many
        As there.
    """
    if contact.yields:
        return None
    ends = jax.eval_shape(contact.panels, _real(), _real())
    shape = len(jax.eval_shape(contact.branches)), ends.shape[0] - 1
    numbers = quantities(contact).field.start + contact.lagging
    drives = len(range(numbers)[DRIVE])
    works = Works(
        _real(*shape, NODES + 1, drives),
        _real(*shape, ENERGY_SAMPLES),
        _real(*shape, TIME_NODES.size),
    )
    table = Table(_real(*ends.shape), _real(*shape, NODES, numbers), works, _real(), _real())
    if many and contact.reversals:
        curves, (pieces, places) = contact.reversals, contact.passed
        of_pieces = RANGES, curves, pieces
        table = table._replace(
            reversals=Reversals(
                low=_real(RANGES),
                high=_real(RANGES),
                length=_real(*of_pieces),
                contacting=_real(*of_pieces, places),
                rows=_real(*of_pieces, places, numbers),
                error=_real(RANGES),
            )
        )
    return table, Reference(_real(), _real(), _of(bool))


def _real(*shape: int) -> Any:
    return _of(jnp.float64, *shape)


def _of(kind: Any, *shape: int) -> Any:
    """The shape of an array, which stands for the array."""
    return jax.ShapeDtypeStruct(shape, kind)

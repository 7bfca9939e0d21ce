"""What the number of rings leaves of error in a force, by one step on a finer mesh."""

from __future__ import annotations

import numpy as np

from .._jax import jax
from ..halfspace import PANEL_COUNT, finer_rings, ring_mesh
from ..laws.law import Real
from ..numerics.compilation import AT_ONCE, Program
from .elastic import ElasticContact
from .equilibrium import pressed


def ring_error(
    contact: ElasticContact, separation: float, size: float, displacement: np.ndarray
) -> float:
    """Estimated relative error that the number of rings makes in the force.

    The pressure on each panel is a polynomial through its rings. On a mesh with two rings more on
    each panel it is read between them, and one step of Newton's method leads from there to the
    equilibrium of the finer mesh: the change of the load is the error, but for that of the finer
    mesh.

    Parameters
    ----------
    contact
        The contact.
    separation
        Rigid separation [m], on a first approach.
    size
        Length [m] of the mesh.
    displacement
        Displacement [m] of its rings and of its end in equilibrium, shape (rings + 1,).

    Returns
    -------
    The error [-]; 0 where nothing presses.
    """
    mesh, modulus = ring_mesh(contact.rings), float(contact.modulus)
    more = contact.rings + 2 * PANEL_COUNT
    fine, between = ring_mesh(more), finer_rings(contact.rings, more)
    if not size > 0.0:
        return 0.0
    pressure, _ = _at(contact, separation, size * mesh.radius, displacement[:-1])
    known = between @ pressure
    compliance = size / modulus * fine.compliance
    found, slope = _at(contact, separation, size * fine.radius, compliance @ known)
    off = found - known
    matrix = np.eye(more) - compliance * slope
    change = off + slope * np.linalg.solve(matrix, compliance @ off)
    load = float(fine.area @ np.abs(known))
    return float(abs(fine.area @ change)) / load if load > 0.0 else 0.0


def _at(
    contact: ElasticContact, separation: float, radius: np.ndarray, displacement: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Pressure [Pa] and its slope [Pa/m] on rings that never touched before."""
    pressure, slope = _pressure(contact, np.asarray(separation), radius, displacement)
    return np.asarray(pressure), np.asarray(slope)


def _pressed(
    contact: ElasticContact, separation: Real, radius: Real, displacement: Real
) -> tuple[jax.Array, jax.Array]:
    h = separation + contact.shape.profile(radius) + displacement
    return pressed(contact, contact.interface.initial_memory(h), h)


_pressure = Program(_pressed, AT_ONCE)

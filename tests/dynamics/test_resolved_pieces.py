"""Pieces of a phase with drag."""

import numpy as np

from asperity._jax import jax, jnp
from asperity.dynamics import Body
from asperity.dynamics.curve_table import CENTRAL, NODES, Pieces
from asperity.dynamics.damped_phase import integrate_phase
from asperity.dynamics.resolved_pieces import resolved
from asperity.dynamics.suspension import Dashpot

APEX, LANDING = 40.0, 1e-3  # m
MASS, GRAVITY, DAMPING = 1e-9, 9.81, 1e-12  # kg, m/s^2, N s/m


def fall(*ends, spent=np.nan):
    """A fall from rest through pieces without a force of contact, cut about a place."""
    enter, leave = jnp.asarray(ends[:-1]), jnp.asarray(ends[1:])
    values = np.zeros((len(ends) - 1, NODES, CENTRAL + 1))
    low, high = (np.full(len(ends) - 1, end) for end in (0.0, 2.0 * APEX))
    pieces = Pieces(jnp.asarray(low), jnp.asarray(high), enter, leave, jnp.asarray(values))
    return passed(pieces, spent)


@jax.jit
def passed(pieces, spent):
    """Compiled once for each number of pieces."""
    body, zero = Body(MASS, GRAVITY, APEX, drags=(Dashpot(DAMPING),)), jnp.asarray(0.0)
    return integrate_phase(body, resolved(body, pieces, zero, spent)[0], zero)


def test_narrow_pieces_stop_no_body_and_are_parts_of_those_beside_them():
    """It starts from rest on one as narrow as rounding, where energies differ by that alone."""
    one, fallen = fall(APEX, LANDING), MASS * GRAVITY * (APEX - LANDING)
    assert 0.9 * fallen < float(one.turn.kinetic) < fallen
    first, second = APEX * (1.0 - 1e-13), APEX * (1.0 - 2e-13)
    two = fall(APEX, first, LANDING)
    np.testing.assert_allclose(two.duration, one.duration, rtol=1e-12)
    for more in (
        two,
        fall(APEX, first, second, LANDING),
        fall(APEX, LANDING * (1.0 + 1e-12), LANDING),
        fall(APEX, LANDING, spent=first),
        fall(APEX, LANDING, spent=LANDING * (1.0 + 1e-12)),
    ):
        assert not bool(more.turn.found)
        np.testing.assert_allclose(more.turn.kinetic, one.turn.kinetic, rtol=1e-12)
        np.testing.assert_allclose(more.turn.kinetic + jnp.sum(more.lost), fallen, rtol=1e-12)

"""The mesh of rings under a rough body, as its first impact on a half-space that creeps asks."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..._jax import jnp
from ...contact.continuation import first_size
from ...contact.viscoelastic import Relaxation
from ..stepped_phase import FAILED
from ..stepped_record import Ledger
from .rough_phase import RoughBounce

_FIT = 0.05  # how closely the mesh fits the pressure of the first impact
_PASSES = 5  # of that fit


def fitted_bounce(relaxation: Relaxation, ledger: Ledger, asked: Callable[[], None]) -> RoughBounce:
    """The body at its release, on a mesh that fits the pressure of its first impact."""
    contact: Any = relaxation.contact
    lowest = ledger.prepared[0].ends[0]
    size = float(first_size(contact, jnp.asarray(float(lowest))))
    for _ in range(_PASSES):
        trial = RoughBounce(relaxation, ledger.body, size, ledger.ends, asked, trial=True)
        trial.start()
        end = trial.phase(inwards=True).end
        if end == FAILED or abs(trial.fit - 1.0) <= _FIT:
            break
        size *= trial.fit
    return RoughBounce(relaxation, ledger.body, size, ledger.ends, asked)

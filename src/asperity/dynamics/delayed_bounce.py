"""A rigid or smooth body whose menisci take time to form, from one turning point to the next."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .._jax import jax, jnp
from ..contact.delayed_formation import DelayedContact
from .curve_table import quantities, read_row
from .stepped_phase import MotionState, PhaseRules, Samples, phase_in_time
from .stepped_record import Ledger, SteppedPhase
from .time_collocation import BodyState
from .time_stepping import Frame


class DelayedBounce:
    """A body that is let go in equilibrium with the vapour.

    Parameters
    ----------
    delayed
        The contact with menisci that take time.
    ledger
        What moves on what, and where it ends.
    asked
        Called before each step; it may raise to stop.
    """

    def __init__(self, delayed: DelayedContact, ledger: Ledger, asked: Callable[[], None]) -> None:
        contact, body, (table, reference) = ledger.contact, ledger.body, ledger.prepared
        frame = Frame.of(contact, delayed, body, table)
        self._rules = PhaseRules.of(contact, frame, reference, float(ledger.limits.rest), asked)
        here = BodyState(
            separation=body.release,
            speed=-body.speed,
            acceleration=-body.gravity,
            threshold=body.release - delayed.law.forming_gap,
            memory=contact.initial_memory(),
            forming=jnp.asarray(True),
        )
        here = jax.tree_util.tree_map(np.asarray, here)
        lost = np.zeros(len(contact.mechanisms) + len(body.mechanisms))
        gravity, speed = float(body.gravity), float(body.speed)
        depth = abs(float(body.release))
        span = 0.1 * (depth / speed if speed > 0.0 else np.sqrt(2.0 * depth / gravity))
        self._state = MotionState(here, 0.0, span, lost)
        row = read_row(table, 0, float(body.release))[: quantities(contact).components.stop]
        columns = (0.0, here.separation, here.speed, row, lost)
        self._release = Samples(*(np.asarray(x)[None] for x in columns))

    def start(self) -> Samples:
        """The sample of the release."""
        return self._release

    @property
    def threshold(self) -> float:
        """Threshold of the menisci that are still forming [m]."""
        return float(self._state.here.threshold)

    def phase(self, inwards: bool) -> SteppedPhase:
        """The phase until the body turns."""
        done = phase_in_time(self._rules, self._state, -1 if inwards else 1)
        self._state = done.state
        none = Samples(*(column[:0] for column in self._release))
        return SteppedPhase(done.fate, Samples.joined([none, *done.samples]), -done.pull_work)

"""Fall, touch, rebound on a bulk that creeps, or on one under menisci that take time to form.

Every impact from the release to the end.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, Protocol

from ...contact.contact import Contact
from ...contact.elastic import ElasticContact
from ...contact.viscoelastic import Relaxation
from ...errors import Outcome
from ..curve_table import Table
from ..record import Body, Limits, Motion
from ..static_equilibrium import Reference
from ..stepped_phase import FAILED, TURNED, Ended, Samples
from ..stepped_series import Trajectory
from .rough_phase import RoughBounce, first_mesh
from .smooth_sphere import SmoothBounce
from .viscoelastic_record import Bounced, Ledger, Way

_FIT = 0.05  # how closely the mesh fits the pressure at the first deepest point
_PASSES = 5  # of that fit


class Bouncing(Protocol):
    """A body that is followed from one turning point to the next."""

    def start(self) -> Samples:
        """The sample of the release."""

    @property
    def threshold(self) -> float:
        """Threshold of menisci that are on their way [m], 0 where none are."""

    def way(self, inwards: bool) -> tuple[str, Samples]:
        """The samples until the body turns, and how they end."""


def integrate_viscoelastic(
    contact: Contact,
    relaxation: Relaxation,
    body: Body,
    prepared: tuple[Table, Reference],
    limits: Limits,
    report: Callable[[int], None],
    stop: threading.Event | None = None,
) -> tuple[Motion, Trajectory, Outcome]:
    """Motion of a body from its release until it rests, escapes, reaches a limit or is stopped.

    Parameters
    ----------
    contact
        The contact when its bulk has relaxed, with a ``viscous`` loss; that with menisci that form
        at once where they take time.
    relaxation
        How it relaxes, or what takes time on it.
    body
        The body and its release, outside contact.
    prepared
        The table of ``contact``, and the reference separation.
    limits
        Ends of the motion.
    report
        Called with the number of impacts, after each.
    stop
        Set from another thread, it ends the motion at the last whole impact.

    Raises
    ------
    Ended
        If it is stopped before the first impact is over.
    """

    def asked() -> None:
        if stop is not None and stop.is_set():
            raise Ended

    ledger = Ledger(contact, body, prepared, limits)
    bouncing = _bouncing(relaxation, ledger, asked)
    last = bouncing.start()
    done: list[Bounced] = []
    outcome = None
    while outcome is None:
        try:
            asked()
            before = bouncing.threshold
            fall = Way(*bouncing.way(inwards=True))
            rise = Way(fall.fate, _none(last))
            if fall.fate == TURNED:
                rise = Way(*bouncing.way(inwards=False))
        except Ended:
            if not done:
                raise
            outcome = Outcome.INTERRUPTED
            break
        done.append(Bounced(last, fall, rise))
        last = done[-1].end
        outcome = ledger.outcome(done, abs(before - bouncing.threshold))
        report(len(done))
    return *ledger.motion(done, outcome), outcome


def _none(like: Samples) -> Samples:
    return Samples(*(column[:0] for column in like))


def _bouncing(relaxation: Relaxation, ledger: Ledger, asked: Callable[[], None]) -> Bouncing:
    """The body at its release, on a mesh that fits the first impact where there is one."""
    if not isinstance(relaxation.contact, ElasticContact):
        return SmoothBounce(relaxation, ledger)
    table, _ = ledger.prepared
    size = first_mesh(relaxation, float(table.ends[0]))
    for _ in range(_PASSES):
        trial: Any = RoughBounce(relaxation, ledger.body, size, ledger.ends, asked)
        trial.start()
        fate, _ = trial.way(inwards=True)
        if fate == FAILED or abs(trial.fit - 1.0) <= _FIT:
            break
        size *= trial.fit
    return RoughBounce(relaxation, ledger.body, size, ledger.ends, asked)

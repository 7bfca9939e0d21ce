"""The motion of a body that is stepped in time: impacts from the release to the end.

For menisci that take time to form, and for a bulk that relaxes: there the force depends on time.
A body is followed by one of three classes: each gives the sample of its ``start``, the ``phase``
from one turning point to the next, and the ``threshold`` of menisci that are still forming.
"""

from __future__ import annotations

import threading
from collections.abc import Callable

from ..contact.contact import Contact
from ..contact.delayed_formation import DelayedContact
from ..contact.elastic import ElasticContact
from ..contact.viscoelastic import Relaxation
from ..errors import InputError, Outcome
from .curve_table import Table
from .delayed_bounce import DelayedBounce
from .record import Body, Limits, Motion
from .static_equilibrium import Reference
from .stepped_phase import TURNED, Ended, Samples, SteppedPhase
from .stepped_record import Ledger, SteppedImpact
from .stepped_series import Trajectory
from .viscoelastic.fitted_mesh import fitted_bounce
from .viscoelastic.rough_phase import RoughBounce
from .viscoelastic.smooth_sphere import SmoothBounce


def integrate_stepped(
    contact: Contact,
    mechanism: Relaxation | DelayedContact,
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
        The contact that slow motions meet: with menisci that form at once, or with a bulk that has
        relaxed.
    mechanism
        What takes time: the menisci of a rigid or smooth body, or the bulk and what is on it.
    body
        The body and its release, outside contact.
    prepared
        The table of ``contact``, and the static equilibrium.
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
    InputError
        If the body has a spring, or a drag that steps in time do not know: that of one film beside
        menisci that take time is all.
    """
    known = isinstance(mechanism, DelayedContact) and len(body.drags) == 1 and body.damped_apart
    if body.forces or (body.drags and not known):
        names = ", ".join([*(force.name for force in body.forces), *body.mechanisms])
        raise InputError(f"a motion that is stepped in time knows no {names}")

    def asked() -> None:
        if stop is not None and stop.is_set():
            raise Ended

    ledger = Ledger(contact, body, prepared, limits)
    bouncing = _bouncing(mechanism, ledger, asked)
    last = bouncing.start()
    done: list[SteppedImpact] = []
    outcome = None
    while outcome is None:
        try:
            asked()
            before = bouncing.threshold
            fall = bouncing.phase(inwards=True)
            rise = SteppedPhase(fall.end, Samples(*(column[:0] for column in last)))
            if fall.end == TURNED:
                rise = bouncing.phase(inwards=False)
        except Ended:
            if not done:
                raise
            outcome = Outcome.INTERRUPTED
            break
        done.append(SteppedImpact(last, fall, rise))
        last = done[-1].end
        outcome = ledger.outcome(done, abs(before - bouncing.threshold))
        report(len(done))
    return *ledger.motion(done, outcome), outcome


def _bouncing(
    mechanism: Relaxation | DelayedContact, ledger: Ledger, asked: Callable[[], None]
) -> DelayedBounce | RoughBounce | SmoothBounce:
    """The body at its release."""
    if isinstance(mechanism, DelayedContact):
        return DelayedBounce(mechanism, ledger, asked)
    if isinstance(mechanism.contact, ElasticContact):
        return fitted_bounce(mechanism, ledger, asked)
    return SmoothBounce(mechanism, ledger)

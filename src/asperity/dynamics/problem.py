"""What the equation of motion needs: a contact, a body, and what they were built from."""

from __future__ import annotations

from typing import NamedTuple

from ..contact import Contact
from ..contact.delayed_formation import DelayedContact
from ..contact.viscoelastic import Relaxation
from ..inputs import Inputs
from .record import Body

CLEARANCE = 1e-9
"""Gap [m] added to the interaction range where a case gives a speed but no release gap.

A first place: a force that goes on beyond its range has the body released further out.
"""


class Problem(NamedTuple):
    """What the equation of motion needs.

    Attributes
    ----------
    contact
        Forces between the two bodies.
    body
        Mass and release; at rest outside contact where a case has no [impact] table.
    inputs
        The quantities that it was built from.
    delayed
        The contact with menisci that take time to form; None where they form at once.
    class_error
        Relative error that classes of tip radius make in the work of bonds; 0 without classes.
    relaxation
        How the bulk creeps; ``contact`` is then that of the relaxed bulk. None where it does not.
    """

    contact: Contact
    body: Body
    inputs: Inputs
    delayed: DelayedContact | None = None
    class_error: float = 0.0
    relaxation: Relaxation | None = None

    @property
    def in_time(self) -> bool:
        """Whether the contact is solved as the body moves; no scanning curve is read then."""
        return self.delayed is not None or self.relaxation is not None

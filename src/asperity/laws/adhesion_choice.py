"""The law of adhesion that a contact has, and why it has this one."""

from __future__ import annotations

from typing import NamedTuple


class AdhesionChoice(NamedTuple):
    """The law of adhesion in use.

    Attributes
    ----------
    law
        Its name, as in a case file.
    reason
        Why this one, in a line; None where the case names the law.
    near_borders
        A warning for each border between two laws that is near.
    """

    law: str
    reason: str | None = None
    near_borders: tuple[str, ...] = ()

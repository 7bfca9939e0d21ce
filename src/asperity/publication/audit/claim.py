"""What a line of the audit is."""

from __future__ import annotations

from typing import NamedTuple

AGREES = "agrees"
REPRODUCED = "reproduced"
WRONG = "does not hold"
MISSING = "not in the text"
UNEXPLAINED = "not explained"
OUTSIDE = "outside the model"


class Claim(NamedTuple):
    """One line of the audit.

    Attributes
    ----------
    claim
        What the publication says, and where.
    published
        Its number, or a dash.
    found
        What the program computes.
    verdict
        In two or three words.
    """

    claim: str
    published: str
    found: str
    verdict: str


def close(found: float, published: float, within: float) -> bool:
    """Whether two numbers agree to a relative difference."""
    return abs(found / published - 1.0) <= within

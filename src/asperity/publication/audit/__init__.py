"""The publication's claims beside what the program finds, each number computed."""

from __future__ import annotations

from ..evidence import Evidence
from . import conjunction_claims, force_claims, motion_claims
from .claim import Claim

__all__ = ["Claim", "claims"]


def claims(evidence: Evidence) -> list[Claim]:
    """The audit, from the choice of the models to the power losses."""
    return [
        *force_claims.claims(evidence),
        *conjunction_claims.claims(evidence),
        *motion_claims.claims(evidence),
    ]

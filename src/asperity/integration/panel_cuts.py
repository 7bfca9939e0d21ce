"""Where the panels of force curves are cut: there where their error is."""

from __future__ import annotations

from math import isnan
from typing import NamedTuple

import numpy as np

from ..errors import SimulationError

RESIDUAL = 1e-6
"""Relative force error of a contact that counts as solved."""

_ORDER = 6.0  # power of a panel's width with which its error falls, at least, where it is smooth
_PARTS = 6  # into which a panel is cut at once: its error may lie at one place of it
_SHORT = 1e-9  # of a panel before the end of forces: it begins there
_SAFE = 0.3  # of the error allowed: panels with more are cut
_GAIN = 0.9  # of the error is left by several more cuts: where more is, no more would help
_TRIES = 4  # that are looked back for it
PATIENCE = 1
"""Tries without an equilibrium, before a contact counts as one that has none."""

_EMPTY = np.zeros(0)


class Unsolved(SimulationError):
    """A contact has no equilibrium that follows from the one before."""


class Inaccurate(SimulationError):
    """Force curves miss the tolerance however they are cut."""


class Left(SimulationError):
    """A motion left the separations at which its contact is tabulated."""


class CutPanels(NamedTuple):
    """Panels of one case's curves, cut again and again.

    Attributes
    ----------
    cuts
        Separations [m] at which panels end besides their own ends.
    errors
        The largest error of each curve so far.
    unsolved
        How often the contact had no equilibrium somewhere.
    """

    cuts: np.ndarray = _EMPTY
    errors: tuple[float, ...] = ()
    unsolved: int = 0

    def stuck(self, patience: int = PATIENCE) -> bool:
        """Whether the last curves are hardly better than those some tries before.

        Or whether more than ``patience`` of them have no equilibrium somewhere.
        """
        if self.unsolved > patience:
            return True
        if len(self.errors) <= _TRIES:
            return False
        return min(self.errors[-_TRIES:]) > _GAIN * min(self.errors[:-_TRIES])

    def finer(
        self,
        ends: np.ndarray,
        errors: np.ndarray,
        reach: float,
        allowed: float,
        most: int,
        *,
        solved: bool = True,
    ) -> CutPanels:
        """Cut once more, where the errors of the last curves are.

        Parameters
        ----------
        ends
            Ends of their panels [m], ascending, shape (panels + 1,).
        errors
            Relative error on each panel [-], shape (panels,).
        reach
            Separation [m] at which forces have nearly ended: a panel across it is cut there and
            before it.
        allowed
            Relative error allowed [-].
        most
            Number of cuts that there may be in all: the worst panels come first.
        solved
            Whether the contact has an equilibrium everywhere.
        """
        low, high = ends[:-1], ends[1:]
        before = reach - low
        across = (before > _SHORT * (high - low)) & (high > reach)
        width = np.where(across, before, high - low)
        bad = np.flatnonzero((errors > _SAFE * allowed) & (width > 0.0))
        bad = bad[np.argsort(-errors[bad])]
        parts = np.ceil((errors[bad] / (_SAFE * allowed)) ** (1.0 / _ORDER))
        parts = np.clip(parts, 2, _PARTS)
        last = parts - np.where(across[bad], 0, 1)
        shares = [np.arange(1.0, k + 1.0) / n for k, n in zip(last, parts, strict=True)]
        new = [ends[k] + width[k] * share for k, share in zip(bad, shares, strict=True)]
        cuts = np.concatenate([self.cuts, *new])[:most]
        return CutPanels(cuts, (*self.errors, float(np.max(errors))), self.unsolved + (not solved))

    def padded(self, count: int) -> np.ndarray:
        """So many cuts; those that there are not lie below all panels."""
        return np.append(self.cuts, np.full(count - self.cuts.size, -np.inf))


def curve_failure(error: float, tolerance: float, residual: float) -> SimulationError:
    """Why curves do not hold: the contact itself comes first, whose noise no panel follows."""
    if not residual <= RESIDUAL:
        off = "no number solves them" if isnan(residual) else f"relative force error {residual:.1e}"
        return Unsolved(
            f"pressure and deformation do not agree: {off}. The contact has no equilibrium that "
            "follows from the one before (strong adhesion on soft bodies folds it)"
        )
    if isnan(error):
        return Inaccurate("force curves are no numbers somewhere that the body may come")
    return Inaccurate(
        f"force curves reach a relative error of {error:.1e}, "
        f"not `numerics.tolerance` = {tolerance:.1e}"
    )

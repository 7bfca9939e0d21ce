"""Values of many cases looked at as one: where a decision differs, they are grouped."""

from __future__ import annotations

import numpy as np


class Mixed(Exception):
    """A rule holds for some cases and not for others.

    Parameters
    ----------
    holds : bool array, shape (cases,)
        For which it holds.
    """

    def __init__(self, holds: np.ndarray) -> None:
        super().__init__("a rule holds for some cases alone")
        self.holds = holds


class BatchValues(np.ndarray):
    """Values of one key in many cases, shape (cases,), to stand for the value of one case.

    Arithmetic is that of arrays. Where a decision is taken on it, all cases must agree; else
    `Mixed` is raised with those for which it holds, and the decision is taken anew on either part.
    So the code that builds one case builds many, and finds out itself which are of one kind.
    """

    def __bool__(self) -> bool:
        holds = np.asarray(self).astype(bool)
        if holds.all():
            return True
        if not holds.any():
            return False
        raise Mixed(holds)

    def __format__(self, spec: str) -> str:
        """The first value: a message of many cases is written anew for each."""
        return format(self.ravel()[0].item(), spec)

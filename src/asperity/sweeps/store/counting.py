"""How the cases of a store ended."""

from __future__ import annotations

import numpy as np

from asperity.errors import ENDS
from asperity.sweeps.store.store import Store
from asperity.sweeps.study.columns import FAILED, reasons


def outcomes(store: Store) -> dict[str, int]:
    """Number of finished cases by outcome.

    Parameters
    ----------
    store : Store
        The store.

    Raises
    ------
    InputError
        Where a chunk of the column is not what was written.
    """
    counts = np.zeros(len(ENDS), np.int64)
    for task in list(store.done):
        counts += np.bincount(store.read(task, "outcome"), minlength=len(ENDS))
    return {outcome.value: int(n) for outcome, n in zip(ENDS, counts, strict=True)}


def first_failure(store: Store) -> tuple[int, str] | None:
    """Number of the first case that failed, and why; None where none did.

    Raises
    ------
    InputError
        As `outcomes`.
    """
    for task in sorted(store.done):
        failed = store.read(task, "outcome") == FAILED
        if failed.any():
            row = int(np.argmax(failed))
            (reason,) = reasons(store.read(task, "reason")[[row]])
            return store.blocks.cases(task)[row], reason
    return None

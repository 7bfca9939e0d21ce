"""The log of a sweep: times and hosts, outside the store, whose bytes must not know them."""

from __future__ import annotations

import contextlib
import os
import platform
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from asperity.sweeps.compute.batch import Effort
    from asperity.sweeps.compute.runner import Tally


class Log:
    """Lines of text, each with its time; a log that cannot be written costs the log alone.

    Parameters
    ----------
    path : Path
        The file; lines are added to it.
    """

    def __init__(self, path: Path) -> None:
        self.path = path

    def write(self, text: str) -> None:
        """Add a line."""
        now = datetime.now(UTC).isoformat(timespec="milliseconds")
        with contextlib.suppress(OSError), self.path.open("a", encoding="utf-8") as file:
            file.write(f"{now} {text}\n")

    def begin(self, text: str) -> None:
        """Say where a run begins, and what it does."""
        self.write(f"begins on {platform.node()}, process {os.getpid()}: {text}")

    def task(self, task: int, effort: Effort, tally: Tally) -> None:
        """Say that a task is kept, what it took, and how far the run is."""
        self.write(
            f"task {task}: {effort.cases} cases in {effort.wall:.3f} s, "
            f"{effort.compiled:.3f} s of it compiled, batch use {effort.batch_use:.3f}; "
            f"{tally.cases} of {tally.cases_wanted} at {tally.rate:.1f} a second"
        )

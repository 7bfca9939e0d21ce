"""What a motion is watched with: its progress, its stop, the time in compiled code."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from .._jax import jax
from ..numerics.compilation import Program

Report = Callable[[float, str], None]

COMPILATION = "compilation"
"""What is reported once all is traced, and the compiler is waited for where it is not through."""


def silently(fraction: float, text: str) -> None:
    """Report nothing."""


class Stopped(Exception):
    """A motion or a task that was asked to stop."""


class Clock:
    """Time in compiled code [s], and the share of the batch that did something.

    Parameters
    ----------
    stop
        When set from another thread, `Stopped` is raised before the next compiled call.
    report
        Called with a fraction done and a line of text, now and then.
    """

    def __init__(self, stop: threading.Event | None = None, report: Report = silently) -> None:
        self.stop, self.report = stop, report
        self.compiled = 0.0
        self.useful = 0
        self.all = 0

    def ready(
        self, fraction: float, name: str, program: Program[..., Any], *args: Any
    ) -> Callable[[], Any]:
        """A call, once all is compiled that it needs; whoever waits is told what and how long."""
        left = program.time_left(*args)
        self.report(
            fraction, f"{COMPILATION} of {name}, some {left:.0f} s" if left > 0.5 else COMPILATION
        )
        return program.ready(*args)

    def run(self, program: Program[..., Any], *args: Any) -> Any:
        """The answer of a compiled call."""
        self.look()
        return self.timed(program.ready(*args))

    def timed(self, call: Callable[[], Any]) -> Any:
        """The answer of a call that is compiled already."""
        began = time.perf_counter()
        answer = jax.block_until_ready(call())
        self.compiled += time.perf_counter() - began
        return answer

    def look(self) -> None:
        """Raise `Stopped` where the work is to end."""
        if self.stop is not None and self.stop.is_set():
            raise Stopped

    def count(self, made: np.ndarray) -> None:
        """Count the impacts that the batch made in a call: all wait for the last."""
        self.useful += int(made.sum())
        self.all += made.shape[0] * int(made.sum(axis=1).max(initial=0))

    @property
    def batch_use(self) -> float:
        """Share of the batch's time that was of use."""
        return self.useful / self.all if self.all else 1.0

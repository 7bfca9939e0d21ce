"""How many programs this process compiled, and how many it found kept: what JAX tells of it."""

from __future__ import annotations

import dataclasses
import threading
from collections import Counter, defaultdict
from functools import cache
from typing import Any

from asperity.numerics.compilation import KEPT, TRACED

_COMPILED = "/jax/core/compile/backend_compile_duration"
_READ = "/jax/compilation_cache/cache_retrieval_time_sec"


@dataclasses.dataclass(frozen=True)
class Compilation:
    """What compiling took, summed over threads that compile side by side.

    Parameters
    ----------
    traced, kept : int
        Whole programs that were traced, and those of which the traced form was kept.
    tracing : float
        Time to trace them [s].
    asked, read : int
        Pieces of code that were asked of XLA, and those found in the cache.
    compiling, reading : float
        Time for code that was compiled, and for code from the cache [s].
    """

    traced: int = 0
    kept: int = 0
    tracing: float = 0.0
    asked: int = 0
    read: int = 0
    compiling: float = 0.0
    reading: float = 0.0

    def __sub__(self, before: Compilation) -> Compilation:
        """What came since then."""
        pairs = zip(dataclasses.astuple(self), dataclasses.astuple(before), strict=True)
        return Compilation(*(now - then for now, then in pairs))

    def lines(self) -> list[str]:
        """In words, a line for each kind."""
        fresh = self.asked - self.read
        return [
            f"programs: {self.traced} traced in {self.tracing:.2f} s, "
            f"{self.kept} found in their traced form",
            f"code: {fresh} compiled in {self.compiling:.2f} s, {self.read} found in the cache "
            f"in {self.reading:.2f} s (sums over threads)",
        ]


class _Tally:
    """Listens to JAX from now on."""

    def __init__(self) -> None:
        from jax import monitoring

        self._counts: Counter[str] = Counter()
        self._times: defaultdict[str, float] = defaultdict(float)
        self._lock = threading.Lock()
        monitoring.register_event_duration_secs_listener(self._hear)

    def _hear(self, event: str, duration_secs: float, **_: Any) -> None:
        with self._lock:
            self._counts[event] += 1
            self._times[event] += duration_secs

    def now(self) -> Compilation:
        """All until now."""
        with self._lock:
            counts, times = self._counts, self._times
            return Compilation(
                counts[TRACED],
                counts[KEPT],
                times[TRACED],
                counts[_COMPILED],
                counts[_READ],
                # JAX counts what it reads from its cache as compiling too.
                times[_COMPILED] - times[_READ],
                times[_READ],
            )


@cache
def _tally() -> _Tally:
    return _Tally()


def compilation() -> Compilation:
    """What this process has compiled since it was first asked."""
    return _tally().now()

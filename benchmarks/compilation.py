"""What it saves to compile otherwise than one by one: the time to an answer each way.

``python -m benchmarks.compilation`` prints a row for each way: seconds until the first answer with
nothing compiled, and the least of some answers after that. Each is the median of three processes,
with the least and the most; the ways of one comparison take turns. Each process has an empty cache.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any
from unittest import mock

PROCESSES, REPEATS = 3, 3

QUESTIONS = {
    "glass-bead": ("as they come", "tabulated"),
    "published-exact": ("as they come", "tabulated"),
    "study of 64 cases": ("as they come", "tabulated"),
    "solve glass-bead": ("side by side", "one by one"),
}
"""What is asked, and the ways in which it is computed."""


def main() -> int:
    """Measure all rows, or, with a question and a way as arguments, that one in this process."""
    if len(sys.argv) > 1:
        print(*_seconds(*sys.argv[1:]))
        return 0
    print(f"{'asked':<19}{'way':<15}{'first [s]':>20}{'then [s]':>20}")
    for asked, ways in QUESTIONS.items():
        took: dict[str, list[list[float]]] = {way: [] for way in ways}
        for _ in range(PROCESSES):
            for way in ways:
                took[way].append(_apart(asked, way))
        for way, each in took.items():
            first, then = (_told(list(column)) for column in zip(*each, strict=True))
            print(f"{asked:<19}{way:<15}{first:>20}{then:>20}", flush=True)
    return 0


def _told(seconds: list[float]) -> str:
    least, most = min(seconds), max(seconds)
    return f"{statistics.median(seconds):.2f} ({least:.2f}-{most:.2f})"


def _apart(asked: str, way: str) -> list[float]:
    """The seconds of one row, from a process with an empty cache."""
    command = [sys.executable, "-m", "benchmarks.compilation", asked, way]
    with tempfile.TemporaryDirectory() as folder:
        given = {**os.environ, "XDG_CACHE_HOME": folder}
        done = subprocess.run(command, env=given, check=True, capture_output=True)
    return [float(word) for word in done.stdout.decode().split()]


def _seconds(asked: str, way: str) -> tuple[float, float]:
    """Seconds to the first answer, and the least of some after that."""
    took = []
    with _computed(way):
        answer = _answer(asked, way)
        for _ in range(1 + REPEATS):
            began = time.perf_counter()
            answer()
            took.append(time.perf_counter() - began)
    return took[0], min(took[1:])


@contextmanager
def _computed(way: str) -> Iterator[None]:
    """The ways that no argument chooses, put in place of what the program does."""
    from asperity.dynamics import prepare
    from asperity.integration import steps

    curves: Any = lambda self, batch: self.curves.ahead(batch, self.tabulated)  # noqa: E731
    alone: Any = lambda contact, body, many: prepare(contact, body)  # noqa: E731
    place: Any
    place, name, other = {
        "one by one": (steps.Steps, "compile_ahead", curves),
        "as they come": (steps, "prepare", alone),
    }.get(way, (steps, "prepare", prepare))
    with mock.patch.object(place, name, other):
        yield


def _answer(asked: str, way: str) -> Callable[[], Any]:
    """What is timed."""
    import asperity
    from asperity.config.resolve import resolve
    from asperity.integration import cut_in_steps, integrate, silently
    from asperity.model import build
    from asperity.results.case_source import case_of
    from asperity.sweeps.compute.batch import compute
    from asperity.sweeps.study.study import parse

    from .sweeps import DEFORMING

    if asked.startswith("study"):
        study = parse(DEFORMING.replace("steps = 16", "steps = 8"))
        return lambda: compute(study, 0)
    if asked.startswith("solve"):
        return lambda: asperity.solve(asked.split()[1])
    problem = cut_in_steps(build(resolve(case_of(asked))))
    return lambda: integrate(problem, silently, None, many=way == "tabulated")


if __name__ == "__main__":
    sys.exit(main())

"""A study of numbers that follow from the case number alone, for tests of stores and loops."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from threading import Event
from typing import Any, NamedTuple

import numpy as np

from asperity.sweeps.study.blocks import Blocks
from asperity.sweeps.study.columns import REASON_SIZE, Column, columns


class Effort(NamedTuple):
    cases: int
    batch_use: float
    compiled: float
    wall: float
    looked: int = 0
    warned: tuple[tuple[int, str], ...] = ()


@dataclass(frozen=True)
class FakeStudy:
    """What stores and runners need of a study."""

    size: int = 50
    task_size: int = 8
    pause: float = 0.0
    salt: int = 0
    keep_impacts: int = 2

    warnings: tuple[str, ...] = ()
    dims: tuple[str, ...] = ("case",)
    axes: tuple[Any, ...] = ()
    sample: None = None

    @property
    def columns(self) -> tuple[Column, ...]:
        return columns(["captured", "restitution", "time_to_rest"], motions=False)

    def width(self, along: str) -> int:
        return {"impact": self.keep_impacts, "byte": REASON_SIZE}[along]

    @property
    def shape(self) -> tuple[int]:
        return (self.size,)

    @property
    def blocks(self) -> Blocks:
        return Blocks(self.shape, (self.task_size,))

    @property
    def tasks(self) -> int:
        return self.blocks.count

    def task(self, number: int) -> range:
        return self.blocks.cases(number)

    @property
    def canonical(self) -> str:
        return f"{self.size} {self.task_size} {self.pause} {self.salt} {self.keep_impacts}"

    @property
    def fingerprint(self) -> str:
        return hashlib.sha256(self.canonical.encode()).hexdigest()


def parse(text: str) -> FakeStudy:
    size, task_size, pause, salt, keep = text.split()
    return FakeStudy(int(size), int(task_size), float(pause), int(salt), int(keep))


def read(path: str) -> FakeStudy:
    return parse(Path(path).read_text())


def expected(study: FakeStudy, cases: range) -> dict[str, np.ndarray]:
    """The columns of some cases; every seventh case fails and says so."""
    number = np.arange(cases.start, cases.stop) + study.salt
    failed = number % 7 == 3
    reason = np.zeros((len(cases), REASON_SIZE), np.uint8)
    for row in np.flatnonzero(failed):
        text = f"case {cases[row]} fails".encode()
        reason[row, : len(text)] = np.frombuffer(text, np.uint8)
    restitution = 1.0 / (1.0 + number[:, None] + np.arange(study.keep_impacts))
    return {
        "outcome": np.where(failed, 5, number % 2).astype(np.int8),
        "impacts": (number % 40).astype(np.int32),
        "energy_balance_error": np.sin(number) * 1e-12,
        "reason": reason,
        "captured": np.where(failed, -1, number % 2).astype(np.int8),
        "restitution": np.where(failed[:, None], np.nan, restitution),
        "time_to_rest": np.sqrt(number.astype(float)),
    }


def compute(
    study: FakeStudy, task: int, stop: Event | None = None
) -> tuple[dict[str, np.ndarray], Effort]:
    time.sleep(study.pause)
    cases = study.task(task)
    return expected(study, cases), Effort(len(cases), 0.5, 0.25 * study.pause, study.pause)


Study = FakeStudy


def compute_task(text: str, task: int) -> tuple[dict[str, np.ndarray], Effort]:
    """As a dask worker computes it."""
    return compute(parse(text), task)


def in_order(study: Any, tasks: Sequence[int], stop: Event) -> Iterator[Any]:
    for task in tasks:
        if stop.is_set():
            return
        yield (task, *compute(study, task))


def backwards(study: Any, tasks: Sequence[int], stop: Event) -> Iterator[Any]:
    yield from in_order(study, tasks[::-1], stop)

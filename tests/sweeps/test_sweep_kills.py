"""A sweep that is killed at random moments and resumed leaves the bytes of an undisturbed one."""

from __future__ import annotations

import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from asperity.sweeps.compute.runner import fill
from asperity.sweeps.store.store import Store
from asperity.sweeps.store.whole_files import beside
from fake_study import FakeStudy, in_order
from store_files import contents

PROGRAM = Path(__file__).parents[1] / "fake_sweep.py"
LONGEST = 0.3
"""Of the times between a run's beginning and its death [s]."""

PAUSE = 0.005
"""Least duration of a task [s]; so many tasks are wanted that no run ends before its death."""


def begin(study: Path, store: Path) -> subprocess.Popen[bytes]:
    """A run of its own, once it computes."""
    log = beside(store, ".log")
    runs = log.read_text().count("begins") if log.exists() else 0
    command = [sys.executable, str(PROGRAM), "sweep", str(study), "-o", str(store), "--resume"]
    run = subprocess.Popen([*command, "--quiet"])
    while run.poll() is None and (not log.exists() or log.read_text().count("begins") == runs):
        time.sleep(0.002)
    return run


def deaths(folder: Path, study: FakeStudy, most: int, seed: int) -> int:
    """Fill a store by runs that are killed, at most so many; how many were."""
    file, store = folder / "study.toml", folder / "study.zarr"
    file.write_text(study.canonical)
    moments = random.Random(seed)
    for killed in range(most):
        run = begin(file, store)
        time.sleep(moments.uniform(0.0, LONGEST))
        run.send_signal(signal.SIGKILL)
        if run.wait() == 0:
            return killed
        assert Store.open(store, study).check() == []
    assert begin(file, store).wait() == 0
    return most


@pytest.mark.parametrize(
    ("most", "seed"), [(3, 1), pytest.param(100, 2, marks=pytest.mark.long)], ids=["3", "100"]
)
def test_killed_at_random_moments_and_resumed_leaves_the_same_bytes(
    tmp_path: Path, most: int, seed: int
):
    study = FakeStudy(size=8 * round(most * LONGEST / PAUSE), pause=PAUSE)
    whole = tmp_path / "whole" / "study.zarr"
    fill(study, Store.create(whole, study), in_order)
    assert deaths(tmp_path, study, most, seed) == most
    assert contents(tmp_path / "study.zarr") == contents(whole)

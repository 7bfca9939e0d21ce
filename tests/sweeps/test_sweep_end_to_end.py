"""A study of real cases from its file to its store: in one process and on workers."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from asperity.errors import ENDS, Outcome
from asperity.solver import solve
from asperity.sweeps.compute.clients import local
from asperity.sweeps.compute.cluster import on_cluster
from asperity.sweeps.compute.runner import fill, in_process
from asperity.sweeps.store.counting import first_failure, outcomes
from asperity.sweeps.store.store import Store
from asperity.sweeps.study.study import Study, read
from store_files import contents

TEXT = """
schema = 1
base = "published"
keep = ["captured", "restitution", "time_to_rest", "energy_lost"]
keep_impacts = 2

[axes]
"impact.release_separation" = {from = "10 nm", to = "1 um", steps = 100}
"roughness.rms_height" = {from = "8 nm", to = "12 nm", steps = 41, scale = "log"}
"""
"""Several tasks, in which cases that begin within the contact fail."""


@pytest.fixture(name="study", scope="module")
def _study(tmp_path_factory: pytest.TempPathFactory) -> Study:
    file = tmp_path_factory.mktemp("study") / "study.toml"
    file.write_text(TEXT)
    return read(str(file))


@pytest.fixture(name="store", scope="module")
def _store(study: Study, tmp_path_factory: pytest.TempPathFactory) -> Store:
    path = tmp_path_factory.mktemp("undisturbed") / "study.zarr"
    tally = fill(study, Store.create(path, study), in_process)
    assert tally.cases == study.size
    assert study.tasks > 1
    return Store.open(path, study)


def test_cases_of_a_store_are_those_of_single_runs(study: Study, store: Store):
    code, restitution = store.column("outcome"), store.column("restitution")
    for number in (4000, study.size - 1):
        alone = solve(study.case(number), critical=False)
        assert ENDS[code[number]] is alone.outcome
        first = alone.measures["restitution"][:2]
        np.testing.assert_allclose(restitution[number, : len(first)], first, rtol=1e-8)


def test_cases_that_fail_are_kept_with_their_reason(study: Study, store: Store):
    failure = first_failure(store)
    assert failure is not None
    number, reason = failure
    assert number == 0
    assert "release_separation" in reason
    assert 0 < outcomes(store)[Outcome.FAILED.value] < study.size / 2


def test_two_workers_leave_the_bytes_of_one_process(study: Study, store: Store, tmp_path: Path):
    path = tmp_path / "study.zarr"
    with local(2) as client:
        assert os.getpid() not in client.run(os.getpid).values()
        fill(study, Store.create(path, study), on_cluster(client))
    assert contents(path) == contents(store.path)

"""``asperity sweep`` and ``asperity merge``: what they say, write and refuse."""

from __future__ import annotations

import errno
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import fake_study
from asperity.errors import ENDS
from asperity.sweeps.compute import batch
from asperity.sweeps.compute.runner import fill
from asperity.sweeps.store.store import Store
from asperity.sweeps.store.whole_files import beside
from asperity.sweeps.study import study as studies
from commands import answered, assert_one_line, call, names, program, refused
from fake_study import FakeStudy, expected, in_order
from store_files import contents, flip

PROGRAM = Path(__file__).parents[1] / "fake_sweep.py"
STUDY = FakeStudy()


@pytest.fixture(autouse=True)
def studied(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder with a study of numbers that cost nothing, which the commands compute."""
    monkeypatch.setattr(studies, "read", fake_study.read)
    monkeypatch.setattr(batch, "compute", fake_study.compute)
    Path("study.toml").write_text(STUDY.canonical)


@pytest.fixture(name="undisturbed", scope="module")
def _undisturbed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    path = tmp_path_factory.mktemp("undisturbed") / "study.zarr"
    fill(STUDY, Store.create(path, STUDY), in_order)
    return contents(path)


def test_a_sweep_says_what_came_out(place, undisturbed):
    ran = program("sweep", "study.toml", script=PROGRAM)
    assert (ran.returncode, ran.stderr) == (0, "")
    assert ran.stdout.startswith("study.zarr: 50 of 50 cases\n")
    assert "case 3 is the first that failed: case 3 fails" in ran.stdout
    assert contents(place / "study.zarr") == undisturbed
    log = (place / "study.zarr.log").read_text()
    assert log.count(" task ") == STUDY.tasks


def test_json_is_one_object_with_the_counts():
    said = answered("sweep", "study.toml")
    codes = list(expected(STUDY, range(STUDY.size))["outcome"])
    found = {outcome.value: codes.count(code) for code, outcome in enumerate(ENDS)}
    assert said["outcomes"] == found
    assert said["failed"] == found["failed"]
    assert (said["store"], said["cases"], said["done"]) == ("study.zarr", 50, 50)
    assert said["computed"] == 50
    assert said["cases_per_second"] == pytest.approx(50 / said["wall"])
    assert said["batch_use"] == pytest.approx(0.5)
    assert 0.0 <= said["overhead_share"] <= 1.0


def test_quiet_is_quiet():
    ran = call("sweep", "study.toml", "--quiet")
    assert (ran.exit_code, ran.stdout, ran.stderr) == (0, "", "")


def test_a_store_that_is_there_is_refused_resumed_or_replaced(place, undisturbed):
    fill(STUDY, Store.create("study.zarr", STUDY), in_order, tasks=[2])
    assert_one_line(refused("sweep", "study.toml"), "study.zarr", "--resume", "--force")
    assert answered("sweep", "study.toml", "--resume")["computed"] == 50 - 8
    assert contents(place / "study.zarr") == undisturbed
    assert answered("sweep", "study.toml", "--force")["computed"] == 50
    assert contents(place / "study.zarr") == undisturbed


def test_the_store_of_another_study_is_exit_2(place):
    other = FakeStudy(salt=1)
    fill(other, Store.create("study.zarr", other), in_order, tasks=[])
    for option in ("--resume", "--repair"):
        said = refused("sweep", "study.toml", option)
        assert_one_line(said, "study.zarr: must be the store of this study")


def test_repair_names_corrupt_chunks_and_computes_them_again(place, undisturbed):
    path = place / "study.zarr"
    fill(STUDY, Store.create(path, STUDY), in_order)
    flip(path / "energy_balance_error" / "c.3")
    (path / "impacts" / "c.5").unlink()
    (path / "impacts" / "zarr.json").write_text("{")
    said = refused("sweep", "study.toml", "--resume")
    assert_one_line(said, "impacts/zarr.json", "--repair")
    ran = call("sweep", "study.toml", "--repair", "--json")
    assert ran.exit_code == 0
    assert json.loads(ran.stdout)["computed"] == 16
    written, *corrupt = ran.stderr.splitlines()
    assert "impacts/zarr.json: written again" in written
    told = " ".join(" ".join(corrupt).split())
    assert told.index("energy_balance_error, task 3") < told.index("impacts, task 5")
    assert contents(path) == undisturbed


def test_options_that_exclude_each_other_are_exit_2():
    for one, other in (
        (("--force",), ("--resume",)),
        (("--force",), ("--repair",)),
        (("--workers", "2"), ("--scheduler", "tcp://127.0.0.1:1")),
    ):
        assert_one_line(refused("sweep", "study.toml", *one, *other), one[0], other[0])
    for options in (("--workers", "0"), ("--shard", "3/2")):
        assert_one_line(refused("sweep", "study.toml", *options), *options)
    assert names() == ["study.toml"]


def test_a_billion_cases_by_mistake_need_yes():
    Path("study.toml").write_text(FakeStudy(size=10**9, task_size=8192).canonical)
    assert_one_line(refused("sweep", "study.toml"), "--yes", "1,000,000,000 cases")


def test_a_scheduler_that_cannot_be_reached_is_exit_4(place):
    ran = program("sweep", "study.toml", "--scheduler", "tcp://127.0.0.1:1", script=PROGRAM)
    assert ran.returncode == 4
    assert_one_line(ran.stderr, "tcp://127.0.0.1:1: the scheduler cannot be reached")
    ran = call("sweep", "study.toml")
    assert (ran.exit_code, ran.stderr) == (0, "")


def test_shards_are_merged_into_the_store_of_one_run(place, undisturbed):
    for number in (1, 2, 3):
        assert call("sweep", "study.toml", "--shard", f"{number}/3", "-q").exit_code == 0
    stores = [f"study.{number}-of-3.zarr" for number in (1, 2, 3)]
    ran = call("merge", *stores[:2])
    assert ran.exit_code == 0
    assert "tasks 2, 5 are missing" in ran.stderr
    assert_one_line(refused("merge", *stores), "study.zarr", "--force")
    ran = call("merge", *stores, "--force", "--json")
    assert (ran.exit_code, ran.stderr) == (0, "")
    assert json.loads(ran.stdout)["done"] == 50
    assert contents(place / "study.zarr") == undisturbed
    said = refused("merge", *stores, "-o", stores[0], "--force")
    assert_one_line(said, "--output", stores[0])


@pytest.mark.parametrize("size", [1024, 10_000], ids=["at once", "in the middle"])
def test_a_full_disk_is_exit_4_and_the_store_goes_on(place, disk_of, size):
    """The largest file is the manifest, a line a task."""
    study = FakeStudy(size=200)
    fill(study, Store.create(place / "whole" / "study.zarr", study), in_order)
    Path("study.toml").write_text(study.canonical)
    with disk_of(size):
        ran = call("sweep", "study.toml")
    assert ran.exit_code == 4
    assert_one_line(ran.stderr, os.strerror(errno.EFBIG), "--resume")
    if size > 1024:
        store = Store.open("study.zarr", study)
        assert 0 < len(store.done) < study.tasks
        assert store.check() == []
    assert call("sweep", "study.toml", "--resume", "--quiet").exit_code == 0
    assert contents(place / "study.zarr") == contents(place / "whole" / "study.zarr")


def test_a_place_that_cannot_be_written_is_exit_4():
    said = refused("sweep", "study.toml", "-o", "study.toml/study.zarr", code=4)
    assert_one_line(said, "study.toml/study.zarr", os.strerror(errno.ENOTDIR))


def test_an_interrupted_sweep_is_exit_130_and_says_how_to_go_on(place):
    Path("study.toml").write_text(FakeStudy(pause=0.2).canonical)
    command = [sys.executable, str(PROGRAM), "sweep", "study.toml"]
    log = beside(place / "study.zarr", ".log")
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as run:
        while run.poll() is None and not (log.exists() and "task 1" in log.read_text()):
            time.sleep(0.01)
        run.send_signal(signal.SIGINT)
        _, said = run.communicate(timeout=60)
    assert run.returncode == 130
    assert_one_line(said, "interrupted", "of 50 cases are kept in study.zarr", "--resume")
    assert {0, 1} <= Store.open("study.zarr").done

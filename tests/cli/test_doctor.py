"""``asperity doctor`` and ``asperity --version``: what is installed, and whether it works."""

from __future__ import annotations

import dataclasses
import errno
import json
import os
import subprocess
import sys
import time
from importlib.metadata import version
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from asperity.cli import app, stack
from asperity.cli.compiling import Compilation
from asperity.cli.doctor import cache, examining, machine, selftest, speed
from asperity.cli.doctor.requirements import unmet
from asperity.errors import SimulationError

KEY = "0123456789abcdef" * 4


def call(*arguments: str) -> Any:
    return CliRunner().invoke(app, list(arguments))


def strict(text: str) -> Any:
    def refuse(constant: str) -> None:
        raise AssertionError(constant)

    return json.loads(text, parse_constant=refuse)


def test_version_is_the_first_line_and_the_stack_follows():
    ran = call("--version")
    first, *rest = ran.stdout.splitlines()
    assert first == f"asperity {version('asperity')}"
    told = {line.split()[0]: line.split()[1] for line in rest}
    for name in stack.STACK:
        assert told[name] == version(name)
    assert told["python"] == ".".join(map(str, sys.version_info[:3]))
    assert "platform" in told


def test_version_is_one_json_object_too():
    for order in (("--version", "--json"), ("--json", "--version")):
        found = strict(call(*order).stdout)
        assert found["asperity"] == version("asperity")
        assert found["jax"] == version("jax")


def test_an_extra_that_is_missing_is_not_installed(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(stack, "requires", lambda name: ["no-such-thing>=1; extra == 'dream'"])
    assert "no-such-thing      not installed (extra dream)" in call("--version").stdout
    assert strict(call("--version", "--json").stdout)["no-such-thing"] is None


def test_version_imports_nothing_that_it_names():
    program = (
        "import sys; sys.argv = ['asperity', '--version']; import os; "
        "os._exit = lambda code: print([n for n in ('jax', 'numpy', 'matplotlib', 'xarray') "
        "if n in sys.modules]); from asperity.cli import main; main()"
    )
    command = [sys.executable, "-c", program]
    ran = subprocess.run(command, capture_output=True, text=True, check=True)
    assert ran.stdout.splitlines()[-1] == "[]"


@pytest.mark.parametrize("arguments", [("--json",), ("--json", "materials")])
def test_json_before_a_command_is_refused(arguments: tuple[str, ...]):
    ran = call(*arguments)
    assert ran.exit_code == 2
    assert ran.stderr.count("\n") == 1
    assert "`--json` must go with --version" in ran.stderr


def test_requirements_are_compared_with_what_is_installed():
    assert unmet() == []
    assert unmet(["numpy>=2", "numpy<1; extra == 'x'"]) == [
        f"numpy<1 is wanted; {version('numpy')} is installed"
    ]
    assert unmet(["no-such-thing>=3"]) == ["no-such-thing>=3 is not installed"]
    assert unmet(["no-such-thing; extra == 'x'", "other; sys_platform == 'none'"]) == []


def test_each_check_of_the_self_test_holds():
    found = list(selftest.checks())
    assert len(found) == 6
    assert [one.name for one in found if not one.ok] == []
    assert max(one.off / one.limit for one in found) < 1.0


@pytest.mark.parametrize("off", [0.02, float("nan")])
def test_a_wrong_value_fails_its_check(off: float):
    assert not selftest.checked("a", "b", 0.01, lambda: off).ok
    assert selftest.checked("a", "b", 0.01, lambda: 0.005).ok


def test_what_cannot_be_computed_fails_with_its_reason():
    def broken() -> float:
        raise SimulationError("no\nequilibrium")

    one = selftest.checked("a", "b", 0.01, broken)
    assert not one.ok
    assert one.words == "SimulationError: no equilibrium"


def timed(name: str) -> speed.Speed:
    return speed.Speed(name, 2.0, 0.5, Compilation(asked=3, read=2), 7, 1e-12)


@pytest.fixture(name="quick")
def _quick(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A doctor whose motions cost nothing, with a cache of its own."""
    monkeypatch.setattr(speed, "speed", timed)
    monkeypatch.setattr(selftest, "checks", lambda: iter([selftest.Check("a", "b", 0.0, 1.0)]))
    monkeypatch.setattr(cache, "folder", lambda: tmp_path / "cache")
    return tmp_path / "cache"


def test_doctor_says_each_section_within_80_columns(quick: Path):
    ran = call("doctor")
    assert (ran.exit_code, ran.stderr) == (0, "")
    for title in ("Installed", "Machine", "Compile cache", "Self-test", "Speed"):
        assert f"\n{title}\n" in "\n" + ran.stdout
    assert "0.50 s for a motion of 7 impacts" in ran.stdout
    assert ran.stdout.endswith("\nall is well\n")
    long = [line for line in ran.stdout.splitlines() if len(line) > 80]
    assert [line for line in long if str(quick) not in line] == []


def test_doctor_is_one_json_object(quick: Path):
    found = strict(call("doctor", "--json").stdout)
    assert list(found) == ["versions", "machine", "cache", "speed", "checks", "ok"]
    assert found["ok"] is True
    assert found["machine"]["usable_processors"] == machine.usable_processors()
    assert found["cache"]["folder"] == str(quick)
    assert [one["case"] for one in found["speed"]] == ["published", "glass-bead", "published-exact"]
    assert {one["ok"] for one in found["checks"]} == {True}


def test_a_check_that_fails_is_exit_3_and_named(quick: Path, monkeypatch: pytest.MonkeyPatch):
    bad = selftest.Check("pull-off", "theory", 1.0, 0.1)
    monkeypatch.setattr(selftest, "checks", lambda: iter([bad]))
    ran = call("doctor")
    assert ran.exit_code == 3
    assert ran.stderr == "asperity: 1 of 5 checks fail: pull-off\n"
    assert "FAIL  off by 1.0e+00, 1e-01 allowed" in ran.stdout
    ran = call("doctor", "-q")
    assert (ran.exit_code, ran.stdout) == (3, "")
    assert strict(call("doctor", "--json").stdout)["ok"] is False


def test_a_requirement_that_is_not_met_is_exit_3(quick: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(examining, "unmet", lambda: ["jax>=99 is wanted; 0.1 is installed"])
    ran = call("doctor")
    assert ran.exit_code == 3
    assert "FAIL  jax>=99 is wanted" in ran.stdout


def test_a_stack_that_cannot_be_imported_is_told_without_a_traceback(
    quick: Path, monkeypatch: pytest.MonkeyPatch
):
    def missing() -> dict[str, Any]:
        raise ImportError("libsomething.so: not found")

    monkeypatch.setattr(machine, "devices", missing)
    ran = call("doctor")
    assert ran.exit_code == 3
    assert "ImportError: libsomething.so: not found" in ran.stdout
    assert "Traceback" not in ran.output


def filled(folder: Path) -> list[Path]:
    """A cache with code, its time, a traced program, and somebody else's file."""
    (folder / "programs").mkdir(parents=True)
    kept = [
        folder / f"jit_f-{KEY}-cache",
        folder / f"jit_f-{KEY}-atime",
        folder / "programs" / f"{KEY}.jax",
    ]
    for file in kept:
        file.write_bytes(bytes(100))
    (folder / "notes.txt").write_text("mine")
    return kept


def test_the_cache_is_measured_and_nothing_is_left_behind(tmp_path: Path):
    filled(tmp_path)
    before = sorted(tmp_path.rglob("*"))
    found = cache.examined(tmp_path)
    assert (found.entries, found.size, found.fault, found.warnings) == (2, 300, None, [])
    assert found.room is not None
    assert sorted(tmp_path.rglob("*")) == before


def test_emptying_removes_what_the_cache_keeps_and_nothing_else(quick: Path):
    kept = filled(quick)
    ran = call("doctor", "--empty-cache")
    assert (ran.exit_code, ran.stderr) == (0, "")
    assert "removed 2 entries, 300 B, from" in ran.stdout
    assert not any(file.exists() for file in kept)
    assert (quick / "notes.txt").read_text() == "mine"
    found = strict(call("doctor", "--empty-cache", "--json").stdout)
    assert found == {"folder": str(quick), "removed": 0, "bytes": 0}


def test_what_jax_keeps_has_the_names_that_are_removed(tmp_path: Path):
    """Real entries of a small program, not names made up here."""
    program = (
        "from asperity._jax import jax, jnp; "
        "jax.config.update('jax_persistent_cache_min_compile_time_secs', 0.0); "
        "jax.jit(lambda x: jnp.sin(x) + 1)(jnp.ones(3)); "
        "from asperity.cli.doctor import cache; print(cache.emptied(cache.folder())[0])"
    )
    env = {**os.environ, "JAX_COMPILATION_CACHE_DIR": str(tmp_path)}
    command = [sys.executable, "-c", program]
    ran = subprocess.run(command, env=env, capture_output=True, text=True, check=True)
    assert int(ran.stdout) > 0
    assert list(tmp_path.rglob("*-cache")) == []


def test_a_cache_that_cannot_be_written_is_told(quick: Path):
    quick.write_text("a file in the way")
    found = cache.examined(quick)
    assert found.fault == os.strerror(errno.EEXIST)
    ran = call("doctor")
    assert ran.exit_code == 0  # it costs time alone
    assert "Nothing can be written to the compile cache" in ran.stdout


def test_a_full_disk_is_told(quick: Path, monkeypatch: pytest.MonkeyPatch):
    def full(*_: Any) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    assert cache.examined(quick).fault == os.strerror(errno.ENOSPC)
    assert list(quick.iterdir()) == []
    assert "full" in dataclasses.replace(cache.Cache("f"), room=10**6).warnings[0]


def test_a_cache_that_is_off_is_told(monkeypatch: pytest.MonkeyPatch):
    assert "is off" in cache.examined(None).warnings[0]
    monkeypatch.setattr(cache, "folder", lambda: None)
    ran = call("doctor", "--empty-cache")
    assert ran.exit_code == 2
    assert ran.stderr.count("\n") == 1


def test_a_containers_quota_is_read(tmp_path: Path):
    file = tmp_path / "cpu.max"
    file.write_text("150000 100000\n")
    assert machine.processor_quota(file) == pytest.approx(1.5)
    file.write_text("max 100000\n")
    assert machine.processor_quota(file) is None
    assert machine.processor_quota(tmp_path / "none") is None


def test_the_reason_why_there_is_no_gpu(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("JAX_PLATFORMS", "")
    assert "processors alone" in machine.why_no_gpu(hardware=True, plugin=False)
    assert "driver" in machine.why_no_gpu(hardware=True, plugin=True)
    assert "shows none" in machine.why_no_gpu(hardware=False, plugin=True)
    assert "shows none" in machine.why_no_gpu(hardware=False, plugin=False)
    monkeypatch.setenv("JAX_PLATFORMS", "cpu")
    assert "JAX_PLATFORMS=cpu leaves it out" in machine.why_no_gpu(hardware=True, plugin=True)


def test_speed_is_that_of_a_motion_and_its_ledger_closes():
    begun = time.perf_counter()
    found = speed.speed("published")
    assert 0.0 < found.warm < found.first < time.perf_counter() - begun
    assert found.impacts == 11
    assert found.energy_balance_error < 1e-9

"""``asperity doctor`` and ``asperity --version``: what is installed, and whether it works."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from dask.system import cpu_count

from asperity import solver
from asperity._jax import jax
from asperity.cli import compile_cache, self_test, stack
from asperity.errors import SimulationError
from commands import answered, call, imported, refused, strict

doctor = import_module("asperity.cli.doctor")  # the package holds the command of that name

LEDGER = {"energy_balance_error": 1e-12}
KEY = "0123456789abcdef" * 4


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


def test_an_extra_that_is_missing_is_not_installed(monkeypatch):
    monkeypatch.setattr(stack, "requires", lambda name: ["no-such-thing>=1; extra == 'dream'"])
    assert "no-such-thing      not installed (extra dream)" in call("--version").stdout
    assert answered("--version")["no-such-thing"] is None


def test_version_imports_nothing_that_it_names():
    code = "from asperity.cli.stack import tell_versions; tell_versions(as_json=False)"
    assert not imported(code) & {"jax", "numpy", "matplotlib", "xarray"}


def test_json_before_a_command_is_refused():
    for arguments in (("--json",), ("--json", "materials")):
        assert "`--json` must go with --version" in refused(*arguments)


def test_requirements_are_compared_with_what_is_installed():
    assert stack.unmet() == []
    assert stack.unmet(["numpy>=2", "numpy<1; extra == 'x'"]) == [
        f"numpy<1 is wanted; {version('numpy')} is installed"
    ]
    assert stack.unmet(["no-such-thing>=3"]) == ["no-such-thing>=3 is not installed"]
    assert stack.unmet(["no-such-thing; extra == 'x'", "other; sys_platform == 'none'"]) == []


def test_each_check_of_the_self_test_holds():
    off = {name: found() / limit for name, _, limit, found in self_test.CHECKS}
    assert len(off) == 6
    assert [name for name, share in off.items() if not share < 1.0] == []


@pytest.fixture(name="quick")
def _quick(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A doctor whose motions cost nothing, with a cache of its own."""
    result = SimpleNamespace(measures={"restitution": [0.5] * 7}, ledger=LEDGER)
    monkeypatch.setattr(solver, "solve", lambda *_, **__: result)
    monkeypatch.setattr(self_test, "CHECKS", (("a", "b", 1.0, lambda: 0.0),))
    monkeypatch.setattr(compile_cache, "folder", lambda: tmp_path / "cache")
    monkeypatch.setattr(compile_cache, "fault_of", lambda place: None)
    return tmp_path / "cache"


def test_doctor_says_each_section_within_80_columns(quick):
    ran = call("doctor")
    assert (ran.exit_code, ran.stderr) == (0, "")
    for title in ("Installed", "Machine", "Compile cache", "Self-test", "Speed"):
        assert f"\n{title}\n" in "\n" + ran.stdout
    assert "for a motion of 7 impacts" in ran.stdout
    assert ran.stdout.endswith("\nall is well\n")
    long = [line.split() for line in ran.stdout.splitlines() if len(line) > 80]
    assert [words for words in long if str(quick) not in words and len(words) > 1] == []


def test_doctor_is_one_json_object(quick):
    found = answered("doctor")
    assert list(found) == [
        "installed", "machine", "compile_cache", "self_test", "speed", "checks", "ok",
    ]  # fmt: skip
    assert found["ok"] is True
    assert found["installed"]["jax"] == version("jax")
    assert found["machine"]["processors"] == cpu_count()
    assert found["self_test"] == {"a": 0.0}
    assert found["compile_cache"]["folder"] == str(quick)
    assert list(found["speed"]) == ["published", "glass-bead", "published-exact"]
    assert found["speed"]["published"]["impacts"] == 7
    assert {one["ok"] for one in found["checks"]} == {True}


@pytest.mark.parametrize("off", [0.2, float("nan")])
def test_a_check_that_fails_is_exit_3_and_named(quick, monkeypatch, off):
    monkeypatch.setattr(self_test, "CHECKS", (("pull-off", "theory", 0.1, lambda: off),))
    ran = call("doctor")
    assert ran.exit_code == 3
    assert ran.stderr == "asperity: 1 of 5 checks fail: pull-off\n"
    assert f"FAIL  off by {off:.1e}, 1e-01 allowed" in ran.stdout
    assert "NOT all is well" in ran.stdout
    ran = call("doctor", "-q")
    assert (ran.exit_code, ran.stdout) == (3, "")
    assert strict(call("doctor", "--json").stdout)["ok"] is False


def test_a_check_that_cannot_be_computed_fails_with_its_reason(quick, monkeypatch):
    def broken() -> float:
        raise SimulationError("no\nequilibrium")

    checks = (("a", "b", 1.0, broken), ("c", "d", 1.0, lambda: 0.0))
    monkeypatch.setattr(self_test, "CHECKS", checks)
    ran = call("doctor")
    assert ran.exit_code == 3
    assert "FAIL  SimulationError: no equilibrium" in ran.stdout
    assert "ok    off by 0.0e+00" in ran.stdout


def test_a_ledger_that_does_not_close_and_an_unmet_requirement_are_exit_3(quick, monkeypatch):
    monkeypatch.setitem(LEDGER, "energy_balance_error", 1e-3)
    monkeypatch.setattr(stack, "unmet", lambda: ["jax>=99 is wanted; 0.1 is installed"])
    ran = call("doctor")
    assert ran.exit_code == 3
    assert "FAIL  closes to 1.0e-03" in ran.stdout
    assert "FAIL  jax>=99 is wanted" in ran.stdout


def test_a_stack_that_does_not_work_is_told_without_a_traceback(quick, monkeypatch):
    def missing() -> Any:
        raise ImportError("libsomething.so: not found")

    monkeypatch.setattr(jax, "devices", missing)
    ran = call("doctor")
    assert ran.exit_code == 3
    assert "ImportError: libsomething.so: not found" in ran.stdout
    assert "\nSpeed\n" in ran.stdout
    assert "Traceback" not in ran.output


def test_a_gpu_that_is_not_used_is_told(quick, monkeypatch):
    monkeypatch.setattr(Path, "glob", lambda self, pattern: iter([self / "nvidia0"]))
    assert "GPU" in call("doctor").stdout
    monkeypatch.setattr(jax, "default_backend", lambda: "gpu")
    assert "GPU" not in call("doctor").stdout


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


def test_the_cache_is_measured(tmp_path):
    filled(tmp_path)
    assert compile_cache.size_of(tmp_path) == (2, 300)
    assert compile_cache.room_for(tmp_path / "not" / "there") > 0
    assert compile_cache.size_of(tmp_path / "not") == (0, 0)


def test_emptying_removes_what_the_cache_keeps_and_nothing_else(quick):
    kept = filled(quick)
    ran = call("doctor", "--empty-cache")
    assert (ran.exit_code, ran.stderr) == (0, "")
    assert "removed 2 entries, 300 B, from" in ran.stdout
    assert not any(file.exists() for file in kept)
    assert (quick / "notes.txt").read_text() == "mine"
    found = answered("doctor", "--empty-cache")
    assert found == {"folder": str(quick), "removed": 0, "bytes": 0}


def test_the_folders_of_other_versions_are_emptied_too(monkeypatch, tmp_path):
    monkeypatch.setattr(compile_cache, "folder", lambda: tmp_path / "jaxlib-2")
    kept = [file for name in ("jaxlib-1", "jaxlib-2", "other") for file in filled(tmp_path / name)]
    assert compile_cache.every_folder(tmp_path / "jaxlib-2") == [tmp_path / "jaxlib-2"]
    monkeypatch.delenv("JAX_COMPILATION_CACHE_DIR")
    assert answered("doctor", "--empty-cache")["removed"] == 4
    assert {file.parts[len(tmp_path.parts)] for file in kept if file.exists()} == {"other"}


def test_another_start_reads_what_one_compiled_and_all_of_it_can_be_removed(tmp_path):
    """Real entries of JAX, not names made up here."""
    cache = tmp_path / "cache"
    assert compile_cache.fault_of(cache) is None
    assert not any("trial" in file.name for file in cache.iterdir())
    entries, _ = compile_cache.empty(cache)
    assert entries > 0
    assert list(cache.rglob("*-cache")) == []
    (tmp_path / "file").write_text("a file in the way")
    assert "File exists" in (compile_cache.fault_of(tmp_path / "file") or "")


def test_a_cache_that_is_not_read_costs_time_alone(quick, monkeypatch):
    monkeypatch.setattr(compile_cache, "fault_of", lambda place: "no room")
    ran = call("doctor")
    assert ran.exit_code == 0
    assert "no: every start compiles anew (no room)" in " ".join(ran.stdout.split())
    monkeypatch.setattr(compile_cache, "room_for", lambda place: 10**6)
    assert "nearly full" in call("doctor").stdout


def test_the_cache_has_a_folder_for_each_version_of_jaxlib():
    program = "from asperity.cli import compile_cache; print(compile_cache.folder().name)"
    env = {key: value for key, value in os.environ.items() if key != "JAX_COMPILATION_CACHE_DIR"}
    command = [sys.executable, "-c", program]
    ran = subprocess.run(command, env=env, capture_output=True, text=True, check=True)
    assert ran.stdout == f"jaxlib-{version('jaxlib')}\n"


def test_a_cache_that_is_off_is_told(quick, monkeypatch):
    monkeypatch.setattr(compile_cache, "folder", lambda: None)
    assert "none: it is off" in call("doctor").stdout
    refused("doctor", "--empty-cache")


def test_speed_is_that_of_a_motion_and_its_ledger_closes():
    """Every built-in case is solved four times: here the quickest alone, by the same code."""
    lines = doctor._speed()
    timed, closes = next(lines), next(lines)
    assert timed.name == "published"
    assert timed.value["impacts"] == 11
    assert 0.0 < timed.value["warm"] < timed.value["first"]
    assert closes.ok

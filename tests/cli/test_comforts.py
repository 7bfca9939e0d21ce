"""What every command has: JSON, a quiet and a talkative manner, lines that fit a terminal."""

from __future__ import annotations

import io
import os
import re
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from typer.main import get_command

from asperity import solver as real_solver
from asperity.cli import app
from asperity.cli.compiling import Compilation
from asperity.cli.reporter import Reporter
from asperity.cli.terminal import WIDTH, say, tell, wrapped
from asperity.cli.working import _bar_on
from asperity.config import builtin
from commands import answered, assert_narrow, call, program, refused, strict
from fake_solve import solver
from study_results import GRID, SAMPLE, SPEEDS, stored

CASE = "published-exact"
COMMANDS = sorted(get_command(app).commands)  # type: ignore[attr-defined]
SAYING_NOTHING_ON_THE_WAY = {"init", "materials", "web"}
NARROW = {**os.environ, "COLUMNS": str(WIDTH)}


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """A solver that answers at once."""
    monkeypatch.setitem(sys.modules, "asperity.solver", solver())


FAILED = frozenset({3})
"""Cases of a study that fail."""


def store(text: str = GRID, failed: frozenset[int] = FAILED) -> str:
    """The store of a study, in this folder."""
    return str(stored(Path(), text, failed))


# Every command


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_prints_json_if_asked_and_one_that_computes_is_quiet_or_verbose(command):
    text = call(command, "--help").stdout
    assert_narrow(text)
    assert " --json " in text
    if command in SAYING_NOTHING_ON_THE_WAY:
        return
    assert "-q, --quiet" in text
    assert "-v, --verbose" in text
    for order in (("-q", "-v"), ("--verbose", "--quiet")):
        said = refused(command, "x", *order)
        assert said == "asperity: `--quiet` must be given without `--verbose`; got both\n"


def test_help_names_every_command_and_fits_the_terminal():
    """How soon is a matter of the benchmarks."""
    ran = program("--help", env=NARROW)
    assert_narrow(ran.stdout)
    for name in COMMANDS:
        assert f"  {name}" in ran.stdout


# Quiet and verbose


def test_a_verbose_run_says_each_step_with_its_time_beside_the_answer():
    plain = call("run", CASE, "--json").stdout
    ran = call("run", CASE, "-v", "--json")
    assert ran.exit_code == 0
    assert strict(ran.stdout) == strict(plain)
    steps = re.findall(r"^asperity: (.*?) +[\d.]+ m?s$", ran.stderr, re.MULTILINE)
    assert steps == ["loading, impact 3"]
    assert re.search(r"^asperity: programs: \d+ traced in", ran.stderr, re.MULTILINE)
    assert re.search(r"^asperity: code: \d+ compiled in", ran.stderr, re.MULTILINE)
    assert_narrow(ran.stderr)


def test_the_real_steps_are_compilation_curves_motion_and_measures():
    """In a process of its own, whose programs come from the cache or are compiled."""
    ran = program("run", "published", "-v", "-o", "out", env=NARROW, timeout=300)
    waits = re.sub(r" of the \w+( \w+)?, some \d+ s", "", ran.stderr)
    steps = re.findall(r"^asperity: (.*?) +[\d.]+ m?s$", waits, re.MULTILINE)
    assert steps == [
        "loading", "tracing", "compilation", "force curves", "compilation", "motion, impact 11",
        "measures", "critical velocity", "record and pictures", "files",
    ]  # fmt: skip
    assert re.search(r"programs: \d+ traced .*, \d+ found", ran.stderr)
    assert_narrow(ran.stderr)
    assert_narrow(ran.stdout)


@pytest.mark.usefixtures("undrawn")
def test_a_quiet_command_prints_errors_and_json_alone():
    size = ("--size", "1 um x 1 um")
    silent = [
        ("run", CASE),
        ("curve", CASE),
        ("plot", f"{CASE}-out/record.nc"),
        ("generate", "made.npy", *size, "--rms-height", "1 nm", "--points", "128"),
        ("surface", "made.npy", *size, "--unit", "m"),
        ("plot", study := store()),
    ]
    for arguments in silent:
        ran = call(*arguments, "-q")
        assert (ran.exit_code, ran.output) == (0, ""), arguments
    assert answered("run", CASE, "-q")["outcome"] == "rest"
    refused("run", "publishd", "-q")
    assert "1 of 861 cases failed" in call("plot", study).stderr


def test_what_compiling_took_is_a_difference():
    before = Compilation(traced=1, kept=1, tracing=0.5, asked=4, read=1, compiling=2.0)
    after = Compilation(2, 1, 0.75, 9, 4, 3.5, 0.25)
    first, second = (after - before).lines()
    assert first == "programs: 1 traced in 0.25 s, 0 found in their traced form"
    assert second.startswith("code: 2 compiled in 1.50 s, 3 found in the cache in 0.25 s")


# JSON of the commands that write


def test_generate_says_what_it_made():
    options = ("--size", "2 um x 1 um", "--rms-height", "5 nm", "--points", "32x16")
    found = answered("generate", "made.npy", *options, "--seed", "7")
    heights = np.load("made.npy")
    assert found["points"] == [32, 16]
    assert heights.shape == (16, 32)
    assert found["pixel_size"] == pytest.approx([62.5e-9, 62.5e-9])
    assert found["rms_height"] == pytest.approx(float(np.std(heights)))
    assert (found["file"], found["seed"], found["spectrum_error"]) == ("made.npy", 7, None)
    shaped = answered("generate", "b.npy", *options, "--skewness", "-1", "--kurtosis", "6")
    assert shaped["skewness"] == pytest.approx(-1.0, abs=1e-3)
    assert shaped["kurtosis"] == pytest.approx(6.0, abs=0.02)
    assert shaped["spectrum_error"]["rms"] > 0.0


@pytest.mark.usefixtures("undrawn")
def test_plot_of_a_store_says_what_it_drew_and_the_whole_front():
    study = store()
    found = answered("plot", study)
    assert found["files"] == ["map.png", "map.svg"]
    assert (found["cases"], found["computed"], found["failed"]) == (861, 861, 1)
    goals = ("max:restitution", "min:time_to_rest")
    front = answered("plot", study, "--pareto", *goals)["front"]
    assert front["goals"] == list(goals)
    assert front["of"] == 860
    sizes = {len(v) for part in ("axes", "measures") for v in front[part].values()}
    assert len(sizes) == 1
    bounce = front["measures"]["restitution"]
    assert bounce == sorted(bounce, reverse=True)


def test_export_says_what_is_in_the_file():
    study = store(SPEEDS, frozenset())
    found = answered("export", study, "-o", "all.csv")
    assert (found["kind"], found["cases"], found["done"]) == ("table", 19, 19)
    assert found["bytes"] == Path("all.csv").stat().st_size
    assert "impact.speed" in found["columns"]
    found = answered("export", study, "--restitution", "e.csv")
    assert found["kind"] == "restitution"
    assert found["impact_speed"][0] == pytest.approx(0.05)
    assert found["restitution"][0] == 0.0  # too slow to bounce


def test_a_force_table_says_its_pull_and_its_loss(monkeypatch):
    monkeypatch.setitem(sys.modules, "asperity.solver", real_solver)
    found = answered("export", "published", "--force-table", "wall.table")
    curve = real_solver.curve(builtin("published"))
    assert (found["kind"], found["file"]) == ("force-table", "wall.table")
    assert found["points"] == curve.rigid_separation.size
    assert (found["pull_off"], found["loss"]) == (curve.pull_off, curve.loss)
    assert found["warnings"] == curve.warnings
    assert found["warnings"]
    ran = call("export", "published", "--force-table", "wall.table", "--force", "-q")
    assert (ran.exit_code, ran.output) == (0, "")
    ran = call("export", "published", "--force-table", "wall.table", "--force", "-v")
    assert "asperity: force curves" in ran.stderr


def test_a_quiet_verdict_says_nothing_and_a_verbose_one_its_steps(monkeypatch):
    monkeypatch.setitem(sys.modules, "asperity.solver", real_solver)
    ran = call("regime", "published", "-q")
    assert (ran.exit_code, ran.output) == (0, "")
    ran = call("regime", "published", "-v")
    assert "asperity: first impact" in ran.stderr
    assert_narrow(ran.stdout + ran.stderr)


# Lines that fit


@pytest.mark.usefixtures("undrawn")
def test_answers_fit_the_terminal():
    study = store()
    for arguments in (
        ("run", CASE),
        ("curve", CASE),
        ("plot", f"{CASE}-out/record.nc"),
        ("plot", study),
        ("export", study, "-o", "all.csv"),
        ("materials",),
        ("init",),
        ("generate", f"{'a long name ' * 4}.npy", "--size", "1 um x 1 um", "--rms-height", "1 nm",
         "--points", "16"),
        ("merge", study, "-o", "other.zarr"),
        ("--version",),
    ):  # fmt: skip
        ran = call(*arguments)
        assert ran.exit_code == 0, ran.output
        assert_narrow(ran.stdout)
        if ran.stderr:
            assert_narrow(ran.stderr)


@pytest.mark.usefixtures("undrawn")
def test_a_front_of_many_axes_is_told_in_paragraphs():
    study = store(SAMPLE)
    ran = call("plot", study, "--pareto", "max:restitution", "min:time_to_rest")
    assert "Pareto front of max:restitution, min:time_to_rest" in ran.stdout
    assert "adhesion.model" in ran.stdout
    assert_narrow(ran.stdout)


def test_long_names_stand_on_a_line_of_their_own_in_tables():
    from asperity.cli.attributing import _index_lines
    from asperity.cli.regimes import _map_lines
    from asperity.regimes import Place

    long = "a-case-with-a-name-that-is-longer-than-half-a-line"
    law = SimpleNamespace(regime=SimpleNamespace(adhesion_law="maugis"), warnings=[])
    lines = _map_lines([Place("short", 0.2, 3.0), Place(long, 0.2, 3e4)], [law, law])  # type: ignore[list-item]
    assert_narrow("\n".join(lines))
    assert long in lines
    numbers = np.array([0.5, 0.25])
    index = SimpleNamespace(value=numbers, low=numbers - 0.1, high=numbers + 0.1)
    keys = ("impact.speed", "materials.polystyrene.youngs_modulus")
    found = SimpleNamespace(measure="restitution", cases=99, keys=keys, first=index, total=index)
    text = "\n".join(_index_lines(found))  # type: ignore[arg-type]
    assert_narrow(text)
    assert all(key in text for key in keys)


@pytest.mark.parametrize("done", ["starting", "1,234,567 of 10,000,000, 98,000 a second, " * 2])
def test_the_bar_keeps_the_time_and_the_line(done):
    from rich.console import Console

    console = Console(file=io.StringIO(), width=WIDTH, force_terminal=True)
    with _bar_on(console) as bar:
        bar.add_task(done, total=1.0)
        bar.refresh()
    shown = re.sub(r"\x1b\[[0-9;?]*[a-zA-Z]", "", console.file.getvalue())  # type: ignore[attr-defined]
    lines = [line for line in re.split(r"[\r\n]", shown) if line.strip()]
    assert_narrow("\n".join(lines))
    assert all(re.search(r"0:00", line) for line in lines)


def test_a_note_is_wrapped_and_an_error_stays_one_line(capsys):
    text = "asperity: " + "a note of many words " * 10
    say(text)
    err = capsys.readouterr().err
    assert_narrow(err)
    assert err.split() == text.split()
    refused("run", "x" * 200 + ".toml")


def test_wrapping_loses_no_word_and_breaks_no_path():
    path = "/".join(["folder"] * 20)
    text = f"written to {path} and to some other places besides, each of which has its own name"
    lines = wrapped(text)
    assert " ".join(lines).split() == text.split()
    assert any(path in line for line in lines)
    assert [line for line in lines if len(line) > WIDTH and path not in line] == []
    assert wrapped("short", "  ") == ["  short"]
    assert all(line.startswith("  ") for line in wrapped("word " * 40, "  "))


def test_an_answer_is_made_only_where_it_is_said(capsys):
    def refuse() -> Any:
        raise AssertionError

    Reporter(quiet=True).answer(refuse, refuse)
    Reporter(as_json=True, quiet=True).answer(refuse, lambda: {"a": 1})
    Reporter().answer(lambda: "words", refuse)
    tell("")
    assert capsys.readouterr().out == '{"a": 1}\nwords\n\n'

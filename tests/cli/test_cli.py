"""The command line: what it answers, what it writes, and how it ends when something is wrong."""

from __future__ import annotations

import errno
import json
import os
import resource
import signal
import subprocess
import sys
import time
import tomllib
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from asperity import plots
from asperity.cli import app
from asperity.config import load_file
from asperity.config.case_file import builtin_text
from asperity.errors import Outcome
from asperity.results import results_folder
from asperity.results.read_record import read
from asperity.results.result import Curve, Result

sys.path.insert(0, str(Path(__file__).parents[1]))

from fake_solve import solver

PROGRAM = Path(__file__).parents[1] / "fake_solve.py"
CASE = "published-exact"


@pytest.fixture(autouse=True)
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty current folder, and a solver that answers at once."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "asperity.solver", solver())
    return tmp_path


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pictures that cost nothing to draw, for tests of what is done with the files."""

    def pictures(result: Result | Curve) -> dict[str, bytes]:
        own = results_folder.RUN_FILES if isinstance(result, Result) else results_folder.CURVE_FILES
        return {name: b"drawn" for name in own if name.endswith((".png", ".svg"))}

    monkeypatch.setattr(plots, "pictures", pictures)


def call(*arguments: str) -> Any:
    return CliRunner().invoke(app, list(arguments))


def program(behaviour: str, *arguments: str, **options: Any) -> subprocess.CompletedProcess[str]:
    """The whole program in a process of its own."""
    command = [sys.executable, str(PROGRAM), behaviour, *arguments]
    options = {"capture_output": True, "text": True, "timeout": 60, **options}
    return subprocess.run(command, check=False, **options)


def assert_one_line(text: str, *parts: str) -> None:
    assert text.count("\n") == 1, text
    assert "Traceback" not in text
    for part in parts:
        assert part in text


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def strict(text: str) -> Any:
    def refuse(constant: str) -> None:
        raise AssertionError(constant)

    return json.loads(text, parse_constant=refuse)


def test_help_imports_nothing_heavy():
    program = (
        "import sys, asperity.cli as c; from typer.main import get_command; get_command(c.app); "
        "heavy = ('jax', 'matplotlib', 'pint', 'xarray', 'numpy', 'netCDF4', 'rich', 'pydantic'); "
        "print([name for name in heavy if name in sys.modules])"
    )
    ran = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert ran.stdout == "[]\n"


def test_help_names_every_command():
    """How soon is a matter of the benchmarks."""
    command = [sys.executable, "-m", "asperity", "--help"]
    ran = subprocess.run(command, capture_output=True, text=True, check=True)
    for name in ("run", "curve", "reproduce", "plot", "init", "materials"):
        assert f"  {name}" in ran.stdout


def test_version_is_that_of_the_package():
    from importlib.metadata import version

    assert call("--version").stdout.startswith(f"asperity {version('asperity')}\n")


def test_run_writes_record_pictures_and_summary(place: Path):
    ran = call("run", CASE)
    assert ran.exit_code == 0, ran.output
    folder = place / f"{CASE}-out"
    assert names(folder) == sorted(results_folder.RUN_FILES)
    assert names(place) == [folder.name]
    assert "published-exact: rest" in ran.stdout
    assert f"written to {folder.name}:\n  record.nc motion.png" in ran.stdout
    assert max(map(len, ran.stdout.splitlines())) <= 80
    assert max(map(len, (folder / "summary.txt").read_text().splitlines())) <= 80


def test_json_is_one_strict_object_and_writes_nothing(place: Path):
    ran = call("run", CASE, "--json")
    assert ran.exit_code == 0
    found = strict(ran.stdout)
    assert list(found) == ["outcome", "regime", "measures", "ledger", "warnings"]
    assert found["measures"]["power_loss_published"][-1] is None
    assert names(place) == []


@pytest.mark.usefixtures("undrawn")
def test_json_with_a_folder_writes_files_too(place: Path):
    ran = call("run", CASE, "--json", "-o", "out")
    assert strict(ran.stdout)["outcome"] == "rest"
    assert "written to out" in ran.stderr
    assert names(place / "out") == sorted(results_folder.RUN_FILES)


def test_curve_writes_its_own_files_and_prints_its_own_json(place: Path):
    assert call("run", CASE).exit_code == 0
    assert call("curve", CASE).exit_code == 0
    both = [*results_folder.RUN_FILES, *results_folder.CURVE_FILES]
    assert names(place / f"{CASE}-out") == sorted(both)
    found = strict(call("curve", CASE, "--json").stdout)
    assert len(found["force_unloading"]) == len(found["rigid_separation"])
    assert isinstance(found["pull_off"], float)
    assert isinstance(read(f"{CASE}-out/curve.nc"), Curve)


@pytest.mark.usefixtures("undrawn")
def test_quiet_prints_nothing(place: Path):
    ran = call("run", CASE, "-q")
    assert (ran.exit_code, ran.output) == (0, "")
    assert names(place) == [f"{CASE}-out"]


def test_a_record_repeats_its_run_byte_by_byte(place: Path):
    assert call("run", CASE, "-o", "first").exit_code == 0
    assert call("run", "first/record.nc", "-o", "second").exit_code == 0
    for name in results_folder.RUN_FILES:
        assert (place / "first" / name).read_bytes() == (place / "second" / name).read_bytes()


@pytest.mark.usefixtures("undrawn")
def test_a_record_holds_the_hash_of_the_file_as_it_was_written(place: Path):
    import hashlib

    assert call("init", "drop.toml").exit_code == 0
    assert call("run", "drop.toml").exit_code == 0
    found = read("drop-out/record.nc")
    assert found.name == "drop"
    content = (place / "drop.toml").read_bytes()
    assert found.input_sha256 == hashlib.sha256(content).hexdigest()
    assert found.case == load_file("drop.toml")


def case_with(place: Path, text: str) -> None:
    assert call("init", "base.toml").exit_code == 0
    base = (place / "base.toml").read_text()
    (place / "drop.toml").write_text(base[: base.index("[output]")] + text)


def test_the_case_says_where_and_what_to_write(place: Path):
    case_with(place, '[output]\ndirectory = "kept/here"\nmotion = false\npictures = false\n')
    assert call("run", "drop.toml").exit_code == 0
    assert names(place / "kept" / "here") == ["record.nc", "summary.txt"]
    found = read("kept/here/record.nc")
    assert isinstance(found, Result)
    assert found.time.size == 0
    ran = call("plot", "kept/here/record.nc")
    assert ran.exit_code == 2
    assert_one_line(ran.stderr, "record.nc", "must hold its motion")


def test_plot_draws_a_record_again(place: Path):
    assert call("run", CASE, "-o", "out").exit_code == 0
    before = (place / "out" / "motion.png").read_bytes()
    (place / "out" / "motion.png").write_bytes(b"old")
    assert call("plot", "out/record.nc").exit_code == 0
    assert (place / "out" / "motion.png").read_bytes() == before
    assert names(place / "out") == sorted(results_folder.RUN_FILES)
    assert call("plot", "out/record.nc", "-o", "pictures").exit_code == 0
    drawn = [name for name in results_folder.RUN_FILES if name.endswith((".png", ".svg"))]
    assert names(place / "pictures") == sorted(drawn)
    assert call("plot", "out/record.nc", "-o", "pictures").exit_code == 2
    assert call("plot", "out/record.nc", "-o", "pictures", "--force").exit_code == 0


def test_init_writes_a_case_that_runs_and_never_overwrites(place: Path):
    assert call("init").exit_code == 0
    text = (place / "case.toml").read_text()
    assert tomllib.loads(text)["schema"] == 1
    (place / "case.toml").write_text("mine")
    ran = call("init")
    assert ran.exit_code == 2
    assert_one_line(ran.stderr, "case.toml", "there already")
    assert (place / "case.toml").read_text() == "mine"
    assert call("init", "no/such/folder.toml").exit_code == 4
    assert call("init", "plain").stdout.endswith("asperity run ./plain\n")
    (place / "plain").unlink()
    assert names(place) == ["case.toml"]


def test_materials_are_listed_with_their_sources():
    from asperity.materials.liquids import LIQUIDS
    from asperity.materials.solids import ADHESION, SOLIDS

    text = call("materials").stdout
    for name in (*SOLIDS, *LIQUIDS):
        assert f"\n{name} " in text
    assert max(map(len, text.splitlines())) <= 80
    found = strict(call("materials", "--json").stdout)
    assert set(found["solids"]) == set(SOLIDS)
    assert found["solids"]["silica"]["youngs_modulus"] == SOLIDS["silica"].youngs_modulus
    works = found.pop("adhesion")
    assert all(entry["source"] for kind in found.values() for entry in kind.values())
    assert [work["work"] for work in works] == [entry.work for entry in ADHESION]
    assert all(work["source"] for work in works)


def test_the_whole_catalogue_takes_a_line_each_and_a_named_entry_tells_its_source():
    from asperity.materials.solids import SOLIDS

    lines = call("materials").stdout.splitlines()
    first = next(n for n, line in enumerate(lines) if line.startswith("silica "))
    table = lines[first : first + len(SOLIDS)]
    assert [line[:25].strip() for line in table] == list(SOLIDS)
    assert lines[-1].endswith("asperity materials NAME")
    named = " ".join(call("materials", "mica", "PDMS").stdout.split())
    assert "J. Geophys. Res. 91, 4657 (1986)" in named
    assert "never yields: an elastomer recovers its shape" in named


def test_works_of_adhesion_are_listed_for_either_solid_of_the_pair_and_never_assumed():
    text = " ".join(call("materials").stdout.split())
    assert "No case assumes one" in text
    assert "J. Phys. Chem. 97, 12034 (1993)" in text
    found = strict(call("materials", "silica", "--json").stdout)["adhesion"]
    assert {tuple(work["pair"]) for work in found} == {("mica", "silica"), ("silica", "silica")}
    only = call("materials", "diamond").stdout
    assert "\nsapphire / diamond " in only
    assert "Solids" not in only


@pytest.mark.usefixtures("undrawn")
def test_a_folder_in_use_is_refused_and_force_leaves_what_is_not_ours(place: Path):
    folder = place / f"{CASE}-out"
    folder.mkdir()
    (folder / "notes.txt").write_text("mine")
    ran = call("run", CASE)
    assert ran.exit_code == 2
    assert_one_line(ran.stderr, folder.name, "--force", "notes.txt")
    assert names(folder) == ["notes.txt"]
    assert call("run", CASE, "--force").exit_code == 0
    assert names(folder) == sorted([*results_folder.RUN_FILES, "notes.txt"])


@pytest.mark.parametrize("command", ["run", "curve"])
@pytest.mark.usefixtures("undrawn")
def test_an_earlier_answer_for_the_same_case_is_replaced(place: Path, command: str):
    assert "in place of" not in call(command, CASE).stdout
    folder = place / f"{CASE}-out"
    for path in folder.iterdir():
        if path.suffix not in (".nc", ".svg"):
            path.write_text("old")
    (folder / next(path.name for path in folder.glob("*.svg"))).unlink()
    ran = call(command, CASE)
    assert ran.exit_code == 0, ran.output
    assert "in place of the earlier results" in ran.stdout
    own = results_folder.RUN_FILES if command == "run" else results_folder.CURVE_FILES
    assert names(folder) == sorted(own)
    assert not any(path.read_bytes() == b"old" for path in folder.iterdir())


@pytest.mark.usefixtures("undrawn")
def test_results_of_an_edited_case_are_replaced_and_those_of_another_are_refused(place: Path):
    text = builtin_text(CASE)
    (place / "drop.toml").write_text(text)
    (place / "other.toml").write_text(text)
    assert call("run", "drop.toml").exit_code == 0
    (place / "drop.toml").write_text(text.replace("humidity = 0.6", "humidity = 0.5"))
    assert call("run", "drop.toml").exit_code == 0
    assert read(place / "drop-out" / "record.nc").case.capillary.humidity == 0.5
    (place / "deep").mkdir()
    (place / "deep" / "drop.toml").write_text(text)
    for other in ("other.toml", "deep/drop.toml", "published"):
        ran = call("run", other, "-o", "drop-out")
        assert ran.exit_code == 2
        assert_one_line(ran.stderr, "drop-out", "--force", "results of another case")


@pytest.mark.parametrize("spoiled", ["a note", "a record cut short", "a folder"])
@pytest.mark.usefixtures("undrawn")
def test_what_is_not_known_as_the_cases_own_results_is_refused(place: Path, spoiled: str):
    assert call("run", CASE).exit_code == 0
    folder = place / f"{CASE}-out"
    record = folder / "record.nc"
    if spoiled == "a note":
        (folder / "notes.txt").write_text("mine")
        assert "notes.txt" in call("run", CASE).stderr
    elif spoiled == "a folder":
        (folder / "summary.txt").unlink()
        (folder / "summary.txt").mkdir()
    else:
        record.write_bytes(record.read_bytes()[:-9])
    before = names(folder)
    ran = call("run", CASE)
    assert ran.exit_code in (2, 4)
    assert_one_line(ran.stderr, folder.name)
    assert names(folder) == before


@pytest.mark.parametrize(
    ("argument", "parts"),
    [
        ("missing.toml", ("missing.toml", "No such file")),
        ("missing.nc", ("missing.nc", "no such file")),
        ("publishd-exact", ("publishd-exact", "did you mean 'published-exact'")),
        ("empty.toml", ("empty.toml", "empty file")),
        ("binary.toml", ("binary.toml", "binary")),
        ("binary.nc", ("binary.nc", "must be a record")),
        ("large.toml", ("large.toml", "1 MiB")),
        ("wrong.toml", ("wrong.toml", "radius", "must be positive", "-50 um")),
        (".", (".", "folder")),
        ("", ("folder",)),
    ],
)
def test_a_case_that_cannot_be_used_is_one_line_and_exit_2(
    place: Path, argument: str, parts: tuple[str, ...]
):
    (place / "empty.toml").touch()
    (place / "binary.toml").write_bytes(bytes(range(256)))
    (place / "binary.nc").write_bytes(bytes(range(256)))
    (place / "large.toml").write_bytes(b"#" * (1 << 20) + b"\n")
    assert call("init", "wrong.toml").exit_code == 0
    text = (place / "wrong.toml").read_text()
    (place / "wrong.toml").write_text(text.replace('"50 um"', '"-50 um"'))
    before = names(place)
    ran = call("run", argument)
    assert ran.exit_code == 2
    assert ran.stdout == ""
    assert_one_line(ran.stderr, *parts)
    assert names(place) == before


def test_a_built_in_name_is_not_a_file_of_that_name(place: Path):
    (place / "drop").write_text("schema = 1")
    ran = call("run", "drop")
    assert ran.exit_code == 2
    assert_one_line(ran.stderr, "write ./drop")
    assert_one_line(call("run", "./drop").stderr, "./drop", "body")


@pytest.mark.parametrize(
    "arguments", [["runn"], ["run"], ["run", CASE, "--jsn"], ["run", "a", "b"]]
)
def test_a_misspelt_command_line_is_exit_2(arguments: list[str]):
    assert call(*arguments).exit_code == 2


def test_a_misspelt_command_is_guessed():
    assert "Did you mean 'run'?" in call("runn").stderr


def test_the_solvers_refusal_is_bad_input(monkeypatch: pytest.MonkeyPatch, place: Path):
    monkeypatch.setitem(sys.modules, "asperity.solver", solver("refuse"))
    ran = call("run", CASE)
    assert ran.exit_code == 2
    assert_one_line(ran.stderr, "impact.release_separation", "45.9 nm")
    assert names(place) == []


def test_a_failure_of_the_numerics_keeps_what_was_computed(
    monkeypatch: pytest.MonkeyPatch, place: Path
):
    monkeypatch.setitem(sys.modules, "asperity.solver", solver("fail"))
    ran = call("run", CASE)
    assert ran.exit_code == 3
    assert_one_line(ran.stderr, "no equilibrium at 44 nm")
    found = read(f"{CASE}-out/record.nc")
    assert isinstance(found, Result)
    assert found.outcome is Outcome.FAILED
    assert strict(call("run", CASE, "--json").stdout)["outcome"] == "failed"


def test_a_failure_without_a_partial_result_writes_nothing(
    monkeypatch: pytest.MonkeyPatch, place: Path
):
    monkeypatch.setitem(sys.modules, "asperity.solver", solver("break"))
    ran = call("run", CASE)
    assert ran.exit_code == 3
    assert_one_line(ran.stderr, "no equilibrium")
    assert names(place) == []


def test_a_bug_is_not_hidden(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "asperity.solver", solver("bug"))
    assert isinstance(call("run", CASE).exception, ZeroDivisionError)


def test_a_place_that_is_no_folder_is_exit_4_before_computing(
    monkeypatch: pytest.MonkeyPatch, place: Path
):
    monkeypatch.setitem(sys.modules, "asperity.solver", solver("bug"))
    (place / "file").touch()
    for target in ("file", "file/below"):
        ran = call("run", CASE, "-o", target)
        assert ran.exit_code == 4
        assert_one_line(ran.stderr, target, "Not a directory")
    assert names(place) == ["file"]


def limit_files() -> None:
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))


def test_a_full_disk_is_exit_4_and_leaves_nothing(place: Path):
    ran = program("quick", "run", CASE, preexec_fn=limit_files)
    assert ran.returncode == 4
    assert_one_line(ran.stderr, f"{CASE}-out/record.nc", os.strerror(errno.EFBIG))
    assert names(place) == []


def test_a_home_that_cannot_be_written_to_costs_no_message(place: Path):
    nowhere = dict.fromkeys(("HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME"), "/proc/nowhere")
    environment = {key: value for key, value in os.environ.items() if key != "MPLCONFIGDIR"}
    ran = program("quick", "run", CASE, env={**environment, **nowhere})
    assert (ran.returncode, ran.stderr) == (0, "")
    assert "motion.png" in names(place / f"{CASE}-out")


@pytest.mark.usefixtures("undrawn")
def test_a_full_disk_keeps_an_earlier_result(place: Path):
    assert call("run", CASE).exit_code == 0
    folder = place / f"{CASE}-out"
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    assert program("quick", "run", CASE, "--force", preexec_fn=limit_files).returncode == 4
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_a_full_disk_at_the_end_of_standard_output_is_exit_4():
    with Path("/dev/full").open("w") as full:
        ran = program(
            "quick", "run", CASE, "--json", capture_output=False, stdout=full,
            stderr=subprocess.PIPE,
        )  # fmt: skip
    assert ran.returncode == 4
    assert_one_line(ran.stderr, "standard output", os.strerror(errno.ENOSPC))


def test_a_folder_without_permission_is_found_before_computing(place: Path):
    closed = place / "closed"
    closed.mkdir()
    closed.chmod(0o555)
    # Rights are given up after the imports, within the folder, and only where there are root's,
    # which no permission stops.
    program = (
        "import os; from asperity.results import results_folder; "
        "os.geteuid() or (os.setgroups([]), os.setgid(65534), os.setuid(65534)); "
        "results_folder.check_folder('out', results_folder.RUN_FILES)"
    )
    ran = subprocess.run(
        [sys.executable, "-c", program], cwd=closed, capture_output=True, text=True, check=False
    )
    assert "OutputError: out: cannot be written: Permission denied" in ran.stderr
    assert names(closed) == []


def test_a_reader_that_leaves_gets_no_traceback():
    command = [sys.executable, str(PROGRAM), "quick", "run", CASE, "--json"]
    reading, writing = os.pipe()
    os.close(reading)
    ran = subprocess.run(command, stdout=writing, stderr=subprocess.PIPE, text=True, check=False)
    os.close(writing)
    assert ran.returncode == 128 + signal.SIGPIPE
    assert ran.stderr == ""


def interrupted(
    behaviour: str, *arguments: str, number: int = signal.SIGINT, times: int = 1
) -> tuple[int, str, str, float]:
    """Exit code, both outputs, and seconds from the signal to the end."""
    running = subprocess.Popen(
        [sys.executable, str(PROGRAM), behaviour, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        assert running.stderr is not None
        assert running.stderr.readline() == "computing\n"
        start = time.monotonic()
        for _ in range(times):
            running.send_signal(number)
            time.sleep(0.2 if times > 1 else 0.0)
        out, err = running.communicate(timeout=20)
        return running.returncode, out, err, time.monotonic() - start
    finally:
        running.kill()


def test_ctrl_c_keeps_what_was_computed_within_two_seconds(place: Path):
    code, _, err, seconds = interrupted("slow", "run", CASE)
    assert code == 130
    assert seconds < 2.0
    assert_one_line(err, "interrupted", "is kept")
    found = read(f"{CASE}-out/record.nc")
    assert isinstance(found, Result)
    assert found.outcome is Outcome.INTERRUPTED
    assert names(place / f"{CASE}-out") == ["record.nc", "summary.txt"]


def test_ctrl_c_prints_the_json_of_what_was_computed():
    code, out, _, _ = interrupted("slow", "run", CASE, "--json")
    assert code == 130
    assert strict(out)["outcome"] == "interrupted"


def test_ctrl_c_does_not_wait_for_a_solver_that_does_not_listen(place: Path):
    code, out, err, seconds = interrupted("deaf", "run", CASE)
    assert (code, out) == (130, "")
    assert seconds < 2.0
    assert_one_line(err, "interrupted")
    assert names(place) == []


def test_a_second_ctrl_c_leaves_at_once(place: Path):
    code, _, err, seconds = interrupted("deaf", "run", CASE, times=2)
    assert code == 130
    assert seconds < 1.0
    assert_one_line(err, "interrupted")
    assert names(place) == []


def test_the_systems_request_to_end_is_heard_too(place: Path):
    code, _, err, seconds = interrupted("slow", "run", CASE, number=signal.SIGTERM)
    assert code == 143
    assert seconds < 2.0
    assert_one_line(err, "interrupted")
    assert names(place / f"{CASE}-out") == ["record.nc", "summary.txt"]


def test_ctrl_c_while_drawing_keeps_the_record(monkeypatch: pytest.MonkeyPatch, place: Path):
    """A signal while a picture takes longer than an interrupted program may wait."""
    from asperity.cli import working

    monkeypatch.setattr(working, "PATIENCE", 0.05)

    def stopped(result: Result) -> dict[str, bytes]:
        signal.raise_signal(signal.SIGINT)
        time.sleep(0.5)
        return {"motion.png": b""}

    monkeypatch.setattr(plots, "pictures", stopped)
    assert call("run", CASE).exit_code == 130
    assert names(place / f"{CASE}-out") == ["record.nc", "summary.txt"]


def test_a_log_has_no_progress_bar_and_a_terminal_has_one():
    import pty

    assert program("quick", "curve", CASE, "-o", "log").stderr == ""
    ours, theirs = pty.openpty()
    command = [sys.executable, str(PROGRAM), "quick", "curve", CASE, "-o", "terminal"]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=theirs) as running:
        os.close(theirs)
        shown = b""
        with open(ours, "rb", buffering=0) as screen:  # noqa: PTH123 - a descriptor, no path
            while True:
                try:
                    piece = screen.read(1024)
                except OSError:  # the other end is closed
                    break
                if not piece:
                    break
                shown += piece
    assert running.returncode == 0
    assert b"\x1b[" in shown

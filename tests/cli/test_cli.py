"""The command line: what it answers, what it writes, and how it ends when something is wrong."""

from __future__ import annotations

import errno
import hashlib
import os
import signal
import subprocess
import sys
import time
import tomllib
from pathlib import Path
from typing import Any

import pytest

from asperity import plots
from asperity.config import load_file, template
from asperity.config.case_file import builtin_text
from asperity.errors import Outcome
from asperity.materials.liquids import LIQUIDS
from asperity.materials.solids import ADHESION, SOLIDS
from asperity.results import results_folder
from asperity.results.read_record import read
from asperity.results.result import Curve, Result
from commands import (
    answered,
    assert_narrow,
    assert_one_line,
    call,
    imported,
    names,
    program,
    refused,
    strict,
)
from fake_solve import solver

PROGRAM = Path(__file__).parents[1] / "fake_solve.py"
CASE = "published-exact"
OUT = f"{CASE}-out"


@pytest.fixture(autouse=True)
def use(monkeypatch: pytest.MonkeyPatch) -> Any:
    """A solver that answers at once, or behaves as a test says."""

    def behave(behaviour: str) -> None:
        monkeypatch.setitem(sys.modules, "asperity.solver", solver(behaviour))

    behave("quick")
    return behave


def faked(behaviour: str, *arguments: str, **options: Any) -> Any:
    """The whole program in a process of its own, with such a solver."""
    return program(behaviour, *arguments, script=PROGRAM, **options)


def test_help_imports_nothing_heavy():
    code = "import asperity.cli as c; from typer.main import get_command; get_command(c.app)"
    assert imported(code) == set()


def test_run_writes_record_pictures_and_summary(place):
    ran = call("run", CASE)
    assert ran.exit_code == 0, ran.output
    assert names(place) == [OUT]
    assert names(OUT) == sorted(results_folder.RUN_FILES)
    assert "published-exact: rest" in ran.stdout
    assert f"written to {OUT}:\n  record.nc motion.png" in ran.stdout
    assert_narrow(ran.stdout)
    assert_narrow((place / OUT / "summary.txt").read_text())


def test_json_is_one_strict_object_and_writes_nothing(place):
    found = answered("run", CASE)
    assert list(found) == ["outcome", "regime", "measures", "ledger", "warnings"]
    assert found["measures"]["power_loss_published"][-1] is None
    assert names(place) == []


@pytest.mark.usefixtures("undrawn")
def test_json_with_a_folder_writes_files_too():
    ran = call("run", CASE, "--json", "-o", "out")
    assert strict(ran.stdout)["outcome"] == "rest"
    assert "written to out" in ran.stderr
    assert names("out") == sorted(results_folder.RUN_FILES)


@pytest.mark.usefixtures("undrawn")
def test_curve_writes_its_own_files_and_prints_its_own_json():
    assert call("run", CASE).exit_code == 0
    assert call("curve", CASE).exit_code == 0
    assert names(OUT) == sorted([*results_folder.RUN_FILES, *results_folder.CURVE_FILES])
    found = answered("curve", CASE)
    assert len(found["force_unloading"]) == len(found["rigid_separation"])
    assert isinstance(found["pull_off"], float)
    assert isinstance(read(f"{OUT}/curve.nc"), Curve)


@pytest.mark.usefixtures("undrawn")
def test_a_record_repeats_its_run_byte_by_byte(place):
    assert call("run", CASE, "-o", "first").exit_code == 0
    assert call("run", "first/record.nc", "-o", "second").exit_code == 0
    for name in results_folder.RUN_FILES:
        assert (place / "first" / name).read_bytes() == (place / "second" / name).read_bytes()


@pytest.mark.usefixtures("undrawn")
def test_a_record_holds_the_hash_of_the_file_as_it_was_written(place):
    assert call("init", "drop.toml").exit_code == 0
    assert call("run", "drop.toml").exit_code == 0
    found = read("drop-out/record.nc")
    assert found.name == "drop"
    content = (place / "drop.toml").read_bytes()
    assert found.input_sha256 == hashlib.sha256(content).hexdigest()
    assert found.case == load_file("drop.toml")


def test_the_case_says_where_and_what_to_write(place):
    rest = template().partition("[output]")[0]
    wanted = '[output]\ndirectory = "kept/here"\nmotion = false\npictures = false\n'
    (place / "drop.toml").write_text(rest + wanted)
    assert call("run", "drop.toml").exit_code == 0
    assert names("kept/here") == ["record.nc", "summary.txt"]
    found = read("kept/here/record.nc")
    assert isinstance(found, Result)
    assert found.time.size == 0
    assert "record.nc: a record must hold its motion" in refused("plot", "kept/here/record.nc")


def test_plot_draws_a_record_again(place, request):
    assert call("run", CASE, "-o", "out").exit_code == 0
    before = (place / "out" / "motion.png").read_bytes()
    (place / "out" / "motion.png").write_bytes(b"old")
    assert call("plot", "out/record.nc").exit_code == 0
    assert (place / "out" / "motion.png").read_bytes() == before
    assert names("out") == sorted(results_folder.RUN_FILES)
    request.getfixturevalue("undrawn")
    found = answered("plot", "out/record.nc", "-o", "drawn")
    pictures = [name for name in results_folder.RUN_FILES if name.endswith((".png", ".svg"))]
    assert names("drawn") == sorted(found["files"]) == sorted(pictures)
    assert found["record"] == "out/record.nc"
    assert "--force" in refused("plot", "out/record.nc", "-o", "drawn")
    assert call("plot", "out/record.nc", "-o", "drawn", "--force").exit_code == 0


def test_init_writes_a_case_that_runs_and_never_overwrites(place):
    found = answered("init")
    content = (place / "case.toml").read_bytes()
    digest = hashlib.sha256(content).hexdigest()
    assert found == {"file": "case.toml", "bytes": len(content), "sha256": digest}
    assert tomllib.loads(content.decode())["schema"] == 1
    (place / "case.toml").write_text("mine")
    assert "case.toml: is there already" in refused("init")
    assert (place / "case.toml").read_text() == "mine"
    refused("init", "no/such/folder.toml", code=4)
    assert call("init", "plain").stdout.endswith("asperity run ./plain\n")


def test_materials_are_listed_with_their_sources_a_line_each_or_one_in_full():
    text = call("materials").stdout
    lines = text.splitlines()
    first = next(n for n, line in enumerate(lines) if line.startswith("silica "))
    assert [line[:25].strip() for line in lines[first : first + len(SOLIDS)]] == list(SOLIDS)
    assert all(f"\n{name} " in text for name in LIQUIDS)
    assert lines[-1].endswith("asperity materials NAME")
    assert_narrow(text)
    found = answered("materials")
    assert set(found["solids"]) == set(SOLIDS)
    assert found["solids"]["silica"]["youngs_modulus"] == SOLIDS["silica"].youngs_modulus
    works = found.pop("adhesion")
    assert all(entry["source"] for kind in found.values() for entry in kind.values())
    assert [work["work"] for work in works] == [entry.work for entry in ADHESION]
    assert all(work["source"] for work in works)
    named = " ".join(call("materials", "mica", "PDMS").stdout.split())
    assert "J. Geophys. Res. 91, 4657 (1986)" in named
    assert "never yields: an elastomer recovers its shape" in named
    found = answered("materials", "silica", "water")
    assert [list(found[kind]) for kind in ("solids", "liquids", "gases")] == [
        ["silica"], ["water"], [],
    ]  # fmt: skip
    assert "did you mean 'silica'" in refused("materials", "slica")


def test_works_of_adhesion_are_listed_for_either_solid_of_the_pair_and_never_assumed():
    text = " ".join(call("materials").stdout.split())
    assert "No case assumes one" in text
    assert "J. Phys. Chem. 97, 12034 (1993)" in text
    found = answered("materials", "silica")["adhesion"]
    assert {tuple(work["pair"]) for work in found} == {("mica", "silica"), ("silica", "silica")}
    only = call("materials", "diamond").stdout
    assert "\nsapphire / diamond " in only
    assert "Solids" not in only


@pytest.mark.usefixtures("undrawn")
def test_a_folder_in_use_is_refused_and_force_leaves_what_is_not_ours(place):
    (place / OUT).mkdir()
    (place / OUT / "notes.txt").write_text("mine")
    assert_one_line(refused("run", CASE), OUT, "--force", "notes.txt")
    assert names(OUT) == ["notes.txt"]
    assert call("run", CASE, "--force").exit_code == 0
    assert names(OUT) == sorted([*results_folder.RUN_FILES, "notes.txt"])


@pytest.mark.parametrize("command", ["run", "curve"])
@pytest.mark.usefixtures("undrawn")
def test_an_earlier_answer_for_the_same_case_is_replaced(place, command):
    assert "in place of" not in call(command, CASE).stdout
    folder = place / OUT
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
def test_results_of_an_edited_case_are_replaced_and_those_of_another_are_refused(place):
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
        said = refused("run", other, "-o", "drop-out")
        assert_one_line(said, "drop-out", "--force", "results of another case")


@pytest.mark.parametrize("spoiled", ["a note", "a record cut short", "a folder"])
@pytest.mark.usefixtures("undrawn")
def test_what_is_not_known_as_the_cases_own_results_is_refused(place, spoiled):
    assert call("run", CASE).exit_code == 0
    folder = place / OUT
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
        ("missing.nc", ("missing.nc", "no such file")),
        ("publishd-exact", ("publishd-exact", "did you mean 'published-exact'")),
        ("binary.toml", ("binary.toml", "binary")),
        ("binary.nc", ("binary.nc", "must be a record")),
        ("wrong.toml", ("wrong.toml", "radius", "must be positive", "-50 um")),
        (".", (".", "folder")),
        ("", ("folder",)),
        ("drop", ("write ./drop",)),
        ("./drop", ("./drop", "body")),
    ],
)
def test_a_case_that_cannot_be_used_is_one_line_and_exit_2(place, argument, parts):
    for name in ("binary.toml", "binary.nc"):
        (place / name).write_bytes(bytes(range(256)))
    (place / "wrong.toml").write_text(template().replace('"50 um"', '"-50 um"'))
    (place / "drop").write_text("schema = 1")
    assert_one_line(refused("run", argument), *parts)


def test_a_misspelt_command_line_is_exit_2():
    for arguments in (["run"], ["run", CASE, "--jsn"], ["run", "a", "b"]):
        assert call(*arguments).exit_code == 2
    ran = call("runn")
    assert ran.exit_code == 2
    assert "Did you mean 'run'?" in ran.stderr


def test_the_solvers_refusal_is_bad_input(use):
    use("refuse")
    assert_one_line(refused("run", CASE), "impact.release_separation", "45.9 nm")


def test_a_failure_of_the_numerics_keeps_what_was_computed(use):
    use("fail")
    ran = call("run", CASE)
    assert ran.exit_code == 3
    assert_one_line(ran.stderr, "no equilibrium at 44 nm")
    found = read(f"{OUT}/record.nc")
    assert isinstance(found, Result)
    assert found.outcome is Outcome.FAILED
    assert strict(call("run", CASE, "--json").stdout)["outcome"] == "failed"


def test_a_failure_without_a_partial_result_writes_nothing(use):
    use("break")
    assert "no equilibrium" in refused("run", CASE, code=3)


def test_a_bug_is_not_hidden(use):
    use("bug")
    assert isinstance(call("run", CASE).exception, ZeroDivisionError)


def test_a_place_that_is_no_folder_is_exit_4_before_computing(use, place):
    use("bug")
    (place / "file").touch()
    for target in ("file", "file/below"):
        assert_one_line(refused("run", CASE, "-o", target, code=4), target, "Not a directory")


@pytest.mark.usefixtures("undrawn")
def test_a_full_disk_is_exit_4_and_keeps_what_was_there(place, disk_of):
    with disk_of(4096):
        said = refused("run", CASE, code=4)
    assert_one_line(said, f"{OUT}/record.nc", os.strerror(errno.EFBIG))
    assert call("run", CASE).exit_code == 0
    before = {path.name: path.read_bytes() for path in (place / OUT).iterdir()}
    with disk_of(4096):
        refused("run", CASE, "--force", code=4)
    assert {path.name: path.read_bytes() for path in (place / OUT).iterdir()} == before


def test_a_home_that_cannot_be_written_to_costs_no_message():
    nowhere = dict.fromkeys(("HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME"), "/proc/nowhere")
    environment = {key: value for key, value in os.environ.items() if key != "MPLCONFIGDIR"}
    ran = faked("quick", "run", CASE, env={**environment, **nowhere})
    assert (ran.returncode, ran.stderr) == (0, "")
    assert "motion.png" in names(OUT)


def test_a_full_disk_at_the_end_of_standard_output_is_exit_4():
    with Path("/dev/full").open("w") as full:
        output = {"capture_output": False, "stdout": full, "stderr": subprocess.PIPE}
        ran = faked("quick", "run", CASE, "--json", **output)
    assert ran.returncode == 4
    assert_one_line(ran.stderr, "standard output", os.strerror(errno.ENOSPC))


def test_a_folder_without_permission_is_found_before_computing(place):
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
    reading, writing = os.pipe()
    os.close(reading)
    output = {"capture_output": False, "stdout": writing, "stderr": subprocess.PIPE}
    ran = faked("quick", "run", CASE, "--json", **output)
    os.close(writing)
    assert (ran.returncode, ran.stderr) == (128 + signal.SIGPIPE, "")


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


@pytest.mark.parametrize(("number", "exit_code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_request_to_end_keeps_what_was_computed_within_two_seconds(number, exit_code):
    code, _, err, seconds = interrupted("slow", "run", CASE, number=number)
    assert code == exit_code
    assert seconds < 2.0
    assert_one_line(err, "interrupted", "is kept")
    found = read(f"{OUT}/record.nc")
    assert isinstance(found, Result)
    assert found.outcome is Outcome.INTERRUPTED
    assert names(OUT) == ["record.nc", "summary.txt"]


def test_ctrl_c_prints_the_json_of_what_was_computed():
    code, out, _, _ = interrupted("slow", "run", CASE, "--json")
    assert code == 130
    assert strict(out)["outcome"] == "interrupted"


@pytest.mark.parametrize(("times", "soon"), [(1, 2.0), (2, 1.0)])
def test_ctrl_c_does_not_wait_for_a_solver_that_does_not_listen(times, soon):
    code, out, err, seconds = interrupted("deaf", "run", CASE, times=times)
    assert (code, out) == (130, "")
    assert seconds < soon
    assert_one_line(err, "interrupted")
    assert names() == []


def test_ctrl_c_while_drawing_keeps_the_record(monkeypatch):
    """A signal while a picture takes longer than an interrupted program may wait."""
    from asperity.cli import working

    monkeypatch.setattr(working, "PATIENCE", 0.05)

    def stopped(result: Result) -> dict[str, bytes]:
        signal.raise_signal(signal.SIGINT)
        time.sleep(0.5)
        return {"motion.png": b""}

    monkeypatch.setattr(plots, "pictures", stopped)
    assert call("run", CASE).exit_code == 130
    assert names(OUT) == ["record.nc", "summary.txt"]


def test_a_log_has_no_progress_bar_and_a_terminal_has_one():
    import pty

    assert faked("quick", "curve", CASE, "-o", "log").stderr == ""
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

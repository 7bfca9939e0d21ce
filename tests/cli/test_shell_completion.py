"""Completion in a shell: its script, commands and options, and what can stand for a value."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import shellingham
from typer.testing import CliRunner

from asperity.cli import app, shell_completion
from asperity.config import BUILTINS
from asperity.materials.solids import SOLIDS
from commands import assert_one_line, imported

BASH = shutil.which("bash")

PUBLISHED = [name for name in sorted(BUILTINS) if name.startswith("pub")]


@pytest.fixture(autouse=True)
def files(place: Path) -> None:
    """A folder with a case, a study's store and other things."""
    for name in ("drop.toml", "notes.txt", "a record.nc", ".hidden.toml", "deep/er/case.toml"):
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).touch()
    for name in ("outcome", "restitution"):
        Path("study.zarr", name).mkdir(parents=True)
        Path("study.zarr", name, "zarr.json").touch()


def called(*arguments: str, **environment: str) -> Any:
    runner = CliRunner(env=environment)
    return runner.invoke(app, list(arguments), prog_name="asperity")


def asked(shell: str, line: str, **environment: str) -> str:
    """What the program answers to a shell about a line whose last word is incomplete."""
    words = line.split(" ")
    given = {
        "_ASPERITY_COMPLETE": f"complete_{shell}",
        "_TYPER_COMPLETE_ARGS": line,
        "COMP_WORDS": "\n".join(words),
        "COMP_CWORD": str(len(words) - 1),
    }
    ran = called(**given, **environment)
    assert (ran.exit_code, ran.stderr) == (0, "")
    return str(ran.stdout)


def offered(line: str) -> list[str]:
    return asked("bash", line).split()


def test_commands_and_options_are_completed():
    assert offered("asperity ru") == ["run"]
    assert {"doctor", "sweep", "export"} <= set(offered("asperity "))
    assert {"--output", "--json", "--quiet", "--verbose"} <= set(offered("asperity run --"))


def test_a_case_is_a_built_in_name_a_case_file_or_a_record():
    assert offered("asperity run pub") == PUBLISHED
    assert offered("asperity curve ") == [*sorted(BUILTINS), "drop.toml", "deep/", "study.zarr/"]
    assert offered("asperity adhesion-map drop.toml d") == ["drop.toml", "deep/"]


def test_a_folder_alone_is_entered():
    assert offered("asperity run deep") == ["deep/er/case.toml"]
    assert offered("asperity run no/such/folder/") == []


def test_hidden_files_only_when_asked_for_and_names_with_blanks_are_left_to_the_shell():
    assert offered("asperity run .hid") == [".hidden.toml"]
    assert shell_completion.case("a") == sorted(BUILTINS)


def test_stores_and_their_columns_are_completed():
    assert offered("asperity plot st") == ["study.zarr"]
    assert offered("asperity merge st") == ["study.zarr"]
    assert offered("asperity plot study.zarr --measure re") == ["restitution"]
    assert offered("asperity sweep d") == ["drop.toml", "deep/"]


def test_words_of_an_option_and_materials_are_completed():
    assert offered("asperity surface x.npy --missing ") == ["refuse", "keep", "fill"]
    assert offered("asperity surface x.npy --line-levelling med") == ["median", "median-difference"]
    assert "silica" in SOLIDS
    assert "silica" in offered("asperity materials sil")


def test_what_an_option_takes_any_file_for_is_left_to_the_shell():
    assert offered("asperity surface no") == []


def test_options_that_exclude_each_other_do_not_break_completion():
    assert offered("asperity run -q -v pub") == PUBLISHED


def test_zsh_and_fish_get_their_own_form():
    assert asked("zsh", "asperity ru").startswith('_arguments \'*: :(("run":"Compute a motion')
    assert asked("zsh", "asperity surface no") == "_files\n"
    assert '"drop.toml"' in asked("zsh", "asperity run dr")
    given = asked("fish", "asperity run pub", _TYPER_COMPLETE_FISH_ACTION="get-args")
    assert given.split() == PUBLISHED


def test_completion_imports_nothing_heavy():
    code = (
        "from typer.main import get_command; from asperity.cli import app, shell_completion; "
        "get_command(app); shell_completion.case(''); shell_completion.material('')"
    )
    assert imported(code) <= {"rich"}


@pytest.mark.skipif(BASH is None, reason="no bash")
def test_bash_completes_with_the_printed_script(place, monkeypatch):
    """The script in a shell, as a press of the key runs it."""
    monkeypatch.setattr(shellingham, "detect_shell", lambda: ("bash", "bash"))
    script = called("--show-completion").stdout
    (place / "asperity").write_text(f'#!/bin/sh\nexec "{sys.executable}" -m asperity "$@"\n')
    (place / "asperity").chmod(0o755)
    pressed = (
        f"{script}\nCOMP_WORDS=(asperity run published-); COMP_CWORD=2\n"
        'PATH="$PWD:$PATH"; _asperity_completion asperity; echo "${COMPREPLY[@]}"\n'
    )
    assert BASH is not None
    ran = subprocess.run([BASH, "-c", pressed], capture_output=True, text=True, check=True)
    assert ran.stdout == "published-exact\n"


SHELLS = ("bash", "zsh", "fish")


@pytest.fixture(name="shell", params=SHELLS)
def _shell(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """The shell that typer finds to be in use."""
    monkeypatch.setattr(shellingham, "detect_shell", lambda: (request.param, request.param))
    return request.param


def test_the_script_is_printed_and_installed_for_the_shell_in_use(shell, place, monkeypatch):
    ran = called("--show-completion")
    assert ran.exit_code == 0
    assert f"_ASPERITY_COMPLETE=complete_{shell}" in ran.stdout
    home = place / "home"
    home.mkdir()
    monkeypatch.setenv("HOME", str(home))
    assert called("--install-completion").exit_code == 0
    written = [path.read_text() for path in home.rglob("*asperity*") if path.is_file()]
    assert any(f"complete_{shell}" in text for text in written)


def test_a_home_that_cannot_be_written_is_exit_4(place):
    program = (
        "import sys, shellingham; shellingham.detect_shell = lambda: ('fish', 'fish'); "
        "sys.argv = ['asperity', '--install-completion']; from asperity.cli import main; main()"
    )
    env = {**os.environ, "HOME": str(place / "drop.toml")}
    command = [sys.executable, "-c", program]
    ran = subprocess.run(command, env=env, capture_output=True, text=True, check=False)
    assert ran.returncode == 4
    assert_one_line(ran.stderr, "drop.toml", "cannot be written")

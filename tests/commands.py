"""The program as a user calls it, in this process or in one of its own."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

from typer.testing import CliRunner

from asperity.cli import app


def call(*arguments: str) -> Any:
    """What the program does in this process, on a terminal of 80 columns."""
    return CliRunner().invoke(app, list(arguments), env={"COLUMNS": "80"})


def program(*arguments: str, script: Path | None = None, **options: Any) -> Any:
    """The whole program in a process of its own, or a script that stands for it."""
    whole = [str(script)] if script else ["-m", "asperity"]
    options = {"capture_output": True, "text": True, "timeout": 60, **options}
    return subprocess.run([sys.executable, *whole, *arguments], check=False, **options)


def imported(code: str, *arguments: str) -> set[str]:
    """Heavy packages that some code has imported when it is done."""
    names = ("jax", "matplotlib", "pint", "xarray", "numpy", "netCDF4", "rich", "pydantic")
    report = f"print('imported:', *(name for name in {names} if name in sys.modules))"
    command = [sys.executable, "-c", f"import sys; {code}; {report}", *arguments]
    ran = subprocess.run(command, capture_output=True, text=True, check=True)
    return set(ran.stdout.rpartition("imported:")[2].split())


def assert_one_line(text: str, *parts: str) -> None:
    assert text.count("\n") == 1, text
    assert "Traceback" not in text
    for part in parts:
        assert part in text


def assert_narrow(text: str) -> None:
    """Some lines, all of which fit the terminal."""
    assert text
    assert [line for line in text.splitlines() if len(line) > 80] == []


def names(folder: Path | str = ".") -> list[str]:
    return sorted(path.name for path in Path(folder).iterdir())


def refused(*arguments: str, code: int = 2) -> str:
    """The one line of a refusal, which leaves nothing behind."""
    before = names()
    ran = call(*arguments)
    assert (ran.exit_code, ran.stdout) == (code, ""), ran.output
    assert_one_line(ran.stderr)
    assert names() == before
    return str(ran.stderr)


def strict(text: str) -> Any:
    """The one JSON object of a text, which holds neither NaN nor infinity."""

    def refuse(constant: str) -> None:
        raise AssertionError(constant)

    (line,) = text.splitlines()
    return json.loads(line, parse_constant=refuse)


def answered(*arguments: str) -> Any:
    """The JSON of a command that succeeds."""
    ran = call(*arguments, "--json")
    assert ran.exit_code == 0, ran.output
    return strict(ran.stdout)

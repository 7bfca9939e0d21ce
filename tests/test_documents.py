"""The documentation: pages that run, what they must hold, and that a broken one is found."""

import ast
import functools
import importlib
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import asperity
from asperity.config.key_labels import LABELS

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
SOURCE = ROOT / "src" / "asperity"
RUN = """---
file_format: mystnb
kernelspec:
  name: python3
  display_name: Python 3
---

# Page

"""


def built(folder: Path, cell: str) -> subprocess.CompletedProcess[str]:
    """Sphinx, called as by `make docs`, on one page with one cell and the project's settings."""
    for name in ("conf.py", "workplace.py"):
        shutil.copy(DOCS / name, folder)
    (folder / "index.md").write_text(f"{RUN}```{{code-cell}} python\n{cell}\n```\n")
    command = [sys.executable, "-m", "sphinx", "-E", "-W", "--keep-going", "-q", "-b", "html"]
    return subprocess.run(
        [*command, str(folder), str(folder / "out")], capture_output=True, text=True, check=False
    )


CONSOLE = """from workplace import enter
enter()
get_ipython().run_cell_magic("console", "", {!r})"""


@pytest.mark.parametrize("commands", ["false\ntrue", "false | true"])
def test_a_broken_example_fails_the_build(commands: str, tmp_path: Path):
    ran = built(tmp_path, CONSOLE.format(commands))
    assert ran.returncode != 0
    assert "Error" in ran.stderr


def test_a_sound_example_does_not(tmp_path: Path):
    ran = built(tmp_path, CONSOLE.format("asperity --version"))
    assert ran.returncode == 0, ran.stderr
    assert f"asperity {asperity.__version__}" in (tmp_path / "out" / "index.html").read_text()


def test_every_equation_of_the_theory_has_a_source_and_a_file():
    page = (DOCS / "theory.md").read_text()
    labels = re.findall(r"^\$\$ \(([\w-]+)\)$", page, re.MULTILINE)
    rows = re.findall(r"^\| \{eq\}`([\w-]+)` \| .+? \| (.+?) \| `(.+?)` \|$", page, re.MULTILINE)
    assert len(labels) > 50
    assert [label for label, _, _ in rows] == labels
    there = {file for *_, file in rows if (SOURCE / file).exists() or (ROOT / file).exists()}
    assert there == {file for *_, file in rows}


def test_every_public_name_is_documented():
    page = (DOCS / "api.md").read_text()
    named = set(re.findall(r"auto(?:class|function|exception):: (\w+)", page))
    assert set(asperity.__all__) <= named


def test_every_page_that_uses_an_example_names_one_that_is_there():
    for page in DOCS.glob("*.md"):
        for call in re.findall(r"^enter\(.*\)$", page.read_text(), re.MULTILINE):
            names = [ast.literal_eval(one) for one in ast.parse(call).body[0].value.args]
            assert all((ROOT / "examples" / name).is_file() for name in names), page.name


def test_the_notebook_has_ten_cells_that_load_solve_sweep_and_plot():
    page = (DOCS / "notebook.md").read_text()
    cells = re.findall(r"^```\{code-cell\} python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    assert len(cells) == 10
    used = set(re.findall(r"asperity\.(\w+)\(", "".join(cells)))
    assert {"load", "solve", "curve", "sweep"} <= used
    assert ".plot(" in "".join(cells)


def test_names_of_code_in_the_documents_exist():
    """A dotted name that begins with a room is one of its objects, or a key of a case."""
    rooms = {path.stem for path in SOURCE.iterdir()}
    wrong = []
    for page in DOCS.glob("*.md"):
        for name in re.findall(r"`([a-z_]+(?:\.[A-Za-z_]\w*)+)`", page.read_text()):
            if name.partition(".")[0] in rooms and name not in LABELS and not is_object(name):
                wrong.append(f"{page.name}: {name}")
    assert not wrong


def is_object(name: str) -> bool:
    """Whether a dotted name is a module of the package or stands in one."""
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        try:
            found = importlib.import_module(".".join(["asperity", *parts[:count]]))
        except ModuleNotFoundError:
            continue
        try:
            functools.reduce(getattr, parts[count:], found)
        except AttributeError:
            return False
        return True
    return False

"""The project itself: the wheel, the locks, the environment's tool, what files may not say."""

import importlib.metadata
import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tomllib
import venv
import zipfile
from pathlib import Path
from types import ModuleType

import pytest

import asperity

ROOT = Path(__file__).resolve().parents[1]
SOURCE = ROOT / "src" / "asperity"
LOCKS = ("requirements.lock", "requirements-dev.lock")
# In pieces, so that this file does not name what it looks for.
INDEX_HOSTS = [".".join(parts) for parts in (("py" + "pi", "org"), ("python" + "hosted", "org"))]
MACHINE_PATH = re.compile(
    r"(?<![\w.}~/-])/(?:home|Users|root|work|tmp|opt|mnt|var/tmp)/[\w.-]+|\b[A-Z]:\\{1,2}Users\b"
)
FENCE = re.compile(r"^```(?:\{code-cell\} )?(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def project() -> dict:
    return tomllib.loads((ROOT / "pyproject.toml").read_text())


def project_files() -> list[Path]:
    """Files that are or would be committed; in an unpacked archive, all that are not made."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        check=False,
    )
    if listed.returncode == 0 and listed.stdout:
        found = [ROOT / os.fsdecode(name) for name in listed.stdout.split(b"\0") if name]
        return [path for path in found if path.is_file()]
    made = {".git", ".venv", ".hypothesis", ".benchmarks", "build", "dist", "_build", "__pycache__"}
    return [
        path
        for path in ROOT.rglob("*")
        if path.is_file()
        and not any(
            part in made or part.endswith(("-out", "_cache", ".egg-info"))
            for part in path.relative_to(ROOT).parts
        )
    ]


def text_of(path: Path) -> str:
    content = path.read_bytes()
    return "" if b"\0" in content else content.decode()


def blocks(path: Path, language: str) -> list[str]:
    """Fenced blocks of one language in a Markdown page."""
    return [code for found, code in FENCE.findall(path.read_text()) if found == language]


@pytest.fixture(scope="session")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel, built without the network."""
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "hatchling", "build", "--target", "wheel"]
    subprocess.run([*command, "--directory", str(folder)], cwd=ROOT, check=True)
    (built,) = folder.glob("*.whl")
    return built


def test_wheel_holds_the_package_its_cases_and_the_licence(wheel: Path):
    cases = sorted((SOURCE / "config" / "cases").glob("*.toml"))
    assert cases
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
        metadata = next(name for name in names if name.endswith(".dist-info/METADATA"))
        described = archive.read(metadata).decode()
    wanted = [*cases, *SOURCE.rglob("*.py"), SOURCE / "py.typed"]
    assert {path.relative_to(ROOT / "src").as_posix() for path in wanted} <= names
    assert any(name.endswith("/licenses/LICENSE") for name in names)
    assert "License-Expression: MIT" in described


def test_wheel_runs_from_any_folder_without_the_repository(wheel: Path, tmp_path: Path):
    site, folder = tmp_path / "site", tmp_path / "elsewhere"
    folder.mkdir()
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps"]
    subprocess.run([*pip, "--target", str(site), str(wheel)], check=True)
    program = (
        "import sys, asperity; assert asperity.__file__.startswith(sys.argv.pop(1)); "
        "from asperity.cli import main; sys.exit(main())"
    )
    ran = subprocess.run(
        [sys.executable, "-c", program, str(site), "run", "glass-bead", "--json"],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(site)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert ran.returncode == 0, ran.stderr
    assert json.loads(ran.stdout)["outcome"]
    assert list(folder.iterdir()) == []


USER = """import numpy as np

import asperity

case = asperity.load("published-exact")
reveal_type(asperity.solve(case).time)
reveal_type(asperity.curve("drop.toml").pull_off)
reveal_type(asperity.sweep(case, {"capillary.humidity": np.linspace(0.2, 0.8, 3)}))
asperity.solve(5)
asperity.slove(case)
"""


LINTED = ROOT / ".mypy_cache"


def test_a_type_checker_knows_the_installed_package(wheel: Path, tmp_path: Path):
    venv.create(tmp_path / "venv", with_pip=False)
    (site,) = (tmp_path / "venv").glob("lib/python*/site-packages")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(site)
    (site / "others.pth").write_text(sysconfig.get_paths()["purelib"])
    (tmp_path / "user.py").write_text(USER)
    cache = tmp_path / "cache"
    if LINTED.is_dir():  # `make lint` has read the libraries, which takes most of the time
        shutil.copytree(LINTED, cache)
    mypy = [sys.executable, "-m", "mypy", "--python-executable", str(tmp_path / "venv/bin/python")]
    mypy += ["--cache-dir", str(cache), "--config-file", str(ROOT / "pyproject.toml")]
    ran = subprocess.run(
        [*mypy, "user.py"],
        cwd=tmp_path,
        env={key: value for key, value in os.environ.items() if key != "PYTHONPATH"},
        capture_output=True,
        text=True,
        check=False,
    )
    told = [line.partition(": ")[2] for line in ran.stdout.splitlines()]
    assert [re.sub(r"\[.*", "", line) for line in told[:3]] == [
        'note: Revealed type is "numpy.ndarray',
        'note: Revealed type is "float"',
        'note: Revealed type is "xarray.core.dataset.Dataset"',
    ]
    assert told[3].startswith('error: Argument 1 to "solve" has incompatible type "int"')
    assert told[4].startswith('error: Module has no attribute "slove"; maybe "solve"?')
    assert len(told) == 6


def test_no_file_names_a_package_index_or_a_path_of_one_machine():
    found = [
        f"{path.relative_to(ROOT)}: {line.strip()}"
        for path in project_files()
        for line in text_of(path).splitlines()
        if any(host in line for host in INDEX_HOSTS) or MACHINE_PATH.search(line)
    ]
    assert found == []


@pytest.mark.parametrize("parts", [("'", "home", "ada'"), ("see ", "work", "x"), ("=", "tmp", "x")])
def test_a_path_of_one_machine_is_recognised(parts: tuple[str, ...]):
    assert MACHINE_PATH.search("/".join(parts))


@pytest.mark.parametrize("name", LOCKS)
def test_locks_hash_every_requirement(name: str):
    lock = (ROOT / name).read_text()
    assert not re.search(r"^\s*--(?!hash)", lock, re.MULTILINE)
    requirements = re.findall(r"^([\w.-]+)==((?:.*\\\n)*.*)", lock, re.MULTILINE)
    assert len(requirements) > 20
    assert [name for name, rest in requirements if "--hash=sha256:" not in rest] == []


def test_dev_lock_holds_the_run_lock():
    pins = [
        set(re.findall(r"^([\w.-]+==[^\s\\]+)", (ROOT / lock).read_text(), re.MULTILINE))
        for lock in LOCKS
    ]
    assert pins[0] - pins[1] == set()


def test_locks_hold_every_direct_requirement():
    stated = project()
    flat = [entry for entry in stated["dependency-groups"]["dev"] if isinstance(entry, str)]
    lock = (ROOT / "requirements-dev.lock").read_text().lower()
    names = [
        re.split(r"[<>=!~;\[ ]", entry)[0] for entry in stated["project"]["dependencies"] + flat
    ]
    assert [name for name in names if f"\n{name.lower()}==" not in "\n" + lock] == []


def test_version_is_said_once():
    version = project()["project"]["version"]
    assert asperity.__version__ == importlib.metadata.version("asperity") == version
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text()
    assert f"## [{version}]" in (ROOT / "CHANGELOG.md").read_text()


def test_licence_is_mit():
    assert (ROOT / "LICENSE").read_text().startswith("MIT License\n")
    assert project()["project"]["license"] == "MIT"


def test_readme_links_lead_somewhere():
    targets = re.findall(r"\]\(([^)#]+)[^)]*\)", (ROOT / "README.md").read_text())
    assert len(targets) > 5
    assert [t for t in targets if "://" not in t and not (ROOT / t).exists()] == []


def test_readme_python_runs(tmp_path: Path):
    (code,) = blocks(ROOT / "README.md", "python")
    assert len(code.splitlines()) <= 10
    ran = subprocess.run(
        [sys.executable, "-W", "error", "-c", code],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert ran.returncode == 0, ran.stderr
    assert (tmp_path / "motion.png").stat().st_size > 1000


def test_first_page_shows_the_same_python_as_the_readme():
    (shown,) = blocks(ROOT / "docs" / "index.md", "python")
    (readme,) = blocks(ROOT / "README.md", "python")
    assert readme.startswith(shown)


def test_commands_named_in_the_pages_exist():
    """In blocks that show the terminal, and in cells that run."""
    for page in (ROOT / "README.md", *(ROOT / "docs").glob("*.md")):
        text = page.read_text()
        cells = re.findall(r"^%%console\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
        shown = "\n".join(blocks(page, "console") + blocks(page, "text") + cells)
        named = set(re.findall(r"^(?:\$ )?asperity ([\w-]+)", shown, re.MULTILINE))
        assert named <= command_names(), page.name
        assert named or page.name not in ("README.md", "index.md", "cli.md")
        assert "%%bash" not in text, page.name  # it tells a failure by its last command


def test_every_command_is_documented():
    page = (ROOT / "docs" / "cli.md").read_text()
    headings = set(re.findall(r"^## asperity ([\w-]+)$", page, re.MULTILINE))
    assert headings == command_names()


def command_names() -> set[str]:
    """Commands that the program's help lists."""
    from typer.main import get_command

    from asperity.cli import app

    return set(get_command(app).commands)  # type: ignore[attr-defined]


def test_case_in_the_pages_is_the_built_in_case():
    from asperity.config import FIRST, builtin, load

    (shown,) = blocks(ROOT / "docs" / "cli.md", "toml")
    assert load(shown, file=None) == builtin(FIRST)


def environment_tool() -> ModuleType:
    spec = importlib.util.spec_from_file_location("environment", ROOT / "tools" / "environment.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_an_environment_is_made_or_added_to_as_far_as_it_is_stale():
    tool = environment_tool()

    def steps(made_for: str | None, kind: str, stale: str = "") -> list[str]:
        noted = None if made_for is None else tool.wanted(made_for)
        if noted is not None and stale:
            noted = {**noted, stale: "other"}
        return tool.steps(noted, tool.wanted(kind))

    for kind in ("run", "dev"):
        anew = ["make", kind, "package"]
        assert steps(None, kind) == anew
        assert [steps("dev", kind, key) for key in ("run", "root", "python")] == [anew] * 3
        assert steps("dev", kind) == []  # one for tests serves runs too
    assert steps("run", "run") == []
    assert steps("run", "dev") == ["dev"]
    assert steps("dev", "run", stale="dev") == []
    assert steps("dev", "dev", stale="dev") == anew
    assert steps("dev", "dev", stale="package") == ["package"]

"""First answers: how long a user waits where nothing is compiled, and where it is.

``python -m benchmarks.first_answers`` prints seconds for each question, in a process that finds an
empty cache and then in processes that find what it left. With the folders of other builds
(``python -m benchmarks.first_answers ../before``) all builds take turns, this one first.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
import tomllib
import urllib.request
from collections.abc import Callable
from pathlib import Path

from asperity.config.case_file import builtin_text

from .web import served

HERE = Path(__file__).parents[1]
ROUNDS = 2

Question = Callable[[Path, Path], float]
"""Seconds that a build takes to an answer, with its cache in a folder."""

STUDY = """
schema = 1
base = "published-exact"
keep = ["captured", "restitution", "energy_lost"]
[axes]
"roughness.rms_height" = {from = "8 nm", to = "12 nm", steps = 10}
"impact.release_separation" = {from = "200 nm", to = "400 nm", steps = 24}
"numerics.max_impacts" = {values = [1]}
"""
TIP = """
schema = 1
[body]
shape = "sphere"
radius = "20 nm"
material = "silicon"
[counterface]
material = "silica"
deformation = "half-space"
[adhesion]
model = "maugis"
work = "50 mJ/m^2"
equilibrium_spacing = "0.2 nm"
[suspension]
stiffness = "1 N/m"
damping = "1 nN s/m"
rest_gap = "5 nm"
[impact]
release_separation = "20 nm"
"""


def main() -> None:
    """Print, for each question and build, the first answer and those after it."""
    builds = [HERE, *(Path(name).resolve() for name in sys.argv[1:])]
    print(f"{'asked':<42}{'build':<10}{'nothing compiled [s]':>22}{'compiled [s]':>18}")
    for asked, seconds in QUESTIONS.items():
        took: dict[Path, list[list[float]]] = {build: [] for build in builds}
        for _ in range(ROUNDS):
            for build in builds:
                with tempfile.TemporaryDirectory() as folder:
                    place = Path(folder)
                    took[build].append([seconds(build, place) for _ in range(2)])
        for build, rounds in took.items():
            first, then = (_told(list(column)) for column in zip(*rounds, strict=True))
            name = "this" if build == HERE else build.name
            print(f"{asked:<42}{name:<10}{first:>22}{then:>18}", flush=True)


def _told(seconds: list[float]) -> str:
    least, most = min(seconds), max(seconds)
    return f"{statistics.median(seconds):.1f} ({least:.1f}-{most:.1f})"


def _environment(build: Path, folder: Path) -> dict[str, str]:
    cache = str(folder / "cache")
    return {**os.environ, "PYTHONPATH": str(build / "src"), "JAX_COMPILATION_CACHE_DIR": cache}


def _command(*words: str) -> Question:
    """Seconds of one command, whose files lie in the folder."""

    def seconds(build: Path, folder: Path) -> float:
        for name, text in (("study.toml", STUDY), ("tip.toml", TIP)):
            (folder / name).write_text(text)
        begun = time.perf_counter()
        subprocess.run(
            [sys.executable, "-m", "asperity", *words, "-o", "out", "--force", "-q"],
            env=_environment(build, folder), cwd=folder, check=True,
        )  # fmt: skip
        return time.perf_counter() - begun

    return seconds


def _page(
    deformation: str | None = None, model: str | None = None
) -> Callable[[Path, Path], float]:
    """Seconds from the server's start to an answer, or of one more answer with other models."""

    def seconds(build: Path, folder: Path) -> float:
        tables = tomllib.loads(builtin_text("glass-bead"))
        begun = time.perf_counter()
        with served("glass-bead", _environment(build, folder)) as address:
            _ask(address, tables)
            if deformation:
                tables["counterface"]["deformation"] = deformation
            if model:
                tables["adhesion"]["model"] = model
            if deformation or model:
                begun = time.perf_counter()
                _ask(address, tables)
            return time.perf_counter() - begun

    return seconds


def _ask(address: str, tables: dict[str, object]) -> None:
    """The answer of the page's server to a case; it must have one."""
    asked = urllib.request.Request(
        f"{address.rstrip('/')}/api/explore",
        json.dumps({"case": tables, "name": "page"}).encode(),
        {"Content-Type": "application/json"},
    )
    with urllib.request.urlopen(asked, timeout=600) as answer:
        said = answer.read().decode()
    if '"verdict"' not in said:
        raise SystemExit(f"no answer from the page: {said[-400:]}")


QUESTIONS: dict[str, Question] = {
    "run glass-bead": _command("run", "glass-bead"),
    "page: first answer (glass-bead)": _page(),
    "page: a bulk that deforms": _page(deformation="half-space"),
    "page: another law (JKR)": _page(model="jkr"),
    "study of 240 cases": _command("sweep", "study.toml"),
    "curve of an AFM tip": _command("curve", "tip.toml"),
}


if __name__ == "__main__":
    main()

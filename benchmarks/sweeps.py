"""Studies of many cases: cases a second beside a plain SciPy loop, cores and workers, a store."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path

from asperity.config.resolve import resolve
from asperity.sweeps.compute.batch import compute
from asperity.sweeps.compute.runner import in_process
from asperity.sweeps.study.study import Study, parse

from . import published_method

Row = tuple[str, str, str]

PROGRAM = Path(sys.executable).with_name("asperity")
MILLION = 1000
"""Values of each axis in the large study."""

PUBLISHED = """
schema = 1
base = "published"
keep = ["captured", "restitution", "time_to_rest", "energy_lost"]
[axes]
"roughness.rms_height" = {{from = "9 nm", to = "12 nm", steps = {rows}}}
"capillary.humidity" = {{from = 0.995, to = 1.0, steps = {columns}}}
"""
"""Every case comes to rest, after 11 to 23 impacts; below a humidity of 0.98 none does in 200."""

DEFORMING = """
schema = 1
base = "published-exact"
keep = ["captured", "restitution", "energy_lost"]
[axes]
"roughness.rms_height" = {from = "9 nm", to = "12 nm", steps = 16}
"capillary.humidity" = {from = 0.85, to = 0.9, steps = 16}
"numerics.rings" = {values = [48]}
"""


def rows(large: bool = False) -> Iterator[Row]:
    """What was measured, its figure, and its goal; the million cases where they are asked for."""
    study = parse(PUBLISHED.format(rows=128, columns=128))
    for task in range(study.tasks):
        compute(study, task)
    rate, outside = _rate(study)
    yield "published over roughness and humidity, cases a second", f"{rate:.0f}", "10000, 50000"
    yield "  share of the time outside compiled code", f"{outside:.2f}", ""
    theirs = _scipy(study)
    yield "  a plain SciPy loop on the same cases, a second", f"{theirs:.2f}", ""
    yield "  ratio", f"{rate / theirs:.0f}", ""
    deforming = parse(DEFORMING)
    columns, _ = compute(deforming, 0)
    impacts = float(columns["impacts"].mean())
    rate, _ = _rate(deforming)
    yield f"with bulk deformation, {impacts:.0f} impacts, cases a second", f"{rate:.1f}", "50, 200"
    yield from _workers(*((MILLION, MILLION) if large else (2048, 128)))
    if large:
        yield from _million()


def _rate(study: Study) -> tuple[float, float]:
    """Cases a second on all cores, and the share of time outside compiled code."""
    began = time.perf_counter()
    efforts = [effort for _, _, effort in in_process(study, range(study.tasks), threading.Event())]
    took = time.perf_counter() - began
    cores = min(len(os.sched_getaffinity(0)), study.tasks)
    return study.size / took, 1.0 - sum(e.compiled for e in efforts) / (cores * took)


def _scipy(study: Study) -> float:
    """Cases a second of the publication's equations by SciPy, rigid, on a 64x64 grid."""
    from asperity.model import build

    columns, _ = compute(study, 0)
    took = 0.0
    for number in (0, len(study.task(0)) - 1):
        method = published_method.of_problem(
            build(resolve(study.case(number))), points=64, deforms=False
        )
        began = time.perf_counter()
        published_method.integrate(method, int(columns["impacts"][number]))
        took += time.perf_counter() - began
    return 2.0 / took


def _workers(rows: int, columns: int) -> Iterator[Row]:
    """How much faster two local workers are than one, of which the start is a part."""
    took = {}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "study.toml"
        file.write_text(PUBLISHED.format(rows=512, columns=128))
        _sweep(file, "--force", "--workers", "1")  # compiles
        file.write_text(PUBLISHED.format(rows=rows, columns=columns))
        for workers in (1, 2):
            took[workers] = _sweep(file, "--force", "--workers", str(workers))["wall"]
    what = f"two local workers over one, {rows * columns} cases"
    yield what, f"{took[1] / took[2]:.2f}", "1.8"


def _sweep(file: Path, *options: str) -> dict[str, float]:
    """What the command says of a run."""
    import json

    command = [str(PROGRAM), "sweep", str(file), "-o", str(file.with_suffix(".zarr")), "--json"]
    done = subprocess.run([*command, *options], check=True, capture_output=True, text=True)
    found: dict[str, float] = json.loads(done.stdout)
    return found


def _million() -> Iterator[Row]:
    """A million cases, end to end."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "study.toml"
        file.write_text(PUBLISHED.format(rows=MILLION, columns=MILLION))
        began = time.perf_counter()
        _sweep(file)
        took = time.perf_counter() - began
        size = sum(path.stat().st_size for path in Path(folder).rglob("*") if path.is_file())
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 2**20
    yield "a million cases, end to end", f"{took:.0f} s", ""
    yield "  store", f"{size / 1e6:.0f} MB", "500 MB"
    yield "  peak memory", f"{peak:.2f} GB", "2 GB"


def main() -> None:
    """Print every figure beside its goal; ``large`` as an argument adds the million cases."""
    for what, figure, goal in rows(large="large" in sys.argv[1:]):
        print(f"{what:<62}{figure:>16}" + (f"   goal {goal}" if goal else ""), flush=True)


if __name__ == "__main__":
    main()

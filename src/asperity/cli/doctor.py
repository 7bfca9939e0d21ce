"""The command ``asperity doctor``: what is installed, on what it runs, and whether it works.

Like `asperity.cli` itself it imports nothing heavy; each section imports what it needs.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Iterator
from math import isfinite
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import typer

from asperity.cli.arguments import reports
from asperity.cli.reporter import Reporter, seconds
from asperity.cli.terminal import say, tell, wrapped
from asperity.cli.working import Work
from asperity.errors import InputError, SimulationError

LEAST_ROOM = 200 * 2**20
"""Room for the compile cache below which a user is warned [bytes]; a case takes some 20 MB."""

_WIDE = 28
_LEDGER = 1e-6  # of the impact energy: how closely a motion's ledger must close
_SETTINGS = ("JAX_PLATFORMS", "XLA_FLAGS", "NPROC", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")

EmptyCache = Annotated[
    bool,
    typer.Option("--empty-cache", help="Remove what the compile cache keeps, and test nothing."),
]


class Line(NamedTuple):
    """What one line says: a name, a plain value and its words; of a check, whether it holds."""

    name: str
    value: Any
    words: str
    ok: bool | None = None


@reports()
def doctor(
    reporter: Reporter,
    empty_cache: EmptyCache = False,
) -> None:
    """Say what is installed and whether it works.

    Versions, processors, the compile cache, a self-test, and how fast motions are here. Writes
    nothing but the compile cache.
    """
    from asperity.cli import compile_cache

    if empty_cache:
        if (place := compile_cache.folder()) is None:
            raise InputError("`--empty-cache` must have a compile cache to empty; it is off")
        removed = [compile_cache.empty(each) for each in compile_cache.every_folder(place)]
        entries, size = map(sum, zip(*removed, strict=True))
        reporter.answer(
            lambda: f"removed {entries} entries, {_bytes(size)}, from\n  {place}",
            lambda: {"folder": str(place), "removed": entries, "bytes": size},
        )
        return
    found, code = Work(lambda stop: _examined(reporter, stop)).wait()
    if code or found is None:
        say("asperity: interrupted; what was found until then is above", whole=True)
        raise typer.Exit(code)
    if reporter.as_json:
        reporter.answer(str, lambda: found)
    failed = [one["name"] for one in found["checks"] if not one["ok"]]
    if failed:
        count = len(found["checks"])
        raise SimulationError(f"{len(failed)} of {count} checks fail: {', '.join(failed)}")


def _examined(reporter: Reporter, stop: threading.Event) -> dict[str, Any]:
    """All sections, each line said as soon as it is known; plain values by section."""
    show = tell if not (reporter.as_json or reporter.quiet) else lambda text: None
    found: dict[str, Any] = {}
    checks: list[dict[str, Any]] = []
    for title, section in _SECTIONS.items():
        show(title)
        values = found[title.lower().replace(" ", "_").replace("-", "_")] = {}
        with reporter.step(title):
            for line in _attempted(title, section()):
                mark = "" if line.ok is None else f"{'ok' if line.ok else 'FAIL':<6}"
                text = f"  {line.name:<{_WIDE}}{mark}{line.words}"
                show("\n".join(wrapped(text, hanging=2 + _WIDE)))
                if line.ok is not None:
                    checks.append({"name": line.name, "ok": line.ok, "found": line.words})
                if line.value is not None:
                    values[line.name.replace(" ", "_")] = line.value
                if stop.is_set():
                    return found
        show("")
    found |= {"checks": checks, "ok": all(one["ok"] for one in checks)}
    show("all is well" if found["ok"] else "NOT all is well")
    return found


def _attempted(title: str, lines: Iterator[Line]) -> Iterator[Line]:
    """The lines of a section; where one cannot be found, the reason is a check that fails."""
    try:
        yield from lines
    except Exception as error:  # noqa: BLE001 - whatever is broken here is what is looked for
        yield Line(title, None, _reason(error), False)


def _installed() -> Iterator[Line]:
    from asperity.cli.stack import NOT_INSTALLED, unmet, versions

    for name, number in versions().items():
        yield Line(name, number, number or NOT_INSTALLED)
    missing = unmet()
    yield Line("requirements", None, "; ".join(missing) or "all met", not missing)


def _machine() -> Iterator[Line]:
    from dask.system import cpu_count
    from distributed.system import MEMORY_LIMIT

    settings = {name: os.environ[name] for name in _SETTINGS if name in os.environ}
    from asperity._jax import jax  # which sets one of them

    usable = cpu_count()  # heeds affinity and the quota of a container
    yield Line("processors", usable, f"{usable} of {os.cpu_count()} usable")
    yield Line("memory", MEMORY_LIMIT, _bytes(MEMORY_LIMIT))
    yield from (Line(name, value, value) for name, value in settings.items())
    devices = [str(each) for each in jax.devices()]
    yield Line("JAX computes on", devices, ", ".join(devices))
    hardware = any(Path("/dev").glob("nvidia[0-9]*")) or Path("/dev/kfd").exists()
    if hardware and jax.default_backend() == "cpu":
        yield Line("GPU", None, "one is there that JAX does not use: it needs a build for it, such "
                   "as jax[cuda13], a driver, and no JAX_PLATFORMS that leaves it out")  # fmt: skip


def _compile_cache() -> Iterator[Line]:
    from asperity.cli import compile_cache

    place = compile_cache.folder()
    if place is None:
        yield Line("folder", None, "none: it is off, and every start compiles anew")
        return
    (entries, size), room = compile_cache.size_of(place), compile_cache.room_for(place)
    yield Line("folder", str(place), str(place))
    yield Line("entries", entries, f"{entries}, {_bytes(size)}")
    scarce = "; nearly full, --empty-cache makes room" if room < LEAST_ROOM else ""
    yield Line("room on its disk", room, _bytes(room) + scarce)
    fault = compile_cache.fault_of(place)
    words = f"no: every start compiles anew ({fault})" if fault else "yes, tried by two processes"
    yield Line("read again", fault is None, words)


def _self_test() -> Iterator[Line]:
    from asperity.cli.self_test import CHECKS

    for name, source, limit, off in CHECKS:
        try:
            found = off()
        except Exception as error:  # noqa: BLE001 - as in `_attempted`
            yield Line(name, None, _reason(error), False)
            continue
        words = f"off by {found:.1e}, {limit:.0e} allowed ({source})"
        yield Line(name, found if isfinite(found) else None, words, bool(found <= limit))


def _speed() -> Iterator[Line]:
    from asperity.cli.compiling import compilation
    from asperity.config import BUILTINS, builtin
    from asperity.solver import solve

    for name in sorted(BUILTINS, key=len):  # the quick one first
        before, times = compilation(), []
        for _ in range(4):
            begun = time.perf_counter()
            result = solve(builtin(name), name=name, critical=False)
            times.append(time.perf_counter() - begun)
        made, warm = compilation() - before, min(times[1:])
        count = len(result.measures["restitution"])
        value = {"impacts": count, "first": times[0], "warm": warm, "compiling": made.compiling,
                 "compiled": made.asked - made.read, "cached": made.read}  # fmt: skip
        yield Line(name, value, f"{seconds(warm)} for a motion of {count} impacts; "
                   f"{seconds(times[0])} the first time, with {value['compiled']} pieces of code "
                   f"compiled and {made.read} from the cache")  # fmt: skip
        off = float(result.ledger["energy_balance_error"])
        words = f"closes to {off:.1e}, {_LEDGER:.0e} allowed (its conservation)"
        yield Line(f"energy of `{name}`", None, words, off <= _LEDGER)


_SECTIONS = {
    "Installed": _installed,
    "Machine": _machine,
    "Compile cache": _compile_cache,
    "Self-test": _self_test,
    "Speed": _speed,
}


def _reason(error: Exception) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())


def _bytes(size: float) -> str:
    """A size for a human."""
    units = iter(("B", "kB", "MB", "GB"))
    unit = next(units)
    while size >= 1000.0 and unit != "GB":
        size, unit = size / 1000.0, next(units)
    return f"{size:.3g} {unit}"

"""The examination: one section after the other, each said as soon as it is known."""

from __future__ import annotations

import importlib
import threading
from collections.abc import Callable
from typing import Any

import typer

from asperity.cli.doctor import cache, machine
from asperity.cli.doctor.requirements import unmet
from asperity.cli.reporter import Reporter, seconds
from asperity.cli.stack import NOT_INSTALLED, versions
from asperity.cli.terminal import say, tell, wrapped
from asperity.cli.working import Work
from asperity.errors import InputError, SimulationError

_NAME = 28
_MARKS = {True: "ok", False: "FAIL"}


def examine(**manner: bool) -> None:
    """Say what is installed, on what it runs, whether it works and how fast.

    Parameters
    ----------
    **manner : bool
        As `Reporter` takes them.

    Raises
    ------
    SimulationError
        Where a requirement is not met, or a check of the self-test fails.
    """
    reporter = Reporter(**manner)
    found, code = Work(lambda stop: _Examination(reporter, stop).made()).wait()
    if code or found is None:
        say("asperity: interrupted; what was found until then is above", whole=True)
        raise typer.Exit(code)
    if reporter.as_json:
        reporter.answer(str, lambda: found)
    failed = [one["name"] for one in found["checks"] if not one["ok"]]
    if failed:
        raise SimulationError(f"{len(failed)} of {len(found['checks'])} checks fail: "
                              f"{', '.join(failed)}")  # fmt: skip


def empty(**manner: bool) -> None:
    """Remove what the compile cache keeps, and say how much it was.

    Parameters
    ----------
    **manner : bool
        As `Reporter` takes them.

    Raises
    ------
    InputError
        Where the cache is off.
    OutputError
        Where a file cannot be removed.
    """
    reporter, place = Reporter(**manner), cache.folder()
    if place is None:
        raise InputError("`--empty-cache` must have a compile cache to empty; it is off")
    with reporter.step("compile cache"):
        entries, size = cache.emptied(place)
    reporter.answer(
        lambda: "\n".join([f"removed {entries} entries, {_bytes(size)}, from", f"  {place}"]),
        lambda: {"folder": str(place), "removed": entries, "bytes": size},
    )


class _Examination:
    """What is found, and said, until now.

    Parameters
    ----------
    reporter : Reporter
        How to say it.
    stop : threading.Event
        Ends the examination after the section under way.
    """

    def __init__(self, reporter: Reporter, stop: threading.Event) -> None:
        self._reporter, self._stop = reporter, stop
        self._checks: list[dict[str, Any]] = []

    def made(self) -> dict[str, Any]:
        """All sections, in order."""
        found: dict[str, Any] = {"versions": self._versions()}
        sections: dict[str, Callable[[], Any]] = {
            "machine": self._machine,
            "cache": self._cache,
            "self_test": self._self_test,
            "speed": self._speed,
        }
        # What does not work may be JAX itself: then its versions are said, and the reason.
        for name, section in sections.items():
            if not self._stop.is_set():
                with self._reporter.step(name.replace("_", "-")):
                    found[name] = self._attempted(name, section)
        found |= {"checks": self._checks, "ok": all(one["ok"] for one in self._checks)}
        found.pop("self_test", None)
        if not self._stop.is_set():
            self._say("", "all is well" if found["ok"] else "NOT all is well")
        return found

    def _attempted(self, name: str, section: Callable[[], Any]) -> Any:
        try:
            return section()
        except Exception as error:  # noqa: BLE001 - whatever is broken here is what is looked for
            fault = " ".join(f"{type(error).__name__}: {error}".split())
            self._check(name.replace("_", "-"), False, fault)
            return None

    def _versions(self) -> dict[str, str | None]:
        found = versions()
        self._head("Installed")
        for name, number in found.items():
            self._row(name, number or NOT_INSTALLED)
        missing = unmet()
        self._check("requirements", not missing, "; ".join(missing) or "all met", "the package's")
        return found

    def _machine(self) -> dict[str, Any]:
        system = machine.machine()
        self._head("Machine")
        usable, quota = system["usable_processors"], system["processor_quota"]
        limit = "" if quota is None else f", {quota:g} by the container's quota"
        self._row("processors", f"{system['processors']}, {usable} usable{limit}")
        free = system["available_memory"]
        self._row("memory", f"{_bytes(system['memory'])}, {_bytes(free)} available")
        self._row("disk of this folder", f"{_bytes(system['disk_room'])} free")
        for name, value in system["environment"].items():
            self._row(name, value)
        devices = machine.devices()
        self._row("JAX computes on", ", ".join(devices["devices"]))
        self._row("GPU", ", ".join(devices["gpus"]) or f"none: {devices['without_gpu']}")
        return system | devices

    def _cache(self) -> dict[str, Any]:
        found = cache.examined(cache.folder())
        self._head("Compile cache")
        self._row("folder", found.folder or "none")
        self._row("entries", f"{found.entries}, {_bytes(found.size)}")
        self._row("writable", "yes" if found.fault is None else f"no: {found.fault}")
        self._row("room on its disk", _bytes(found.room))
        for warning in found.warnings:
            self._row("warning", warning)
        return {"folder": found.folder, "entries": found.entries, "bytes": found.size,
                "room": found.room, "fault": found.fault, "warnings": found.warnings}  # fmt: skip

    def _self_test(self) -> None:
        self._head("Self-test")
        selftest = importlib.import_module("asperity.cli.doctor.selftest")
        for one in selftest.checks():
            self._check(one.name, one.ok, one.words, one.source)
            if self._stop.is_set():
                return

    def _speed(self) -> list[dict[str, Any]]:
        self._head("Speed")
        timing, found = importlib.import_module("asperity.cli.doctor.speed"), []
        for name in timing.NAMES:
            if self._stop.is_set():
                break
            one = timing.speed(name)
            kept = one.compiled
            self._row(name, f"{seconds(one.warm)} for a motion of {one.impacts} impacts")
            self._row("", f"{seconds(one.first)} the first time: {kept.asked - kept.read} pieces "
                          f"of code compiled, {kept.read} from the cache")  # fmt: skip
            limit = 1e-6
            words = f"closes to {one.energy_balance_error:.1e}, {limit:.0e} allowed"
            self._check(
                f"energy of `{name}`", one.energy_balance_error <= limit, words, "its conservation"
            )
            found.append({"case": name, "impacts": one.impacts, "warm": one.warm,
                          "first": one.first, "compiling": kept.compiling,
                          "compiled": kept.asked - kept.read, "cached": kept.read})  # fmt: skip
        return found

    def _check(self, name: str, ok: bool, words: str, source: str = "") -> None:
        """Keep a check, and say it."""
        self._checks.append({"name": name, "ok": bool(ok), "found": words, "known": source})
        about = f" ({source})" if source else ""
        self._row(name, f"{_MARKS[bool(ok)]:<6}{words}{about}")

    def _head(self, title: str) -> None:
        self._say("" if self._checks else None, title)

    def _row(self, name: str, text: str) -> None:
        head = f"  {name:<{_NAME}}"
        first, *rest = wrapped(f"{head}{text}", hanging=2 + _NAME)
        self._say(first.rstrip(), *rest)

    def _say(self, *lines: str | None) -> None:
        if not (self._reporter.as_json or self._reporter.quiet):
            for line in lines:
                if line is not None:
                    tell(line)


def _bytes(size: int | None) -> str:
    """A size for a human."""
    if size is None:
        return "-"
    for unit in ("B", "kB", "MB", "GB"):
        if size < 1000:
            return f"{size:.3g} {unit}"
        size = size / 1000  # type: ignore[assignment]
    return f"{size:.3g} TB"

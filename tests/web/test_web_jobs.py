"""Computations for the page: the newest counts, few wait, none outlives its asker or compiles."""

from __future__ import annotations

import asyncio
import contextlib
import functools
import json
import logging
import math
import re
import sys
import threading
import time
from collections.abc import Awaitable, Callable, Coroutine, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest
from starlette.testclient import TestClient

from asperity.errors import SimulationError
from asperity.web import app as pages
from asperity.web import jobs as desks
from asperity.web.jobs import Busy, Desk, Event, Job, Report, Task
from chosen import long_but
from fake_solve import solver
from web_client import page_of, refusal, told

LONG = 20.0
"""How long a test waits for what must come [s]."""


class Held:
    """A task that tells when it has begun and waits until it may end."""

    def __init__(self, answer: object = "answer") -> None:
        self.begun, self.may_end, self.stop = (threading.Event() for _ in range(3))
        self.left = threading.Event()
        self._answer = answer

    def __call__(self, report: Report, stop: threading.Event) -> object:
        self.stop = stop
        self.begun.set()
        try:
            until = time.monotonic() + LONG
            while not self.may_end.is_set() and time.monotonic() < until:
                report(0.5, "computing")
                time.sleep(0.005)
            return self._answer
        finally:
            self.left.set()


async def last(job: Job, patience: float = LONG) -> Event:
    return [event async for event in job.events(patience)][-1]


async def happens(what: Callable[[], bool]) -> None:
    until = time.monotonic() + LONG
    while not what():
        assert time.monotonic() < until
        await asyncio.sleep(0.005)


def run_apart(main: Coroutine[Any, Any, Any]) -> Any:
    """Runs it in a thread of its own: a browser's tests leave their event loop in this one."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(asyncio.run, main).result()


def apart(test: Callable[..., Coroutine[Any, Any, None]]) -> Callable[..., None]:
    """A test that waits for what a desk tells."""

    @functools.wraps(test)
    def run(*given: Any, **named: Any) -> None:
        run_apart(test(*given, **named))

    return run


def quick(answer: object) -> Task:
    return lambda report, stop: answer


# The desk


@apart
async def test_an_older_one_that_ends_late_does_not_speak():
    """Its answer, which no report could stop any more, comes after the word that it is replaced."""
    desk = Desk(threads=2)
    begun, going, ended = (threading.Event() for _ in range(3))

    def deaf(report: Report, stop: threading.Event) -> str:
        begun.set()
        going.wait(LONG)
        ended.set()
        return "stale"

    older = desk.ask("A", deaf)
    await happens(begun.is_set)
    newer = desk.ask("A", quick("new"))
    going.set()
    await happens(ended.is_set)
    assert [event.kind async for event in older.events(LONG)] == ["replaced"]
    assert (await last(newer)).value == "new"


@apart
async def test_askers_do_not_replace_each_other():
    desk, held = Desk(threads=2), Held("first")
    first = desk.ask("A", held)
    assert (await last(desk.ask("B", quick("second")))).value == "second"
    held.may_end.set()
    assert (await last(first)).value == "first"


@apart
async def test_one_that_waits_is_replaced_without_being_begun():
    desk, held, never = Desk(threads=1), Held(), Held()
    running = desk.ask("A", held)
    await happens(held.begun.is_set)
    waiting = desk.ask("B", never)
    newest = desk.ask("B", quick("newest"))
    held.may_end.set()
    assert (await last(running)).kind == "answer"
    assert (await last(newest)).value == "newest"
    assert (await last(waiting)).kind == "replaced"
    assert not never.begun.is_set()


@apart
async def test_who_leaves_stops_the_computation():
    desk, held = Desk(threads=1), Held()
    events = desk.ask("A", held).events(LONG)
    assert (await anext(events)).kind == "progress"
    await events.aclose()
    await happens(held.left.is_set)
    assert held.stop.is_set()
    assert not held.may_end.is_set()


@apart
async def test_too_many_that_wait_are_refused_and_room_comes_back():
    desk, held = Desk(threads=1, room=2), Held()
    jobs = [desk.ask("running", held)]
    await happens(held.begun.is_set)
    jobs += [desk.ask(f"waiting {number}", quick(number)) for number in range(2)]
    with pytest.raises(Busy):
        desk.ask("one more", quick(None))
    newer = desk.ask("waiting 1", quick("newer"))  # in the place of the older
    held.may_end.set()
    assert (await last(newer)).value == "newer"
    assert (await last(desk.ask("one more", quick("now")))).value == "now"


@apart
async def test_what_nobody_waits_for_is_done_one_at_a_time_until_a_question_comes():
    desk, held, second = Desk(threads=3), Held(), Held()
    spare = desk.spare(held)
    assert spare is not None
    await happens(held.begun.is_set)
    assert desk.spare(second) is None
    assert (await last(desk.ask("A", quick("answer")))).value == "answer"
    await happens(spare.over.is_set)  # it heard of the question
    assert spare.stop.is_set()
    assert not held.may_end.is_set()
    again = desk.spare(second)
    assert again is not None
    second.may_end.set()
    await happens(again.over.is_set)
    assert not again.stop.is_set()


@apart
async def test_what_nobody_waits_for_is_not_begun_after_a_question():
    desk, held, never = Desk(threads=1), Held(), Held()
    running = desk.ask("A", held)
    await happens(held.begun.is_set)
    spare = desk.spare(never)
    assert spare is not None
    waiting = desk.ask("B", quick("B"))
    assert not spare.busy
    held.may_end.set()
    assert [(await last(job)).kind for job in (running, waiting)] == ["answer", "answer"]
    assert not never.begun.is_set()


@apart
async def test_patience_ends_a_computation():
    held = Held()
    event = await last(Desk(threads=1).ask("A", held), patience=0.1)
    assert isinstance(event.value, SimulationError)
    assert "no answer within" in str(event.value)
    await happens(held.left.is_set)


def test_a_thread_survives_a_failure_which_is_told_and_logged(caplog):
    def fail(report: Report, stop: threading.Event) -> None:
        raise ZeroDivisionError("a bug")

    async def ask() -> list[Event]:
        desk = Desk(threads=1)
        return [await last(desk.ask("A", task)) for task in (fail, quick("well"))]

    failed, well = run_apart(ask())
    assert isinstance(failed.value, ZeroDivisionError)
    assert well.value == "well"
    assert [record.levelno for record in caplog.records] == [logging.ERROR]
    assert "ZeroDivisionError: a bug" in caplog.text


# The server


@pytest.fixture(autouse=True)
def stand_in(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    if "real" not in request.fixturenames:
        monkeypatch.setitem(sys.modules, "asperity.solver", solver())


@pytest.fixture
def real() -> None:
    """The solver itself."""


@pytest.fixture(autouse=True)
def every_word(monkeypatch: pytest.MonkeyPatch) -> None:
    """Progress is told whenever there is any."""
    monkeypatch.setattr(desks, "OFTEN", 0.0)


def test_progress_is_told_now_and_then(monkeypatch):
    monkeypatch.setattr(desks, "OFTEN", 0.05)

    def task(report: Report, stop: threading.Event) -> None:
        report(0.0, "loading")
        report(0.0, "compilation")
        for number in range(100):
            report(number / 100.0, f"impact {number}")
            time.sleep(2e-3)
        report(1.0, "measures")

    async def ask() -> list[Any]:
        job = Desk(threads=1).ask("A", task)
        return [event.value async for event in job.events(LONG) if event.kind == "progress"]

    told = [text for _, text in run_apart(ask())]
    impacts = [text for text in told if text.startswith("impact")]
    assert [*told[:3], told[-1]] == ["loading", "compilation", "impact 0", "measures"]
    assert 2 <= len(impacts) <= 50


def test_progress_comes_before_the_answer(client, tables):
    *progress, answer = told(client, tables)
    assert progress
    assert all(list(each) == ["progress", "text"] for each in progress)
    assert "impact 3" in [each["text"] for each in progress]
    assert list(answer) == ["answer"]


@pytest.mark.parametrize("asker", ["A", ""])
def test_nothing_is_kept_of_who_was_answered(client, tables, asker):
    told(client, tables, asker=asker)
    client.post("/api/files/curve.csv", json={"case": tables, "asker": asker})
    assert page_of(client).desk._newest == {}


def patient(monkeypatch: pytest.MonkeyPatch) -> tuple[threading.Event, threading.Event]:
    """A solver that goes on until it is stopped: when it has begun, and when it has ended."""
    begun, ended = threading.Event(), threading.Event()

    def explore(case: Any, *, progress: Report, stop: threading.Event, **more: Any) -> None:
        begun.set()
        stop.wait(LONG)
        ended.set()
        progress(0.5, "after")

    module = solver()
    module.explore = module.solve = module.curve = explore  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "asperity.solver", module)
    return begun, ended


def test_a_newer_question_replaces_the_older_which_hears_so(client, tables, monkeypatch):
    begun, ended = patient(monkeypatch)
    older: list[dict[str, Any]] = []
    asking = threading.Thread(target=lambda: older.extend(told(client, tables, asker="A")))
    asking.start()
    assert begun.wait(LONG)
    monkeypatch.setitem(sys.modules, "asperity.solver", solver())
    newer = told(client, tables, asker="A")
    asking.join(LONG)
    assert older[-1] == {"replaced": True}
    assert list(newer[-1]) == ["answer"]
    assert ended.wait(LONG)


def test_a_file_that_is_asked_for_again_is_a_conflict(client, tables, monkeypatch):
    begun, _ = patient(monkeypatch)
    statuses: list[int] = []

    def ask() -> None:
        question = {"case": tables, "asker": "A"}
        statuses.append(client.post("/api/files/curve.csv", json=question).status_code)

    asking = threading.Thread(target=ask)
    asking.start()
    assert begun.wait(LONG)
    monkeypatch.setitem(sys.modules, "asperity.solver", solver())
    ask()
    asking.join(LONG)
    assert sorted(statuses) == [200, 409]


def test_too_many_questions_are_told_to_come_back(client, tables, monkeypatch):
    monkeypatch.setattr(page_of(client), "desk", Desk(threads=1, room=0))
    for path in ("explore", "files/record.nc"):
        answer = client.post(f"/api/{path}", json={"case": tables})
        assert (answer.status_code, answer.json()["error"]["kind"]) == (503, "busy")
        assert int(answer.headers["retry-after"]) > 0


def test_a_case_that_takes_too_long_is_given_up(client, tables, monkeypatch):
    monkeypatch.setitem(sys.modules, "asperity.solver", solver("slow"))
    monkeypatch.setattr(pages, "PATIENCE", 0.2)
    error = told(client, tables)[-1]["error"]
    assert (error["kind"], error["key"]) == ("numerics", None)
    assert "no answer within" in error["message"]


@pytest.mark.parametrize(
    ("behaviour", "wanted", "words"),
    [
        ("refuse", ("input", "impact.release_separation"), "must be above 45.9 nm"),
        ("fail", ("numerics", None), "no equilibrium at 44 nm"),
        ("bug", ("program", None), "its log says more"),
    ],
)
def test_what_goes_wrong_is_told_in_a_line(
    client, tables, monkeypatch, caplog, behaviour, wanted, words
):
    monkeypatch.setitem(sys.modules, "asperity.solver", solver(behaviour))
    error = told(client, tables)[-1]["error"]
    assert (error["kind"], error["key"]) == wanted
    assert words in error["message"]
    assert refusal(client, "/api/files/summary.txt", json={"case": tables}) == error
    failed = [record for record in caplog.records if record.name.startswith("asperity")]
    assert bool(failed) == (behaviour == "bug")


async def asked(
    app: Any, path: str, body: bytes, when: Callable[[], Awaitable[None]], *, whole: bool = True
) -> int | None:
    """Ask, and go away at some time, as a server tells an application of it: the status."""
    messages = iter([{"type": "http.request", "body": body, "more_body": not whole}])
    status = None

    async def receive() -> dict[str, Any]:
        for message in messages:
            return message
        await when()
        return {"type": "http.disconnect"}

    async def send(message: dict[str, Any]) -> None:
        nonlocal status
        status = message.get("status", status)
        await asyncio.sleep(0)

    scope = {
        "type": "http", "asgi": {"version": "3.0", "spec_version": "2.3"}, "http_version": "1.1",
        "method": "POST", "scheme": "http", "path": path, "raw_path": path.encode(),
        "query_string": b"", "root_path": "", "headers": [(b"host", b"127.0.0.1")],
        "client": ("127.0.0.1", 50000), "server": ("127.0.0.1", 8737),
    }  # fmt: skip
    await app(scope, receive, send)
    return status


@pytest.mark.parametrize("path", ["/api/explore", "/api/read", "/api/surfaces/a.csv"])
def test_who_sends_too_slowly_is_not_waited_for(client, monkeypatch, path):
    monkeypatch.setattr(pages, "ARRIVAL", 0.1)

    async def never() -> None:
        await asyncio.sleep(LONG)

    begin = time.monotonic()
    assert run_apart(asked(client.app, path, b"{", never, whole=False)) == 408
    assert time.monotonic() - begin < 5.0
    assert client.post("/api/surfaces/a.csv", content=b"1").status_code == 200


def test_few_uploads_arrive_at_a_time(client):
    """Each is held in memory as a whole."""

    async def ask() -> None:
        app, end = client.app, asyncio.Event()

        async def held() -> None:
            await end.wait()

        async def upload() -> int | None:
            return await asked(app, "/api/surfaces/a.csv", b"1", held, whole=False)

        arriving = [asyncio.create_task(upload()) for _ in range(pages.MOST_UPLOADS)]
        await asyncio.sleep(0.1)
        assert await upload() == 503
        end.set()
        await asyncio.gather(*arriving, return_exceptions=True)

    run_apart(ask())
    assert client.post("/api/surfaces/a.csv", content=b"1").status_code == 200


@pytest.mark.parametrize("path", ["/api/explore", "/api/files/motion.csv", "/api/files/curve.nc"])
@pytest.mark.parametrize("soon", [False, True])
def test_who_closes_the_page_stops_its_computation(client, tables, monkeypatch, soon, path):
    """In the middle of it, or before the first line of the answer went out."""
    begun, ended = patient(monkeypatch)

    async def when() -> None:
        if not soon:
            await happens(begun.is_set)

    desk, begin = page_of(client).desk, time.monotonic()
    body = json.dumps({"case": tables, "asker": "leaver"}).encode()
    run_apart(asked(client.app, path, body, when))
    assert not begun.is_set() or ended.wait(LONG)
    assert time.monotonic() - begin < 5.0
    assert not [asker for asker in desk._newest if asker.startswith("leaver")]
    assert all(job.stop.is_set() for job in desk._waiting)


# Compilation

RIGID = {"counterface.deformation": "rigid"}
GLASS = {"youngs_modulus": "70 GPa", "poisson": 0.22, "density": "2500 kg/m^3"}
FEW = {"numerics.max_impacts": 4}
WAIT = {**FEW, "capillary.formation_time": "1 us"}
CREEP = {
    "model": "standard-linear-solid", "relaxed_modulus_ratio": 0.4, "relaxation_time": "500 ns",
}  # fmt: skip
YIELD = {
    "plasticity": {"model": "kogut-etsion"},
    "body.material": "glass",
    "materials.glass": {**GLASS, "hardness": "5.5 GPa"},
}
USUAL = (0.0, 0.25, 1.0)
KINDS: dict[str, tuple[dict[str, Any], tuple[float, ...]]] = {
    "rigid": ({**RIGID, **FEW}, USUAL),
    "rigid, in many steps": (RIGID, (0.0, 0.1, 0.25, 0.75, 0.9, 1.0)),
    "half-space": ({}, (0.0, 0.1, 0.9, 1.0)),
    "asperities that yield": ({**RIGID, **FEW, **YIELD}, USUAL),
    "menisci that take time": ({**RIGID, **WAIT}, USUAL),
    "menisci that take time on a half-space": ({**WAIT, "numerics.rings": 24}, USUAL),
    "bulk that creeps": (
        {**FEW, "capillary": {"model": "none"}, "numerics.rings": 24, "viscoelasticity": CREEP},
        USUAL,
    ),
}
"""Changes to the case whose numbers are moved, and shares of the way of each slider."""


def ends(spec: dict[str, Any], value: float, unit: str) -> tuple[float, float, bool] | None:
    """From where to where a slider of the page goes, and whether by factors; see its form.js."""
    if spec["scale"] == "linear" and unit == spec["unit"]:
        edge = 0.005 * (spec["high"] - spec["low"])
        return spec["low"] + edge, spec["high"] - edge, False
    if not value > 0.0:
        return None
    if spec["scale"] == "linear":
        return 0.5 * value, 1.5 * value, False
    low, high = spec.get("low", 0.0), spec.get("high", math.inf)
    return max(value / 10.0, low), min(value * 10.0, high), True


def at(tables: dict[str, Any], path: tuple[str, ...]) -> dict[str, Any]:
    """The table at a path; empty where there is none."""
    for name in path:
        tables = tables.get(name, {})
    return tables


def having(tables: dict[str, Any], path: tuple[str, ...], value: Any) -> dict[str, Any]:
    """The same tables with a value at a path."""
    first, *rest = path
    inner = having(tables.get(first, {}), tuple(rest), value) if rest else value
    return {**tables, first: inner}


def changed(client: TestClient, changes: dict[str, Any]) -> dict[str, Any]:
    """The case whose numbers are moved, with other values at some keys."""
    tables: dict[str, Any] = client.get("/api/cases/published-exact").json()["tables"]
    for key, value in changes.items():
        tables = having(tables, tuple(key.split(".")), value)
    return tables


def slid(form: list[Any], tables: dict[str, Any], shares: tuple[float, ...]) -> Iterator[Any]:
    """Key and value wherever a slider of the page can stand."""
    paths = [
        (path, table)
        for table in form
        for path in (
            [(table["name"], name) for name in tables.get(table["name"], {})]
            if table["named"]
            else [(table["name"],)]
        )
    ]
    for path, table in paths:
        if table["name"] in ("numerics", "publication"):
            continue
        for key in table["keys"]:
            given = at(tables, path).get(key["key"])
            parts = re.fullmatch(r"([-+\d.eE]+) ?(.*)", str(given))
            if key["slider"] is None or key["kind"] == "whole" or parts is None:
                continue
            span = ends(key["slider"], float(parts[1]), parts[2])
            for share in shares if span else ():
                low, high, factor = span
                value = low * (high / low) ** share if factor else low + share * (high - low)
                shown = f"{value:.4g}"
                moved = f"{shown} {parts[2]}" if parts[2] else float(shown)
                yield (*path, key["key"]), moved


@contextlib.contextmanager
def compilations() -> Iterator[list[str]]:
    """What XLA compiles meanwhile."""
    import jax
    from jax._src import monitoring

    found: list[str] = []

    def hear(event: str, seconds: float, **more: Any) -> None:
        if event == "/jax/core/compile/backend_compile_duration":
            found.append(f"{more.get('fun_name')} in {seconds:.2f} s")

    jax.monitoring.register_event_duration_secs_listener(hear)
    try:
        yield found
    finally:
        monitoring.unregister_event_duration_listener(hear)


def test_compilations_are_heard():
    from asperity._jax import jax

    with compilations() as found:
        jax.jit(lambda number: 2.0 * number)(1.0)
    assert found


MEAN = {"roughness.placement": "mean"}
"""Single bodies beside it compile once for each power of two of summits."""

QUICK = ("rigid", "asperities that yield", "menisci that take time")
"""Kinds that compile and answer soon."""


@pytest.mark.parametrize("kind", long_but(KINDS, *QUICK))
def test_a_slider_never_compiles(client, kind, real):
    """Values are traced: after one answer to a case, none of its numbers needs a new program."""
    form = client.get("/api/form").json()["tables"]
    changes, shares = KINDS[kind]
    tables = changed(client, {**changes, **MEAN})
    assert "answer" in told(client, tables)[-1]
    moved, compiled = set(), []
    for path, value in slid(form, tables, shares):
        with compilations() as found:
            end = told(client, having(tables, path, value))[-1]
        assert "answer" in end or end["error"]["kind"] in ("input", "numerics"), end
        moved.add(".".join(path))
        if found:
            compiled += [f"{'.'.join(path)} = {value} compiles {each}" for each in found]
    assert len(moved) >= 10, moved
    assert {"body.radius", "roughness.rms_height", "impact.release_separation"} <= moved
    assert ("capillary.humidity" in moved) == ("capillary" not in changes)
    assert ("materials.glass.hardness" in moved) == ("materials.glass" in changes)
    assert ("capillary.formation_time" in moved) == ("capillary.formation_time" in changes)
    assert not compiled, "\n".join(compiled)


AUTO = {"counterface.deformation": "rigid", "adhesion.model": "auto", **FEW}


@pytest.mark.long
def test_a_slider_across_a_border_of_laws_compiles_nothing_once_all_are(client, real):
    """After the first answer the laws that "auto" may choose are compiled unasked."""
    tables = changed(client, AUTO)
    page, others = page_of(client), {**tables, "capillary": {"model": "none"}}
    for case, kinds in ((tables, 1), (others, 2), (tables, 2)):
        assert "answer" in told(client, case)[-1]
        if page.desk._spare is not None:
            assert page.desk._spare.over.wait(300.0)
        assert len(page._ready) == kinds
    laws, compiled = [], []
    for work in ("0.1 mJ/m^2", "30 mJ/m^2", "1 J/m^2", "300 J/m^2"):
        with compilations() as found:
            end = told(client, having(tables, ("adhesion", "work"), work))[-1]
        laws.append(end["answer"]["regime"]["adhesion_law"])
        compiled += [f"work = {work} compiles {each}" for each in found]
    assert laws == ["bradley", "dmt", "maugis", "jkr"]
    assert not compiled, "\n".join(compiled)

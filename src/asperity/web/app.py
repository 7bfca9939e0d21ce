"""The routes of the page."""

from __future__ import annotations

import asyncio
import contextlib
import json
import threading
from collections.abc import AsyncIterator, Callable, Iterable
from functools import partial
from importlib import resources
from typing import Any

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import JSONResponse, Response, StreamingResponse
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles
from starlette.types import Receive, Scope, Send

from asperity.config import BUILTINS, FIRST, Case
from asperity.config.case_file import SIZE_LIMIT, builtin_text, tables
from asperity.config.case_text import text_of
from asperity.config.problems import check
from asperity.errors import InputError
from asperity.web.answer import adhesion_map
from asperity.web.exploring import FILES, ahead, critical, file, glance, kind_of
from asperity.web.form import form
from asperity.web.guard import Guard
from asperity.web.jobs import Busy, Desk, Job, Report, Task
from asperity.web.json_answers import HANDLERS, event_line
from asperity.web.missing_keys import completed, remedies
from asperity.web.requests import Asked, asked, changed, refuse_depth
from asperity.web.surface_uploads import Surfaces

LOCAL = ("127.0.0.1", "localhost", "::1")
"""Names of a server that only this machine can reach."""

PATIENCE = 120.0
"""How long a computation may take [s]."""

ARRIVAL = 60.0
"""How long a request may take to arrive [s]."""

MOST_UPLOADS = 2
"""Surface files that may arrive at a time: each is held in memory as a whole."""

MOST_KINDS = 64
"""Kinds of cases of which it is remembered that all their laws are compiled."""


def application(first: tuple[str, str] | None = None, names: Iterable[str] = LOCAL) -> Starlette:
    """The page and what it asks for.

    Parameters
    ----------
    first
        Name and text of the case that the page opens with; a built-in one without it.
    names
        Names by which the server may be asked, as in ``Host``; others are refused.
    """
    page = _Page(first)

    @contextlib.asynccontextmanager
    async def alive(app: Starlette) -> AsyncIterator[None]:
        yield
        page.desk.close()
        page.surfaces.close()

    static = resources.files("asperity.web") / "static"
    routes = [
        Route("/", page.index),
        Route("/api/form", page.form),
        Route("/api/map", page.map),
        Route("/api/cases/{name}", page.case),
        Route("/api/read", page.read, methods=["POST"]),
        Route("/api/toml", page.toml, methods=["POST"]),
        Route("/api/complete", page.complete, methods=["POST"]),
        Route("/api/explore", page.explore, methods=["POST"]),
        Route("/api/critical", page.critical, methods=["POST"]),
        Route("/api/files/{name}", page.file, methods=["POST"]),
        Route("/api/surfaces/{name}", page.surface, methods=["POST"]),
        Mount("/static", StaticFiles(directory=str(static))),
    ]
    guarded = [Middleware(Guard, names=tuple(names))]
    return Starlette(routes=routes, middleware=guarded, exception_handlers=HANDLERS, lifespan=alive)


class _Page:
    """What the routes share: the desk, the uploads, the case to begin with."""

    def __init__(self, first: tuple[str, str] | None) -> None:
        self.desk = Desk()
        self.surfaces = Surfaces()
        self._arriving = 0
        self._ready: set[int] = set()
        self._first = first
        self._form = json.dumps(
            {"tables": form(), "cases": [*BUILTINS], "first": first[0] if first else FIRST}
        )
        self._map: str | None = None

    async def index(self, request: Request) -> Response:
        page = resources.files("asperity.web") / "static" / "index.html"
        return Response(page.read_bytes(), media_type="text/html; charset=utf-8")

    async def form(self, request: Request) -> Response:
        return Response(self._form, media_type="application/json")

    async def map(self, request: Request) -> Response:
        if self._map is None:
            self._map = json.dumps(await run_in_threadpool(adhesion_map))
        return Response(self._map, media_type="application/json")

    async def case(self, request: Request) -> Response:
        name = request.path_params["name"]
        if self._first is not None and name == self._first[0]:
            text = self._first[1]
        elif name in BUILTINS:
            text = builtin_text(name)
        else:
            raise HTTPException(404, f"no case of this name; there are {', '.join(BUILTINS)}")
        return JSONResponse({"name": name, "tables": tables(text, None)})

    async def read(self, request: Request) -> Response:
        """The tables of a case file that the user has."""
        body = await _body(request)
        try:
            text = body.decode("utf-8-sig")
        except UnicodeDecodeError:
            raise InputError("a case must be UTF-8 text; got a binary file") from None
        found = tables(text, None)
        refuse_depth(found)
        try:
            return JSONResponse({"tables": found})
        except (TypeError, ValueError):
            raise InputError("a case must hold no dates and no infinite numbers") from None

    async def toml(self, request: Request) -> Response:
        """The case as the text that `asperity run` takes, as it was given."""
        what = asked(await _body(request))
        what.case()
        check(Case, what.tables)  # what it says of output counts here
        text = text_of(what.tables)
        assert tables(text, None) == what.tables
        return JSONResponse({"toml": text})

    async def complete(self, request: Request) -> Response:
        """The tables with what a choice of the user asks for, and what would mend the rest."""
        after, before = changed(await _body(request))
        found = completed(after, before)
        return JSONResponse({"tables": found, "remedies": remedies(found)})

    async def explore(self, request: Request) -> Response:
        """Lines of JSON: progress, and in the end the answer or what is wrong."""
        what = asked(await _body(request))
        case = what.case()  # refused at once, by its status
        asker = _asker(what, request)
        job = self.desk.ask(asker, partial(glance, what, self.surfaces))

        def left() -> None:
            job.stop.set()
            self.desk.forget(asker, job)

        return _Lines(_lines(job, lambda: self._compile_ahead(what, case)), left)

    def _compile_ahead(self, what: Asked, case: Case) -> None:
        """Have what other laws need compiled while nobody asks, once for each kind of case."""
        if case.adhesion.model != "auto" or (kind := kind_of(case)) in self._ready:
            return

        def task(report: Report, stop: threading.Event) -> None:
            ahead(what, self.surfaces, report, stop)
            if stop.is_set():
                return
            if len(self._ready) >= MOST_KINDS:
                self._ready.clear()
            self._ready.add(kind)

        self.desk.spare(task)

    async def critical(self, request: Request) -> Response:
        """The critical velocity of the case."""
        what = asked(await _body(request))
        what.case()
        asker = f"{_asker(what, request)} critical"
        return await self._answered(request, asker, partial(critical, what, self.surfaces))

    async def file(self, request: Request) -> Response:
        """A file of the case's results."""
        name = request.path_params["name"]
        if name not in FILES:
            raise HTTPException(404, f"no such file; there are {', '.join(FILES)}")
        what = asked(await _body(request))
        what.case()
        task = partial(file, what, self.surfaces, name)
        headers = {"content-disposition": f'attachment; filename="{name}"'}
        response = partial(Response, media_type=FILES[name], headers=headers)
        return await self._answered(request, f"{_asker(what, request)} {name}", task, response)

    async def _answered(
        self,
        request: Request,
        asker: str,
        task: Task,
        response: Callable[[Any], Response] = JSONResponse,
    ) -> Response:
        """The response with what a computation gives, or with why it gives nothing."""
        job = self.desk.ask(asker, task)
        watch = asyncio.create_task(_dropped_by(request, job))
        events = job.events(PATIENCE)
        try:
            *_, event = [event async for event in events]
        finally:
            watch.cancel()
            await events.aclose()  # type: ignore[attr-defined]
            self.desk.forget(asker, job)
        if event.kind == "answer":
            return response(event.value)
        return JSONResponse(event_line(event), 422 if event.kind == "error" else 409)

    async def surface(self, request: Request) -> Response:
        """Keep a surface file that was dropped in."""
        name = request.path_params["name"]
        if self._arriving >= MOST_UPLOADS:
            raise Busy
        self._arriving += 1
        try:
            async with _in_time():
                body = await request.body()
            token = await run_in_threadpool(self.surfaces.keep, name, body)
        finally:
            self._arriving -= 1
        return JSONResponse({"name": name, "token": token, "bytes": len(body)})


class _Lines(StreamingResponse):
    """Lines of JSON. However it ends, even before its first line was asked for, it is told."""

    def __init__(self, lines: AsyncIterator[str], left: Callable[[], None]) -> None:
        super().__init__(lines, media_type="application/x-ndjson")
        self._left = left

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        try:
            await super().__call__(scope, receive, send)
        finally:
            self._left()


async def _lines(job: Job, answered: Callable[[], None]) -> AsyncIterator[str]:
    events = job.events(PATIENCE)
    try:
        async for event in events:
            yield json.dumps(event_line(event), allow_nan=False) + "\n"
            if event.kind == "answer":
                answered()
    finally:
        await events.aclose()  # type: ignore[attr-defined]


async def _dropped_by(request: Request, job: Job) -> None:
    """Drop a job when its asker, whose request was read, leaves."""
    while (await request.receive())["type"] != "http.disconnect":
        pass
    job.drop()


async def _body(request: Request) -> bytes:
    """A request's body, never read beyond the limit of a case."""
    body = bytearray()
    async with _in_time():
        async for part in request.stream():
            body += part
            if len(body) > SIZE_LIMIT:
                raise HTTPException(413, f"a case must be at most {SIZE_LIMIT >> 20} MiB")
    return bytes(body)


@contextlib.asynccontextmanager
async def _in_time() -> AsyncIterator[None]:
    """Refuse a request that comes too slowly, and so would be waited for without end."""
    try:
        async with asyncio.timeout(ARRIVAL):
            yield
    except TimeoutError:
        raise HTTPException(408, f"a request must arrive within {ARRIVAL:.0f} s") from None


def _asker(what: Asked, request: Request) -> str:
    client = request.client
    return what.asker or (f"{client.host}:{client.port}" if client else "nobody")

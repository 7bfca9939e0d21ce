"""Events and errors as the page is answered them, in JSON."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import JSONResponse, Response

from asperity.errors import InputError, OutputError, SimulationError, one_line
from asperity.web.jobs import Busy, Event

_BUSY = "too much is being asked already; try again in a few seconds"


def event_line(event: Event) -> dict[str, Any]:
    """An event as JSON."""
    if event.kind == "progress":
        fraction, text = event.value
        return {"progress": round(fraction, 3), "text": text}
    if event.kind == "answer":
        return {"answer": event.value}
    if event.kind == "replaced":
        return {"replaced": True}
    return {"error": words_of(event.value)}


def words_of(error: Exception) -> dict[str, Any]:
    """What went wrong, in a line."""
    if isinstance(error, InputError):
        problems = [{"key": one.key, "message": str(one)} for one in error.problems]
        return {**problems[0], "kind": "input", "problems": problems}
    if isinstance(error, SimulationError):
        return {"kind": "numerics", "key": None, "message": one_line(str(error))}
    return {"kind": "program", "key": None, "message": "the program failed; its log says more"}


def _input(request: Request, error: InputError) -> Response:
    return JSONResponse({"error": words_of(error)}, 422)


def _output(request: Request, error: OutputError) -> Response:
    return JSONResponse({"error": {"kind": "output", "key": None, "message": str(error)}}, 507)


def _busy(request: Request, error: Busy) -> Response:
    words = {"kind": "busy", "key": None, "message": _BUSY}
    return JSONResponse({"error": words}, 503, headers={"retry-after": "3"})


def _http(request: Request, error: HTTPException) -> Response:
    words = {"kind": "request", "key": None, "message": error.detail}
    return JSONResponse({"error": words}, error.status_code, headers=error.headers)


HANDLERS: dict[Any, Callable[[Request, Any], Response]] = {
    InputError: _input,
    OutputError: _output,
    Busy: _busy,
    HTTPException: _http,
}
"""What answers an error of each kind."""

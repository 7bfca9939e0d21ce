"""Events and errors as the page is answered them, in JSON."""

from __future__ import annotations

from collections.abc import Callable, Mapping
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


def refusal(
    kind: str, message: str, status: int, headers: Mapping[str, str] | None = None
) -> JSONResponse:
    """An answer that refuses a request for no single key of a case."""
    error = {"kind": kind, "key": None, "message": message}
    return JSONResponse({"error": error}, status, headers=headers)


HANDLERS: dict[Any, Callable[[Request, Any], Response]] = {
    InputError: lambda request, error: JSONResponse({"error": words_of(error)}, 422),
    OutputError: lambda request, error: refusal("output", str(error), 507),
    Busy: lambda request, error: refusal("busy", _BUSY, 503, {"retry-after": "3"}),
    HTTPException: lambda request, error: refusal(
        "request", error.detail, error.status_code, error.headers
    ),
}
"""What answers an error of each kind."""

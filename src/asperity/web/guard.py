"""Who may ask: requests to this server by its own name, from its own page, and not too long."""

from __future__ import annotations

from collections.abc import Iterable
from urllib.parse import urlsplit

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from asperity.web.json_answers import refusal

MOST = 64 << 20
"""Longest request [bytes]: a measured surface. Cases have their own, smaller limit."""

_TOO_LONG = f"a request must be at most {MOST >> 20} MiB"

_HEADERS = {
    b"content-security-policy": b"default-src 'self'; img-src 'self' blob: data:; "
    b"frame-ancestors 'none'; form-action 'none'; "
    b"base-uri 'none'; object-src 'none'",
    b"x-content-type-options": b"nosniff",
    b"referrer-policy": b"no-referrer",
    b"cross-origin-opener-policy": b"same-origin",
    b"cross-origin-resource-policy": b"same-origin",
    b"cache-control": b"no-cache",
}


class TooLong(Exception):
    """A request's body is longer than it says or than it may be."""


class Guard:
    """Refuses requests by a foreign name or from a foreign page; bounds their length.

    A page of somebody else's site, open in the same browser, can send requests here, under a name
    of its own that leads to this machine or from its own origin: `Host` and `Origin` give it away.

    Parameters
    ----------
    app
        What answers.
    names
        Names of this server, as in ``Host`` without the port.
    """

    def __init__(self, app: ASGIApp, names: Iterable[str]) -> None:
        self._app = app
        self._names = frozenset(name.lower() for name in names)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            if scope["type"] == "websocket":
                await receive()
                await send({"type": "websocket.close", "code": 1008})
                return
            await self._app(scope, receive, send)
            return
        refused = self._refusal(_headers(scope))
        if refused is not None:
            status, reason = refused
            await refusal("request", reason, status)(scope, receive, _dressed(send))
            return
        await self._answered(scope, receive, _dressed(send))

    async def _answered(self, scope: Scope, receive: Receive, send: Send) -> None:
        taken, begun = 0, False

        async def bounded() -> Message:
            nonlocal taken
            message = await receive()
            taken += len(message.get("body", b""))
            if taken > MOST:
                raise TooLong
            return message

        async def noted(message: Message) -> None:
            nonlocal begun
            begun = True
            await send(message)

        try:
            await self._app(scope, bounded, noted)
        except TooLong:
            if begun:
                raise
            await refusal("request", _TOO_LONG, 413)(scope, receive, send)

    def _refusal(self, headers: dict[str, list[str]]) -> tuple[int, str] | None:
        """Status and reason for which a request is refused; None where it is not."""
        hosts = headers.get("host", [])
        if len(hosts) != 1 or _name(f"//{hosts[0]}") not in self._names:
            return 421, "this server goes by other names: see `asperity web --help`"
        for origin in headers.get("origin", []):
            if _place(origin) != hosts[0].lower():
                return 403, "requests must come from this server's own page"
        if headers.get("sec-fetch-site", ["none"])[0] not in ("none", "same-origin"):
            return 403, "requests must come from this server's own page"
        lengths = headers.get("content-length", ["0"])
        if len(lengths) != 1 or not lengths[0].isdecimal():
            return 400, "`Content-Length` must be a number"
        if int(lengths[0][:20]) > MOST:
            return 413, _TOO_LONG
        return None


def _headers(scope: Scope) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for name, value in scope["headers"]:
        found.setdefault(name.decode("latin-1").lower(), []).append(value.decode("latin-1"))
    return found


def _place(origin: str) -> str | None:
    """Host and port of an origin; None where it is no address."""
    try:
        return urlsplit(origin).netloc.lower()
    except ValueError:
        return None


def _name(address: str) -> str | None:
    """Name of the host in an address; None where it is no address."""
    try:
        parts = urlsplit(address)
        _ = parts.port  # which must be a number
    except ValueError:
        return None
    return None if parts.username or parts.path else parts.hostname


def _dressed(send: Send) -> Send:
    """The same, with headers that bind the browser."""

    async def dressed(message: Message) -> None:
        if message["type"] == "http.response.start":
            own = {name.lower() for name, _ in message.get("headers", [])}
            extra = [pair for pair in _HEADERS.items() if pair[0] not in own]
            message = {**message, "headers": [*message.get("headers", []), *extra]}
        await send(message)

    return dressed

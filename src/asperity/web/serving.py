"""The server: one process on one address."""

from __future__ import annotations

import asyncio
import contextlib
import ipaddress
import socket
import threading
from collections.abc import Callable, Sequence
from typing import Any

import uvicorn
from uvicorn.protocols.http.h11_impl import H11Protocol

from asperity.config import load
from asperity.errors import InputError, OutputError, SimulationError
from asperity.web.answer import DRAWN
from asperity.web.app import LOCAL, application

MOST_CONNECTIONS = 64

SILENCE = 10.0
"""How long a connection may wait for a request [s], at least; at most twice as long."""


class Impatient(H11Protocol):
    """HTTP that closes a connection on which no request comes.

    The server has places for `MOST_CONNECTIONS`: silent ones must not take them all.
    """

    _checks: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        """Begin to look at the clock."""
        super().connection_made(transport)
        self._checks = self.loop.call_later(SILENCE, self._check, None)

    def connection_lost(self, error: Exception | None) -> None:
        """Look no longer."""
        if self._checks is not None:
            self._checks.cancel()
        super().connection_lost(error)

    def _check(self, before: object) -> None:
        """Close where no request has come since the last look, else look again."""
        cycle = self.cycle
        if cycle is before and (cycle is None or cycle.response_complete):
            self.transport.close()
            return
        self._checks = self.loop.call_later(SILENCE, self._check, cycle)


def serve(
    host: str,
    port: int,
    names: Sequence[str],
    first: tuple[str, str],
    ready: Callable[[str], None],
) -> None:
    """Serve the page until the process is asked to end.

    Parameters
    ----------
    host
        Address of this machine; others than the loopback's are reached from outside.
    port
        Port; 0 for a free one.
    names
        Other names by which the server may be asked.
    first
        Name and text of the case that the page opens with.
    ready
        Called with the page's address once it listens.

    Raises
    ------
    InputError, OutputError
        Where the address is none of this machine's, or taken.
    """
    listening = _bound(host, port)
    shown = f"[{host}]" if ":" in host else host
    app = application(first, {*LOCAL, host, *names} - {"0.0.0.0", "::"})
    config = uvicorn.Config(
        app,
        http=Impatient,
        log_level="warning",
        access_log=False,
        server_header=False,
        limit_concurrency=MOST_CONNECTIONS,
        timeout_keep_alive=30,
        timeout_graceful_shutdown=1,
        lifespan="on",
    )
    threading.Thread(target=_warm, args=(first,), daemon=True).start()
    ready(f"http://{shown}:{listening.getsockname()[1]}/")
    uvicorn.Server(config).run(sockets=[listening])


def _warm(first: tuple[str, str]) -> None:
    """Compute the first case while the page loads: its question finds all compiled."""
    from asperity.solver import explore

    # What is wrong with the case is said when the page asks for it.
    with contextlib.suppress(InputError, SimulationError):
        explore(load(first[1]), most=DRAWN)


def _bound(host: str, port: int) -> socket.socket:
    if not 0 <= port <= 65535:
        raise InputError(f"`--port` must lie in [0, 65535]; got {port}")
    try:
        version = ipaddress.ip_address(host).version
    except ValueError:
        rule = "must be an address of this machine, such as 127.0.0.1"
        raise InputError(f"`--host` {rule}; got {host!r}") from None
    family = socket.AF_INET6 if version == 6 else socket.AF_INET
    # With the protocol's number asyncio sends each packet at once; without, TCP waits up to 40 ms.
    listening = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((host, port))
        listening.listen(128)
    except OSError as error:
        listening.close()
        raise OutputError(
            f"{host}:{port}: cannot be listened at: {error.strerror or error}; "
            "take another --port (0 for any free one)"
        ) from None
    return listening

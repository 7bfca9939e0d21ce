"""A browser for the tests of the page: Debian's chromium, where there is one."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome")
REQUIRED = "ASPERITY_BROWSER"
"""Set to ``required``, its absence is a failure."""

CHROMIUM = next(filter(None, map(shutil.which, NAMES)), None)


def needed() -> str:
    """The browser; without one the tests are not run, or fail where one is required."""
    if CHROMIUM is None:
        if os.environ.get(REQUIRED) == "required":
            pytest.fail("no chromium here, and it is required")
        pytest.skip("not run: no chromium here")
    return CHROMIUM


@contextmanager
def served(case: str | Path = "published-exact") -> Iterator[str]:
    """Address of a server that shows a case, in a process of its own."""
    command = [sys.executable, "-m", "asperity", "web", str(case), "--port", "0", "--json"]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert server.stdout is not None
    try:
        yield json.loads(server.stdout.readline())["address"]
    finally:
        server.send_signal(signal.SIGINT)
        try:
            server.wait(10.0)
        except subprocess.TimeoutExpired:
            server.kill()
            server.wait()
            raise
        finally:
            server.stdout.close()

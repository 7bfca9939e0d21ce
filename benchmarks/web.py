"""The page: from the start to its first answer, from a slider to new curves, in a browser."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from statistics import median, quantiles

from playwright.sync_api import Browser, Page, sync_playwright

from asperity.config.case_file import builtin_text

Row = tuple[str, str, str]

MOVES = 40
"""Moves of sliders for each figure."""

_SLIDERS = ("roughness-rms_height", "capillary-humidity", "body-radius", "capillary-contact_angle")
_MOVE = "(slider, to) => { slider.value = to; slider.dispatchEvent(new Event('input')); }"
_FIRST_ANSWER = "#verdicts .said"


def rows() -> Iterator[Row]:
    """Figures with their goals; one line that says so where there is no chromium."""
    chromium = shutil.which("chromium") or shutil.which("google-chrome")
    if chromium is None:
        yield "the page in a browser: not run, no chromium here", "", ""
        return
    with sync_playwright() as play, tempfile.TemporaryDirectory() as folder:
        browser = play.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        cold = {**os.environ, "JAX_COMPILATION_CACHE_DIR": f"{folder}/cache"}
        for what in ("the page's first answer, nothing compiled yet", "the page's first answer"):
            begun = time.perf_counter()
            with served("published-exact", cold) as address:
                _opened(browser, address)
                yield what, f"{time.perf_counter() - begun:.1f} s", "8 s"
        for kind, goals in (("rigid", "100, 250 ms"), ("half-space", "500 ms")):
            case = Path(folder) / f"{kind}.toml"
            case.write_text(builtin_text("published-exact").replace('"half-space"', f'"{kind}"'))
            with served(str(case), cold) as address:
                found = _latencies(browser, address)
            slow = quantiles(found, n=20)[-1]
            what = f"published-exact, {kind}: slider to new curves, median and 95 %"
            yield what, f"{median(found):.0f}, {slow:.0f} ms", goals
        browser.close()


@contextmanager
def served(case: str, environment: dict[str, str]) -> Iterator[str]:
    command = [sys.executable, "-m", "asperity", "web", case, "--port", "0", "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as server:
        assert server.stdout is not None
        try:
            yield json.loads(server.stdout.readline())["address"]
        finally:
            server.send_signal(signal.SIGINT)


def _opened(browser: Browser, address: str) -> Page:
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.goto(address)
    page.wait_for_selector(_FIRST_ANSWER, timeout=120_000)
    return page


def _latencies(browser: Browser, address: str) -> list[float]:
    """Times [ms] from a slider's event to the drawn answer, one move after the other."""
    page = _opened(browser, address)
    page.wait_for_selector("#map canvas")
    for number in range(MOVES + 4):
        key = _SLIDERS[number % len(_SLIDERS)]
        share = 380 + 7 * number if key.endswith("angle") else 420 + number
        count = page.evaluate("() => asperity.latencies.length")
        page.locator(f"#field-{key}-slider").evaluate(
            "(slider, to) => { slider.value = to; slider.dispatchEvent(new Event('input')); }",
            share,
        )
        page.wait_for_function(f"() => asperity.latencies.length > {count}", timeout=60_000)
    found: list[float] = page.evaluate("() => asperity.latencies")
    page.close()
    return found[-MOVES:]


if __name__ == "__main__":
    for _what, _figure, _goal in rows():
        print(f"{_what:<72}{_figure:>16}   goal {_goal}", flush=True)

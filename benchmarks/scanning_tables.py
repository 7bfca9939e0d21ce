"""Scanning curves tabulated before a motion, or each solved as it comes: the time to an answer.

``python -m benchmarks.scanning_tables`` prints a row for each case and each way: seconds until the
first motion is there with nothing compiled, and the least of three motions after that. Each row is
a process of its own, with an empty cache.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time

CASES = ("glass-bead", "published-exact")
REPEATS = 3


def main() -> int:
    """Measure all rows, or, with a case and 0 or 1 as arguments, one of them in this process."""
    if len(sys.argv) > 1:
        print(*(f"{took:.2f}" for took in _seconds(sys.argv[1], bool(int(sys.argv[2])))))
        return 0
    print(f"{'case':<18}{'scanning curves':<18}{'first [s]':>10}{'then [s]':>10}")
    for case in CASES:
        for tabulated in (False, True):
            first, then = _apart(case, tabulated)
            how = "tabulated" if tabulated else "as they come"
            print(f"{case:<18}{how:<18}{first:>10}{then:>10}", flush=True)
    return 0


def _apart(case: str, tabulated: bool) -> list[str]:
    """The seconds of one row, from a process with an empty cache."""
    command = [sys.executable, "-m", __spec__.name, case, str(int(tabulated))]
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            command, env={**os.environ, "XDG_CACHE_HOME": folder}, check=True, capture_output=True
        )
    return done.stdout.decode().split()


def _seconds(name: str, tabulated: bool) -> tuple[float, float]:
    """Seconds to the first motion of a case, and the least of some after that."""
    from asperity.config.resolve import resolve
    from asperity.integration import cut_in_steps, integrate, silently
    from asperity.model import build
    from asperity.results.case_source import case_of

    problem = cut_in_steps(build(resolve(case_of(name))))
    took = []
    for _ in range(1 + REPEATS):
        began = time.perf_counter()
        integrate(problem, silently, None, many=tabulated)
        took.append(time.perf_counter() - began)
    return took[0], min(took[1:])


if __name__ == "__main__":
    sys.exit(main())

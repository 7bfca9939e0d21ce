"""For the whole session: one thread a worker, a compile cache, no screen, steady examples."""

import gc
import os
from pathlib import Path

import hypothesis
import pytest
from tools.compiling import prepare

MAPS = 15_000
"""Memory maps of a worker above which it drops what it has compiled; at 65530 Linux kills it."""


# Before anything imports JAX, which reads these once. Programs that the tests start inherit them.
prepare()
_worker = os.environ.get("PYTEST_XDIST_WORKER", "alone")
if _worker != "alone":
    for _variable in ("NPROC", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(_variable, "1")

# Compiling takes the first example over any deadline; on CI the examples are always the same.
hypothesis.settings.register_profile("here", deadline=None)
hypothesis.settings.register_profile("ci", deadline=None, derandomize=True)
hypothesis.settings.load_profile("ci" if os.environ.get("CI") else "here")


def _memory_maps() -> int:
    """Memory maps of this process, a few for each compiled function; 0 where none can be told."""
    try:
        return Path("/proc/self/maps").read_bytes().count(b"\n")
    except OSError:
        return 0


def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> None:
    """Between two modules, forget what was compiled where there is much of it."""
    if (nextitem is not None and item.path == nextitem.path) or _memory_maps() < MAPS:
        return
    import equinox as eqx
    import jax

    eqx.clear_caches()
    jax.clear_caches()
    gc.collect()

"""For the whole session: one thread a worker, a compile cache, no screen, steady examples."""

import gc
import os
import tempfile
from pathlib import Path

import hypothesis
import platformdirs
import pytest

MAPS = 15_000
"""Memory maps of a worker above which it drops what it has compiled; at 65530 Linux kills it."""


def _compile_cache() -> Path:
    """A folder for compiled code that outlives the session, shared by all workers.

    JAX does not read an entry that another worker has half written: it says so and compiles.
    """
    try:
        folder = platformdirs.user_cache_path("asperity") / "tests"
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        folder = Path(tempfile.mkdtemp(prefix="asperity-tests-"))
    return folder


# Before anything imports JAX, which reads these once. Programs that the tests start inherit them.
_worker = os.environ.get("PYTEST_XDIST_WORKER", "alone")
os.environ.setdefault("JAX_PLATFORMS", "cpu")
os.environ.setdefault("JAX_COMPILATION_CACHE_DIR", str(_compile_cache()))
os.environ.setdefault("MPLBACKEND", "Agg")
os.environ.setdefault("XLA_FLAGS", "--xla_cpu_multi_thread_eigen=false")
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

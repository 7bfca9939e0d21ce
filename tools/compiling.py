"""How tests and executed pages compile: quickly, into one cache that outlives them."""

import os
import tempfile
from pathlib import Path

import platformdirs

FLAGS = (
    "--xla_cpu_multi_thread_eigen=false --xla_backend_optimization_level=0 "
    "--xla_cpu_use_fusion_emitters=false --xla_cpu_parallel_codegen_split_count=1 "
    "--xla_disable_hlo_passes=while-loop-invariant-code-motion"
)
"""As the program compiles a single case, less optimised: most tests run what they compile once.

In one piece, since a worker compiles in one thread: that saves it a twentieth of its time.
"""


def prepare() -> None:
    """Set what JAX reads when it is imported, where the environment does not say it already.

    Programs that are started inherit it. JAX does not read an entry of the cache that another
    process has half written: it says so and compiles.
    """
    os.environ.setdefault("JAX_PLATFORMS", "cpu")
    os.environ.setdefault("XLA_FLAGS", FLAGS)
    os.environ.setdefault("MPLBACKEND", "Agg")
    if "JAX_COMPILATION_CACHE_DIR" not in os.environ:
        try:
            folder = platformdirs.user_cache_path("asperity") / "tests"
            folder.mkdir(parents=True, exist_ok=True)
        except OSError:
            folder = Path(tempfile.mkdtemp(prefix="asperity-tests-"))
        os.environ["JAX_COMPILATION_CACHE_DIR"] = str(folder)

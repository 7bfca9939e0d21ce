"""JAX set up once: float64, one thread for LAPACK, a compile cache on disk.

Every room that computes imports ``jax`` from here, so that no array can be made
before double precision is on.
"""

from __future__ import annotations

import gc
import os
from pathlib import Path

import platformdirs

# The half-space solves many systems of some hundred unknowns, one after the other. Threads of
# the BLAS library that JAX borrows from SciPy only wait for each other there: ten times slower
# when another program runs, and for ever now and then.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# Tracing makes millions of objects, few of them in cycles: looking for these as often as Python
# does by default takes a fifteenth of the time to a first answer.
if gc.get_threshold()[0] in (700, 2000):
    gc.set_threshold(50_000, 20, 100)

import jax
import jax.numpy as jnp
import jaxlib.version
import scipy.linalg  # noqa: F401
import threadpoolctl

__all__ = ["jax", "jnp"]

jax.config.update("jax_enable_x64", True)

for _library in threadpoolctl.ThreadpoolController().lib_controllers:
    if "scipy.libs" in _library.filepath:  # loaded before this room could set the variable above
        _library.set_num_threads(1)

if "JAX_COMPILATION_CACHE_DIR" not in os.environ:
    # What another version of jaxlib compiled can end the process that reads it.
    _cache = Path(platformdirs.user_cache_dir("asperity", appauthor=False))
    _cache /= f"jaxlib-{jaxlib.version.__version__}"
    jax.config.update("jax_compilation_cache_dir", str(_cache))
jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
jax.config.update("jax_persistent_cache_min_entry_size_bytes", -1)

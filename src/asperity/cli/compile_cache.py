"""The compile cache: code that JAX compiled, and traced programs of this package beside it."""

from __future__ import annotations

import contextlib
import os
import re
import secrets
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from asperity.writing import told

OWN = "jaxlib-"
"""Beginning of the name of the user's own folder."""

_CODE = re.compile(r".+-[0-9a-f]{64}-(cache|atime)")
_PROGRAM = re.compile(r"[0-9a-f]{64}\.(jax|\d+\.\d+)")
_TRIAL = """
from asperity._jax import jax, jnp
from asperity.cli.compiling import compilation
jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
compilation()
def asperity_trial(x):
    return jnp.sin(x @ x) + {token}
jax.jit(asperity_trial)(jnp.zeros((3, 3))).block_until_ready()
print(compilation().asked - compilation().read)
"""


def folder() -> Path | None:
    """Folder of the cache; None where it is off."""
    from asperity._jax import jax

    named = jax.config.jax_compilation_cache_dir  # type: ignore[attr-defined]
    return Path(named) if named else None


def every_folder(place: Path) -> list[Path]:
    """A folder, and where it is the user's own those of other versions of jaxlib beside it."""
    own = place.name.startswith(OWN) and "JAX_COMPILATION_CACHE_DIR" not in os.environ
    return sorted({place, *(place.parent.glob(f"{OWN}*") if own else ())})


def size_of(place: Path) -> tuple[int, int]:
    """Pieces of code and traced programs that a folder keeps, and their size [bytes]."""
    entries = size = 0
    for file in _kept(place):
        with contextlib.suppress(FileNotFoundError):  # removed meanwhile by another process
            size += file.stat().st_size
            entries += not file.name.endswith("-atime")
    return entries, size


def room_for(place: Path) -> int:
    """Room on the disk of a folder [bytes], whether it is there yet or not."""
    there = next(each for each in (place, *place.parents) if each.exists())
    return shutil.disk_usage(there).free


def fault_of(place: Path) -> str | None:
    """Why a start does not find in a folder what one before compiled; None where it does.

    A small program, another one each time, is compiled in two processes, one after the other. On
    some processors JAX writes its cache and refuses, without a word, to read it.
    """
    env = {**os.environ, "JAX_COMPILATION_CACHE_DIR": str(place)}
    program = [sys.executable, "-c", _TRIAL.format(token=secrets.randbits(32))]
    for _ in range(2):
        ran = subprocess.run(program, env=env, capture_output=True, text=True, check=False)
    for file in place.glob("jit_asperity_trial-*") if place.is_dir() else ():
        file.unlink(missing_ok=True)
    if ran.stdout.strip() == "0":
        return None
    said = [line for line in ran.stderr.splitlines() if "rror" in line]
    return said[-1].rpartition("Error: ")[2] if said else "what was written is not read again"


def empty(place: Path) -> tuple[int, int]:
    """Remove what a cache keeps, and nothing else; number of entries, and their size [bytes].

    Raises
    ------
    OutputError
        Where a file cannot be removed.
    """
    before = size_of(place)
    for file in _kept(place):
        with told(file, "removed"):
            file.unlink(missing_ok=True)
    return before


def _kept(place: Path) -> Iterator[Path]:
    """Files of the cache; what else is in the folder is somebody's own."""
    for where, named in ((place, _CODE), (place / "programs", _PROGRAM)):
        if where.is_dir() and os.access(where, os.R_OK | os.X_OK):
            yield from (file for file in sorted(where.iterdir()) if named.fullmatch(file.name))

"""The compile cache: compiled code of JAX, and traced programs of this package beside it."""

from __future__ import annotations

import contextlib
import os
import re
import secrets
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from asperity.errors import OutputError

LEAST_ROOM = 200 * 2**20
"""Room on a disk below which a user is warned [bytes]; a case's programs take some 20 MB."""

_CODE = re.compile(r".+-[0-9a-f]{64}-(cache|atime)")
_PROGRAM = re.compile(r"[0-9a-f]{64}\.(jax|\d+\.\d+)")
_TRIAL = bytes(1 << 16)


@dataclass(frozen=True)
class Cache:
    """What is kept of compiling.

    Parameters
    ----------
    folder : str or None
        The folder; None where nothing is kept.
    entries : int
        Pieces of code and traced programs in it.
    size : int
        Their size [bytes].
    room : int or None
        Room on its disk [bytes]; None where that cannot be told.
    fault : str or None
        Why nothing can be written there; None where it can.
    """

    folder: str | None
    entries: int = 0
    size: int = 0
    room: int | None = None
    fault: str | None = None

    @property
    def warnings(self) -> list[str]:
        """What a user should do something about."""
        if self.folder is None:
            return ["The compile cache is off: every start compiles anew."]
        if self.fault is not None:
            return [
                f"Nothing can be written to the compile cache ({self.fault}): every start "
                "compiles anew. JAX_COMPILATION_CACHE_DIR names another folder."
            ]
        if self.room is not None and self.room < LEAST_ROOM:
            return ["The disk of the compile cache is nearly full; --empty-cache makes room."]
        return []


def folder() -> Path | None:
    """Folder of the cache; None where it is off."""
    from asperity._jax import jax

    named = jax.config.jax_compilation_cache_dir  # type: ignore[attr-defined]
    return Path(named) if named else None


def examined(place: Path | None) -> Cache:
    """What a folder keeps, and whether more can be written; makes the folder where it is missing.

    Parameters
    ----------
    place : Path or None
        The folder; None where the cache is off.
    """
    if place is None:
        return Cache(None)
    files = list(_kept(place))
    return Cache(
        str(place),
        sum(not file.name.endswith("-atime") for file in files),
        sum(_size(file) for file in files),
        _room(place),
        _fault(place),
    )


def emptied(place: Path) -> tuple[int, int]:
    """Remove what a cache keeps, and nothing else; number of entries, and their size [bytes].

    Raises
    ------
    OutputError
        Where a file cannot be removed.
    """
    before = examined(place)
    for file in _kept(place):
        try:
            file.unlink(missing_ok=True)
        except OSError as error:
            reason = error.strerror or error
            raise OutputError(f"{file}: cannot be removed: {reason}", path=str(file)) from None
    return before.entries, before.size


def _kept(place: Path) -> Iterator[Path]:
    """Files of the cache; what else is in the folder is somebody's own."""
    for where, named in ((place, _CODE), (place / "programs", _PROGRAM)):
        try:
            found = sorted(where.iterdir())
        except OSError:  # not there yet, or not to be read: nothing that could be used
            continue
        yield from (file for file in found if named.fullmatch(file.name))


def _size(file: Path) -> int:
    try:
        return file.stat().st_size
    except OSError:  # removed meanwhile by another process
        return 0


def _room(place: Path) -> int | None:
    """Room on a disk for this user [bytes]."""
    while not place.exists() and place != place.parent:
        place = place.parent
    try:
        return shutil.disk_usage(place).free
    except OSError:
        return None


def _fault(place: Path) -> str | None:
    """Why nothing can be written to a folder; None where a trial goes well."""
    trial = place / f".asperity-{secrets.token_hex(6)}"
    try:
        place.mkdir(parents=True, exist_ok=True)
        with trial.open("xb") as stream:
            stream.write(_TRIAL)
            stream.flush()
            os.fsync(stream.fileno())
    except OSError as error:
        return error.strerror or str(error)
    finally:
        with contextlib.suppress(OSError):
            trial.unlink(missing_ok=True)
    return None

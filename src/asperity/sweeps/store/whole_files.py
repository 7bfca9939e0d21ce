"""Files of a store, which are on the disk or not there, whatever kills the process."""

from __future__ import annotations

import contextlib
import functools
import os
import shutil
from collections.abc import Mapping
from pathlib import Path

from asperity import writing

told = functools.partial(
    writing.told,
    if_full="; what was finished is kept, `--resume` goes on once there is room",
)
"""Failures of the system as `OutputError`, with the path, the reason and what to do."""


def put(path: Path, content: bytes, aside: Path) -> None:
    """Write a file aside, wait until it is on the disk, and rename it.

    Parameters
    ----------
    path : Path
        The file, which may be there.
    content : bytes
        What it shall hold.
    aside : Path
        Where it is written first, on the same file system. A process that is killed may leave it.

    Raises
    ------
    OutputError
        Where it cannot be written; an earlier file is then as it was.
    """
    with told(path):
        try:
            with aside.open("wb") as file:
                file.write(content)
                file.flush()
                os.fsync(file.fileno())
            aside.replace(path)
        except OSError:
            with contextlib.suppress(OSError):
                aside.unlink(missing_ok=True)
            raise


def settle(folder: Path) -> None:
    """Wait until the names in a folder are on the disk, where its file system can tell."""
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def put_all(folder: Path, files: Mapping[str, bytes]) -> None:
    """Make a folder with these files in it.

    Parameters
    ----------
    folder : Path
        The folder.
    files : mapping of str to bytes
        Contents by name.

    Raises
    ------
    OutputError
        Where one cannot be written.
    """
    for name, content in files.items():
        file = folder / name
        with told(file):
            file.parent.mkdir(parents=True, exist_ok=True)
        put(file, content, beside(file, ".part"))
    for name in files:
        settle((folder / name).parent)


def beside(path: Path, ending: str) -> Path:
    """The neighbour of a store whose name has more at its end."""
    return path.with_name(path.name + ending)


def clear(path: Path) -> None:
    """Remove a folder so that it is never seen half removed.

    Raises
    ------
    OutputError
        Where it cannot be removed.
    """
    old = beside(path, ".old")
    with told(path):
        if old.exists():
            shutil.rmtree(old)
        if path.exists():
            path.rename(old)
            shutil.rmtree(old)

"""Which tasks of a store are finished, and the hash of each of their chunks.

A file of JSON lines beside the store: a header, and one line a finished task, appended once its
chunks are on the disk. A task without a line is not finished, whatever files there are.
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Collection, Iterator, Mapping
from io import FileIO
from pathlib import Path
from typing import Any

from asperity.errors import InputError, OutputError
from asperity.sweeps.store.whole_files import beside, put, settle, told
from asperity.units import shown

try:
    import fcntl
except ImportError:  # not a POSIX system: nothing keeps a second writer out
    fcntl = None  # type: ignore[assignment]

SCHEMA = 3
"""Version of stores and manifests that this program writes."""


class Manifest:
    """The finished tasks of one store.

    Parameters
    ----------
    path : Path
        The file.
    fingerprint : str
        Of the study.
    chunks : mapping
        For each finished task the SHA-256 of each column's chunk, in hexadecimal.
    """

    def __init__(
        self, path: Path, fingerprint: str, chunks: Mapping[int, dict[str, str]] | None = None
    ) -> None:
        self.path = path
        self.fingerprint = fingerprint
        self.chunks = dict(chunks or {})
        self._file: FileIO | None = None

    @classmethod
    def read(cls, path: Path) -> Manifest:
        """The manifest in a file; lines that are torn or foreign do not count.

        Raises
        ------
        InputError
            Where there is none, or its header is of no manifest or of a newer schema.
        """
        chunks: dict[int, dict[str, str]] = {}
        try:
            with path.open("rb") as file:
                fingerprint = _header(path, file.readline())
                for line in file:
                    chunks.update(_task(line))
        except OSError as error:
            reason = error.strerror or error
            raise InputError(f"{path}: cannot be read: {reason}", file=str(path)) from error
        return cls(path, fingerprint, chunks)

    def begin(self) -> None:
        """Write the header and what is finished, and keep the file open for more.

        Raises
        ------
        OutputError
            Where it cannot be written, or another process writes this store.
        """
        self.end()
        put(self.path, b"".join(self._lines()), beside(self.path, ".part"))
        settle(self.path.parent)
        self.hold()

    def hold(self) -> None:
        """Open the file for more lines, for this process alone; a torn last line goes.

        Raises
        ------
        OutputError
            As `begin`.
        """
        with told(self.path):
            self._file = self.path.open("r+b", buffering=0)
            if fcntl is not None:
                try:
                    fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                except BlockingIOError:
                    self.end()
                    raise OutputError(
                        f"{self.path}: cannot be written: another process computes this sweep",
                        path=str(self.path),
                    ) from None
                except OSError:  # a file system without locks
                    pass
            content = self._file.read()
            self._file.truncate(content.rfind(b"\n") + 1)
            self._file.seek(0, os.SEEK_END)

    def append(self, task: int, chunks: dict[str, str]) -> None:
        """Count a task as finished.

        Parameters
        ----------
        task : int
            Its number.
        chunks : dict
            Hash of each column's chunk, in the order of the columns.

        Raises
        ------
        OutputError
            Where the line cannot be written; the task then does not count.
        """
        if self._file is None:
            raise ValueError("the manifest is not open for writing")
        before = self._file.tell()
        with told(self.path):
            try:
                line = _line(task, chunks)
                while line:
                    line = line[self._file.write(line) :]
                os.fsync(self._file.fileno())
            except OSError:
                with contextlib.suppress(OSError):
                    self._file.truncate(before)
                self.end()
                raise
        self.chunks[task] = chunks

    def forget(self, tasks: Collection[int]) -> None:
        """Count tasks as not finished."""
        for task in tasks:
            self.chunks.pop(task, None)
        self.begin()

    def end(self) -> None:
        """Close the file."""
        if self._file is not None:
            with contextlib.suppress(OSError):
                self._file.close()
            self._file = None

    def _lines(self) -> Iterator[bytes]:
        """The whole file, in the order of the tasks."""
        header = {"schema": SCHEMA, "fingerprint": self.fingerprint}
        yield _compact(header)
        for task in sorted(self.chunks):
            yield _line(task, self.chunks[task])


def manifest_of(path: Path) -> Path:
    """The file that says what of a store is finished."""
    return beside(path, ".manifest")


def _line(task: int, chunks: dict[str, str]) -> bytes:
    return _compact({"task": task, "chunks": chunks})


def _compact(record: dict[str, Any]) -> bytes:
    return json.dumps(record, separators=(",", ":")).encode() + b"\n"


def _header(path: Path, line: bytes) -> str:
    """Fingerprint in a manifest's first line."""
    try:
        header = json.loads(line)
        schema, fingerprint = header["schema"], header["fingerprint"]
    except (ValueError, TypeError, KeyError):
        raise InputError(
            f"{path}: must begin with the header of a manifest; got {shown(line[:40])}",
            file=str(path),
        ) from None
    refuse_newer(path, schema)
    return str(fingerprint)


def refuse_newer(path: Path, schema: object) -> None:
    """Refuse a store of another schema than this program's.

    Raises
    ------
    InputError
        With the schema that was found.
    """
    if schema != SCHEMA:
        hint = ""
        if isinstance(schema, int):
            age = "a newer" if schema > SCHEMA else "an earlier"
            hint = f" - {age} asperity wrote it"
        raise InputError(
            f"{path}: `schema` must be {SCHEMA}; got {shown(schema)}{hint}", file=str(path)
        )


def _task(line: bytes) -> dict[int, dict[str, str]]:
    """Task and hashes of a line; nothing where it is torn."""
    if not line.endswith(b"\n"):
        return {}
    try:
        record = json.loads(line)
        return {int(record["task"]): {str(k): str(v) for k, v in record["chunks"].items()}}
    except (ValueError, TypeError, KeyError, AttributeError):
        return {}

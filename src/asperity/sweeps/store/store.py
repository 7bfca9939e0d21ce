"""The store of a study: one zarr array a column, one chunk a task, a manifest beside it.

A chunk is written aside, synchronized and renamed, and the task then enters the manifest: a
process killed at any moment loses the tasks in flight alone. Nothing in the store depends on when,
where or in which order the tasks were computed.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import math
import os
import shutil
from collections.abc import Collection, Iterable, Mapping, Set
from pathlib import Path

import numpy as np
from numcodecs.zstd import Zstd  # type: ignore[import-untyped]

from asperity.config.problems import among
from asperity.errors import InputError
from asperity.sweeps.store.array import (
    LEVEL,
    METADATA,
    Array,
    corrupt,
    metadata,
    other_study,
    read_group,
    refuse_other_cut,
    stored,
)
from asperity.sweeps.store.manifest import Manifest, manifest_of
from asperity.sweeps.store.whole_files import beside, clear, put, put_all, settle, told
from asperity.sweeps.study.columns import Column
from asperity.sweeps.study.study import Study, parse

REPAIR = "`asperity sweep STUDY --repair` computes it again"
"""What to do about a chunk that is not what was written."""


class Store:
    """The results of one study on disk; made by `create` or `open`.

    Parameters
    ----------
    path : Path
        Folder of the zarr group.
    arrays : mapping of str to Array
        What the folder holds, by column.
    text : str
        The study, as its canonical text.
    manifest : Manifest
        What of it is finished.
    """

    def __init__(
        self, path: Path, arrays: Mapping[str, Array], text: str, manifest: Manifest
    ) -> None:
        self.path = path
        self.arrays = dict(arrays)
        self.text = text
        self.manifest = manifest
        self._codec = Zstd(level=LEVEL, checksum=True)
        self.blocks = next(iter(self.arrays.values())).blocks
        self.size, self.tasks = math.prod(self.blocks.shape), self.blocks.count

    @classmethod
    def create(cls, path: str | Path, study: Study) -> Store:
        """A new store, open for writing.

        Raises
        ------
        InputError
            Where something of this name is there already.
        OutputError
            Where nothing can be written there.
        """
        return cls._make(Path(path), metadata(study), study.fingerprint)

    @classmethod
    def like(cls, path: str | Path, other: Store) -> Store:
        """A new store of another's study, open for writing.

        Raises
        ------
        InputError, OutputError
            As `create`.
        """
        axes = [file for file in other.path.glob("*/*") if file.parent.name not in other.arrays]
        names = [other.path / METADATA, *(other.path / name / METADATA for name in other.arrays)]
        files = {
            file.relative_to(other.path).as_posix(): file.read_bytes() for file in names + axes
        }
        return cls._make(Path(path), files, other.fingerprint)

    @classmethod
    def _make(cls, path: Path, files: Mapping[str, bytes], fingerprint: str) -> Store:
        """A store with these metadata files, made aside and renamed."""
        if path.exists() or path.is_symlink():
            raise InputError(
                f"{path}: must not be there yet; `--resume` goes on with it, `--force` replaces it",
                file=str(path),
            )
        new = beside(path, ".new")
        manifest = Manifest(manifest_of(path), fingerprint)
        clear(new)
        try:
            with told(path):
                put_all(new, files)
                manifest.begin()
                new.rename(path)
            settle(path.parent)
            group = read_group(path)
        except BaseException:
            manifest.end()
            shutil.rmtree(new, ignore_errors=True)
            raise
        return cls(path, group.arrays, group.text, manifest)

    @classmethod
    def open(
        cls,
        path: str | os.PathLike[str],
        study: Study | None = None,
        *,
        writable: bool = False,
    ) -> Store:
        """A store that is there.

        Parameters
        ----------
        path : path
            Its folder.
        study : Study, optional
            The study that it must belong to.
        writable : bool
            Whether more is to be written.

        Raises
        ------
        InputError
            Where there is no store, or one of another study or of a newer schema, or its metadata
            cannot be read.
        OutputError
            Where it is to be written and cannot be.
        """
        path = Path(path)
        group = read_group(path)
        if study is not None:
            if group.fingerprint != study.fingerprint:
                raise other_study(path)
            refuse_other_cut(path, group.arrays["outcome"], study)
        file = manifest_of(path)
        there = file.exists()
        manifest = Manifest.read(file) if there else Manifest(file, group.fingerprint)
        if manifest.fingerprint != group.fingerprint:
            raise InputError(
                f"{file}: must be the manifest of {path}; it is another's", file=str(file)
            )
        known = {name for chunks in manifest.chunks.values() for name in chunks}
        for name in known | {column.name for column in (stored(study) if study else ())}:
            if name not in group.arrays:
                raise corrupt(path / name / METADATA, "No such file")
        if writable and there:
            manifest.hold()
        elif writable:
            manifest.begin()
        return cls(path, group.arrays, group.text, manifest)

    @property
    def fingerprint(self) -> str:
        """Of the study."""
        return self.manifest.fingerprint

    @functools.cached_property
    def study(self) -> Study:
        """The study.

        Raises
        ------
        InputError
            Where this version of the program cannot read it.
        """
        return parse(self.text, file=str(self.path))

    @property
    def columns(self) -> dict[str, Column]:
        """What the study keeps of each case, by name."""
        return {column.name: column for column in self.study.columns}

    def checked(self, names: Iterable[str]) -> list[str]:
        """Names of columns, once each.

        Raises
        ------
        InputError
            Where the study has not kept one of them, or its array is missing.
        """
        wanted = list(dict.fromkeys(names))
        for name in wanted:
            rule = f"{self.path}: a column must be one of {', '.join(self.columns)}"
            among(name, self.columns, rule, file=str(self.path))
            if name not in self.arrays:
                raise InputError(
                    f"{self.path}: must hold an array {name}; it is missing - {REPAIR}",
                    file=str(self.path),
                )
        return wanted

    def refuse_empty(self) -> None:
        """Refuse a store in which nothing is computed yet.

        Raises
        ------
        InputError
            Where no task is finished.
        """
        if not self.done:
            raise InputError(
                f"{self.path}: must hold results; none is computed yet - `asperity sweep STUDY "
                "--resume` goes on",
                file=str(self.path),
            )

    @property
    def done(self) -> Set[int]:
        """Numbers of the finished tasks."""
        return self.manifest.chunks.keys()

    @property
    def cases_done(self) -> int:
        """Number of cases in finished tasks."""
        return sum(len(self.blocks.cases(task)) for task in self.done)

    def write(self, task: int, columns: Mapping[str, np.ndarray]) -> None:
        """Keep the results of a task.

        Parameters
        ----------
        task : int
            Its number.
        columns : mapping of str to ndarray
            Every column, of shape (cases of the task[, width]).

        Raises
        ------
        OutputError
            Where it cannot be written; the task then counts as not finished.
        ValueError
            Where a column is missing, or its type or shape is another.
        """
        if set(columns) != set(self.arrays):
            raise ValueError(f"columns must be {', '.join(self.arrays)}; got {', '.join(columns)}")
        hashes = {}
        for name, array in self.arrays.items():
            content = self._codec.encode(array.chunk(task, columns[name]))
            self._put(name, task, content)
            hashes[name] = hashlib.sha256(content).hexdigest()
        self._mark_complete(task, hashes)

    def adopt(self, task: int, chunks: Mapping[str, bytes], hashes: dict[str, str]) -> None:
        """Keep chunks as another store of the study has them.

        Raises
        ------
        OutputError
            As `write`.
        """
        for name in self.arrays:
            self._put(name, task, chunks[name])
        self._mark_complete(task, hashes)

    def _put(self, name: str, task: int, content: bytes) -> None:
        put(self.chunk_file(task, name), content, beside(self.path, ".part"))

    def _mark_complete(self, task: int, hashes: dict[str, str]) -> None:
        for name in self.arrays:
            settle(self.path / name)
        self.manifest.append(task, hashes)

    def chunk_file(self, task: int, name: str) -> Path:
        """File of a column's chunk."""
        return self.path / name / self.arrays[name].key(task)

    def content(self, task: int, name: str) -> bytes | None:
        """Bytes of a column's chunk; None where they are not those that were written."""
        try:
            found = self.chunk_file(task, name).read_bytes()
        except OSError:
            return None
        wanted = self.manifest.chunks[task].get(name)
        return found if hashlib.sha256(found).hexdigest() == wanted else None

    def check(self) -> list[tuple[int, str]]:
        """The chunks of finished tasks that are missing or not what was written.

        Returns
        -------
        list of tuple
            Task and column of each.
        """
        return [
            (task, name)
            for task in sorted(self.done)
            for name in self.arrays
            if self.content(task, name) is None
        ]

    def read(self, task: int, name: str) -> np.ndarray:
        """A column of a finished task, shape (cases of the task[, width]).

        Raises
        ------
        InputError
            Where the chunk is missing or not what was written.
        """
        return self.arrays[name].values(task, self._codec.decode(self.sound(task, name)))

    def sound(self, task: int, name: str) -> bytes:
        """Bytes of a column's chunk.

        Raises
        ------
        InputError
            Where they are missing or not those that were written.
        """
        content = self.content(task, name)
        if content is None:
            raise InputError(
                f"{self.chunk_file(task, name)}: must be what was written "
                f"(column {name}, task {task}); it is not - {REPAIR}",
                file=str(self.path),
            )
        return content

    def column(self, name: str) -> np.ndarray:
        """A whole column, shape (cases[, width]); where a task is not finished, what fills it.

        Raises
        ------
        InputError
            As `read`.
        """
        array = self.arrays[name]
        whole = np.full((self.size, *array.width), array.fill, array.dtype)
        for task in self.done:
            cases = self.blocks.cases(task)
            whole[cases.start : cases.stop] = self.read(task, name)
        return whole

    def forget(self, tasks: Collection[int]) -> None:
        """Count tasks as not finished, so that they are computed again.

        Raises
        ------
        OutputError
            Where the manifest cannot be written.
        """
        self.manifest.forget(tasks)

    def finish(self) -> None:
        """Bring the manifest into the order of the tasks, and remove what was aside.

        Raises
        ------
        OutputError
            Where the manifest cannot be written.
        """
        self.manifest.begin()
        self.close()

    def close(self) -> None:
        """Let go of the store; what is finished stays."""
        self.manifest.end()
        with contextlib.suppress(OSError):
            beside(self.path, ".part").unlink(missing_ok=True)

"""Shards of one study: which tasks each computes, and one store made of their stores."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from asperity.errors import InputError
from asperity.sweeps.store.manifest import manifest_of
from asperity.sweeps.store.repair import remove
from asperity.sweeps.store.store import Store
from asperity.sweeps.store.whole_files import beside, settle, told
from asperity.units import shown


class Shard(NamedTuple):
    """One of several parts of a study.

    Attributes
    ----------
    number
        Which one, from 1.
    of
        How many there are.
    """

    number: int
    of: int

    def tasks(self, tasks: int) -> range:
        """Its tasks, of a study with so many."""
        return range(self.number - 1, tasks, self.of)

    def store(self, whole: Path) -> Path:
        """Where it keeps its part of a store."""
        return whole.with_name(f"{whole.stem}.{self.number}-of-{self.of}{whole.suffix or '.zarr'}")


def shard(text: str) -> Shard:
    """A part as ``"2/10"`` names it.

    Raises
    ------
    InputError
        Where the text is not so, or there is no such part.
    """
    match = re.fullmatch(r"\s*([0-9]{1,9})\s*/\s*([0-9]{1,9})\s*", text)
    if match is None or not 1 <= int(match[1]) <= int(match[2]):
        raise InputError(
            f"`--shard` must be i/N with i from 1 to N, such as 2/10; got {shown(text)}"
        )
    return Shard(int(match[1]), int(match[2]))


def whole(part: Path) -> Path:
    """The store that a shard's store is a part of.

    Raises
    ------
    InputError
        Where its name is not that of a shard's store.
    """
    match = re.fullmatch(r"(.+)\.[0-9]+-of-[0-9]+(\.[^.]*)", part.name)
    if match is None:
        raise InputError(
            f"`--output` must be given where the stores have other names than "
            f"NAME.1-of-4.zarr; got {part}"
        )
    return part.with_name(match[1] + match[2])


def join(
    output: str | Path,
    stores: Sequence[str | Path],
    *,
    replace: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> Store:
    """One store of all that several stores of a study hold.

    Parameters
    ----------
    output : path
        The store to make.
    stores : sequence of path
        Stores of the same study; they may have tasks in common.
    replace : bool
        Whether an earlier store of this name goes, once the stores are known to fit.
    progress : callable, optional
        Told how many tasks are copied, of how many.

    Returns
    -------
    Store
        The new store, for reading. Tasks that no store has are missing in it.

    Raises
    ------
    InputError
        Where the output is there already, the stores are of different studies or have a task in
        common and differ in it, or a chunk is not what was written.
    OutputError
        Where the new store cannot be written.
    """
    output = Path(output)
    if output.exists() and not replace:
        raise InputError(
            f"{output}: must not be there yet; `--force` replaces it", file=str(output)
        )
    parts = [Store.open(path) for path in stores]
    source = _sources(parts)
    aside = beside(output, ".merged")
    remove(aside)
    _copy(source, Store.like(aside, parts[0]), progress)
    if replace:
        remove(output)
    with told(output):
        manifest_of(aside).replace(manifest_of(output))
        aside.rename(output)
    settle(output.parent)
    return Store.open(output)


def _copy(
    source: dict[int, Store], joined: Store, progress: Callable[[int, int], None] | None
) -> None:
    """Fill a store from others; where that fails nothing is left of it."""
    try:
        for count, task in enumerate(sorted(source)):
            part = source[task]
            chunks = {name: part.sound(task, name) for name in joined.arrays}
            joined.adopt(task, chunks, part.manifest.chunks[task])
            if progress is not None:
                progress(count + 1, len(source))
        joined.finish()
    except BaseException:
        joined.close()
        remove(joined.path)
        raise


def _sources(parts: Sequence[Store]) -> dict[int, Store]:
    """The store that each task is taken from."""
    source: dict[int, Store] = {}
    for part in parts:
        if part.fingerprint != parts[0].fingerprint or part.arrays != parts[0].arrays:
            raise InputError(
                f"{part.path}: must be of the same study as {parts[0].path}; it is not",
                file=str(part.path),
            )
        for task in part.done:
            other = source.setdefault(task, part)
            for name, digest in part.manifest.chunks[task].items():
                if other.manifest.chunks[task].get(name) != digest:
                    raise InputError(
                        f"{part.chunk_file(task, name)}: must be the same as "
                        f"{other.chunk_file(task, name)} (task {task} is in both); it differs",
                        file=str(part.path),
                    )
    return source

"""``asperity merge``: the stores of a study's shards into one."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from asperity.cli.reporter import Reporter
from asperity.cli.tallying import about, lines
from asperity.errors import InputError

_NAMED = 8
"""Tasks that a message names."""


def merge(
    stores: Sequence[str],
    *,
    output: str | None = None,
    force: bool = False,
    **manner: bool,
) -> None:
    """Make one store of those of a study's shards, and say what it holds.

    Parameters
    ----------
    stores : sequence of str
        The stores.
    output : str or None
        The store to make, NAME.zarr for NAME.i-of-N.zarr unless given.
    force : bool
        Whether a store that is there may be replaced.
    **manner : bool
        As `Reporter` takes them.
    """
    from asperity.sweeps.store.merge import join, whole

    reporter = Reporter(**manner)
    path = Path(output) if output is not None else whole(Path(stores[0]))
    if path.resolve() in {Path(store).resolve() for store in stores}:
        raise InputError(f"`--output` must be none of the stores to merge; got {path}")
    with reporter.watch(compiles=False) as bar:

        def copied(count: int, of: int) -> None:
            if bar is not None:
                bar(count / of, f"{count:,} of {of:,} tasks")

        joined = join(path, stores, replace=force, progress=copied)
    reporter.answer(lambda: "\n".join(lines(joined)), lambda: about(joined))
    missing = [task for task in range(joined.tasks) if task not in joined.done]
    if missing:
        named = ", ".join(str(task) for task in missing[:_NAMED])
        more = f" and {len(missing) - _NAMED:,} more" if len(missing) > _NAMED else ""
        reporter.note(
            f"asperity: {path}: tasks {named}{more} are missing in the stores; "
            f"`asperity sweep STUDY -o {path} --resume` computes them"
        )

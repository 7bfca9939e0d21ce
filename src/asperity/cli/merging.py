"""``asperity merge``: the stores of a study's shards into one."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from asperity.cli import shell_completion
from asperity.cli.arguments import Replace, StoreName, argument, reports
from asperity.cli.reporter import Reporter
from asperity.cli.tallying import about, lines
from asperity.errors import InputError

_NAMED = 8
"""Tasks that a message names."""


@reports()
def merge(
    reporter: Reporter,
    stores: Annotated[
        list[str],
        argument("Stores of shards.", "STORE...", values=shell_completion.store),
    ],
    output: StoreName = None,
    force: Replace = False,
) -> None:
    """Make one store of those of a study's shards."""
    from asperity.sweeps.store.merge import join, whole

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

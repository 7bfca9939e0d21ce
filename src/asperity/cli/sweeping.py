"""``asperity sweep``: a study into a store."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from asperity.cli.arguments import Replace, StoreName, StudyFile, optional, reports
from asperity.cli.reporter import Reporter
from asperity.cli.tallying import about, lines, lines_of, progress_of, took
from asperity.cli.terminal import exit_code_of, say
from asperity.cli.working import Progress, Work
from asperity.errors import InputError

if TYPE_CHECKING:
    from asperity.sweeps.compute.runner import Runner, Tally
    from asperity.sweeps.store.merge import Shard
    from asperity.sweeps.store.store import Store
    from asperity.sweeps.study.study import Study

MOST_CASES = 10_000_000
MOST_BYTES = 2_000_000_000
"""Larger studies need ``--yes``."""


class _Request(NamedTuple):
    """What to compute, where to, and by whom."""

    study: Study
    path: Path
    shard: Shard | None
    workers: int | None
    scheduler: str | None


@reports()
def sweep(
    reporter: Reporter,
    study: StudyFile,
    output: StoreName = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with a store that is there.")
    ] = False,
    repair: Annotated[
        bool, typer.Option("--repair", help="Look through a store; compute damaged tasks again.")
    ] = False,
    shard: Annotated[
        str | None, optional("shard", "i/N", "Compute the i-th of N parts, for a job array.")
    ] = None,
    workers: Annotated[
        int | None, optional("workers", "N", "Worker processes of a local dask cluster.")
    ] = None,
    scheduler: Annotated[
        str | None, optional("scheduler", "ADDRESS", "A dask scheduler whose workers compute.")
    ] = None,
    yes: Annotated[bool, typer.Option("--yes", help="Compute a very large study.")] = False,
    force: Replace = False,
) -> None:  # fmt: skip
    """Compute all cases of a study.

    Writes the store NAME.zarr and, beside it, its manifest and a log. What was finished before an
    interruption is kept.
    """
    from asperity.sweeps.compute.runner import one_thread

    one_thread(at_once=True)
    _refuse_both(force=force, resume=resume)
    _refuse_both(force=force, repair=repair)
    _refuse_both(workers=workers is not None, scheduler=scheduler is not None)
    if workers is not None and workers < 1:
        raise InputError(f"`--workers` must be at least 1; got {workers}")
    request = _request(study, output, shard, workers, scheduler)
    for warning in request.study.warnings:
        reporter.note(f"asperity: {warning}")
    _refuse_huge(request.study, yes)
    store, tasks = _opened(request, reporter, resume=resume, repair=repair, force=force)
    tally, code = _filled(request, store, tasks, reporter)
    _tell_sweep(request, store, tally, code, reporter)
    if code:
        raise typer.Exit(code)


def _refuse_both(**options: bool) -> None:
    """Refuse two options of which one excludes the other."""
    if all(options.values()):
        one, other = options
        raise InputError(f"`--{one}` must be given without `--{other}`; got both")


def _request(
    study: str, output: str | None, part: str | None, workers: int | None, scheduler: str | None
) -> _Request:
    from asperity.sweeps.store import merge
    from asperity.sweeps.study.study import read

    shard = None if part is None else merge.shard(part)
    path = Path(output or f"{Path(study).stem}.zarr")
    path = path if shard is None else shard.store(path)
    return _Request(read(study), path, shard, workers, scheduler)


def _refuse_huge(study: Study, yes: bool) -> None:
    """Refuse a study that is large by mistake."""
    import numpy as np

    a_case = sum(
        np.dtype(column.dtype).itemsize * (study.width(column.along) if column.along else 1)
        for column in study.columns
        if column.along != "byte"  # text, nearly all of it empty
    )
    size = study.size * a_case
    if not yes and (study.size > MOST_CASES or size > MOST_BYTES):
        raise InputError(
            f"`--yes` must be given above {MOST_CASES:,} cases or {MOST_BYTES / 1e9:.0f} GB; "
            f"got {study.size:,} cases, {size / 1e9:.3g} GB"
        )


def _opened(
    request: _Request, reporter: Reporter, *, resume: bool, repair: bool, force: bool
) -> tuple[Store, Sequence[int]]:
    """The store, open for writing, and the tasks wanted of it."""
    from asperity.sweeps.store.repair import remove
    from asperity.sweeps.store.store import Store

    study, path = request.study, request.path
    tasks = range(study.tasks) if request.shard is None else request.shard.tasks(study.tasks)
    if repair:
        store, damaged = _mended(request, reporter)
        return store, tasks if resume else damaged
    if force:
        remove(path)
    if path.exists() and (resume or _is_empty(path, study)):
        return Store.open(path, study, writable=True), tasks
    return Store.create(path, study), tasks


def _is_empty(path: Path, study: Study) -> bool:
    """Whether a store is this study's and holds nothing: one that could not begin left it."""
    from asperity.sweeps.store.store import Store

    try:
        return not Store.open(path, study).done
    except InputError:
        return False


def _mended(request: _Request, reporter: Reporter) -> tuple[Store, Sequence[int]]:
    """The store with nothing in it that is not as it was written, and the tasks that went."""
    from asperity.sweeps.store.repair import mend
    from asperity.sweeps.store.store import Store

    for file in mend(request.path, request.study):
        reporter.note(f"asperity: {file}: written again")
    store = Store.open(request.path, request.study, writable=True)
    damaged = store.check()
    for task, name in damaged:
        chunk = store.chunk_file(task, name)
        reporter.note(f"asperity: {chunk}: column {name}, task {task} is corrupt")
    tasks = sorted({task for task, _ in damaged})
    if tasks:
        store.forget(tasks)
    return store, tasks


@contextlib.contextmanager
def _runner(request: _Request) -> Iterator[Runner]:
    """What computes."""
    if request.workers is None and request.scheduler is None:
        from asperity.sweeps.compute.runner import in_process

        yield in_process
        return
    from asperity.sweeps.compute.clients import connected, local
    from asperity.sweeps.compute.cluster import on_cluster

    with (
        local(request.workers) if request.workers is not None else connected(str(request.scheduler))
    ) as client:
        yield on_cluster(client)


def _filled(
    request: _Request, store: Store, tasks: Sequence[int], reporter: Reporter
) -> tuple[Tally | None, int]:
    """What the run did, None where it did not stop in time; and its exit code."""
    from asperity.sweeps.compute.log import Log
    from asperity.sweeps.compute.runner import fill
    from asperity.sweeps.store.whole_files import beside

    log = Log(beside(request.path, ".log"))
    log.begin(f"{len(store.done)} of {store.tasks} tasks are finished")

    def task(stop: threading.Event, bar: Progress | None) -> Tally:
        def kept(task: int, effort: Any, tally: Tally) -> None:
            log.task(task, effort, tally)
            for case, line in effort.warned:
                log.write(f"case {case}: {line}")
            reporter.detail(f"task {task}: {effort.cases:,} cases in {effort.wall:.3g} s")
            if bar is not None:
                bar(tally.cases / tally.cases_wanted, progress_of(tally))

        if bar is not None:
            bar(0.0, "tasks (the first are compiled)")
        with _runner(request) as runner:
            return fill(request.study, store, runner, tasks=tasks, progress=kept, stop=stop)

    with reporter.watch() as bar:
        try:
            tally, code = Work(lambda stop: task(stop, bar)).wait()
        except KeyboardInterrupt as impatience:  # a second Ctrl-C
            tally, code = None, exit_code_of(impatience)
    log.write(f"ends; {len(store.done)} of {store.tasks} tasks are finished")
    return tally, code


def _tell_sweep(
    request: _Request, store: Store, tally: Tally | None, code: int, reporter: Reporter
) -> None:
    """What is in the store now, and what this run took."""
    if code:
        say(
            f"asperity: interrupted; {store.cases_done:,} of {store.size:,} cases are kept in "
            f"{store.path}, `--resume` goes on with them",
            whole=True,
        )
    if reporter.as_json or not code:
        reporter.answer(
            lambda: "\n".join([*lines(store), *lines_of(tally)]),
            lambda: about(store) | took(tally),
        )
    if tally is not None and not reporter.as_json:
        for warning in tally.warnings:
            reporter.note(f"asperity: {warning}")
    missing = store.size - store.cases_done
    if missing and not code and request.shard is None:
        reporter.note(f"asperity: {missing:,} cases are missing yet; `--resume` computes them")

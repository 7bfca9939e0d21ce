"""``asperity run``, ``curve`` and ``restitution``: from a case to files or JSON."""

from __future__ import annotations

import dataclasses
import importlib
import json
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from asperity.cli.reporter import Reporter
from asperity.cli.speeds import speeds_of, turn_of
from asperity.cli.terminal import say
from asperity.cli.working import Progress, Work
from asperity.errors import InputError, Outcome, SimulationError
from asperity.results import summary
from asperity.results.case_source import Source, source_of
from asperity.results.read_record import read
from asperity.results.record_layout import json_object
from asperity.results.result import Curve, Result
from asperity.results.results_folder import (
    CURVE_FILES,
    RESTITUTION_FILES,
    RUN_FILES,
    SINGLE_BODY_FILES,
    check_folder,
    holds_only_results,
    write_folder,
)

if TYPE_CHECKING:
    from asperity.sweeps.restitution_curve import RestitutionCurve

    Answer = Result | Curve | RestitutionCurve

_FILES = {
    "solve": (*RUN_FILES, *SINGLE_BODY_FILES),
    "curve": CURVE_FILES,
    "restitution_curve": RESTITUTION_FILES,
}


@dataclasses.dataclass(frozen=True)
class _Request:
    """What to compute and what to do with it."""

    what: str
    source: Source
    folder: Path | None
    force: bool
    earlier: bool
    reporter: Reporter
    given: Mapping[str, Any]
    published: bool | None


def run(reporter: Reporter, case: str, *, publication: bool, **options: Any) -> None:
    """Compute a motion, keep it and say what came out; ``options`` are ``output`` and ``force``."""
    _compute("solve", reporter, case, published=publication or None, **options)


def curve(
    reporter: Reporter, case: str, *, load: str | None, depth: str | None, **options: Any
) -> None:
    """As `run` for force against separation, which turns at a load or a depth."""
    _compute("curve", reporter, case, given=turn_of(load, depth), **options)


def restitution(
    reporter: Reporter, case: str, *, speeds: str | None, points: int | None, **options: Any
) -> None:
    """As `run` for restitution against speed."""
    _compute("restitution_curve", reporter, case, given=speeds_of(speeds, points), **options)


def _compute(
    what: str,
    reporter: Reporter,
    case: str,
    *,
    output: str | None,
    force: bool,
    given: Mapping[str, Any] | None = None,
    published: bool | None = None,
) -> None:
    """Compute ``what``, a function of this program that takes a case and what is ``given``."""
    named = source_of(case)
    folder, earlier = None, False
    if output is not None or not reporter.as_json:
        folder = Path(output or named.case.output.directory or f"{named.case.name}-out")
        earlier = _earlier(folder, what, named)
        force = force or earlier
        check_folder(folder, _FILES[what], force=force)
    request = _Request(what, named, folder, force, earlier, reporter, given or {}, published)
    try:
        with reporter.watch() as progress:
            work = Work(lambda stop: _task(request, stop, progress))
            result, code = work.wait()
    except InputError as error:
        error.file = error.file or named.file
        raise
    except SimulationError as error:
        if isinstance(error.partial, Result):
            _deliver(_sourced(error.partial, request.source), request, 0)
        raise
    if result is not None:
        code = _deliver(_sourced(result, request.source), request, code)
    elif code:
        say("asperity: interrupted before there was anything to keep", whole=True)
    if code:
        raise typer.Exit(code)


def _earlier(folder: Path, what: str, named: Source) -> bool:
    """Whether a folder holds an earlier answer for this case file, and no other file.

    Such an answer is replaced without being asked, also where the file was edited since. It is
    known by its own record, whole.
    """
    if named.case_file is None or not holds_only_results(folder):
        return False
    try:
        if what != "restitution_curve":
            kind = "record.nc" if what == "solve" else "curve.nc"
            return read(folder / kind).case_file == named.case_file
        told = json.loads((folder / "restitution.json").read_bytes())
        return isinstance(told, dict) and told.get("case_file") == named.case_file
    except (InputError, OSError, ValueError):
        return False


def _task(request: _Request, stop: threading.Event, progress: Progress | None) -> Answer:
    """Load what computes, and compute; in a thread of its own."""
    home = "sweeps.restitution_curve" if request.what == "restitution_curve" else "solver"
    function = getattr(importlib.import_module(f"asperity.{home}"), request.what)
    named, tell = request.source, progress
    if request.folder is not None:
        tell = _importing(progress)
    answer: Answer = function(named.case, progress=tell, stop=stop, **request.given)
    return answer


def _importing(progress: Progress | None) -> Progress:
    """The same progress, which imports what writes and draws once there is nothing to do but wait.

    Sooner it would keep Python from tracing, later it would be waited for.
    """
    from asperity.integration import COMPILATION

    imports = threading.Thread(target=_import_ahead, daemon=True)

    def tell(fraction: float, text: str) -> None:
        if text.startswith(COMPILATION) and imports.ident is None:
            imports.start()
        if progress is not None:
            progress(fraction, text)

    return tell


def _import_ahead() -> None:
    """Import what writes and draws: a second less to wait for in the end."""
    for name in ("asperity.plots", "matplotlib.backends.backend_agg"):
        importlib.import_module(name)


def _sourced(result: Answer, source: Source) -> Answer:
    """The result with the hash of its input, and with its case file."""
    return dataclasses.replace(result, input_sha256=source.input_sha256, case_file=source.case_file)


def _deliver(result: Answer, request: _Request, code: int) -> int:
    """Write the files and print the answer; the exit code, an interruption's if one came."""
    written, code = _keep(result, request, code)
    if code:
        say(f"asperity: {Outcome.INTERRUPTED.message}", whole=True)
    request.reporter.answer(lambda: _brief(result, request), lambda: _object(result))
    request.reporter.written(written, earlier=request.earlier)
    return code


def _brief(result: Answer, request: _Request) -> str:
    if isinstance(result, Curve):
        return summary.brief_curve(result)
    if isinstance(result, Result):
        return summary.brief(result, published=request.published)
    return result.summary()


def _object(result: Answer) -> dict[str, Any]:
    return json_object(result) if isinstance(result, Result | Curve) else result.json_object()


def _files(result: Answer, request: _Request, **manner: bool) -> dict[str, bytes]:
    if isinstance(result, Result):
        return result.files(published=request.published, **manner)
    return result.files(**manner)


def _keep(result: Answer, request: _Request, code: int) -> tuple[Sequence[Path], int]:
    """Write the files; without pictures, which take a second, where time presses."""
    if request.folder is None:
        return [], code
    own = _FILES[request.what]
    files = None
    if not code:
        # In a thread, where no interruption can be lost in a callback of somebody else's.
        with request.reporter.step("record and pictures"):
            files, code = Work(lambda stop: _files(result, request)).wait()
    files = files or _files(result, request, pictures=False)
    with request.reporter.step("files"):
        return write_folder(request.folder, files, own, force=request.force), code

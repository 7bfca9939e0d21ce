"""``asperity sensitivity``: how much of a measure's variance each axis of a study makes."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from asperity.cli.arguments import Folder, Json, Replace, StudyFile, optional, reports
from asperity.cli.reporter import Reporter
from asperity.cli.working import completed
from asperity.errors import InputError

if TYPE_CHECKING:
    from asperity.sweeps.analysis.sensitivity import Sensitivity

SENSITIVITY_FILES = ("sensitivity.png", "sensitivity.svg", "sensitivity.json")
"""Names of the files that the command may write."""


_WIDEST = 28


@reports(json=Json)
def sensitivity(
    reporter: Reporter,
    study: StudyFile,
    measure: Annotated[str, optional("measure", "NAME", "The measure.")],
    output: Folder = None,
    force: Replace = False,
) -> None:
    """Say which axes of a study a measure depends on.

    Sobol indices of first order and in total, with their confidence. Writes a picture and a table
    to DIR, ./STUDY-sensitivity unless given.
    """
    from asperity.results.results_folder import check_folder, write_folder

    folder = None
    if output is not None or not reporter.as_json:
        folder = Path(output or f"{Path(study).stem}-sensitivity")
        check_folder(folder, SENSITIVITY_FILES, force=force)
    found = _indices(study, measure, reporter)
    reporter.answer(lambda: "\n".join(_index_lines(found)), found.json_object)
    if folder is not None:
        with reporter.step("pictures and files"):
            from asperity.plots.study.bars import pictures

            files = completed(lambda stop: pictures(found))
            text = json.dumps(found.json_object(), allow_nan=False)
            files["sensitivity.json"] = text.encode() + b"\n"
            written = write_folder(folder, files, SENSITIVITY_FILES, force=force)
        reporter.written(written)


def _indices(file: str, measure: str, reporter: Reporter) -> Sensitivity:
    """The indices, computed in a thread of its own."""
    import dataclasses

    from asperity.sweeps.analysis.sensitivity import check, measured
    from asperity.sweeps.analysis.sensitivity import sensitivity as indices
    from asperity.sweeps.compute.batch import evaluate
    from asperity.sweeps.study.study import read

    # A study keeps what is measured and no more; its other measures would cost time alone.
    study = dataclasses.replace(read(file), keep=(measured(measure).name,), motions=False)
    try:
        check(study)
    except InputError as error:
        error.file = error.file or file
        raise
    cases, computed = study.size * (len(study.axes) + 2), 0
    with reporter.watch() as progress:

        def tell_of(count: int) -> None:
            nonlocal computed
            computed += count
            if progress is not None:
                progress(computed / cases, f"{computed:,} of {cases:,} cases")

        tell_of(0)
        return completed(
            lambda stop: indices(
                study, measure, lambda values: evaluate(study, values, tell_of, stop)
            )
        )


def _index_lines(found: Sensitivity) -> list[str]:
    """The indices as a table."""
    from asperity.sweeps.analysis.sensitivity import CONFIDENCE

    wide = min(max(len(key) for key in found.keys), _WIDEST)
    lines = [
        f"{found.measure}: share of its variance that each axis makes, {found.cases} cases",
        "",
        f"  {'':<{wide}}  {'alone':<24}with others",
    ]
    for k, key in enumerate(found.keys):
        cells = [
            f"{index.value[k]:6.3f} [{index.low[k]:6.3f}, {index.high[k]:6.3f}]"
            for index in (found.first, found.total)
        ]
        if len(key) > wide:  # a long key stands on a line of its own
            lines.append(f"  {key}")
            key = ""
        lines.append(f"  {key:<{wide}}  {cells[0]:<24}{cells[1]:<24}".rstrip())
    total = math.fsum(found.first.value)
    return [
        *lines,
        "",
        f"  the axes alone make {total:.3f} of it; in brackets {100.0 * CONFIDENCE:g} % intervals",
    ]

"""What the page asks to be computed: a case seen at a glance, and its files."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator, Mapping
from typing import Any

from asperity.config import Case
from asperity.errors import InputError, SimulationError
from asperity.regimes.choice import CHOSEN
from asperity.results.result import Curve, Result
from asperity.web.answer import DRAWN, answer
from asperity.web.jobs import Report
from asperity.web.requests import Asked
from asperity.web.surface_uploads import Surfaces, Upload, renamed, retold
from asperity.writing import csv_of

FILES = {
    "record.nc": "application/x-netcdf",
    "curve.nc": "application/x-netcdf",
    "summary.txt": "text/plain; charset=utf-8",
    "motion.csv": "text/csv; charset=utf-8",
    "curve.csv": "text/csv; charset=utf-8",
    "motion.png": "image/png",
    "forces.png": "image/png",
    "energy.png": "image/png",
    "curve.png": "image/png",
}
"""Files that can be downloaded, and what they are."""


def glance(
    asked: Asked, surfaces: Surfaces, report: Report, stop: threading.Event
) -> dict[str, Any]:
    """What the page shows."""
    with _resolved(asked, surfaces, report) as (case, uploads):
        from asperity.solver import explore  # which loads JAX

        result, curve = explore(case, name=asked.name, most=DRAWN, progress=report, stop=stop)
        bodies = None
        if result.realisations is not None:
            report(0.95, "single bodies at other speeds")
            from asperity.sweeps.capture_probability import capture_nearby

            try:
                bodies = capture_nearby(case, result, stop)
            except (InputError, SimulationError) as error:
                if stop.is_set():
                    raise
                result.warnings.append(f"there is no chart of single bodies: {error}")
        return answer(renamed(result, asked.case(), uploads), curve, bodies)


def critical(
    asked: Asked, surfaces: Surfaces, report: Report, stop: threading.Event
) -> dict[str, Any]:
    """The critical velocity, which takes longer than all the rest."""
    with _resolved(asked, surfaces, report) as (case, _):
        from asperity.solver import critical_velocity

        return critical_velocity(case, progress=report, stop=stop)


def ahead(asked: Asked, surfaces: Surfaces, report: Report, stop: threading.Event) -> None:
    """Compile what a case needs under each law that "auto" may choose.

    Then no slider that crosses a border between two of them has to. All are once it returns, unless
    it was stopped.
    """
    with _resolved(asked, surfaces, report) as (case, _):
        from asperity.solver import explore

        numerics = case.numerics.model_copy(update={"max_impacts": 1})
        for law in CHOSEN:
            adhesion = case.adhesion.model_copy(update={"model": law})
            one = case.model_copy(update={"adhesion": adhesion, "numerics": numerics})
            # What a law cannot do here is said once it is chosen.
            with contextlib.suppress(InputError, SimulationError):
                explore(one, most=DRAWN, progress=report, stop=stop)


def kind_of(case: Case) -> int:
    """A number for what a case is beside its real numbers: on these few programs depend."""

    def without(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: without(inner) for key, inner in value.items()}
        if isinstance(value, list | tuple):
            return [without(inner) for inner in value]
        return None if isinstance(value, float) else str(value)

    numerics = case.numerics.model_copy(update={"max_impacts": 1})
    return hash(repr(without(case.model_copy(update={"numerics": numerics}).model_dump())))


def file(
    asked: Asked, surfaces: Surfaces, name: str, report: Report, stop: threading.Event
) -> bytes:
    """One of `FILES`, as `asperity run` and `asperity curve` write it."""
    with _resolved(asked, surfaces, report) as (case, uploads):
        from asperity.solver import curve, solve

        made: Result | Curve
        if name.startswith("curve"):
            made = curve(case, name=asked.name, progress=report, stop=stop)
        else:
            made = solve(case, name=asked.name, progress=report, stop=stop)
        made = renamed(made, asked.case(), uploads)
    if name.endswith(".csv"):
        return table(made)
    if name.endswith(".png"):
        return picture(made, name.removesuffix(".png"))
    return made.files(pictures=False)[name]


@contextlib.contextmanager
def _resolved(
    asked: Asked, surfaces: Surfaces, report: Report
) -> Iterator[tuple[Case, Mapping[str, Upload]]]:
    """The case to compute; errors within name files as the user does."""
    report(0.0, "loading")
    case, uploads = surfaces.resolved(asked.case(), asked.surfaces)
    try:
        yield case, uploads
    except InputError as error:
        raise InputError(retold(str(error), uploads), key=error.key) from error
    except SimulationError as error:
        raise SimulationError(retold(str(error), uploads)) from error


_drawing = threading.Lock()
"""One picture at a time: matplotlib's style is the process's."""


def picture(made: Result | Curve, part: str) -> bytes:
    """One part of a result as PNG; see :func:`asperity.plots.figure`."""
    from asperity.plots import figure, style

    with _drawing:
        return style.png(figure(made, part))


def table(made: Result | Curve) -> bytes:
    """The series of a result as CSV, a column a quantity, named with its unit."""
    from asperity.results.record_layout import variables

    columns = [one for one in variables(made) if one.dimensions in (("time",), ("point",))]
    heads = (f"{one.name} [{one.units}]" for one in columns)
    return csv_of(heads, zip(*(one.values.tolist() for one in columns), strict=True))

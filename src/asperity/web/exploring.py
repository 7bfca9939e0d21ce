"""What the page asks to be computed: a case seen at a glance, and its files."""

from __future__ import annotations

import csv
import io
import threading
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from asperity.errors import InputError, SimulationError
from asperity.result import Curve, Result
from asperity.web.answer import DRAWN, answer
from asperity.web.asking import Asked
from asperity.web.jobs import Report
from asperity.web.surfaces import Surfaces, renamed, retold

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

Explored = tuple[Result, Curve]


def glance(asked: Asked, surfaces: Surfaces) -> Callable[[Report, threading.Event], Any]:
    """A computation that gives what the page shows."""

    def compute(tell: Report, stop: threading.Event) -> dict[str, Any]:
        result, curve = _explored(asked, surfaces, tell, stop, DRAWN)
        return answer(result, curve)

    return compute


def file(asked: Asked, surfaces: Surfaces, name: str) -> Callable[[Report, threading.Event], bytes]:
    """A computation that gives one of `FILES`."""

    def compute(tell: Report, stop: threading.Event) -> bytes:
        result, curve = _explored(asked, surfaces, tell, stop, None)
        if name.endswith(".csv"):
            return table(curve if name.startswith("curve") else result)
        made = curve if name.startswith("curve") else result
        if name.endswith(".png"):
            return picture(made, name.removesuffix(".png"))
        return made.files(pictures=False)[name]

    return compute


def _explored(
    asked: Asked, surfaces: Surfaces, tell: Report, stop: threading.Event, most: int | None
) -> Explored:
    case = asked.case()
    tell(0.0, "loading")
    from asperity.solver import explore  # which loads JAX

    resolved, uploads = surfaces.resolved(case, asked.surfaces)
    try:
        result, curve = explore(resolved, name=asked.name, most=most, progress=tell, stop=stop)
    except InputError as error:
        raise InputError(retold(str(error), uploads), key=error.key) from error
    except SimulationError as error:
        raise SimulationError(retold(str(error), uploads)) from error
    return renamed(result, case, uploads), replace(curve, case=case)


_drawing = threading.Lock()
"""One picture at a time: matplotlib's style is the process's."""


def picture(made: Result | Curve, part: str) -> bytes:
    """One part of a result as PNG; see :func:`asperity.plots.figure`."""
    from asperity.plots import figure, style

    with _drawing:
        return style.png(figure(made, part))


def table(made: Result | Curve) -> bytes:
    """The series of a result as CSV, a column a quantity, named with its unit."""
    from asperity.records.layout import variables

    columns = [one for one in variables(made) if one.dimensions in (("time",), ("point",))]
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(f"{one.name} [{one.units}]" for one in columns)
    writer.writerows(zip(*(one.values.tolist() for one in columns), strict=True))
    return out.getvalue().encode()

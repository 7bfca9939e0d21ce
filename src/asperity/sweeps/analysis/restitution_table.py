"""Restitution against impact speed, in the forms that codes for many particles read.

Numbers are written with all the digits that a float has, so that reading them gives the same
floats.
"""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from asperity.errors import InputError
from asperity.sweeps.analysis.pareto import numbers
from asperity.sweeps.analysis.view import axes_of, is_number, is_sample
from asperity.writing import aside, ending_of

if TYPE_CHECKING:
    import xarray

_NEEDED = ("impact_speed", "restitution")
_BODIES = {
    "mean_restitution_error": "standard error",
    "capture_probability": "capture probability",
    "capture_probability_low": "lower bound of it",
    "capture_probability_high": "upper bound of it",
}

COLUMNS = (*_NEEDED, "mean_restitution", *_BODIES)
"""Measures of a study that a table may hold."""


@dataclass(frozen=True)
class Restitution:
    """Restitution of the first impact against its speed.

    Parameters
    ----------
    speed
        Impact speeds [m/s], ascending, shape (points,).
    restitution
        Coefficients of restitution, 0 where the first impact captures, shape (points,); where a
        study has single bodies, their mean.
    beside
        What is known of single bodies besides, by its name in words, shape (points,) each; the
        bounds are those of 95 %.
    about
        What they belong to, in lines.
    """

    speed: np.ndarray
    restitution: np.ndarray
    beside: dict[str, np.ndarray]
    about: tuple[str, ...]


def restitution_of(dataset: xarray.Dataset, taken: str = "") -> Restitution:
    """Restitution against impact speed along the one axis that is left.

    Parameters
    ----------
    dataset
        A grid's results with ``impact_speed`` and ``restitution``, or ``mean_restitution`` where it
        has single bodies, all axes but one held fixed.
    taken
        What is held fixed, in words.

    Raises
    ------
    InputError
        Where the study is a sample, has not kept both measures, varies along several axes, or
        two cases have one speed.
    """
    bodies = {"mean_restitution", *_BODIES} & {str(name) for name in dataset}
    needed = ("impact_speed", "mean_restitution") if bodies else _NEEDED
    missing = [name for name in needed if name not in dataset]
    if missing:
        of = " of single bodies" if bodies else ""
        raise InputError(
            f"`keep` must hold {' and '.join(needed)} for a table of restitution{of}; "
            f"got no {missing[0]}",
            key="keep",
        )
    key = _only_axis(dataset)
    speed, bounce = (numbers(dataset, name) for name in needed)
    known = np.isfinite(speed) & np.isfinite(bounce)
    order = np.flatnonzero(known)[np.argsort(speed[known], kind="stable")]
    if order.size < 2:
        raise InputError(
            f"a table of restitution must have two points; got {order.size} along {key}"
        )
    if not np.all(np.diff(speed[order]) > 0.0):
        raise InputError(
            f"a table of restitution must have one value for each speed; along {key} two cases "
            "have the same - vary impact.speed"
        )
    lost = int(known.size - order.size)
    about = [
        f"base case: {dataset.attrs['base']}",
        *([taken] if taken else []),
        *([f"{lost} of {known.size} cases have no restitution and are left out"] if lost else []),
        f"{'mean ' if bodies else ''}coefficient of restitution of the first impact"
        f"{' of single bodies' if bodies else ''}, 0 where it captures",
    ]
    beside = {_BODIES[one]: numbers(dataset, one)[order] for one in _BODIES if one in bodies}
    return Restitution(speed[order], bounce[order], beside, tuple(about))


def _only_axis(dataset: xarray.Dataset) -> str:
    """The one axis along which the results vary."""
    if is_sample(dataset):
        raise InputError(
            "a table of restitution must come from a grid; got a sample, whose cases differ in "
            "every axis at once"
        )
    free = [key for key in axes_of(dataset) if dataset[key].ndim and dataset[key].size > 1]
    numeric = [key for key in free if is_number(dataset[key])]
    speeds = [key for key in numeric if key.startswith("impact.")] or numeric
    others = [key for key in free if key not in speeds[:1]]
    if others:
        options = " ".join(f"--at {key}=VALUE" for key in others)
        raise InputError(
            f"a table of restitution must vary along one axis; add {options}", key="at"
        )
    if not speeds:
        raise InputError("a table of restitution must have an axis of numbers; got none")
    return speeds[0]


def write_restitution(
    table: Restitution, file: str | os.PathLike[str], *, force: bool = False
) -> Path:
    """Write restitution against speed; the file's ending says in which form.

    What is known of single bodies besides follows in columns or arrays of its own, in ``.foam`` as
    comments.

    ``.dat``
        two columns under ``#`` comments, for anything that reads columns.
    ``.txt``
        two columns under ``%`` comments: COMSOL's spreadsheet format of an interpolation
        function.
    ``.csv``
        two columns under their names: a file table of Simcenter STAR-CCM+, for
        ``interpolateTable``.
    ``.foam``
        a list of pairs: the values of OpenFOAM's ``Function1`` ``table``.
    ``.h``
        arrays in C, for compiled boundary conditions such as Fluent's ``DEFINE_DPM_BC``.

    Raises
    ------
    InputError
        Where the ending is another, or the file is there already.
    OutputError
        Where it cannot be written.
    """
    target = Path(file)
    form = _FORMS[ending_of(target, _FORMS)]
    with aside(target, force=force) as path:
        path.write_text(form(table), encoding="utf-8")
    return target


def _commented(sign: str) -> Callable[[Restitution], str]:
    def columns(table: Restitution) -> str:
        names = ["coefficient of restitution", *table.beside]
        heads = [*table.about, ", ".join(["impact speed [m/s]", *(f"{n} [-]" for n in names)])]
        return "\n".join([*(f"{sign} {line}" for line in heads), *_rows(table, " "), ""])

    return columns


def _named(table: Restitution) -> str:
    names = [name.capitalize() for name in table.beside]
    return "\n".join([",".join(["Speed (m/s)", "Restitution", *names]), *_rows(table, ","), ""])


def _foam(table: Restitution) -> str:
    beside = [f"{name}: {values.tolist()}" for name, values in table.beside.items()]
    heads = [*table.about, *beside, "(impact speed [m/s]  coefficient of restitution [-])"]
    rows = [f"    ({row})" for row in _rows(dataclasses.replace(table, beside={}), " ")]
    return "\n".join([*(f"// {line}" for line in heads), "(", *rows, ")", ""])


def _c(table: Restitution) -> str:
    lines = [f"/* {line.replace('*/', '* /')} */" for line in table.about]
    lines += [
        "#ifndef ASPERITY_RESTITUTION_H",
        "#define ASPERITY_RESTITUTION_H",
        f"#define ASPERITY_POINTS {table.speed.size}",
    ]
    for name, values, unit in (
        ("speed", table.speed, "m/s"),
        ("restitution", table.restitution, "-"),
        *((name.replace(" ", "_"), values, "-") for name, values in table.beside.items()),
    ):
        numbers_written = ",\n".join(f"    {value!r}" for value in values.tolist())
        lines.append(
            f"static const double asperity_{name}[ASPERITY_POINTS] = {{ /* [{unit}] */\n"
            f"{numbers_written}\n}};"
        )
    return "\n".join([*lines, "#endif", ""])


def _rows(table: Restitution, between: str) -> list[str]:
    columns = (table.speed, table.restitution, *table.beside.values())
    rows = zip(*(column.tolist() for column in columns), strict=True)
    return [between.join(map(repr, row)) for row in rows]


_FORMS: dict[str, Callable[[Restitution], str]] = {
    ".dat": _commented("#"),
    ".txt": _commented("%"),
    ".csv": _named,
    ".foam": _foam,
    ".h": _c,
}

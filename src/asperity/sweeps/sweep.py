"""A sweep from Python: a grid of cases, computed in memory, as one dataset."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from asperity.config import Case, Output
from asperity.config.replacing import with_unit
from asperity.errors import InputError
from asperity.integration import Report, silently
from asperity.results.case_source import CaseLike, case_of
from asperity.sweeps.compute.runner import Tally, in_process
from asperity.sweeps.store.dataset import dataset_in
from asperity.sweeps.study.axes import Axis
from asperity.sweeps.study.axis_text import axis_of
from asperity.sweeps.study.columns import ALWAYS, DEFAULT_KEEP
from asperity.sweeps.study.keys import find
from asperity.sweeps.study.refusing import refuse_unusable
from asperity.sweeps.study.study import Study
from asperity.units import shown

if TYPE_CHECKING:
    import xarray

MOST_CASES = 1_000_000
"""Most cases of a sweep in memory."""


def sweep(
    case: CaseLike,
    axes: Mapping[str, Iterable[object]],
    *,
    keep: Iterable[str] = DEFAULT_KEEP,
    impacts: int | None = None,
    progress: Report | None = None,
    stop: threading.Event | None = None,
) -> xarray.Dataset:
    """Motions of many cases: one case with other values of some keys, every value with every other.

    Everything is computed by this process and kept in memory; ``asperity sweep`` keeps larger
    studies in a store, which :func:`asperity.open_study` reads.

    Parameters
    ----------
    case
        A case, or the name or path of one.
    axes
        Values by the dotted key that takes them, e.g. ``{"capillary.humidity": [0.2, 0.5, 0.8]}``:
        numbers in SI, or text as in a case file such as ``"5 nm"`` or ``"silica"``; all
        different. Any key of a case but those of ``[output]`` and keys that take a list.
    keep
        Measures that are kept, those that a study can keep: ``"restitution"``, ``"captured"``,
        ``"pull_off"``, ``"critical_velocity"`` and so on. ``outcome``, ``impacts``,
        ``energy_balance_error`` and ``reason`` are there in any case.
    impacts
        Of measures with a value for each impact: how many are kept, along a dimension ``impact``.
        Without it the first alone, without that dimension.
    progress
        Called with a fraction done and a line of text, after each part that is computed.
    stop
        Set from another thread, it ends the sweep early; what was computed is returned.

    Returns
    -------
    xarray.Dataset
        A dimension for each axis, named by its key; all values are SI, with ``units`` and
        ``long_name``. A case that cannot be computed has NaN (-1 in whole numbers), the outcome
        "failed" of ``flag_meanings``, and its ``reason``. The attributes ``failed`` and
        ``computed`` count cases; ``warnings`` says where those at the corners of the grid leave the
        validity of their models. ``outcome.attrs["study"]`` is all of it as a study file.

    Raises
    ------
    InputError
        If there is no such case, key or measure, or a value breaks the rule of its key.
    """
    study = _study(case_of(case), axes, keep, impacts)
    columns, tally = _computed(study, progress or silently, stop or threading.Event())
    found = dataset_in(study, columns)
    text = {name: found.attrs.pop(name) for name in ("axes", "fingerprint", "study")}
    found["outcome"].attrs["study"] = text["study"]  # where it is kept, and is not in the way
    found.attrs["warnings"] = tally.warnings
    if impacts is None and "impact" in found.dims:
        found = found.isel(impact=0)
    return found


def _study(
    case: Case, axes: Mapping[str, Iterable[object]], keep: Iterable[str], impacts: int | None
) -> Study:
    """The study that a sweep is."""
    if not isinstance(axes, Mapping) or not axes:
        raise InputError(
            "`axes` must be values by their dotted key, such as "
            f"{{'capillary.humidity': [0.2, 0.5, 0.8]}}; got {shown(axes)}",
            key="axes",
        )
    if not any(str(key).startswith("impact.") for key in axes):
        _ = case.launch
    always = {column.name for column in ALWAYS}
    if not isinstance(keep, Iterable):
        raise InputError(f"`keep` must be names of measures; got {shown(keep)}", key="keep")
    names = (keep,) if isinstance(keep, str) else tuple(keep)
    base = case.model_copy(update={"output": Output()})
    study = Study(
        base,
        case.name,
        tuple(_axis(case, key, values) for key, values in axes.items()),
        None,
        tuple(name for name in names if name not in always),
        _whole(impacts),
        False,
    )
    refuse_unusable(study, study.canonical)
    if study.size > MOST_CASES:
        raise InputError(
            f"`axes` must give at most {MOST_CASES:,} cases in memory (`asperity sweep` keeps more "
            f"in a store); got {study.size:,}",
            key="axes",
        )
    return study


def _whole(impacts: object) -> int:
    if impacts is None:
        return 1
    if isinstance(impacts, bool) or not isinstance(impacts, int) or not 1 <= impacts <= 100_000:
        raise InputError(
            f"`impacts` must be a whole number in [1, 100000]; got {shown(impacts)}", key="impacts"
        )
    return impacts


def _axis(case: Case, name: str, values: Iterable[object]) -> Axis:
    """The axis of a key, its values from Python."""
    try:
        key = find(str(name), case.materials)
        if _no_list(values):
            rule = "must be a list, or an array of one dimension, of values"
            raise InputError(f"{rule}; got {shown(values)}")
        listed = [with_unit(value, key.unit, key.last) for value in values]
        return axis_of(key, {"values": listed}, sampled=False)
    except InputError as error:
        raise InputError(f"axes[{str(name)!r}]: {error}", key=f"axes.{name}") from None


def _no_list(values: object) -> bool:
    one_value = isinstance(values, str | Mapping) or not isinstance(values, Iterable)
    return one_value or getattr(values, "ndim", 1) != 1


def _computed(
    study: Study, report: Report, stop: threading.Event
) -> tuple[dict[str, np.ndarray], Tally]:
    """The columns of all cases, and what is to be known of them."""
    whole = {column.name: study.blank(column, study.size) for column in study.columns}
    tally = Tally(0, 0, study.size)
    report(0.0, f"{study.size:,} cases (the first are compiled)")
    with contextlib.closing(in_process(study, range(study.tasks), stop)) as answers:
        for task, columns, effort in answers:
            cases = study.task(task)
            for name, values in columns.items():
                whole[name][cases.start : cases.stop] = values
            tally = tally.plus(effort, 0.0)
            report(tally.cases / study.size, f"{tally.cases:,} of {study.size:,} cases")
    report(1.0, "done")
    return whole, tally

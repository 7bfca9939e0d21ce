"""What a picture of a study shows: a measure, the axes it is drawn over, the values held fixed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from asperity.config.problems import among
from asperity.errors import InputError
from asperity.results.summary import amount
from asperity.sweeps.study.definition import CASE
from asperity.units import quantity, shown

if TYPE_CHECKING:
    import xarray

FEW = 6
"""Most values of an axis that are drawn as lines of different colours."""

MOST_PANELS = 9
"""Most values of an axis that are drawn side by side."""

_BESIDE = ("energy_balance_error", "turning_separation", "turning_time")


@dataclass(frozen=True)
class View:
    """What is drawn over what.

    Parameters
    ----------
    kind
        "lines", "map" or "sample".
    measures
        Names of the measures, one a panel.
    x, y
        Axes of the picture; ``y`` of a map alone.
    series
        Axis whose values are lines of different colours; "" for none.
    facet
        Axis whose values are panels side by side; "" for none.
    """

    kind: str
    measures: tuple[str, ...]
    x: str = ""
    y: str = ""
    series: str = ""
    facet: str = ""


def axes_of(dataset: xarray.Dataset) -> tuple[str, ...]:
    """Keys of the axes, in the order of the study, whether or not they are held fixed."""
    return tuple(dataset.attrs["axes"])


def is_sample(dataset: xarray.Dataset) -> bool:
    """Whether the cases are drawn at random rather than on a grid."""
    return CASE in dataset.dims


def is_number(values: xarray.DataArray) -> bool:
    """Whether values are numbers, not text or switches."""
    return values.dtype.kind in "fiu"


def words(value: object, unit: str = "1") -> str:
    """A value of an axis or a measure as titles have it, e.g. ``10 nm``, ``0.4``, ``dmt``."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if not isinstance(value, (int, float, np.integer, np.floating)):
        return str(value)
    return amount(float(value), unit)


def measures_of(dataset: xarray.Dataset) -> list[str]:
    """Measures that can be drawn: those kept as numbers, the speed of impact, capture, the rest."""
    known = [str(name) for name in dataset.data_vars if name != "reason"]
    known.sort(key=lambda name: (name == "impact_speed", name != "captured"))
    main = [n for n in known if dataset[n].dtype.kind == "f" and n not in _BESIDE]
    return [*main, *(n for n in known if n not in main)]


def telling(dataset: xarray.Dataset) -> list[str]:
    """Measures to draw unasked: none without a value, no impact speed that is given or fixed."""
    speeds = dataset.get("impact_speed")
    fixed = speeds is None or bool(speeds.max() <= (1.0 + 1e-6) * speeds.min())
    idle = ("impact_speed",) if fixed or "impact.speed" in axes_of(dataset) else ()
    known = measures_of(dataset)
    return [n for n in known if n not in idle and dataset[n].notnull().any()] or known


def measure_named(dataset: xarray.Dataset, name: str, option: str = "measure") -> str:
    """The name of a measure that the dataset holds.

    Raises
    ------
    InputError
        Where it holds none of this name.
    """
    known = measures_of(dataset)
    rule = f"`{option}` must be kept by the study: one of {', '.join(known)}"
    among(name, known, rule, key=option)
    return name


def at(dataset: xarray.Dataset, held: Mapping[str, str]) -> tuple[xarray.Dataset, str]:
    """A grid's results with some axes held at the nearest of their values.

    Parameters
    ----------
    dataset
        The results.
    held
        Values by the axes' keys, as text with the unit that a case file would have.

    Returns
    -------
    tuple
        The results with these axes gone, and those of one value; and in words which values were
        taken.

    Raises
    ------
    InputError
        Where there is no such axis, or a value is none of its kind.
    """
    if held and is_sample(dataset):
        raise InputError(
            f"`at` must not be given for a sample, which has no grid to be cut; "
            f"got {next(iter(held))}",
            key="at",
        )
    taken = []
    for key, text in held.items():
        axis = _axis(dataset, key, "at")
        index = _nearest(axis, text)
        dataset = dataset.isel({key: index})
        taken.append(f"{axis.attrs['long_name']} {words(axis.values[index], _unit(axis))}")
    if not is_sample(dataset):
        dataset = dataset.isel({key: 0 for key in axes_of(dataset) if dataset[key].shape == (1,)})
    return dataset, ", ".join(taken)


def view_of(
    dataset: xarray.Dataset,
    *,
    measure: str | None = None,
    x: str | None = None,
    y: str | None = None,
) -> View:
    """How to draw a study's results.

    Parameters
    ----------
    dataset
        The results, with what is held fixed taken out by `at`.
    measure
        Measure to draw; without it the first that is kept, and for lines all (see `telling`).
    x, y
        Keys of the axes to draw over; ``y`` asks for a map.

    Raises
    ------
    InputError
        Where a name is unknown, or more axes are left than a picture can show.
    """
    names = (measure_named(dataset, measure),) if measure else tuple(telling(dataset)[:1])
    for option, key in (("x", x), ("y", y)):
        if key is not None:
            _axis(dataset, key, option)
    if is_sample(dataset):
        if y is not None:
            raise InputError("`y` must not be given for a sample, which is no map", key="y")
        return View("sample", names, x or "")
    left = [key for key in axes_of(dataset) if dataset[key].ndim and dataset[key].size > 1]
    if not left:
        raise InputError("a study must have an axis with two values to be drawn; got one case")
    across = x or _first(dataset, [key for key in left if key != y])
    rest = [key for key in left if key != across]
    up = y or next((key for key in rest if _is_long(dataset[key])), None)
    if up is not None:
        return _map(dataset, names, across, up, [key for key in rest if key != up])
    return _lines(dataset, names if measure else None, across, rest)


def _map(dataset: xarray.Dataset, names: tuple[str, ...], x: str, y: str, rest: list[str]) -> View:
    for option, key in (("x", x), ("y", y)):
        if not is_number(dataset[key]):
            raise InputError(
                f"`{option}` of a map must be an axis of numbers; got {key}", key=option
            )
    if x == y:
        raise InputError(f"`x` and `y` must be two axes; got {x} twice", key="y")
    return View("map", names, x, y, facet=_facet(dataset, rest))


def _lines(dataset: xarray.Dataset, names: tuple[str, ...] | None, x: str, rest: list[str]) -> View:
    text_first = sorted(rest, key=lambda key: is_number(dataset[key]))
    series = next((key for key in text_first if dataset[key].size <= FEW), "")
    facet = _facet(dataset, [key for key in rest if key != series])
    known = telling(dataset)
    numbers = [name for name in known if dataset[name].dtype.kind == "f" and name not in _BESIDE]
    drawn = tuple((numbers or known)[: 1 if facet else MOST_PANELS])
    return View("lines", names or drawn, x, series=series, facet=facet)


def _facet(dataset: xarray.Dataset, rest: list[str]) -> str:
    """The axis that is left for panels side by side, if any."""
    facet = next((key for key in rest if dataset[key].size <= MOST_PANELS), "")
    beyond = [key for key in rest if key != facet]
    if beyond:
        options = " ".join(f"--at {key}={_middle(dataset[key])}" for key in beyond)
        raise InputError(
            f"a picture must hold some axes fixed where there are so many; add {options}", key="at"
        )
    return facet


def _first(dataset: xarray.Dataset, keys: list[str]) -> str:
    """The axis to draw along: the first long one of numbers, else the first of numbers, else any.

    Raises
    ------
    InputError
        Where none is left.
    """
    numbers = [key for key in keys if is_number(dataset[key])]
    found = [*(key for key in numbers if _is_long(dataset[key])), *numbers, *keys]
    if not found:
        raise InputError("`y` must leave another axis to draw along; got the only one", key="y")
    return found[0]


def _is_long(axis: xarray.DataArray) -> bool:
    return is_number(axis) and axis.size > FEW


def _middle(axis: xarray.DataArray) -> str:
    text = words(axis.values[axis.size // 2], _unit(axis))
    return f'"{text}"' if " " in text else text


def _unit(values: xarray.DataArray) -> str:
    return str(values.attrs.get("units", "1"))


def _axis(dataset: xarray.Dataset, key: str, option: str) -> xarray.DataArray:
    """An axis of the study that is still free."""
    known = [name for name in axes_of(dataset) if dataset[name].ndim]
    rule = f"`{option}` must name an axis of the study: {', '.join(known)}"
    among(key, known, rule, key=option)
    return dataset[key]


def _nearest(axis: xarray.DataArray, text: str) -> int:
    """Index of the value of an axis that is nearest to a text."""
    if not is_number(axis):
        names = [words(value) for value in axis.values]
        rule = f"`at` must give {axis.name} one of its values, {', '.join(names)}"
        among(text, names, rule, key="at")
        return names.index(text)
    unit, values = _unit(axis), axis.values.astype(float)
    wanted = _number(text, str(axis.name)) if unit == "1" else quantity(text, unit, str(axis.name))
    if axis.attrs.get("scale") == "log" and wanted > 0.0:
        values, wanted = np.log(values), float(np.log(wanted))
    return int(np.argmin(np.abs(values - wanted)))


def _number(text: str, name: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not np.isfinite(value):
        raise InputError(f"`{name}` must be a number; got {shown(text)}", key="at")
    return value

"""Axes and measures of a study as numbers to draw: with prefixes, labels, edges of cells."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.ticker import MaxNLocator, NullFormatter, NullLocator

from asperity.config.key_labels import PERCENT
from asperity.plots import style
from asperity.sweeps.analysis.view import is_number, words

if TYPE_CHECKING:
    import xarray

_DECADE = 10.0
_LONG_NAME = 12
_TICKS = 6
_LINE = 28  # letters as long as an axis is high


class Quantity(NamedTuple):
    """A quantity as it is drawn.

    Attributes
    ----------
    values
        In the unit of the label; the numbers 0, 1, ... of names.
    label
        Name and unit, for an axis.
    log
        Whether it is drawn on a logarithmic axis.
    names
        Of values that are no numbers; () for numbers.
    factor
        SI value of 1 in the unit of the label.
    """

    values: np.ndarray
    label: str
    log: bool
    names: tuple[str, ...]
    factor: float

    @property
    def edges(self) -> np.ndarray:
        """Ends of the cells about ascending values, midway between them, shape (values + 1,)."""
        at = np.log(self.values) if self.log else self.values.astype(float)
        if at.size == 1:
            half = 0.5 * abs(at[0]) or 0.5
            ends = np.array([at[0] - half, at[0] + half])
        else:
            middle = 0.5 * (at[1:] + at[:-1])
            ends = np.concatenate([[2.0 * at[0] - middle[0]], middle, [2.0 * at[-1] - middle[-1]]])
        return np.exp(ends) if self.log else ends

    @property
    def upright(self) -> str:
        """The label for an axis upwards, in several lines where it is long."""
        return textwrap.fill(self.label.replace(" [", "\N{NO-BREAK SPACE}["), _LINE)

    def dress(self, axes: Axes, way: Literal["x", "y"]) -> None:
        """Give one of the axes this quantity's label, scale and ticks."""
        axis = axes.xaxis if way == "x" else axes.yaxis
        axis.set_label_text(self.label if way == "x" else self.upright)
        if self.names:
            shown = [name if len(name) <= _LONG_NAME else f"{name[:9]}..." for name in self.names]
            axis.set_ticks(range(len(shown)), shown)
            axes.set(**{f"{way}lim": (-0.5, len(shown) - 0.5)})
        elif self.log:
            axes.set(**{f"{way}scale": "log"})
            self._log_ticks(axis)
        else:
            axis.set_major_locator(MaxNLocator(_TICKS, steps=[1, 2, 5, 10]))

    def _log_ticks(self, axis: Axis) -> None:
        """Plain numbers at the ticks of an axis of less than two decades."""
        found = self.values[np.isfinite(self.values)]
        span = found.max() / found.min()
        axis.set_minor_formatter(NullFormatter())
        if span < _DECADE**2:
            style.log_ticks(axis)
        if span < _DECADE:
            axis.set_major_locator(MaxNLocator(_TICKS, steps=[1, 2, 5, 10]))
            axis.set_minor_locator(NullLocator())


def axis_quantity(axis: xarray.DataArray) -> Quantity:
    """An axis of a study."""
    name = str(axis.attrs.get("long_name", axis.name))
    if not is_number(axis):
        texts = [words(value) for value in axis.values.ravel()]
        names = tuple(dict.fromkeys(texts))
        return Quantity(np.array([names.index(text) for text in texts]), name, False, names, 1.0)
    log = axis.attrs.get("scale") == "log" and bool(np.all(axis.values > 0.0))
    unit = "%" if axis.name in PERCENT else str(axis.attrs.get("units", "1"))
    return _of(axis.values.astype(float), name, unit, log=log)


def measure_quantity(values: np.ndarray, measure: xarray.DataArray) -> Quantity:
    """Some values of a measure, on a logarithmic axis where they span two decades."""
    meanings = str(measure.attrs.get("flag_meanings", "")).split()[1:]
    if meanings:
        names = tuple(meaning.replace("_", " ") for meaning in meanings)
        return Quantity(values, str(measure.attrs["long_name"]), False, names, 1.0)
    found = values[np.isfinite(values)]
    log = bool(found.size and found.min() > 0.0 and found.max() > _DECADE**2 * found.min())
    name = str(measure.attrs.get("long_name", measure.name))
    first = ", first impact" if {"impact", "turn"} & set(measure.dims) else ""
    return _of(values, name + first, str(measure.attrs.get("units", "1")), log=log)


def _of(values: np.ndarray, name: str, unit: str, *, log: bool) -> Quantity:
    """Values with a prefix to their unit, where it takes one."""
    found = values[np.isfinite(values)]
    typical = np.exp(np.log(found).mean(keepdims=True)) if log else found
    others = {"rad": (np.pi / 180.0, "deg"), "%": (0.01, "%")}
    factor, shown = others.get(unit) or style.scale_of(typical, unit=unit)
    shown = "-" if shown == "1" else shown.replace("^2", "²").replace("^3", "³")
    return Quantity(values / factor, style.label(name, shown), log, (), factor)

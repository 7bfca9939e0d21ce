"""What a picture shows, without how it is drawn: columns of numbers by series."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import pi, sqrt
from typing import NamedTuple

import numpy as np

from ..regimes import Boundary
from ..writing import csv_of

Columns = tuple[np.ndarray, ...]


class Drawing(NamedTuple):
    """The data of one figure.

    Attributes
    ----------
    title
        What it shows, in a line.
    columns
        Names of the columns with their SI units, e.g. ``time [s]``.
    series
        Arrays of one length for each column, by the name of the series.
    about
        Single numbers that the picture needs, in SI.
    """

    title: str
    columns: tuple[str, ...]
    series: Mapping[str, Columns]
    about: Mapping[str, float]

    def csv(self) -> bytes:
        """The data as CSV: a comment, a header, and the series under each other."""
        told = [self.title, *(f"{name}: {value:.9g}" for name, value in self.about.items())]
        rows = (
            (name, *(f"{value:.9g}" for value in row))
            for name, arrays in self.series.items()
            for row in np.column_stack(arrays)
        )
        return csv_of(("series", *self.columns), rows, "".join(f"# {line}\n" for line in told))


def map_lines(boundaries: Sequence[Boundary]) -> dict[str, Columns]:
    """Lines of the adhesion map where they exist, by the models on their sides."""
    series: dict[str, Columns] = {}
    for line in boundaries:
        keep = np.isfinite(line.elasticity) & np.isfinite(line.load)
        series[" | ".join(line.between)] = (line.elasticity[keep], line.load[keep])
    return series


def map_columns(heights: np.ndarray, steps: Sequence[float]) -> Columns:
    """Place x and y [m] of each pixel of a map, by its steps along x and y, and its height."""
    places = (np.arange(n) * step for n, step in zip(heights.shape, steps[::-1], strict=True))
    y, x = np.meshgrid(*places, indexing="ij")
    return x.ravel(), y.ravel(), heights.ravel()


def gaussian(low: float, high: float, rms: float) -> Columns:
    """Heights [m] from one to another, and the density [1/m] of a Gaussian of this rms there."""
    fine = np.linspace(low, high, 301)
    return fine, np.exp(-0.5 * (fine / rms) ** 2) / (rms * sqrt(2.0 * pi))

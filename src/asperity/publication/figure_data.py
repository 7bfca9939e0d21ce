"""What a picture shows, without how it is drawn: columns of numbers by series."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np


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
    series: Mapping[str, tuple[np.ndarray, ...]]
    about: Mapping[str, float]

    def csv(self) -> bytes:
        """The data as CSV: a comment, a header, and the series under each other."""
        store = io.StringIO()
        store.write(f"# {self.title}\n")
        for name, value in self.about.items():
            store.write(f"# {name}: {value:.9g}\n")
        writer = csv.writer(store, lineterminator="\n")
        writer.writerow(("series", *self.columns))
        for name, arrays in self.series.items():
            rows = np.column_stack([np.asarray(values, dtype=float) for values in arrays])
            writer.writerows((name, *(f"{value:.9g}" for value in row)) for row in rows)
        return store.getvalue().encode()

"""Evenly spread samples of a study: the same points whatever part of them is asked for."""

from __future__ import annotations

import functools
import warnings
from typing import Annotated, Literal

import numpy as np

from asperity.config.base_table import Table
from asperity.config.fields import Number
from asperity.errors import InputError

_BITS = 30
SOBOL_LIMIT = 1 << _BITS
"""Largest size of a Sobol sample, after which the sequence would start again."""

LATIN_LIMIT = 20_000_000
"""Most numbers of a Latin hypercube, its size times the axes: all are drawn at once, in 0.5 GB."""


class Sample(Table):
    """A sample of a study in place of a grid.

    Parameters
    ----------
    method : str
        "sobol" (scrambled Sobol sequence) or "latin" (Latin hypercube).
    size : int
        Number of cases.
    seed : int
        Seed of the scramble or of the permutations.
    """

    method: Literal["sobol", "latin"]
    size: Annotated[int, Number(f"[1, {SOBOL_LIMIT}]", whole=True)]
    seed: Annotated[int, Number("[0, 4294967295]", whole=True)] = 0

    def refuse_axes(self, dimensions: int) -> None:
        """Refuse a Latin hypercube that is too large to draw at once.

        Raises
        ------
        InputError
            With the largest size over so many axes.
        """
        if self.method == "latin" and self.size * dimensions > LATIN_LIMIT:
            raise InputError(
                f"`size` must be at most {LATIN_LIMIT // dimensions} with method = 'latin' over "
                f"{dimensions} axes, all drawn at once; take 'sobol'; got {self.size}",
                key="sample.size",
            )

    @property
    def warnings(self) -> list[str]:
        """What should be known of the sample."""
        if self.method == "latin" or not self.size & (self.size - 1):
            return []
        return [
            f"a Sobol sample is evenly spread where its size is a power of two; {self.size} is none"
        ]

    def points(self, start: int, stop: int, dimensions: int) -> np.ndarray:
        """Points number `start` to `stop` - 1 of the sample, in the unit cube.

        Returns
        -------
        ndarray
            Numbers in [0, 1); shape (stop - start, dimensions).
        """
        if self.method == "latin":
            return _latin(self.size, dimensions, self.seed)[start:stop]
        return _sobol(start, stop, dimensions, self.seed)


@functools.lru_cache(maxsize=1)
def _latin(size: int, dimensions: int, seed: int) -> np.ndarray:
    from scipy.stats import qmc  # here, since SciPy's statistics take 0.5 s to import

    points: np.ndarray = qmc.LatinHypercube(dimensions, rng=seed).random(size)
    points.flags.writeable = False
    return points


def _sobol(start: int, stop: int, dimensions: int, seed: int) -> np.ndarray:
    from scipy.stats import qmc

    engine = qmc.Sobol(dimensions, bits=_BITS, rng=seed)
    if start:
        engine.fast_forward(start)
    with warnings.catch_warnings():  # of a first part whose size is no power of two
        warnings.simplefilter("ignore", UserWarning)
        points: np.ndarray = engine.random(stop - start)
    return points

"""A measured or made map of heights."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from ..errors import InputError

_LEAST = 3
"""Pixels a side, at least: a summit needs neighbours on all sides."""


@dataclass(frozen=True, eq=False)
class Topography:
    """Heights on a rectangular grid of pixels.

    Parameters
    ----------
    heights
        Heights [m], shape (rows, columns); rows lie along y, columns along x. NaN where a
        pixel is missing. Kept as a read-only float64 array.
    pixel_size
        Distance (dx, dy) [m] of neighbouring pixels: along a row, and from row to row.
    source
        Name of the file, for messages and records; empty where there is none.

    Raises
    ------
    InputError
        If the map has fewer than three pixels a side, a pixel size that is no positive
        length, an infinite height, or no height at all.
    """

    heights: np.ndarray
    pixel_size: tuple[float, float]
    source: str = ""

    def __post_init__(self) -> None:
        heights = np.array(self.heights, dtype=np.float64)
        if heights.ndim != 2 or min(heights.shape) < _LEAST:
            raise self._error(
                f"a surface must have at least {_LEAST} x {_LEAST} pixels; got "
                f"{' x '.join(str(count) for count in heights.shape[::-1]) or 'one number'}"
            )
        if not all(np.isfinite(step) and step > 0.0 for step in self.pixel_size):
            raise self._error(f"the pixel size must be a positive length; got {self.pixel_size} m")
        if np.isinf(heights).any():
            raise self._error("heights must be finite; missing pixels are NaN")
        if np.isnan(heights).all():
            raise self._error("all pixels are missing")
        heights.flags.writeable = False
        object.__setattr__(self, "heights", heights)
        object.__setattr__(
            self, "pixel_size", (float(self.pixel_size[0]), float(self.pixel_size[1]))
        )

    @property
    def physical_size(self) -> tuple[float, float]:
        """Size (x, y) [m] of the map: pixels times their size."""
        rows, columns = self.heights.shape
        return columns * self.pixel_size[0], rows * self.pixel_size[1]

    @property
    def area(self) -> float:
        """Area of the map [m^2]."""
        width, length = self.physical_size
        return width * length

    @property
    def missing(self) -> np.ndarray:
        """Which pixels are missing, shape (rows, columns)."""
        return np.isnan(self.heights)

    @property
    def missing_pixels(self) -> int:
        """How many pixels are missing."""
        return int(np.count_nonzero(self.missing))

    @property
    def rms_height(self) -> float:
        """Root mean square deviation [m] of the heights from their mean, Sq (ISO 25178-2)."""
        return float(np.nanstd(self.heights))

    @property
    def peak_to_valley(self) -> float:
        """Highest height over the lowest [m]."""
        return float(np.nanmax(self.heights) - np.nanmin(self.heights))

    def with_heights(self, heights: np.ndarray) -> Topography:
        """The same map with other heights [m]."""
        return dataclasses.replace(self, heights=heights)

    def _error(self, rule: str) -> InputError:
        """A refusal that names the file, where there is one."""
        return InputError(
            f"{self.source}: {rule}" if self.source else rule, file=self.source or None
        )

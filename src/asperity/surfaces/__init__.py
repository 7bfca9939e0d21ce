"""Measured surfaces: from a file of heights to summits and statistics.

Heights lie on a grid of pixels, in metres, rows along y and columns along x; a missing one is NaN.

`files`: reading and writing; `preparation`: missing pixels, line levelling, form removal, filters;
`description`: summits, spectrum, statistics, two surfaces as one; `generation`: made surfaces;
`heights`: distributions of asperity heights, Gaussian or as measured, for the rooms above;
`measured_surface`: these steps in a row. What is read is never guessed: a unit or a size that a
file does not state is asked for.
"""

from .topography import Topography

__all__ = ["Topography"]

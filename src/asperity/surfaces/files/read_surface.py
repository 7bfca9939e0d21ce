"""A file of heights -> `Topography`, in metres, with nothing guessed.

Formats
-------
=============  =====================================================================
``.npy``       a plane of numbers, rows along y; size and unit by argument
``.csv .txt``  a matrix, one row of x a line, cells parted by ``;``, ``,``, tabs or blanks
``.dat``       the same where it is text, else an instrument's file
``.xyz``       points x y z in any order on a regular grid; places without one are missing
``.nc``        netCDF: one variable of two dimensions with `units`, coordinates with `units`
others         through SurfaceTopography
=============  =====================================================================

Each may be packed as ``.gz``.

Header of text files
--------------------
Lines before the first number that begin with ``#`` are remarks, but for these::

    # size[um] 10 10        size along x and y: pixels times their size
    # unit nm               unit of the heights (of points: of x and y too)
    # x[um] y[um] z[nm]     the lines hold points, in these units, also in a .csv
    # pixels 512 256        columns and rows, checked: a file cut short is found out

and the heading of Gwyddion's text export (``# Width: 10 um``, ``# Height: 10 um``,
``# Value units: m``). A missing height is ``nan`` or an empty cell; a mark that begins or ends
every line parts nothing. Row 0 of a matrix is the first line; row 0 of points the least y. The
size of points is their spacing times their number.

Cut short
---------
A line too short, a scan line of points that ends early, and fewer pixels than ``# pixels`` states
are refused. A text cut between two rows without that line looks like a smaller map; one cut within
its last number is read with a note that its last line has no end.
"""

from __future__ import annotations

import os
import re

import numpy as np

from ..topography import Topography
from . import content as packed
from . import text_heights as texts
from .arrays import matrix_of_array
from .content import refusal
from .header import agreed_size, agreed_unit, check_pixels, in_metres
from .instruments import instrument_reading
from .netcdf_heights import map_of_netcdf
from .reading import Asked, Reading
from .scattered_points import gridded

_TEXTS = (".csv", ".txt", ".dat", ".xyz")
_HEAD = 4096
_ADVICE_SIZE = ", or by a line `# size[um] 10 10` in the file"
_ADVICE_UNIT = ", or by a line `# unit nm` in the file"

Map = tuple[np.ndarray, tuple[float, float]]
"""Heights [m], shape (rows, columns), and pixel size (dx, dy) [m]."""


def read_surface(
    path: str | os.PathLike[str],
    *,
    size: tuple[float, float] | None = None,
    unit: str | None = None,
    channel: str | int | None = None,
) -> Reading:
    """A surface from a file, with the format and channel that were read.

    Parameters
    ----------
    path
        The file; its ending names the format.
    size
        Size (x, y) [m] of the whole map, pixels times their size, where the file does not state it.
    unit
        Unit of the heights, e.g. ``"nm"``, where the file does not state it; of points also that of
        x and y.
    channel
        Number or name of the channel; by default the one that the format's reader prefers.

    Raises
    ------
    InputError
        Where the file cannot be read, or what it lacks is not given, or what is given contradicts
        it; the message is one line that names file, rule and remedy.
    """
    asked = Asked(size, unit, channel)
    file = os.fspath(path)
    suffix = packed.suffix_of(file)
    content = packed.content_of(file)
    if suffix == ".nc":
        heights, pixel_size = map_of_netcdf(content, file, asked)
        return Reading(Topography(heights, pixel_size, file), "netCDF")
    if suffix == ".npy" or (suffix in _TEXTS and not _is_binary(suffix, content)):
        if channel is not None:
            raise refusal(file, f"holds one map and no channels; got {channel!r}; leave it out")
        if suffix == ".npy":
            found = _from_array(content, file, asked)
            return Reading(Topography(*found, file), "NumPy array")
        text = texts.split(content, file)
        found, words = _from_text(text, suffix, asked)
        return Reading(Topography(*found, file), words, notes=_doubts(text))
    return instrument_reading(content, file, asked)


def _is_binary(suffix: str, content: bytes) -> bool:
    """Whether a .dat is an instrument's: the ending is used for text and for binary data."""
    return suffix == ".dat" and b"\0" in content[:_HEAD]


def _from_array(content: bytes, file: str, asked: Asked) -> Map:
    values = matrix_of_array(content, file)
    heights = in_metres(values, agreed_unit(None, asked.unit, file))
    return heights, _pixel_size(values, agreed_size(None, asked.size, file))


def _doubts(text: texts.Text) -> tuple[str, ...]:
    """A note where nothing tells a whole text from one cut within its last number."""
    if text.ended or text.stated.pixels is not None:
        return ()
    return ("its last line has no end: it may have been cut short; `# pixels 512 256` tells",)


def _from_text(text: texts.Text, suffix: str, asked: Asked) -> tuple[Map, str]:
    file = text.file
    if suffix == ".xyz" or text.stated.lateral is not None:
        return _from_points(text, asked), "points x y z"
    heights_unit = agreed_unit(text.stated.unit, asked.unit, file, _ADVICE_UNIT)
    agreed = agreed_size(text.stated.size, asked.size, file, _ADVICE_SIZE)
    if gap := re.search(rb"\n *\n", text.body):
        line = text.first + text.body.count(b"\n", 0, gap.start()) + 1
        raise refusal(
            file, f"line {line}: a matrix must have a row on every line; got an empty one; cut it"
        )
    values = texts.numbers(text)
    check_pixels(text.stated, values.shape, file)
    return (in_metres(values, heights_unit), _pixel_size(values, agreed)), "matrix of text"


def _from_points(text: texts.Text, asked: Asked) -> Map:
    heights_unit = agreed_unit(text.stated.unit, asked.unit, text.file, _ADVICE_UNIT)
    x_unit, y_unit = text.stated.lateral or (heights_unit, heights_unit)
    points = texts.numbers(text, columns=3)
    points[:, 0] = in_metres(points[:, 0], x_unit)
    points[:, 1] = in_metres(points[:, 1], y_unit)
    values, (width, length) = gridded(points, text.file)
    check_pixels(text.stated, values.shape, text.file)
    rows, columns = values.shape
    for told in (text.stated.size, asked.size):
        agreed_size((columns * width, rows * length), told, text.file)
    return in_metres(values, heights_unit), (width, length)


def _pixel_size(values: np.ndarray, size: tuple[float, float]) -> tuple[float, float]:
    rows, columns = values.shape
    return size[0] / columns, size[1] / rows

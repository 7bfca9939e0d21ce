"""Heights from NumPy's .npy."""

from __future__ import annotations

import io
import math
import reprlib

import numpy as np

from .content import MOST_PIXELS, cut_short, refusal

_HEADERS = {
    (1, 0): np.lib.format.read_array_header_1_0,
    (2, 0): np.lib.format.read_array_header_2_0,
}


def matrix_of_array(content: bytes, file: str) -> np.ndarray:
    """The heights of an .npy file, shape (rows, columns).

    Raises
    ------
    InputError
        As `numbers_of_array`, or where it holds anything but a plane.
    """
    heights = numbers_of_array(content, file)
    if heights.ndim != 2:
        raise refusal(
            file,
            f"must hold a plane of heights, rows by columns; got shape "
            f"{reprlib.repr(heights.shape)}; save one map a file",
        )
    if heights.size > MOST_PIXELS:
        raise refusal(file, f"must have at most {MOST_PIXELS} pixels; got {heights.size}")
    return heights


def numbers_of_array(content: bytes, file: str) -> np.ndarray:
    """The numbers of an .npy file of any shape.

    The header is checked against the length of the file before any memory is taken, and nothing
    is unpickled.

    Raises
    ------
    InputError
        Where it is no .npy file, is cut short, or holds anything but real numbers.
    """
    held = io.BytesIO(content)
    try:
        shape, columns_first, kind = _HEADERS[np.lib.format.read_magic(held)](held)
        size = math.prod(shape) * kind.itemsize
    except Exception as error:  # the header is Python's syntax, whose parser raises many kinds
        raise refusal(
            file,
            "must be a whole .npy file of real numbers; got another header; write it with "
            "numpy.save",
        ) from error
    if kind.kind not in "iuf" or kind.hasobject:
        raise refusal(file, f"must hold real numbers; got {kind}; save the heights as float64")
    left = len(content) - held.tell()
    if min(shape, default=1) < 1 or size != left:
        raise cut_short(
            file, f"a header of {reprlib.repr(shape)} numbers ({size} bytes) over {left} bytes"
        )
    plain = np.frombuffer(content, dtype=kind, offset=held.tell())
    with np.errstate(over="ignore"):  # an extended number beyond float64 becomes inf
        numbers = plain.astype(np.float64)
    return numbers.reshape(shape, order="F" if columns_first else "C")

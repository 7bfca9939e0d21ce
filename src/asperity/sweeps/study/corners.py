"""The corners of a grid: cases that say of a study what the others will be like."""

from __future__ import annotations

import itertools

import numpy as np


def corners_of(shape: tuple[int, ...], most: int) -> list[int]:
    """Numbers of a grid's corners, the first slowest (C order).

    Parameters
    ----------
    shape : tuple of int
        Sizes of the axes.
    most : int
        How many corners at most; of a grid of more, those next to the first and the last case.
    """
    last = np.array(shape) - 1
    alone = np.eye(last.size, dtype=bool)
    none = np.zeros((1, last.size), bool)
    chosen = [none, ~none, alone, ~alone]  # all low, all high, each axis apart from the others
    if 2**last.size <= most:
        chosen.append(np.array(list(itertools.product((False, True), repeat=last.size))))
    numbers = np.ravel_multi_index(tuple((np.concatenate(chosen) * last).T), shape)
    return list(dict.fromkeys(numbers.tolist()))[:most]

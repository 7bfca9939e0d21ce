"""Shares of a sum in per cent, rounded so that they add up to 100."""

from __future__ import annotations

from collections.abc import Iterable
from math import floor, isfinite


def percentages(parts: Iterable[float], places: int = 1) -> list[float]:
    """Shares of the parts of a sum [%], which add up to exactly 100 as they are written.

    Each share is rounded down, and what is then missing goes to those that lost most by it (the
    method of largest remainders; Balinski and Young, Fair Representation, 1982).

    Parameters
    ----------
    parts : iterable of float
        The parts, in one unit; a negative one, which is rounding, counts as none.
    places : int
        Decimal places.

    Returns
    -------
    list of float
        A share for each part; 0 for all where the sum is none.
    """
    sizes = [max(part, 0.0) if isfinite(part) else 0.0 for part in parts]
    total, unit = sum(sizes), 10**places
    if total <= 0.0:
        return [0.0] * len(sizes)
    exact = [size / total * 100 * unit for size in sizes]
    steps = [floor(share) for share in exact]
    by_remainder = sorted(range(len(sizes)), key=lambda k: steps[k] - exact[k])
    for k in by_remainder[: 100 * unit - sum(steps)]:
        steps[k] += 1
    return [step / unit for step in steps]


def share_texts(parts: Iterable[float]) -> list[str]:
    """The `percentages` in words, e.g. ``71.3 %``; ``< 0.1 %`` of a part too small to be one."""
    known = list(parts)
    return [
        f"{share:g} %" if share or not part > 0.0 else "< 0.1 %"
        for part, share in zip(known, percentages(known), strict=True)
    ]

"""Cuts of short and long wavelengths with the Gaussian filter of ISO 16610."""

from __future__ import annotations

from math import log, pi, sqrt

import numpy as np
from scipy import fft

from ..topography import Topography
from .step import Step, length

_ALPHA = sqrt(log(2.0) / pi)
"""Makes the transmission one half at the cut-off; ISO 16610-21."""

_REACH = 6.0
"""Standard deviations after which the filter's weight, exp(-18), is nothing."""

_LEAST_PADDING = 32
"""Pixels: a filter of a few pixels has a tail, for no grid resolves its short waves."""


def band_limited(
    topography: Topography, s_filter: float | None = None, l_filter: float | None = None
) -> tuple[Topography, tuple[Step, ...]]:
    """A surface without its short or its long wavelengths.

    The areal Gaussian filter, ISO 16610-61: it passes the share

        exp(-pi (alpha cutoff/wavelength)^2), alpha = sqrt(ln 2/pi),

    of a wave's amplitude, one half at the cut-off. The short cut (lambda_s, an S-filter) keeps
    what the filter passes, the long one (lambda_c, an L-filter) what it does not. A smooth
    filter leaves some of what lies beyond a cut: 1/16 at half the short cut.

    At the edge and beside missing pixels the weights that fall outside are dropped and the rest
    is scaled to a sum of one (ISO/TS 16610-28). So a constant stays as it is everywhere, but a
    tilt within about half a cut-off of an edge does not: remove the form first. Missing pixels
    stay missing.

    Parameters
    ----------
    topography
        The surface.
    s_filter
        Waves shorter than this [m] are damped; None keeps them.
    l_filter
        Waves longer than this [m] are damped; None keeps them.

    Returns
    -------
    The surface, and one step for each cut.

    Raises
    ------
    InputError
        If a cut is shorter than two pixels or longer than the map's shorter side.
    """
    steps = []
    for name, cut in (("s_filter", s_filter), ("l_filter", l_filter)):
        if cut is None:
            continue
        _require_resolved(topography, name, cut)
        smooth = _gaussian(topography, cut)
        made = topography.with_heights(
            smooth if name == "s_filter" else topography.heights - smooth
        )
        side = "below" if name == "s_filter" else "above"
        words = f"wavelengths {side} {length(cut)} cut by a Gaussian filter"
        steps.append(Step(name, words, topography.rms_height, made.rms_height, {"cut": cut}))
        topography = made
    return topography, tuple(steps)


def _require_resolved(topography: Topography, name: str, cut: float) -> None:
    """Refuse a cut that the pixels or the size of the map cannot show."""
    least, most = 2.0 * max(topography.pixel_size), min(topography.physical_size)
    # A cut of exactly two pixels may differ from it in the last digit.
    if not least * (1.0 - 1e-9) <= cut <= most * (1.0 + 1e-9):
        raise topography._error(
            f"`{name}` must lie between two pixels, {length(least)}, and the map's shorter side, "
            f"{length(most)}; got {length(cut)}; leave it out or choose a cut in between"
        )


def _gaussian(topography: Topography, cut: float) -> np.ndarray:
    """Heights [m] smoothed with a cut-off [m]; NaN where they are missing."""
    heights, missing = topography.heights, topography.missing
    passed = _transmissions(topography, cut)
    if not missing.any():
        # The weights of a rectangle without holes are a product of those of its sides.
        sides = [
            _convolved(np.ones(count), (share,))
            for count, share in zip(heights.shape, passed, strict=True)
        ]
        return _convolved(heights, passed) / (sides[0][:, None] * sides[1])
    smooth = _convolved(np.where(missing, 0.0, heights), passed)
    weights = _convolved(np.where(missing, 0.0, 1.0), passed)
    return np.divide(smooth, weights, out=np.full(heights.shape, np.nan), where=~missing)


def _transmissions(topography: Topography, cut: float) -> tuple[np.ndarray, np.ndarray]:
    """Share of each wave's amplitude that passes along y and along x, on padded sides."""
    width = _ALPHA * cut / sqrt(2.0 * pi)
    shares = []
    for count, step in zip(topography.heights.shape, topography.pixel_size[::-1], strict=True):
        padding = max(round(_REACH * width / step), _LEAST_PADDING)
        padded = fft.next_fast_len(count + padding, real=True)
        shares.append(np.exp(-pi * (_ALPHA * cut * fft.fftfreq(padded, step)) ** 2))
    return shares[0], shares[1]


def _convolved(values: np.ndarray, passed: tuple[np.ndarray, ...]) -> np.ndarray:
    """Values, zero beyond their ends, with each wave scaled by what passes along each axis."""
    for axis, share in enumerate(passed):
        waves = fft.rfft(values, share.size, axis=axis)
        share = share[: share.size // 2 + 1]
        waves *= share.reshape([-1 if i == axis else 1 for i in range(values.ndim)])
        kept = fft.irfft(waves, passed[axis].size, axis=axis)
        values = kept[: values.shape[0]] if axis == 0 else kept[:, : values.shape[1]]
    return values

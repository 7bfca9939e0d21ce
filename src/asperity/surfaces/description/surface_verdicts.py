"""What the figures of a surface mean, in sentences."""

from __future__ import annotations

from collections.abc import Sequence

from .gaussianity import Gaussianity
from .nayak import NARROWEST
from .pixel_size import RESOLVED, PixelEffect, discretisation_error
from .spectrum import Moments
from .summits import LEAST_SUMMITS, Summits

_UNSEARCHED = 0.01
_LOST = 0.02
_NEARLY = 0.05
_ANISOTROPIC = 1.5


def verdicts(
    heights: Gaussianity | None,
    summit_heights: Gaussianity | None,
    summits: Summits,
    spectral: Moments,
    effects: Sequence[PixelEffect],
) -> tuple[str, ...]:
    """Sentences on the distribution, the summits, the pixel and the validity of the models."""
    found: list[str] = []
    found.append(heights.verdict if heights else "the map is flat: its heights have no shape")
    if summits.count < LEAST_SUMMITS:
        found.append(
            f"{summits.count} summits are too few for their statistics, which need at least "
            f"{LEAST_SUMMITS}: measure a larger area or filter less"
        )
    elif summit_heights:
        found.append(summit_heights.verdict)
    found.extend(_on_counting(summits))
    found.extend(_on_pixels(effects))
    found.extend(_on_models(spectral))
    return tuple(found)


def _on_counting(summits: Summits) -> list[str]:
    """Summits that the definition or missing pixels keep from being counted."""
    found = []
    tops = summits.count + summits.plateaus
    if summits.plateaus > _LOST * tops:
        found.append(
            f"the heights are quantised: {summits.plateaus} of {tops} tops are flat over several "
            "pixels and are not counted as summits; density and radii depend on the step of height"
        )
    if summits.searched < 1.0 - _UNSEARCHED:
        found.append(
            f"missing pixels left {1.0 - summits.searched:.1%} of the map unsearched: the summit "
            "density counts this area as without summits"
        )
    return found


def _on_pixels(effects: Sequence[PixelEffect]) -> list[str]:
    """Whether the pixel resolves the summits."""
    errors = discretisation_error(effects)
    if effects[0].count < LEAST_SUMMITS:
        return []
    if errors is None or effects[1].count < LEAST_SUMMITS:
        return ["the map is too small to show the effect of the pixel size on its summits"]
    density, radius = (
        getattr(effects[1], name) / getattr(effects[0], name) for name in ("density", "radius")
    )
    if max(map(abs, errors)) <= RESOLVED:
        return [
            "the pixel resolves the summits: estimated errors of "
            f"{errors[0]:+.1%} in density and {errors[1]:+.1%} in radius"
        ]
    figures = (
        f"at every second pixel the density is {density:.3g} and the radius {radius:.3g} of that "
        "at every pixel"
    )
    if max(map(abs, errors)) <= _NEARLY:
        return [
            f"the pixel nearly resolves the summits: {figures}, so the estimated errors are "
            f"{errors[0]:+.1%} in density and {errors[1]:+.1%} in radius"
        ]
    return [
        f"the pixel does not resolve the summits: {figures}, so both are figures of this pixel "
        "size and of the instrument's noise as much as of the surface"
    ]


def _on_models(spectral: Moments) -> list[str]:
    """Whether Nayak's and McCool's assumptions hold."""
    found = []
    along, across = spectral.slopes
    if max(along, across) > _ANISOTROPIC * min(along, across):
        found.append(
            f"anisotropic: rms slopes {along:.3g} along x and {across:.3g} along y; the McCool and "
            "Nayak values assume a surface alike in all directions"
        )
    if spectral.bandwidth < NARROWEST:
        found.append(
            f"the bandwidth {spectral.bandwidth:.3g} is below {NARROWEST}: no isotropic surface "
            "has it, and Nayak's statistics do not exist"
        )
    return found

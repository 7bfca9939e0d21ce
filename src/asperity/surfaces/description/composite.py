"""Two rough surfaces as one: by convolution of their distributions, and by adding their maps."""

from __future__ import annotations

from dataclasses import dataclass

from ..topography import Topography
from .convolution import (
    HeightDistribution,
    convolved,
    distribution_against_gaussian,
    independent_sums,
)
from .gaussianity import Gaussianity, Independent, independent_heights, independent_summits
from .sum_of_maps import added, adding_in_words
from .summits import LEAST_SUMMITS, Summits, find_summits


@dataclass(frozen=True, eq=False)
class Composite:
    """Two surfaces as one rough surface against a flat one.

    Attributes
    ----------
    heights, summits
        The two height distributions convolved, and those of the summits. The latter is the
        publication's distribution of peaks; None with fewer than ten summits on either.
    height_gaussianity, summit_gaussianity
        Those against the Gaussian.
    added
        The sum of the maps: densities and curvatures of the composite come from it.
    added_summits
        Its summits.
    how
        How the maps were added, in words.
    """

    heights: HeightDistribution
    height_gaussianity: Gaussianity
    summits: HeightDistribution | None
    summit_gaussianity: Gaussianity | None
    added: Topography
    added_summits: Summits
    how: str

    @property
    def rms_height(self) -> float:
        """Standard deviation [m] of the convolved heights: the root of the sum of the squares."""
        return self.height_gaussianity.rms


def composite(first: Topography, second: Topography) -> Composite:
    """Two surfaces that face each other, as one against a flat.

    The publication convolves the two distributions; that needs no common pixel, and it holds
    for surfaces that know nothing of each other. Adding the maps is one sample of it, and
    the only source of the composite's densities and curvatures.

    Parameters
    ----------
    first, second
        The maps, levelled, heights outwards from either body.

    Raises
    ------
    InputError
        If both are flat, or if they share fewer than three pixels a side.
    """
    maps = (first, second)
    whole = added(first, second)
    worth = [independent_heights(surface) for surface in maps]
    heights = convolved(first.heights, second.heights)
    tops = [find_summits(surface) for surface in maps]
    enough = min(found.count for found in tops) >= LEAST_SUMMITS
    summits = convolved(tops[0].heights, tops[1].heights) if enough else None
    return Composite(
        heights=heights,
        height_gaussianity=distribution_against_gaussian(
            heights,
            independent_sums((first.rms_height, second.rms_height), (worth[0], worth[1])),
            "composite heights",
        ),
        summits=summits,
        summit_gaussianity=_peaks(summits, tops, worth) if summits is not None else None,
        added=whole,
        added_summits=find_summits(whole),
        how=adding_in_words(first, second),
    )


def _peaks(
    distribution: HeightDistribution, tops: list[Summits], worth: list[Independent]
) -> Gaussianity:
    """The convolved summit heights against the Gaussian."""
    one, other = (
        independent_summits(found.count, number) for found, number in zip(tops, worth, strict=True)
    )
    independent = independent_sums((tops[0].rms_height, tops[1].rms_height), (one, other))
    return distribution_against_gaussian(distribution, independent, "composite summit heights")

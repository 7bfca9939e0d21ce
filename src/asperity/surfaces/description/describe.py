"""A surface described: heights, summits, spectrum, models, and what they mean."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from ..topography import Topography
from .gaussianity import (
    Gaussianity,
    Independent,
    gaussianity,
    independent_heights,
    independent_summits,
)
from .nayak import NARROWEST, McCool, Nayak, mccool
from .pixel_size import PixelEffect, discretisation_error, pixel_effect
from .spectrum import Moments, ProfileSpectrum, moments, profile_spectrum
from .summits import LEAST_SUMMITS, Summits, find_summits
from .surface_verdicts import verdicts


@dataclass(frozen=True, eq=False)
class Description:
    """What a map says of its surface; made by `describe`.

    Attributes
    ----------
    topography
        The map.
    heights
        The heights against the Gaussian; None for a flat map.
    spectral
        Spectral moments by finite differences.
    along_x, along_y
        Spectra of the profiles; None where no profile is complete.
    summits
        All summits.
    summit_heights
        Their heights against the Gaussian; None below ten summits.
    mccool, nayak
        What the moments say of the summits of a Gaussian isotropic surface; None where they
        cannot.
    effects
        The effect of the pixel size, the map's own pixel first.
    verdicts
        What it means, in sentences.
    """

    topography: Topography
    heights: Gaussianity | None
    spectral: Moments
    along_x: ProfileSpectrum | None
    along_y: ProfileSpectrum | None
    summits: Summits
    summit_heights: Gaussianity | None
    mccool: McCool | None
    nayak: Nayak | None
    effects: tuple[PixelEffect, ...]
    verdicts: tuple[str, ...]

    @property
    def independent(self) -> Independent:
        """How many independent heights the map is worth; 1 for a flat one."""
        return self.heights.independent if self.heights else Independent(1.0, 1.0, 1.0)

    def as_json(self) -> dict[str, Any]:
        """The figures in SI units, by name; None or NaN where a figure does not exist."""
        surface, heights, summits = self.topography, self.heights, self.summits
        return {
            "source": surface.source,
            "pixels": surface.heights.shape[::-1],
            "pixel_size": surface.pixel_size,
            "physical_size": surface.physical_size,
            "missing_pixels": surface.missing_pixels,
            "rms_height": surface.rms_height,
            "peak_to_valley": surface.peak_to_valley,
            "skewness": heights and heights.skewness,
            "kurtosis": heights and heights.kurtosis,
            "gaussian": _gaussian(heights),
            "moments": [self.spectral.m0, self.spectral.m2, self.spectral.m4],
            "bandwidth": self.spectral.bandwidth,
            "rms_slopes": self.spectral.slopes,
            "spectrum_moments": self._spectrum_moments(),
            "summit_density": summits.density,
            "summit_radius": summits.radius,
            "summit_rms_height": summits.rms_height if self.summit_heights else None,
            "summits": self._summits(),
            "mccool": self.mccool and asdict(self.mccool),
            "nayak": self.nayak and self.nayak.as_json(),
            "pixel_effect": [asdict(effect) for effect in self.effects],
            "discretisation_error": self._errors(),
            "verdicts": self.verdicts,
        }

    def _summits(self) -> dict[str, Any]:
        """Figures of the summits; those of their distribution only from ten summits up."""
        found, shape = self.summits, self.summit_heights
        return {
            "count": found.count,
            "plateaus": found.plateaus,
            "searched": found.searched,
            "mean_height": found.mean_height,
            "rms_height": found.rms_height if shape else None,
            "mean_radius": found.mean_radius,
            "median_radius": found.median_radius,
            "skewness": shape and shape.skewness,
            "kurtosis": shape and shape.kurtosis,
            "gaussian": _gaussian(shape),
        }

    def _spectrum_moments(self) -> list[float] | None:
        """Moments m0, m2, m4 of the spectra, the mean of both directions."""
        if self.along_x is None or self.along_y is None:
            return None
        both = (self.along_x, self.along_y)
        return [0.5 * sum(one.moment(order) for one in both) for order in (0, 2, 4)]

    def _errors(self) -> dict[str, float] | None:
        """Estimated relative errors of the counted density and radius."""
        errors = discretisation_error(self.effects)
        return dict(zip(("density", "radius"), errors, strict=True)) if errors else None


def describe(topography: Topography) -> Description:
    """Heights, summits, spectral moments and models of a map, with verdicts in words.

    The map is taken as it is: nothing is levelled, filtered or filled. What is absent
    for want of summits or roughness is None, and a verdict says so.
    """
    heights = topography.heights
    present = heights[~topography.missing] if topography.missing_pixels else heights
    worth = independent_heights(topography)
    shape = gaussianity(present, worth, "heights")
    spectral, summits = moments(topography), find_summits(topography)
    tops = _summit_shape(summits, worth)
    effects = pixel_effect(topography, summits, spectral)
    return Description(
        topography=topography,
        heights=shape,
        spectral=spectral,
        along_x=profile_spectrum(topography, "x"),
        along_y=profile_spectrum(topography, "y"),
        summits=summits,
        summit_heights=tops,
        mccool=mccool(spectral),
        nayak=_nayak(spectral),
        effects=effects,
        verdicts=verdicts(shape, tops, summits, spectral, effects),
    )


def _summit_shape(summits: Summits, worth: Independent) -> Gaussianity | None:
    """Summit heights against the Gaussian; None where they are too few."""
    if summits.count < LEAST_SUMMITS:
        return None
    independent = independent_summits(summits.count, worth)
    return gaussianity(summits.heights, independent, "summit heights")


def _nayak(spectral: Moments) -> Nayak | None:
    """Nayak's statistics, where an isotropic surface can have the moments."""
    if not (spectral.bandwidth >= NARROWEST and spectral.m4 > 0.0):
        return None
    return Nayak(spectral.m0, spectral.m2, spectral.m4)


def _gaussian(shape: Gaussianity | None) -> dict[str, Any]:
    """Statistic, p-value and number of independent values; null where nothing has a shape."""
    return {
        "statistic": shape and shape.statistic,
        "p_value": shape and shape.p_value,
        "independent": shape and shape.independent.distribution,
    }

"""A surface made ready to be described: gaps, scan lines, form and wavelengths, in this order."""

from __future__ import annotations

from dataclasses import dataclass

from ...errors import InputError
from ..topography import Topography
from . import gaussian_filter, line_levelling
from .form_removal import FORMS, levelled
from .gaussian_filter import band_limited
from .line_levelling import lines_aligned
from .missing_pixels import MISSING, filled
from .step import Step


@dataclass(frozen=True)
class Preparation:
    """What to do to a surface before it is described.

    Parameters
    ----------
    missing
        Missing pixels: ``refuse``, ``keep`` or ``fill``.
    form_removal
        Form: ``none``, ``mean``, ``tilt``, ``curvature`` or ``sphere``.
    line_levelling
        Scan lines: ``none``, ``median``, ``median-difference`` or ``polynomial``.
    direction
        What a scan line is: ``rows`` or ``columns``.
    degree
        Degree of the polynomial of a scan line, 0 to 5.
    s_filter, l_filter
        Wavelengths [m] below and above which waves are cut; None keeps them.

    Raises
    ------
    InputError
        If a value is none of these; the error names its key.
    """

    missing: str = "refuse"
    form_removal: str = "tilt"
    line_levelling: str = "none"
    direction: str = "rows"
    degree: int = 1
    s_filter: float | None = None
    l_filter: float | None = None

    def __post_init__(self) -> None:
        for key, value, known in (
            ("missing", self.missing, MISSING),
            ("form_removal", self.form_removal, FORMS),
            ("line_levelling", self.line_levelling, ("none", *line_levelling.ALIGNMENTS)),
        ):
            if value not in known:
                raise InputError(
                    f"`{key}` must be one of {', '.join(known)}; got {value!r}", key=key
                )
        line_levelling.checked(
            self.line_levelling if self.line_levelling != "none" else "median",
            self.direction,
            self.degree,
        )
        if self.line_levelling == "none" and self.direction != "rows":
            raise InputError(
                f"`direction` must be absent without `line_levelling`; got {self.direction!r}",
                key="direction",
            )
        if self.line_levelling != "polynomial" and self.degree != 1:
            raise InputError(
                f"`degree` must be absent without `line_levelling` 'polynomial'; got {self.degree}",
                key="degree",
            )
        gaussian_filter.checked(self.s_filter, self.l_filter)


@dataclass(frozen=True)
class Prepared:
    """A prepared surface and how it was prepared.

    Parameters
    ----------
    topography
        The surface.
    steps
        What was done, in order.
    missing_pixels
        How many pixels were missing in the surface as it was read.
    """

    topography: Topography
    steps: tuple[Step, ...]
    missing_pixels: int

    @property
    def sentences(self) -> tuple[str, ...]:
        """The steps in words, each with the rms height before and after it."""
        return tuple(step.sentence for step in self.steps)

    def to_json(self) -> dict[str, object]:
        """Missing pixels and steps as plain numbers and text, in SI units."""
        return {
            "missing_pixels": self.missing_pixels,
            "steps": [step.to_json() for step in self.steps],
        }


def prepared(topography: Topography, preparation: Preparation) -> Prepared:
    """A surface prepared as asked.

    The order is fixed. Missing pixels are counted, and refused if they are to be. Scan lines are
    levelled, while the offsets are still all that differs from line to line. The form is removed,
    for the filters need a surface without one at its edges. The short and the long wavelengths
    are cut. Last, missing pixels are filled, so that no invented height enters a fit.

    Parameters
    ----------
    topography
        The surface as it was read.
    preparation
        What to do.

    Returns
    -------
    The surface with its steps.

    Raises
    ------
    InputError
        If pixels are missing and are to be refused, or if a step refuses the surface.
    """
    count = topography.missing_pixels
    steps = []
    if preparation.missing == "refuse" or count == 0:
        filled(topography, preparation.missing)
    if preparation.line_levelling != "none":
        topography, step = lines_aligned(
            topography, preparation.line_levelling, preparation.direction, preparation.degree
        )
        steps.append(step)
    if preparation.form_removal != "none":
        topography, step = levelled(topography, preparation.form_removal)
        steps.append(step)
    topography, cuts = band_limited(topography, preparation.s_filter, preparation.l_filter)
    steps.extend(cuts)
    if count:
        topography, step = filled(topography, preparation.missing)
        steps.append(step)
    return Prepared(topography, tuple(steps), count)

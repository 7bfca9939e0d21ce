"""A surface made ready to be described: gaps, scan lines, form and wavelengths, in this order."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from ...errors import InputError
from ..topography import Topography
from .form_removal import FORMS, levelled
from .gaussian_filter import band_limited
from .line_levelling import ALIGNMENTS, DIRECTIONS, lines_aligned
from .missing_pixels import MISSING, filled
from .step import Step, length


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
            ("line_levelling", self.line_levelling, ALIGNMENTS),
            ("direction", self.direction, DIRECTIONS),
        ):
            if value not in known:
                raise InputError(
                    f"`{key}` must be one of {', '.join(known)}; got {value!r}", key=key
                )
        if isinstance(self.degree, bool) or self.degree not in range(6):
            raise InputError(
                f"`degree` must be a whole number from 0 to 5; got {self.degree!r}", key="degree"
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
        self._refuse_cuts()

    def _refuse_cuts(self) -> None:
        """Refuse cuts that are no lengths or leave nothing between them."""
        short, long = self.s_filter, self.l_filter
        for key, value in (("s_filter", short), ("l_filter", long)):
            if value is not None and not (isfinite(value) and value > 0.0):
                raise InputError(f"`{key}` must be a positive length; got {value} m", key=key)
        if short is not None and long is not None and short >= long:
            raise InputError(
                f"`s_filter` must lie below `l_filter`, {length(long)}; got {length(short)}",
                key="s_filter",
            )


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
    if count and preparation.missing == "refuse":
        raise topography._error(
            f"{count} of {topography.heights.size} pixels are missing; fill them with --missing "
            "fill (in a case: missing = 'fill'), or leave them out with --missing keep"
        )
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

"""Form of a surface: mean, tilt, curvature or a sphere, found and removed."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, degrees, inf, isfinite

import numpy as np
from numpy.polynomial import legendre

from ..topography import Topography
from .sphere_fit import fitted_sphere
from .step import Step, length

FORMS = ("none", "mean", "tilt", "curvature", "sphere")
"""What can be removed; each but the last contains the one before."""

_TERMS = {
    "mean": ((0, 0),),
    "tilt": ((0, 0), (1, 0), (0, 1)),
    "curvature": ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)),
}
"""Degrees along x and y of the polynomials that a form is made of."""


@dataclass(frozen=True)
class Form:
    """A smooth surface that heights were measured from.

    Parameters
    ----------
    heights
        Its heights [m], shape (rows, columns).
    slopes
        Slope (x, y) [-] at the centre of the map.
    second
        Second derivatives (x, y, mixed) [1/m] at the centre; zero where the form has none.
    radius
        Radius [m] of the sphere: positive where it bulges up, negative for a hollow; None for
        other forms.
    """

    heights: np.ndarray
    slopes: tuple[float, float] = (0.0, 0.0)
    second: tuple[float, float, float] = (0.0, 0.0, 0.0)
    radius: float | None = None


def levelled(topography: Topography, form_removal: str) -> tuple[Topography, Step]:
    """A surface measured from its mean, its plane, its paraboloid or its sphere.

    The form has the least squares of vertical distance over all pixels that are not missing.

    Parameters
    ----------
    topography
        The surface.
    form_removal
        ``mean``; ``tilt``, a plane; ``curvature``, the full polynomial of second
        order; ``sphere``, a true sphere, bulging up or hollow, seen from above.

    Returns
    -------
    The surface, and the step: tilt [rad] along x and y at the centre of the map, principal radii
    of curvature [m] or the sphere's radius [m], positive where the form bulges up.

    Raises
    ------
    InputError
        If too few pixels, or only pixels on a line, are left to fit, or if no sphere passes over
        all of them.
    """
    form = (
        _sphere(topography) if form_removal == "sphere" else _polynomial(topography, form_removal)
    )
    made = topography.with_heights(topography.heights - form.heights)
    words, values = _in_words(form, form_removal)
    values = {"removed": form_removal, **values}
    return made, Step("form", words, topography.rms_height, made.rms_height, values)


def _polynomial(topography: Topography, form_removal: str) -> Form:
    """The polynomial of least squares; its sums factorise into products of matrices."""
    heights, terms = topography.heights, _TERMS[form_removal]
    along_x, along_y = (
        legendre.legvander(np.linspace(-1.0, 1.0, count), 2) for count in heights.shape[::-1]
    )
    finite = ~topography.missing
    level = np.nanmean(heights)
    known = np.where(finite, heights - level, 0.0)
    pairs = [
        (vander[:, :, None] * vander[:, None, :]).reshape(-1, 9) for vander in (along_x, along_y)
    ]
    products = (pairs[1].T @ finite.astype(float) @ pairs[0]).reshape(3, 3, 3, 3)
    sums = along_y.T @ known @ along_x
    gram = np.array([[products[q, s, p, r] for r, s in terms] for p, q in terms])
    if np.linalg.matrix_rank(gram, hermitian=True, tol=1e-10 * finite.sum()) < len(terms):
        raise topography._error(
            f"removing `{form_removal}` needs {len(terms)} pixels that do not lie on a line; got "
            f"{finite.sum()} pixels that are not missing; remove 'mean', or fill the gaps first"
        )
    solved = np.linalg.solve(gram, [sums[q, p] for p, q in terms])
    weights = np.zeros((3, 3))
    for (p, q), weight in zip(terms, solved, strict=True):
        weights[q, p] = weight
    return _form_of(topography, level + along_y @ weights @ along_x.T, weights)


def _form_of(topography: Topography, heights: np.ndarray, weights: np.ndarray) -> Form:
    """A form with its derivatives at the centre, from the weights [m] of Legendre polynomials."""
    x, y = (
        0.5 * (count - 1) * step
        for count, step in zip(topography.heights.shape[::-1], topography.pixel_size, strict=True)
    )
    return Form(
        heights,
        (weights[0, 1] / x, weights[1, 0] / y),
        (3.0 * weights[0, 2] / x**2, 3.0 * weights[2, 0] / y**2, weights[1, 1] / (x * y)),
    )


def _sphere(topography: Topography) -> Form:
    """The sphere of least squares."""
    cap = fitted_sphere(topography)
    return Form(cap.heights(topography), slopes=cap.slopes, radius=cap.radius)


def _in_words(form: Form, form_removal: str) -> tuple[str, dict[str, float | str | None]]:
    """What was removed, in words and in numbers."""
    tilt = [atan(slope) for slope in form.slopes]
    leaning = f"{degrees(tilt[0]):.3g} deg along x, {degrees(tilt[1]):.3g} deg along y"
    values: dict[str, float | str | None] = {"tilt_x": tilt[0], "tilt_y": tilt[1]}
    if form_removal == "mean":
        level = float(form.heights.mean())
        return f"mean removed: {length(level)}", {"mean": level}
    if form_removal == "tilt":
        return f"tilt removed: {leaning}", values
    if form_removal == "curvature":
        radii = _principal_radii(form)
        values |= {"radius_1": _or_none(radii[0]), "radius_2": _or_none(radii[1])}
        round_ = f"principal radii {length(radii[0])} and {length(radii[1])}"
        return f"curvature removed: {round_}; tilt {leaning}", values
    radius = form.radius if form.radius is not None else inf
    values["radius"] = _or_none(radius)
    side = "bulging up" if radius > 0.0 else "hollow"
    return f"sphere removed: radius {length(abs(radius))}, {side}; tilt {leaning}", values


def _principal_radii(form: Form) -> tuple[float, float]:
    """Radii of curvature [m] for small slopes, the smaller size first; positive for a bulge."""
    xx, yy, xy = form.second
    bent = sorted(-np.linalg.eigvalsh([[xx, xy], [xy, yy]]), key=abs, reverse=True)
    first, second = (1.0 / float(value) if value != 0.0 else inf for value in bent)
    return first, second


def _or_none(value: float) -> float | None:
    """A finite number, or nothing, for JSON knows no infinity."""
    return value if isfinite(value) else None

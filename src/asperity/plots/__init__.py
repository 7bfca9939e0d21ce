"""Pictures of results. The only room that knows matplotlib."""

from __future__ import annotations

from matplotlib.figure import Figure

from asperity.errors import InputError
from asperity.plots import bodies_plot, curve, energy, forces, motion_plot, style
from asperity.plots.style import Row
from asperity.results.result import Curve, Result

__all__ = ["figure", "pictures"]


def figure(result: Result | Curve, *parts: str) -> Figure:
    """Some parts of a result in one figure, under each other; without ``parts`` all.

    Parameters
    ----------
    result : Result or Curve
        What to draw.
    *parts : str
        Of "motion", "forces" and "energy" for a result, and "bodies" and "summits" where it has
        single bodies; "curve" for a curve.

    Raises
    ------
    InputError
        Where the result holds no motion, or has no such part.
    """
    rows = _rows(result)
    unknown = [part for part in parts if part not in rows]
    if unknown:
        raise InputError(f"`parts` must be of {', '.join(rows)}; got {unknown[0]!r}")
    with style.look():
        return style.figure_of([rows[part] for part in parts or rows])


def pictures(result: Result | Curve) -> dict[str, bytes]:
    """Every picture of a result as PNG and SVG, by file name; none where it holds no motion."""
    try:
        parts = _rows(result)
    except InputError:
        return {}
    found: dict[str, bytes] = {}
    for part in parts:
        found |= style.images(part, figure(result, part))
    return found


def _rows(result: Result | Curve) -> dict[str, Row]:
    """The panels of each part of a result."""
    if isinstance(result, Curve):
        return {"curve": curve.panels(result)}
    if result.time.size < 2:
        raise InputError(
            f"{result.name}: a result must hold its motion to be drawn; it has none "
            "(`output.motion` is false, or nothing was computed)"
        )
    rows = {
        "motion": motion_plot.panels(result),
        "forces": forces.panels(result),
        "energy": energy.panels(result),
    }
    if result.realisations is not None:
        rows["bodies"] = bodies_plot.panels(result, result.realisations)
        rows["summits"] = bodies_plot.summits(result.realisations)
    return rows

"""Pictures of the results of a study: lines, maps, samples, Pareto fronts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from asperity.errors import InputError
from asperity.plots import style
from asperity.plots.study import lines, maps, outcomes, points
from asperity.plots.study.panels import Page
from asperity.sweeps.analysis.pareto import Goal, front_of, table
from asperity.sweeps.analysis.view import at, view_of

if TYPE_CHECKING:
    import xarray

__all__ = ["figure", "pareto_figure", "pictures"]

_PAGES = {"lines": lines.page, "map": maps.page, "sample": points.sample_page}


def pictures(
    dataset: xarray.Dataset,
    *,
    measure: str | None = None,
    x: str | None = None,
    y: str | None = None,
    held: Mapping[str, str] | None = None,
    pareto: tuple[Goal, Goal] | None = None,
) -> dict[str, bytes]:
    """A picture of a study's results as PNG and SVG, by file name.

    Parameters
    ----------
    dataset
        The results; see `asperity.sweeps.store.dataset.open_study`.
    measure, x, y
        As for `asperity.sweeps.analysis.view.view_of`.
    held
        Axes held fixed; see `asperity.sweeps.analysis.view.at`.
    pareto
        Two measures whose front is drawn, in place of anything over axes; the front is a file
        ``pareto.csv`` besides.

    Raises
    ------
    InputError
        Where a name is unknown, or more axes are left than a picture can show.
    """
    if pareto is None:
        kind, drawn = figure(dataset, measure=measure, x=x, y=y, held=held)
        return style.images(kind, drawn)
    for option, given in (("measure", measure), ("x", x), ("y", y)):
        if given is not None:
            raise InputError(f"`{option}` and `pareto` exclude each other; got both", key=option)
    chosen, taken = at(dataset, held or {})
    drawn = pareto_figure(chosen, pareto, taken)
    listed = table(chosen, front_of(chosen, pareto))
    return style.images("pareto", drawn) | {"pareto.csv": listed}


def figure(
    dataset: xarray.Dataset,
    *,
    measure: str | None = None,
    x: str | None = None,
    y: str | None = None,
    held: Mapping[str, str] | None = None,
) -> tuple[str, Figure]:
    """The name of a kind of picture ("lines", "map", "sample"), and the picture; as `pictures`."""
    chosen, taken = at(dataset, held or {})
    view = view_of(chosen, measure=measure, x=x, y=y)
    page: Page = _PAGES[view.kind](chosen, view, _title(chosen, taken))
    return view.kind, page.figure()


def pareto_figure(dataset: xarray.Dataset, goals: tuple[Goal, Goal], taken: str = "") -> Figure:
    """All cases over two measures, with the front; ``taken`` says in words what is held fixed."""
    return points.front_page(dataset, front_of(dataset, goals), _title(dataset, taken)).figure()


def _title(dataset: xarray.Dataset, taken: str) -> str:
    """What a picture must say besides its axes."""
    return ", ".join(part for part in (taken, outcomes.incomplete(dataset)) if part)

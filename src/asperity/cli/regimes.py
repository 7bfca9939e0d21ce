"""``asperity regime`` and ``asperity adhesion-map``: which models hold, before a motion is run."""

from __future__ import annotations

import math
import textwrap
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from asperity.cli.reporter import Reporter
from asperity.cli.working import Progress, completed
from asperity.errors import InputError, SimulationError
from asperity.regimes import LAW_NAMES, Boundary, Frame, Place, Verdict, region
from asperity.results.case_source import Source, source_of
from asperity.results.record_layout import plain
from asperity.results.results_folder import check_folder, write_folder
from asperity.results.summary import WIDTH, amount, warning_lines
from asperity.writing import ending_of, refuse_present

if TYPE_CHECKING:
    from asperity.results.assessment import Assessment

MAP_FILE = "adhesion-map.png"
"""The map's picture unless another is named."""

_NAMES, _VALUES = 22, 17
_WIDEST = 24  # of a case's name on the map


def tell_regime(reporter: Reporter, case: str) -> None:
    """Print the numbers of a case with what each says.

    Parameters
    ----------
    reporter : Reporter
        What prints them.
    case : str
        As the user named it.
    """
    (found,) = _assessed([source_of(case)], reporter)
    reporter.answer(lambda: _regime_text(found), lambda: _regime_object(found))


def _regime_text(found: Assessment) -> str:
    rows = [line for name, one in found.verdicts.items() for line in _row(name, one)]
    title = f"{found.name}: which models hold"
    return "\n".join([title, "", *rows, *warning_lines(found.warnings)])


def _regime_object(found: Assessment) -> dict[str, Any]:
    numbers = {name: one._asdict() for name, one in found.verdicts.items()}
    shown: dict[str, Any] = plain(
        {"name": found.name, "regime": numbers, "warnings": found.warnings}
    )
    return shown


def draw_map(reporter: Reporter, cases: Sequence[str], *, output: str | None, force: bool) -> None:
    """Draw the adhesion map with cases on it.

    Parameters
    ----------
    reporter : Reporter
        What says where they lie.
    cases : sequence of str
        As the user named them.
    output : str or None
        The picture's path; the other files go beside it.
    force : bool
        Whether an earlier map may be replaced.
    """
    given = [source_of(case) for case in cases]
    for one in given:
        _need_a_place(one)
    picture = None
    if output is not None or not reporter.as_json:
        picture = Path(output or MAP_FILE)
        _check_picture(picture, force=force)
    found = _assessed(given, reporter)
    places = _places(given, found)
    with reporter.step("map"):
        frame = Frame.around(places)
        boundaries = frame.boundaries()
        written = _keep(picture, frame, boundaries, places) if picture else []
    reporter.answer(
        lambda: "\n".join(_map_lines(places, found)),
        lambda: plain(_map_object(boundaries, places, found)),
    )
    reporter.written(written)


def _assessed(given: Sequence[Source], reporter: Reporter) -> list[Assessment]:
    """What each case's numbers say; an error names the file."""

    def task(stop: threading.Event, progress: Progress | None) -> list[Assessment]:
        from asperity.solver import assess

        found: list[Assessment] = []
        for one in given:
            if stop.is_set():
                break
            try:
                found.append(assess(one.case, progress=progress, stop=stop))
            except InputError as error:
                error.file = error.file or one.file
                raise
            except SimulationError as error:
                raise SimulationError(
                    f"{one.file or one.case.name}: {error}", error.partial
                ) from error
        return found

    with reporter.watch() as progress:
        return completed(lambda stop: task(stop, progress))


def _row(name: str, one: Verdict) -> list[str]:
    """A number and its verdict, the verdict in a column of its own."""
    label = name.replace("_", " ").replace("tabor", "Tabor").replace("kelvin", "Kelvin")
    label = label.replace("Kelvin radius over", "over")
    if isinstance(one.value, str):
        value = LAW_NAMES.get(one.value, one.value)
    else:
        value = amount(one.value, one.unit)
    head = f"  {label:<{_NAMES}}{value:<{_VALUES}}"
    return textwrap.wrap(
        one.verdict, WIDTH, initial_indent=head, subsequent_indent=" " * (2 + _NAMES + _VALUES)
    )


def _need_a_place(given: Source) -> None:
    """Refuse a case that has no place on the map, and say what it lacks."""
    adhesion = given.case.adhesion
    if adhesion.model == "none":
        raise InputError(
            "`model` must be a law of adhesion for a place on the map; got 'none'",
            file=given.file,
            key="adhesion.model",
        )
    if adhesion.equilibrium_spacing is None:
        raise InputError(
            "`equilibrium_spacing` must be given for a place on the map, whose elasticity "
            "parameter rests on it; got nothing",
            file=given.file,
            key="adhesion.equilibrium_spacing",
        )


def _places(given: Sequence[Source], found: Sequence[Assessment]) -> list[Place]:
    """A place for each case, by its name; by what the user wrote where names are the same."""
    names = [one.name for one in found]
    out = []
    for one, assessed in zip(given, found, strict=True):
        name = assessed.name
        if names.count(name) > 1:
            name = one.file or name
        elasticity, load = assessed.regime.elasticity_parameter, assessed.regime.load_parameter
        assert elasticity is not None
        out.append(Place(name, elasticity, math.nan if load is None else load))
    return out


def _region(place: Place) -> str | None:
    return region(place.elasticity, place.load) if place.load > 0.0 else None


def _map_lines(places: Sequence[Place], found: Sequence[Assessment]) -> list[str]:
    wide = min(max(4, *(len(place.name) for place in places)) + 2, _WIDEST)
    lines = [f"{'case':<{wide}}{'elasticity':<12}{'load':<12}{'region':<16}law in use"]
    for place, assessed in zip(places, found, strict=True):
        law = LAW_NAMES[assessed.regime.adhesion_law]
        numbers = f"{place.elasticity:<12.4g}{amount(place.load):<12}"
        if len(place.name) > wide - 2:  # a long name stands on a line of its own
            lines.append(place.name)
        name = place.name if len(place.name) <= wide - 2 else ""
        lines.append(f"{name:<{wide}}{numbers}{_region(place) or '-':<16}{law}")
    pairs = zip(places, found, strict=True)
    told = [f"{place.name}: {line}" for place, assessed in pairs for line in assessed.warnings]
    return [*lines, *warning_lines(told)]


def _map_object(
    boundaries: Sequence[Boundary], places: Sequence[Place], found: Sequence[Assessment]
) -> dict[str, Any]:
    return {
        "boundaries": [
            {
                "between": line.between,
                "elasticity_parameter": line.elasticity,
                "load_parameter": line.load,
            }
            for line in boundaries
        ],
        "cases": [
            {
                "name": place.name,
                "elasticity_parameter": place.elasticity,
                "load_parameter": place.load,
                "region": _region(place),
                "adhesion_law": assessed.regime.adhesion_law,
                "warnings": assessed.warnings,
            }
            for place, assessed in zip(places, found, strict=True)
        ],
    }


def _files(picture: Path) -> list[str]:
    """The picture's name, and those of the files beside it."""
    return [picture.name, *(picture.with_suffix(suffix).name for suffix in (".svg", ".csv"))]


def _check_picture(picture: Path, *, force: bool) -> None:
    """See to it, before anything is computed, that the map can be written."""
    ending_of(picture, [".png"])
    names = _files(picture)
    for name in names:
        refuse_present(picture.parent / name, force=force)
    check_folder(picture.parent, names, force=True)


def _keep(
    picture: Path, frame: Frame, boundaries: Sequence[Boundary], places: Sequence[Place]
) -> list[Path]:
    """Write the map as PNG, SVG and CSV."""
    from asperity.plots import adhesion_map

    contents = adhesion_map.files(frame, boundaries, places)
    names = _files(picture)
    files = dict(zip(names, contents, strict=True))
    return write_folder(picture.parent, files, names, force=True)

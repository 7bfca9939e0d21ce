"""The seed publication again: its tables beside ours, its figures, and what does not add up."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from ..config import Case, builtin
from ..config.html_table import card, counted
from ..config.resolve import resolve
from ..errors import InputError, SimulationError
from ..results.record_layout import plain
from ..results.result import Result
from ..solver import solve
from . import audit, figures
from .comparison import found_of, power_of, problems_of, rows_of, table_1
from .evidence import Evidence
from .figure_data import Drawing
from .parameter_estimation import Refit, Unknowns, refit
from .published_tables import Entry, read_tables

if TYPE_CHECKING:
    from ..surfaces.measured_surface import Pair

Report = Callable[[float, str], None]
Motions = dict[tuple[float, float], Result]


@dataclass(frozen=True)
class Reproduction:
    """The tables, the inputs found, the audit and the data of the figures.

    Parameters
    ----------
    rows
        One for each published number: "table", "asperity_radius", "rms_height", "quantity",
        "published", "computed", "relative_difference"; SI, None where there is none.
    table_1
        Its Table 1 and what is in use: "quantity", "unit", "published", "used"; SI.
    found
        The inputs that the publication does not name, and how well they fit.
    power
        For each surface the published power loss over what one can compute instead.
    audit
        "claim", "published", "found", "verdict", each a text.
    drawings
        Data of the figures by name; empty where it was interrupted.
    problems
        What a refit could not do, a line each.
    surfaces
        Figures of the measured surfaces of Figures 2 and 3; None where they are synthetic.
    """

    rows: list[dict[str, Any]]
    table_1: list[dict[str, Any]]
    found: dict[str, Any]
    power: list[dict[str, float | None]]
    audit: list[dict[str, str]]
    drawings: dict[str, Drawing]
    problems: list[str] = field(default_factory=list)
    surfaces: dict[str, Any] | None = None

    def __repr__(self) -> str:
        parts = (self.rows, "published number"), (self.audit, "claim"), (self.problems, "problem")
        return f"<Reproduction: {', '.join(counted(len(of), word) for of, word in parts)}>"

    def _repr_html_(self) -> str:
        claims = [(claim["claim"], claim["verdict"]) for claim in self.audit]
        sentence = f"{counted(len(self.rows), 'published number')} beside ours; its claims:"
        return card("Reproduction", sentence, [("", claims)], self.problems)

    def json_object(self) -> dict[str, Any]:
        """What ``--json`` prints."""
        names = ("rows", "table_1", "found", "power", "audit", "problems")
        found = {name: getattr(self, name) for name in names}
        return found if self.surfaces is None else {**found, "surfaces": self.surfaces}


def reproduce(
    *,
    tables: str | None = None,
    refitted: bool = False,
    measured: Pair | None = None,
    progress: Report | None = None,
    stop: threading.Event | None = None,
    keep: Callable[[Reproduction], None] | None = None,
) -> Reproduction:
    """Compute the publication's tables and figures from its own assumptions, and audit it.

    Parameters
    ----------
    tables
        Path of a CSV of tables to compare with, see :func:`read_tables`; by default the
        publication's.
    refitted
        Whether to find the unknown inputs again from the tables, instead of taking those of
        the built-in case ``published``.
    measured
        The surfaces of Figures 2 and 3; a synthetic pair where there is none.
    progress, stop
        As for :func:`asperity.solve`. What is there when it stops is returned: the tables as
        far as they were computed, no figures.
    keep
        Called with the tables alone as soon as they are there.

    Raises
    ------
    InputError
        If the tables cannot be read, or hold a surface that the case refuses.
    SimulationError
        If a motion fails.
    """
    report = progress or (lambda fraction, text: None)
    stop = stop or threading.Event()
    entries, case = read_tables(tables), builtin("published")
    fit: Refit | None = None
    report(0.02, "tables")
    if refitted:
        before = _before(case, entries, stop)
        if keep is not None and before is not None:
            keep(before)
        fit = refit(case, entries, report=lambda f, text: report(0.2 + 0.4 * f, text), stop=stop)
        case = case if fit is None else fit.unknowns.within(case)
        if stop.is_set() and before is not None:
            return before
    partial, results = _compared(case, entries, fit, stop)
    if refitted and not stop.is_set():
        partial = replace(partial, problems=problems_of(fit, entries, partial.rows))
    if measured is not None:
        partial = replace(partial, surfaces=plain(measured.json_object()))
    if keep is not None:
        keep(partial)
    if stop.is_set():
        return partial
    report(0.2 + 0.4 * refitted, "what the exact model says")
    return _audited(partial, case, results, report, stop, measured)


def _audited(
    partial: Reproduction,
    case: Case,
    results: Motions,
    report: Report,
    stop: threading.Event,
    measured: Pair | None,
) -> Reproduction:
    """The tables with audit and figures; alone where it was stopped."""
    usable = _usable(case)
    try:
        evidence = Evidence.gather(usable, results, partial.rows, partial.power, stop)
    except SimulationError:
        if not stop.is_set():
            raise
    if stop.is_set():
        return partial
    report(0.9, "figures")
    claims = [claim._asdict() for claim in audit.claims(evidence)]
    drawings = figures.drawings(evidence, measured)
    report(1.0, "done")
    problems = [*partial.problems, *([_ELSEWHERE] if usable != case else [])]
    return replace(partial, audit=claims, drawings=drawings, problems=problems)


_ELSEWHERE = (
    "the inputs found release the sphere inside contact on the publication's own surface: the "
    "audit and the figures of that surface have the built-in inputs"
)


def _usable(case: Case) -> Case:
    """The case; the built-in one where its release lies within its own conjunction."""
    edge, gap, _ = Unknowns.of(case)
    rough = resolve(case).asperities
    assert rough is not None
    return case if gap > edge * rough.rms_height else builtin("published")


def _before(case: Case, entries: list[Entry], stop: threading.Event) -> Reproduction | None:
    """The tables with the built-in inputs; None where these do not go with a surface."""
    try:
        return _compared(case, entries, None, stop)[0]
    except InputError:
        return None


def _compared(
    case: Case, entries: list[Entry], fit: Refit | None, stop: threading.Event
) -> tuple[Reproduction, Motions]:
    """The tables beside ours, without audit and figures, and the motion on each surface."""
    results = _tables(case, entries, stop)
    rows = [row for entry in entries for row in rows_of(entry, results.get(entry.surface))]
    power = [
        power_of(entry, results[entry.surface])
        for entry in _unique(entries)
        if entry.surface in results
    ]
    found = found_of(Unknowns.of(case), rows, fit)
    return Reproduction(rows, table_1(case), found, power, [], {}), results


def surface_case(case: Case, entry: Entry) -> Case:
    """A case on another surface.

    Raises
    ------
    InputError
        Where the release lies within the conjunction there.
    """
    case, (_, height) = entry.within(case), entry.surface
    edge, gap, _ = Unknowns.of(case)
    if gap <= edge * height:
        raise InputError(
            f"`rms_height` must leave the release at {gap * 1e9:.4g} nm outside the conjunction, "
            f"which ends at {edge:g} of it; got {height * 1e9:.4g} nm"
        )
    return case


def _tables(case: Case, entries: list[Entry], stop: threading.Event) -> Motions:
    """The motion on each surface."""
    out: Motions = {}
    for entry in _unique(entries):
        try:
            motion = solve(surface_case(case, entry), name=entry.name, stop=stop, critical=False)
        except SimulationError:
            if not stop.is_set():
                raise
        if stop.is_set():
            break
        out[entry.surface] = motion
    return out


def _unique(entries: list[Entry]) -> list[Entry]:
    """The first entry of each surface."""
    found: dict[tuple[float, float], Entry] = {}
    for entry in entries:
        found.setdefault(entry.surface, entry)
    return list(found.values())

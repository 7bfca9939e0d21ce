"""The seed publication again: its tables beside ours, its figures, and what does not add up."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import radians
from typing import Any

import numpy as np

from ..case import Case, builtin
from ..errors import InputError, SimulationError
from ..materials import contact_modulus
from ..regimes import ELASTICITY_PER_TABOR, tabor_number
from ..result import Result
from ..solver import solve
from . import audit, figures
from .drawing import Drawing
from .evidence import Evidence
from .refit import WITHIN, Inputs, Refit, refit
from .tables import QUANTITIES, Entry, read_tables

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
        For each surface the published power loss over three that one can compute.
    audit
        "claim", "published", "found", "verdict", each a text.
    drawings
        Data of the figures by name; empty where it was interrupted.
    problems
        What a refit could not do, a line each.
    """

    rows: list[dict[str, Any]]
    table_1: list[dict[str, Any]]
    found: dict[str, Any]
    power: list[dict[str, float | None]]
    audit: list[dict[str, str]]
    drawings: dict[str, Drawing]
    problems: list[str] = field(default_factory=list)

    def json_object(self) -> dict[str, Any]:
        """What ``--json`` prints."""
        names = ("rows", "table_1", "found", "power", "audit", "problems")
        return {name: getattr(self, name) for name in names}


def reproduce(
    *,
    tables: str | None = None,
    refitted: bool = False,
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
    tell = progress or (lambda fraction, text: None)
    stop = stop or threading.Event()
    entries, case = read_tables(tables), builtin("published")
    fit: Refit | None = None
    tell(0.02, "tables")
    if refitted:
        before = _before(case, entries, stop)
        if keep is not None and before is not None:
            keep(before)
        fit = refit(case, entries, tell=lambda f, text: tell(0.2 + 0.4 * f, text), stop=stop)
        case = case if fit is None else fit.inputs.within(case)
        if stop.is_set() and before is not None:
            return before
    partial, results = _compared(case, entries, fit, stop)
    if refitted and not stop.is_set():
        partial = replace(partial, problems=_problems(fit, entries, partial.rows))
    if keep is not None:
        keep(partial)
    if stop.is_set():
        return partial
    tell(0.2 + 0.4 * refitted, "what the exact model says")
    return _audited(partial, case, results, tell, stop)


def _audited(
    partial: Reproduction, case: Case, results: Motions, tell: Report, stop: threading.Event
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
    tell(0.9, "figures")
    claims = [claim._asdict() for claim in audit.claims(evidence)]
    drawings = figures.drawings(evidence)
    tell(1.0, "done")
    problems = [*partial.problems, *([_ELSEWHERE] if usable != case else [])]
    return replace(partial, audit=claims, drawings=drawings, problems=problems)


_ELSEWHERE = (
    "the inputs found release the sphere inside contact on the publication's own surface: the "
    "audit and the figures of that surface have the built-in inputs"
)


def _usable(case: Case) -> Case:
    """The case; the built-in one where its release lies within its own conjunction."""
    edge, gap, _ = Inputs.of(case)
    assert case.roughness is not None
    return case if gap > edge * case.roughness.rms_height else builtin("published")


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
    rows = [row for entry in entries for row in _rows(entry, results.get(entry.surface))]
    power = [
        _power(entry, results[entry.surface])
        for entry in _unique(entries)
        if entry.surface in results
    ]
    found = _found(Inputs.of(case), rows, fit)
    return Reproduction(rows, table_1(case), found, power, [], {}), results


def table_1(case: Case) -> list[dict[str, Any]]:
    """Table 1 and the numbers derived from it, as published and as a case has them."""
    body, flat, rough = case.body_solid, case.counterface_solid, case.roughness
    liquid, adhesion = case.liquid, case.adhesion
    assert rough is not None
    assert liquid is not None
    assert adhesion.work is not None
    assert adhesion.range is not None
    modulus = contact_modulus(body, flat)
    tabor = tabor_number(rough.asperity_radius, adhesion.work, modulus, adhesion.range)
    lines = (
        ("Young's modulus of silica", "Pa", 80e9, body.youngs_modulus),
        ("Young's modulus of silicon carbide", "Pa", 161e9, flat.youngs_modulus),
        ("Poisson's ratio of silica", "1", 0.25, body.poisson),
        ("Poisson's ratio of silicon carbide", "1", 0.23, flat.poisson),
        ("asperities per area", "1/m^2", 169e14, rough.asperity_density),
        ("work of adhesion", "J/m^2", 30e-3, adhesion.work),
        ("tension of water", "J/m^2", 75e-3, liquid.tension),
        ("contact angle", "rad", radians(73.0), case.capillary.contact_angle),
        ("contact modulus", "Pa", None, modulus),
        ("Tabor number", "1", 0.02, tabor),
        ("elasticity parameter", "1", 0.0235, ELASTICITY_PER_TABOR * tabor),
    )
    names = ("quantity", "unit", "published", "used")
    return [dict(zip(names, line, strict=True)) for line in lines]


def surface_case(case: Case, entry: Entry) -> Case:
    """A case on another surface.

    Raises
    ------
    InputError
        Where the release lies within the conjunction there.
    """
    case, (_, height) = entry.within(case), entry.surface
    edge, gap, _ = Inputs.of(case)
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
            motion = solve(surface_case(case, entry), name=entry.name, stop=stop)
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


def mean_power_loss(result: Result, rest: float = 0.0) -> float | None:
    """Mean over the impacts of eq. 23, the one-way work over the impact time [W].

    Parameters
    ----------
    result
        A motion.
    rest
        Share of the first rebound: the first impact whose rebound is lower is the last counted.
    """
    if not any(value is not None for value in result.measures["log_decrement"]):
        return None  # it sticks at once: there is no impact time
    heights = [height or 0.0 for height in result.measures["rebound_height"]]
    low = [k for k, height in enumerate(heights) if height < rest * heights[0]]
    counted = result.measures["power_loss_published"][: low[0] + 1 if low else None]
    values = [value for value in counted if value is not None]
    return float(np.mean(values)) if values else None


def computed(result: Result) -> dict[str, float | None]:
    """What a motion gives for each quantity of the tables."""
    decrements = result.measures["log_decrement"]
    return {
        "log_decrement": decrements[0] if decrements else None,
        "stiction_time": result.measures["stiction_time"],
        "power_loss": mean_power_loss(result),
    }


def _rows(entry: Entry, result: Result | None) -> list[dict[str, Any]]:
    ours = computed(result) if result is not None else dict.fromkeys(QUANTITIES)
    rows = []
    for quantity in QUANTITIES:
        published, mine = entry.values[quantity], ours[quantity]
        both = published is not None and mine is not None
        rows.append(
            {
                "table": entry.table,
                "asperity_radius": entry.asperity_radius,
                "rms_height": entry.rms_height,
                "quantity": quantity,
                "published": published,
                "computed": mine,
                "relative_difference": mine / published - 1.0 if both else None,  # type: ignore[operator]
            }
        )
    return rows


def _power(entry: Entry, result: Result) -> dict[str, float | None]:
    """Published power loss over the two energy balances, and over the mean of eq. 23."""
    published, measures = entry.values["power_loss"], result.measures
    first, mean = measures["power_loss"][0], mean_power_loss(result)
    rest, release = measures["stiction_time"], result.ledger["initial"]
    whole = release / rest if rest else None

    def ratio(balance: float | None) -> float | None:
        return published / balance if published and balance else None

    return {
        "asperity_radius": entry.asperity_radius,
        "rms_height": entry.rms_height,
        "published": published,
        "over_first_impact": ratio(first),
        "over_whole_drop": ratio(whole),
        "over_mean_of_impacts": ratio(mean),
        "over_mean_of_large_impacts": ratio(mean_power_loss(result, 1e-2)),
    }


def _found(inputs: Inputs, rows: list[dict[str, Any]], fit: Refit | None) -> dict[str, Any]:
    """The inputs and how well they fit, as plain numbers."""
    # The row that both tables share counts once.
    off = {
        (row["asperity_radius"], row["rms_height"], row["quantity"], row["published"]): row[
            "relative_difference"
        ]
        for row in rows
        if row["quantity"] in WITHIN and row["published"] is not None
    }
    whole = bool(off) and None not in off.values()
    rms = float(np.sqrt(np.mean(np.square(list(off.values()))))) if whole else None
    if fit is not None:
        rms = fit.rms
    out: dict[str, Any] = {**inputs._asdict(), "rms": rms, "refitted": fit is not None}
    if fit is not None:
        out["uncertainty"] = {k: _number(v) for k, v in fit.uncertainty._asdict().items()}
        out["correlation"] = [[_number(v) for v in line] for line in fit.correlation]
        out["profile"] = [{**held._asdict(), "rms": rms} for held, rms in fit.profile]
    return out


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _problems(fit: Refit | None, entries: list[Entry], rows: list[dict[str, Any]]) -> list[str]:
    """Published numbers that are missing or that no inputs meet."""
    missing = [
        f"{quantity} at {entry.name} (table {entry.table})"
        for entry in entries
        for quantity in WITHIN
        if entry.values[quantity] is None
    ]
    problems = []
    if missing:
        problems.append(f"the tables are missing {', '.join(missing)}")
    if fit is None:
        problems.append("fewer than three numbers are left for three inputs: nothing was refitted")
    missed = [
        f"{row['quantity']} at {row['asperity_radius'] * 1e9:.4g}, "
        f"{row['rms_height'] * 1e9:.4g} nm (off by {_off(row)})"
        for row in rows
        if row["quantity"] in WITHIN
        and row["published"] is not None
        and not abs(row["relative_difference"] or np.inf) <= WITHIN[row["quantity"]]
    ]
    if missed:
        problems.append(f"no inputs meet {', '.join(dict.fromkeys(missed))}")
    return problems


def _off(row: dict[str, Any]) -> str:
    difference = row["relative_difference"]
    return "no rest" if difference is None else f"{100.0 * difference:+.0f} %"

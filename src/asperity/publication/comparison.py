"""Published numbers beside computed ones: the tables, the power losses, what a refit misses."""

from __future__ import annotations

from collections.abc import Sequence
from math import radians
from typing import Any

import numpy as np

from ..config import Case
from ..config.resolve import resolve
from ..regimes import ELASTICITY_PER_TABOR, tabor_number
from ..results.result import Result
from .parameter_estimation import WITHIN, Refit, Unknowns
from .published_tables import QUANTITIES, Entry


def table_1(case: Case) -> list[dict[str, Any]]:
    """Table 1 and the numbers derived from it, as published and as a case has them."""
    inputs = resolve(case)
    body, flat, rough, liquid = inputs.body, inputs.counterface, inputs.asperities, inputs.liquid
    assert rough is not None
    assert liquid is not None
    work, modulus = inputs.work_of_adhesion, inputs.modulus
    tabor = tabor_number(inputs.tip_radius, work, modulus, inputs.equilibrium_spacing)
    lines = (
        ("Young's modulus of silica", "Pa", 80e9, body.youngs_modulus),
        ("Young's modulus of silicon carbide", "Pa", 161e9, flat.youngs_modulus),
        ("Poisson's ratio of silica", "1", 0.25, body.poisson),
        ("Poisson's ratio of silicon carbide", "1", 0.23, flat.poisson),
        ("asperities per area", "1/m^2", 169e14, rough.asperity_density),
        ("work of adhesion", "J/m^2", 30e-3, work),
        ("tension of water", "J/m^2", 75e-3, liquid.tension),
        ("contact angle", "rad", radians(73.0), inputs.contact_angle),
        ("contact modulus", "Pa", None, modulus),
        ("Tabor number", "1", 0.02, tabor),
        ("elasticity parameter", "1", 0.0235, ELASTICITY_PER_TABOR * tabor),
    )
    names = ("quantity", "unit", "published", "used")
    return [dict(zip(names, line, strict=True)) for line in lines]


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
        "time_to_rest": result.measures["time_to_rest"],
        "power_loss": mean_power_loss(result),
    }


def rows_of(entry: Entry, result: Result | None) -> list[dict[str, Any]]:
    """A row for each quantity of an entry; nothing computed where there is no motion."""
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


def power_of(entry: Entry, result: Result) -> dict[str, float | None]:
    """Published power loss over the two energy balances, and over the mean of eq. 23."""
    published, measures = entry.values["power_loss"], result.measures
    first, mean = measures["power_loss"][0], mean_power_loss(result)
    rest, release = measures["time_to_rest"], result.ledger["initial"]
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


def found_of(unknowns: Unknowns, rows: list[dict[str, Any]], fit: Refit | None) -> dict[str, Any]:
    """What the text leaves open, and how well it fits, as plain numbers."""
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
    out: dict[str, Any] = {**unknowns._asdict(), "rms": rms, "refitted": fit is not None}
    if fit is not None:
        out["uncertainty"] = {k: _number(v) for k, v in fit.uncertainty._asdict().items()}
        out["correlation"] = [[_number(v) for v in line] for line in fit.correlation]
        out["profile"] = [{**held._asdict(), "rms": rms} for held, rms in fit.profile]
    return out


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def problems_of(
    fit: Refit | None, entries: Sequence[Entry], rows: list[dict[str, Any]]
) -> list[str]:
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
        if row["quantity"] in WITHIN and row["published"] is not None and not _met(row)
    ]
    if missed:
        problems.append(f"no inputs meet {', '.join(dict.fromkeys(missed))}")
    return problems


def _met(row: dict[str, Any]) -> bool:
    difference = row["relative_difference"]
    return difference is not None and abs(difference) <= WITHIN[row["quantity"]]


def _off(row: dict[str, Any]) -> str:
    difference = row["relative_difference"]
    return "no rest" if difference is None else f"{100.0 * difference:+.0f} %"

"""A reproduction in words and tables: for a terminal, and as files."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Collection, Iterable
from typing import Any

from ..results.summary import WIDTH, amount
from ..writing import csv_of
from .audit import Claim
from .published_tables import QUANTITIES
from .reproduce import Reproduction

_BALANCES = (
    "over_first_impact", "over_whole_drop", "over_mean_of_impacts", "over_mean_of_large_impacts",
)  # fmt: skip


def brief(done: Reproduction) -> str:
    """What a terminal shows: the tables side by side, the inputs, the power, the verdicts."""
    return "\n".join([*_tables(done), *_inputs(done), *_power(done), *_verdicts(done)])


def whole(done: Reproduction) -> str:
    """The same with every line of the audit, for ``summary.txt``."""
    lines = [*_tables(done), *_inputs(done), *_power(done)]
    for claim in done.audit:
        lines += ["", *textwrap.wrap(f"{claim['claim']}: {claim['verdict']}", WIDTH)]
        for side in ("published", "found"):
            lines += textwrap.wrap(
                f"{side:<11}{claim[side]}", WIDTH, initial_indent="  ", subsequent_indent=" " * 13
            )
    return "\n".join([*lines, ""])


def files(done: Reproduction) -> dict[str, bytes]:
    """The tables, the audit and both together, by file name."""
    return {
        "tables.csv": _csv(done.rows[0], done.rows),
        "table-1.csv": _csv(done.table_1[0], done.table_1),
        "audit.csv": _csv(Claim._fields, done.audit),
        "reproduction.json": json.dumps(
            done.json_object(), allow_nan=False, indent=1, ensure_ascii=False
        ).encode(),
        "summary.txt": whole(done).encode(),
    }


def _csv(columns: Collection[str], rows: Iterable[dict[str, Any]]) -> bytes:
    return csv_of(columns, ([row[name] for name in columns] for row in rows))


def _tables(done: Reproduction) -> list[str]:
    """Published beside what is used or computed, a line for each quantity or surface."""
    lines = ["Table 1: published / used"]
    for row in done.table_1:
        published, used = (amount(row[side], row["unit"]) for side in ("published", "used"))
        lines.append(f"  {row['quantity']:<36}{published:>16} / {used}")
    lines.append("")
    for table in dict.fromkeys(row["table"] for row in done.rows):
        lines += [
            f"Table {table}: published / computed (power loss: mean of eq. 23 over all impacts)"
        ]
        lines.append(_line(("beta", "sigma"), (q.words for q in QUANTITIES.values())))
        rows = [row for row in done.rows if row["table"] == table]
        surfaces = dict.fromkeys((row["asperity_radius"], row["rms_height"]) for row in rows)
        for surface in surfaces:
            cells = [
                _pair(row) for row in rows if (row["asperity_radius"], row["rms_height"]) == surface
            ]
            lines.append(_line([amount(x, "m") for x in surface], cells))
        lines.append("")
    return lines


def _line(left: Iterable[str], cells: Iterable[str]) -> str:
    return ("".join(f"{x:>9}" for x in left) + "".join(f"{x:>20}" for x in cells)).rstrip()


def _pair(row: dict[str, Any]) -> str:
    unit = QUANTITIES[row["quantity"]].unit
    published, computed = (amount(row[side], unit) for side in ("published", "computed"))
    # The unit once where both have the same.
    number, _, prefixed = published.partition(" ")
    if prefixed and computed.endswith(f" {prefixed}"):
        published = number
    return f"{published} / {computed}"


def _inputs(done: Reproduction) -> list[str]:
    found = done.found
    how = "found again from the tables" if found["refitted"] else "of the built-in case"
    spread = found.get("uncertainty") or {}
    lines = [f"Inputs that the text does not name, {how}"]
    for name, unit in (
        ("conjunction_ends", ""),
        ("release_separation", "m"),
        ("capillary_factor", ""),
    ):
        within = f" +- {amount(spread[name], unit)}" if spread.get(name) else ""
        lines.append(f"  {name.replace('_', ' '):<20}{amount(found[name], unit)}{within}")
    rms = found["rms"]
    lines.append(f"  {'rms difference':<20}{'-' if rms is None else f'{100.0 * rms:.2f} %'}")
    if found.get("correlation"):
        correlation = amount(found["correlation"][0][2])
        lines.append(f"  correlation of the conjunction's end and the factor: {correlation}")
        lines.append("  other ends of the conjunction, with the best gap and factor:")
        for held in found["profile"]:
            lines.append(
                f"    {held['conjunction_ends']:<6g}{amount(held['release_separation'], 'm'):<12}"
                f"{amount(held['capillary_factor']):<10}rms {100.0 * held['rms']:.2f} %"
            )
    return lines


def _power(done: Reproduction) -> list[str]:
    lines = [
        "",
        "Published power loss over the energy lost in the first impact by its time, over",
        "the energy of the whole drop by the time to rest, over the mean of eq. 23 over",
        "all impacts until a rebound of 1e-3 of the first, and until 1e-2",
    ]
    for row in done.power:
        left = [amount(row[name], "m") for name in ("asperity_radius", "rms_height")]
        lines.append(_line(left, [f"{_ratio(row[name]):>12}" for name in _BALANCES]))
    return lines


def _ratio(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"


def _verdicts(done: Reproduction) -> list[str]:
    if not done.audit:
        return []
    verdicts = [claim["verdict"] for claim in done.audit]
    counted = ", ".join(f"{verdicts.count(v)} {v}" for v in dict.fromkeys(verdicts))
    return ["", *textwrap.wrap(f"Audit of {len(verdicts)} claims: {counted}", WIDTH)]

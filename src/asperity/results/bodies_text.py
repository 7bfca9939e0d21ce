"""Single bodies in words: their quantiles, with the mean field's values beside them."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import TYPE_CHECKING

from asperity.amounts import amount
from asperity.results.realisations import KINDS, percent, restitution_text

if TYPE_CHECKING:
    from asperity.results.result_data import ResultData


def bodies_rows(result: ResultData) -> list[tuple[str, str]]:
    """First impacts of single bodies, beside the mean over all."""
    found = result.realisations
    if found is None:
        return []
    measures, first = result.measures, (result.measures.get("restitution") or [None])[0]
    low, high = (percent(share) for share in found.capture_interval)
    mean = {
        "restitution": first,
        "contacting": result.regime.get("contacting_asperities"),
        "loaded": result.regime.get("loaded_asperities"),
        "maximum_force": measures.get("maximum_force"),
        "pull_off": measures.get("pull_off"),
    }
    labels = {
        "restitution": "restitution",
        "contacting": "contacting asperities",
        "loaded": "loaded, effectively",
        "maximum_force": "largest force",
        "pull_off": "pull-off force",
        "rebounds": "rebounds until captured",
        "flight_time": "time in flight until then",
    }
    captured = f"{percent(found.capture_probability)} %  (95 % interval: {low} to {high} %)"
    rows = [("bodies", str(found.size)), ("captured at first impact", captured)]
    for name, label in ((name, label) for name, label in labels.items() if name in found.values):
        quantiles = found.quantiles(name)
        if isfinite(quantiles[0]):  # of rebounds none, where no body was captured in those followed
            rows.append((label, _spread(quantiles, KINDS[name][0], mean.get(name))))
    if unsolved := int(found.values["unsolved"].sum()):
        rows.append(("without equilibrium", f"{unsolved} of {found.size}, at some separation"))
    lost = result.ledger.get("lost") or {}
    once = len(measures.get("restitution") or []) == 1
    for name in found.lost:
        told = lost.get(name) if once else None
        rows.append((f"lost to {name}", _spread(found.quantiles(name), "J", told)))
    return rows


def _spread(quantiles: Sequence[float], unit: str, mean: float | None) -> str:
    """The median, what lies 10 % below and above, and the mean field's value."""

    def told(value: float) -> str:
        if unit == "1" and 0.9995 <= value < 1.0:
            return restitution_text(value)
        return amount(value, unit) if isfinite(value) else "more"

    low, median, high = (told(value) for value in quantiles)
    beside = "" if mean is None else f"; mean field: {told(mean)}"
    return f"{median}  ({low} to {high}{beside})"

"""What a sweep says of its store and of its run, for a human and as plain numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from asperity.errors import Outcome

if TYPE_CHECKING:
    from asperity.sweeps.compute.runner import Tally
    from asperity.sweeps.store.store import Store


def progress_of(tally: Tally) -> str:
    """How far a run is, for the bar."""
    return (
        f"{tally.cases:,} of {tally.cases_wanted:,}, {rate(tally)}, "
        f"batch use {tally.batch_use:.0%}, {duration(tally.left)} left"
    )


def rate(tally: Tally) -> str:
    """Cases a second, for a human."""
    return f"{tally.rate:,.0f} a second" if tally.rate >= 10.0 else f"{tally.rate:.2g} a second"


def duration(seconds: float) -> str:
    """A time for a human, in two units at most."""
    if seconds < 100.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 100 else f"{minutes // 60} h {minutes % 60} min"


def about(store: Store) -> dict[str, Any]:
    """What a store holds, as plain numbers."""
    from asperity.sweeps.store.counting import outcomes

    found = outcomes(store)
    return {
        "store": str(store.path),
        "cases": store.size,
        "done": store.cases_done,
        "failed": found[Outcome.FAILED.value],
        "outcomes": found,
    }


def took(tally: Tally | None) -> dict[str, Any]:
    """What a run took, as plain numbers."""
    if tally is None:
        return {}
    return {
        "computed": tally.cases,
        "wall": tally.wall,
        "cases_per_second": tally.rate,
        "batch_use": tally.batch_use,
        "overhead_share": tally.outside,
        "cases_checked": tally.looked,
        "warnings": tally.warnings,
    }


def lines(store: Store) -> list[str]:
    """What a store holds, for a human."""
    from asperity.sweeps.store.counting import first_failure, outcomes

    lines = [f"{store.path}: {store.cases_done:,} of {store.size:,} cases"]
    found = {name: count for name, count in outcomes(store).items() if count}
    if found:
        lines.append("  " + ", ".join(f"{count:,} {name}" for name, count in found.items()))
    failure = first_failure(store) if Outcome.FAILED.value in found else None
    if failure is not None:
        lines.append(f"  case {failure[0]} is the first that failed: {failure[1]}")
    return lines


def lines_of(tally: Tally | None) -> list[str]:
    """What a run took, for a human."""
    if tally is None or not tally.cases:
        return ["  nothing was left to compute"]
    return [
        f"  computed {tally.cases:,} in {tally.wall:.3g} s: {rate(tally)}, "
        f"batch use {tally.batch_use:.0%}, {tally.outside:.0%} of the time outside compiled code"
    ]

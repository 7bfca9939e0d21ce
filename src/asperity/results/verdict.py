"""The answer in one sentence: what the first impact does, how the motion ends, and why."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from asperity.errors import Outcome
from asperity.regimes import CARRIED
from asperity.results.realisations import Realisations, percent, restitution_text

if TYPE_CHECKING:
    from asperity.results.result_data import ResultData

_TAKERS = {
    "adhesion": "dry adhesion takes",
    "capillary": "menisci take",
    "damping": "the dashpot takes",
    "gas": "the gas film takes",
    "instability": "jumps of the surface take",
    "plastic": "yielding takes",
    "viscous": "the viscoelastic bulk takes",
    "waves": "elastic waves take",
}
_LITTLE = 1e-9
"""Share of the energy at the release below which nothing was lost that is worth a word."""


def verdict(result: ResultData) -> str:
    """What happens at the first impact, how the motion ends, and what takes most of the energy.

    E.g. ``leaves the first impact with e = 0.922 and sticks after 13 rebounds; menisci take all of
    the energy lost``.

    Parameters
    ----------
    result: ResultData
        The result.
    """
    if result.realisations is not None:
        return _bodies(result.realisations)
    if unjudged(result):
        contacting = result.regime["contacting_asperities"]
        return (
            f"no verdict: {contacting:.2g} asperities are expected to touch at closest approach, "
            f"but {CARRIED}; the numbers are means over many bodies"
        )
    if not result.measures["rebound_height"]:
        return "touched nothing before the run ended"
    if _swings(result):
        return f"never touches, and {_swinging(result)}; {_taken(result.ledger)}"
    parts = [_first(result.measures), _ending(result)]
    if result.outcome is Outcome.STOPPED:
        parts = [_first(result.measures) if not _untouched(result) else "", _stopped(result)]
    told = " and ".join(part for part in parts if part)
    return "; ".join(part for part in (told, _taken(result.ledger)) if part)


def sentence(result: ResultData) -> str:
    """The `verdict` as the beginning of a sentence, with its subject and without its stop.

    Parameters
    ----------
    result: ResultData
        The result.
    """
    answer = verdict(result)
    if result.realisations is not None:
        return answer
    return answer[0].upper() + answer[1:] if unjudged(result) else f"The body {answer}"


def _bodies(found: Realisations) -> str:
    """What single bodies do at their first impact."""
    low, high = (percent(share) for share in found.capture_interval)
    median = found.quantiles("restitution")[1]
    return (
        f"Of single bodies {percent(found.capture_probability)} % are captured at the first impact "
        f"(95 % interval: {low} to {high} %); their median restitution is "
        f"{restitution_text(median)}"
    )


def _first(measures: dict[str, Any]) -> str:
    """What happens at the first impact."""
    kept = measures["restitution"][0]
    if measures["captured"]:
        return "is captured at the first impact"
    if kept is None:
        return ""
    return f"leaves the first impact with e = {restitution_text(kept)}"


def unjudged(result: ResultData) -> bool:
    """Whether fewer than one asperity is expected to touch, so that no single body does as told.

    Parameters
    ----------
    result: ResultData
        The result.
    """
    contacting = result.regime.get("contacting_asperities")
    if result.outcome is Outcome.FAILED or _untouched(result):
        return False
    return contacting is not None and contacting < 1.0


def _untouched(result: ResultData) -> bool:
    """Whether the gas film stopped the body on its first way in."""
    if result.outcome is not Outcome.STOPPED:
        return False
    apexes, deepest = (result.events[f"{name}_separation"] for name in ("apex", "closest_approach"))
    return len(apexes) == 1 and bool(apexes[0] <= deepest[0])


def _swings(result: ResultData) -> bool:
    """Whether a body on a spring never comes to the surface."""
    return result.case.suspension is not None and result.measures["impact_speed"] is None


def _swinging(result: ResultData) -> str:
    """How it ends then."""
    if result.outcome is Outcome.REST:
        return "comes to rest on its spring"
    if result.outcome is Outcome.OSCILLATING:
        return "swings on its spring for ever"
    return "still swings on its spring where the run was stopped"


def _stopped(result: ResultData) -> str:
    """Where the gas film stopped the body."""
    place = f"{result.events['apex_separation'][-1] * 1e9:.4g} nm"
    if _untouched(result):
        return f"is stopped by the gas film at {place} before it touched"
    return f"is stopped by the gas film at {place} on its way out"


def _ending(result: ResultData) -> str:
    """How the motion ends, where the first impact does not say it."""
    measures, outcome = result.measures, result.outcome
    impacts = len(measures["rebound_height"])
    if outcome is Outcome.TIME_LIMIT:
        impacts = _rebounds_made(result)
    if measures["captured"]:
        return "" if _held(result) else f"held there by {_presses(result)} alone"
    if measures["capture_time"] is not None:
        held = "sticks" if _held(result) else f"comes to rest, held by {_presses(result)} alone,"
        return f"{held} {_after(_rebounds_before(result))}"
    if outcome is Outcome.REST:
        return f"comes to rest {_after(impacts)}"
    if outcome is Outcome.ESCAPED:
        return "does not come back"
    if outcome is Outcome.OSCILLATING:
        if _takes(result.ledger):
            return "goes on for ever: its last cycle loses nothing"
        return "bounces for ever"
    if outcome is Outcome.FAILED:
        return "the numerics failed before there was an answer"
    if not impacts:
        return "had not come back once where the run was stopped"
    return f"still bounces {_after(impacts)}, where the run was stopped"


def _held(result: ResultData) -> bool:
    """Whether anything pulls the body to the surface, be it captured or at rest in a gas."""
    return bool(np.min(result.forces["contact"], initial=0.0) < 0.0)


def _presses(result: ResultData) -> str:
    """What presses a body on the surface that nothing pulls there."""
    return "its weight" if result.case.suspension is None else "weight and spring"


def _rebounds_made(result: ResultData) -> int:
    """Rebounds that ended before the time limit."""
    limit = result.case.numerics.time_limit
    times = np.asarray(result.events["apex_time"])
    return int(np.sum(times <= (np.inf if limit is None else limit)))


def _rebounds_before(result: ResultData) -> int:
    """Rebounds before the impact that captures."""
    times = np.asarray(result.events["closest_approach_time"])
    return int(np.sum(times < result.measures["capture_time"] * (1.0 - 1e-12)))


def _after(rebounds: int) -> str:
    if not rebounds:
        return "at the first impact"
    return f"after {rebounds} rebound{'s' * (rebounds > 1)}"


def _taken(ledger: dict[str, Any]) -> str:
    """Who takes most of the energy that is lost."""
    lost = ledger.get("lost") or {}
    if not _takes(ledger):
        return "no energy is lost"
    total = sum(lost.values())
    most = max(lost, key=lambda name: lost[name])
    share = 100.0 * lost[most] / total
    words = _TAKERS.get(most, f"{most} takes")
    if len(lost) == 1 or share > 99.95:
        return f"{words} all of the energy lost"
    return f"{words} {share:.{1 if share > 99.0 else 0}f} % of the energy lost"


def _takes(ledger: dict[str, Any]) -> bool:
    """Whether energy is lost that is worth a word."""
    total = sum((ledger.get("lost") or {}).values())
    return total > _LITTLE * abs(ledger.get("initial") or 0.0)

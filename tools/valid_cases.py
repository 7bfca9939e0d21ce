"""Cases drawn from the stated domain, and what becomes of each: ``python -m tools.valid_cases``.

The domain: Tabor number 0.001 to 1000, rms height 0.01 nm to 1 um, body radius 100 nm to 1 mm,
speed 0.1 mm/s to 50 m/s, every law and every mechanism. A case is named by its seed and number, so
that one that fails can be run again: ``--seed 3 --first 41 --count 1``.
"""

from __future__ import annotations

import argparse
import collections
import json
import multiprocessing
import threading
import time
from typing import Any, NamedTuple

import numpy as np

BALANCE = 1e-5
"""Error of the energy balance, over the initial energy, above which an answer counts as broken."""

LIMIT = 60.0
"""Time [s] after which a case counts as too slow."""

_TOGETHER = 10  # cases of one process: it keeps what it has compiled

_LIQUID = ("equilibrium", "constant-volume", "kelvin-filling")
_LAWS = ("none", "bradley", "dmt", "maugis", "jkr", "auto", "lennard-jones")
_GASES = ("air", "nitrogen", "argon", "carbon dioxide")
_YIELDING = ("kogut-etsion", "jackson-green", "thornton-ning")


class Found(NamedTuple):
    """What became of one case.

    Attributes
    ----------
    number, structure
        Its number of the seed, and the kind of case.
    end
        "answered", "refused", "failed", "slow" or "broken".
    words
        The outcome, or the reason.
    seconds
        Time that it took [s].
    balance
        Error of the energy balance over the initial energy [-]; NaN without an answer.
    """

    number: int
    structure: str
    end: str
    words: str
    seconds: float
    balance: float


class _Random:
    """Draws of one case."""

    def __init__(self, seed: int, number: int) -> None:
        self._random = np.random.default_rng((seed, number))

    def between(self, low: float, high: float) -> float:
        """Evenly in the logarithm."""
        return float(np.exp(self._random.uniform(np.log(low), np.log(high))))

    def evenly(self, low: float, high: float) -> float:
        return float(self._random.uniform(low, high))

    def some(self, share: float) -> bool:
        return bool(self._random.random() < share)

    def among(self, names: tuple[str, ...]) -> str:
        return names[int(self._random.integers(len(names)))]


def drawn(seed: int, number: int) -> dict[str, dict[str, Any]]:
    """The tables of one case, as they stand in a file."""
    random = _Random(seed, number)
    radius, work = random.between(1e-7, 1e-3), random.between(1e-4, 0.5)
    spacing, tip = random.evenly(1.5e-10, 4.5e-10), min(random.between(1e-9, 1e-5), radius)
    rms = min(random.between(1e-11, 1e-6), 0.05 * radius)
    rough, law = random.some(0.85), random.among(_LAWS)
    tabor = random.between(*((0.01, 5.0) if law == "lennard-jones" else (1e-3, 1e3)))
    bent = tip if rough else radius
    # Both solids alike: E* = E / (2 (1 - nu^2)).
    modulus = min(max((bent * work**2 / (tabor * spacing) ** 3) ** 0.5, 1e4), 5e11)
    modulus *= 2.0 * (1.0 - 0.25**2)
    solid = {
        "youngs_modulus": f"{modulus} Pa",
        "poisson": 0.25,
        "density": f"{random.between(800.0, 12e3)} kg/m^3",
    }
    deformation = random.among(("rigid", "half-space")) if rough else "half-space"
    case: dict[str, dict[str, Any]] = {
        "body": {"radius": f"{radius} m", **solid},
        "counterface": {**solid, "deformation": deformation},
        "impact": {
            "speed": f"{random.between(1e-4, 50.0)} m/s",
            "gravity": random.among(("0 m/s^2", "9.81 m/s^2")),
        },
        "numerics": {"max_impacts": 4},
    }
    if rough:
        case["roughness"] = {
            "asperity_density": f"{random.between(0.005, 0.3) / (tip * rms)} 1/m^2",
            "asperity_radius": f"{tip} m",
            "rms_height": f"{rms} m",
        }
    if law != "none":
        case["adhesion"] = {"model": law, "work": f"{work} J/m^2"}
        if law != "jkr":
            case["adhesion"]["equilibrium_spacing"] = f"{spacing} m"
    return _fitting({**case, **_ambient(random, case, rms), **_rates(random, modulus)}, rms)


def _fitting(case: dict[str, dict[str, Any]], rms: float) -> dict[str, dict[str, Any]]:
    """The case without what its other tables leave no room for, and with what they ask for."""
    rough = "roughness" in case
    if rough and case.get("adhesion", {}).get("model") == "lennard-jones":
        case["counterface"]["deformation"] = "rigid"
        case.pop("viscoelasticity", None)
    if "viscoelasticity" in case:
        case.pop("gas", None)
        case["counterface"]["deformation"] = "half-space"
        for table in () if rough else ("adhesion", "capillary"):
            case.pop(table, None)
    wet = case.get("capillary", {})
    if "plasticity" in case:
        if rough:
            case["counterface"]["deformation"] = "rigid"
        if case.get("adhesion", {}).get("model", "dmt") != "dmt":
            case.pop("adhesion")
        if wet.get("model") == "constant-volume":
            wet["model"] = "equilibrium"
    if wet.get("model") == "kelvin-filling":
        if rough:
            wet["surface_rms_height"] = f"{1.2 * rms} m"
        else:
            wet["model"] = "equilibrium"
    if "gas" in case and not rough:
        case["gas"]["cutoff_separation"] = "1 nm"
    return case


def _ambient(random: _Random, case: dict[str, dict[str, Any]], rms: float) -> dict[str, Any]:
    """Liquid and gas; through gas a case is released where it says."""
    found: dict[str, Any] = {}
    if random.some(0.5):
        found["capillary"] = {
            "model": random.among(_LIQUID),
            "formation": random.among(("on-contact", "capillary-condensation")),
            "liquid": "water",
            "humidity": random.evenly(0.0, 0.98),
            "temperature": f"{random.evenly(278.0, 333.0)} K",
            "contact_angle": f"{random.evenly(10.0, 85.0)} degrees",
        }
    if random.some(0.25):
        found["gas"] = {
            "name": random.among(_GASES),
            "pressure": f"{random.between(10.0, 1e6)} Pa",
            "temperature": f"{random.evenly(278.0, 350.0)} K",
        }
        release = {"release_separation": f"{20.0 * rms + 1e-7} m"}
        found["impact"] = {**case["impact"], **release}
    return found


def _rates(random: _Random, modulus: float) -> dict[str, Any]:
    """Yield, a bulk that relaxes, or waves; often nothing of these."""
    if random.some(0.15):
        strength = f"{random.between(1e-3, 0.05) * modulus} Pa"
        return {"plasticity": {"model": random.among(_YIELDING), "yield_strength": strength}}
    if random.some(0.1):
        return {
            "viscoelasticity": {
                "model": "standard-linear-solid",
                "relaxed_modulus_ratio": random.between(0.01, 0.9),
                "relaxation_time": f"{random.between(1e-8, 1e-4)} s",
            }
        }
    return {"waves": {"model": "hunter"}} if random.some(0.1) else {}


def text_of(case: dict[str, dict[str, Any]]) -> str:
    """The file of a case."""
    lines = ["schema = 1"]
    for name, table in case.items():
        lines += [f"[{name}]", *(f"{key} = {json.dumps(value)}" for key, value in table.items())]
    return "\n".join(lines)


def structure_of(case: dict[str, Any]) -> str:
    """The kind of a case, by what decides how it is computed."""
    words = ["rough" if "roughness" in case else "smooth", case["counterface"]["deformation"]]
    words.append(case.get("adhesion", {}).get("model", "dry"))
    words += [case["capillary"]["model"]] if "capillary" in case else []
    words += [name for name in ("gas", "plasticity", "viscoelasticity", "waves") if name in case]
    return " ".join(words)


def found(seed: int, number: int) -> Found:
    """Compute one case, and say what became of it."""
    import asperity
    from asperity.config import load
    from asperity.errors import InputError, Outcome, SimulationError

    case, stop, begun = drawn(seed, number), threading.Event(), time.monotonic()
    clock = threading.Timer(LIMIT, stop.set)
    clock.start()
    balance = float("nan")
    try:
        result = asperity.solve(load(text_of(case)), critical=False, stop=stop)
        end, words = "answered", result.outcome.value
        balance = float(result.ledger["energy_balance_error"])
        if result.outcome is Outcome.INTERRUPTED or time.monotonic() - begun > LIMIT:
            end = "slow"
        elif not np.isfinite([balance, *result.separation, *result.time]).all():
            end, words = "broken", "a number is NaN"
        elif balance > BALANCE:
            end, words = "broken", f"the energy balance closes to {balance:.1e}"
    except InputError as error:
        end, words = "refused", f"{error.key}: {error}"
    except SimulationError as error:
        end, words = ("slow" if stop.is_set() else "failed"), str(error)
    except Exception as error:  # noqa: BLE001 - whatever is broken is what is looked for
        end, words = "broken", f"{type(error).__name__}: {error}"
    finally:
        clock.cancel()
    return Found(number, structure_of(case), end, words, time.monotonic() - begun, balance)


def _found(job: tuple[int, int]) -> Found:
    return found(*job)


def main() -> int:
    """Draw cases, compute them and write the table; 1 where one fails, is slow or is broken."""
    parser = argparse.ArgumentParser(prog="python -m tools.valid_cases", description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--processes", type=int, default=2)
    asked = parser.parse_args()
    jobs = [(asked.seed, asked.first + k) for k in range(asked.count)]
    jobs.sort(key=lambda job: structure_of(drawn(*job)))  # they share what is compiled
    all_found = []
    with multiprocessing.get_context("spawn").Pool(asked.processes, maxtasksperchild=1) as pool:
        for one in pool.imap_unordered(_found, jobs, chunksize=_TOGETHER):
            all_found.append(one)
            if one.end != "answered":
                words = f"{one.end}: {one.words}"
                print(f"{one.number:6d} {one.seconds:6.1f} s  {one.structure}: {words}", flush=True)
    print(table(all_found))
    return int(any(one.end in ("failed", "slow", "broken") for one in all_found))


def table(all_found: list[Found]) -> str:
    """How many of each structure ended in which way, quantiles of time, the worst balance."""
    ends = ("answered", "refused", "failed", "slow", "broken")
    groups: dict[str, list[Found]] = collections.defaultdict(list)
    for one in all_found:
        rough, deformation, law, *_ = one.structure.split()
        groups[f"{rough} {deformation} {law}"].append(one)
    rows: list[tuple[str, ...]] = [
        ("structure", *ends, "time 50 %", "95 %", "most", "worst balance")
    ]
    for name, group in [*sorted(groups.items()), ("all", all_found)]:
        counts = [str(sum(one.end == end for one in group)) for end in ends]
        seconds = [one.seconds for one in group if one.end != "refused"] or [0.0]
        times = [f"{np.quantile(seconds, q):.1f} s" for q in (0.5, 0.95, 1.0)]
        known = [one.balance for one in group if np.isfinite(one.balance)]
        rows.append((name, *counts, *times, f"{max(known):.0e}" if known else "-"))
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join(
        "  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    )


if __name__ == "__main__":
    raise SystemExit(main())

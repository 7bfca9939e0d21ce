"""A result and a curve made by hand, for what stores, draws and prints them.

The body falls freely and meets a linear spring that is softer on the way out than on the way in, so
that it loses a known share of its energy at the deepest point of each impact.
"""

from __future__ import annotations

import itertools

import numpy as np

from asperity.config import builtin
from asperity.config.schema import Case
from asperity.errors import Outcome
from asperity.results.result import Curve, Result

MASS = 1.152e-9
GRAVITY = 9.81
SURFACE = 45.9e-9
RELEASE = 60e-9
SPRING = 2.0e4
ATTRACTION = 2e-9


def bounce(
    restitution: float = 0.8,
    impacts: int = 30,
    *,
    case: Case | None = None,
    name: str = "published-exact",
    outcome: Outcome = Outcome.REST,
) -> Result:
    """A drop with ``impacts`` rebounds of which each loses 1 - restitution^2 of the energy."""
    frequency = np.sqrt(SPRING / MASS)
    time, gap, speed, stored, lost = [], [], [], [], []
    clock, gone = 0.0, 0.0
    heights = (RELEASE - SURFACE) * restitution ** (2.0 * np.arange(impacts + 1))
    deepest = []
    for before, after in itertools.pairwise(heights):
        fall = np.sqrt(2 * before / GRAVITY)
        s = np.linspace(0, fall, 16)
        _add(time, clock + s, gap, before - GRAVITY * s**2 / 2, speed, -GRAVITY * s)
        _add(stored, 0 * s, lost, gone + 0 * s, [], s)
        clock, fast = clock + fall, GRAVITY * fall
        way_in = np.pi / 2 / frequency
        s = np.linspace(0, way_in, 16)
        depth = fast / frequency * np.sin(frequency * s)
        _add(time, clock + s, gap, -depth, speed, -fast * np.cos(frequency * s))
        _add(stored, SPRING * depth**2 / 2, lost, gone + 0 * s, [], s)
        clock += way_in
        deepest.append((clock, SURFACE - fast / frequency))
        gone += MASS * fast**2 / 2 * (1 - restitution**2)
        way_out = np.pi / 2 / (restitution * frequency)
        s = np.linspace(0, way_out, 16)
        depth = fast / frequency * np.cos(restitution * frequency * s)
        rate = restitution * fast * np.sin(restitution * frequency * s)
        _add(time, clock + s, gap, -depth, speed, rate)
        _add(stored, restitution**2 * SPRING * depth**2 / 2, lost, gone + 0 * s, [], s)
        clock, rise = clock + way_out, np.sqrt(2 * after / GRAVITY)
        s = np.linspace(0, rise, 16)
        _add(
            time, clock + s, gap, after - GRAVITY * (rise - s) ** 2 / 2, speed, GRAVITY * (rise - s)
        )
        _add(stored, 0 * s, lost, gone + 0 * s, [], s)
        clock += rise
    arrays = [np.concatenate(part) for part in (time, gap, speed, stored, lost)]
    case = case or builtin("published-exact")
    return _result(arrays, heights, deepest, restitution, case, name, outcome)


def _add(*pairs) -> None:
    for store, values in zip(pairs[::2], pairs[1::2], strict=True):
        store.append(values)


def _result(arrays, heights, deepest, restitution, case, name, outcome) -> Result:
    time, gap, speed, stored, lost = arrays
    unloading = np.where(speed > 0, restitution, 1.0)
    elastic = SPRING * np.maximum(-gap, 0) * unloading**2
    capillary = np.where((gap < 0.3e-9) & (speed > 0), -ATTRACTION, 0.0)
    adhesion = np.where(gap < 0, -ATTRACTION / 10, 0.0)
    contact = elastic + capillary + adhesion
    weight = np.full_like(time, -MASS * GRAVITY)
    central = SURFACE + np.where(gap < 0, 0.9 * gap, gap)
    tops = time[63::64]
    periods = np.diff(np.concatenate([[0.0], tops]))
    losses = MASS * GRAVITY * -np.diff(heights)
    return Result(
        case=case,
        name=name,
        outcome=outcome,
        time=time,
        separation=SURFACE + gap,
        central_separation=central,
        speed=speed,
        forces={
            "weight": weight,
            "elastic": elastic,
            "adhesion": adhesion,
            "capillary": capillary,
            "contact": contact,
            "total": contact + weight,
        },
        energies={
            "kinetic": MASS * speed**2 / 2,
            "potential": MASS * GRAVITY * (SURFACE + gap),
            "stored": stored,
            "lost_adhesion": 0.02 * lost,
            "lost_capillary": 0.98 * lost,
        },
        regime={
            "tabor_number": 0.0206,
            "elasticity_parameter": 0.0239,
            "plasticity_index": 41.0,
            "load_parameter": None,
            "adhesion_law": "dmt",
        },
        measures={
            "impact_speed": float(np.sqrt(2 * heights[0] * GRAVITY)),
            "captured": False,
            "capture_time": None,
            "time_to_rest": float(time[-1]) if outcome is Outcome.REST else None,
            "rebound_height": heights[1:].tolist(),
            "restitution": [restitution] * len(losses),
            "log_decrement": (-np.diff(np.log(heights))).tolist(),
            "rebound_period": periods.tolist(),
            "power_loss": (losses / periods).tolist(),
            "power_loss_published": [*(0.36 * losses / periods)[:-1].tolist(), None],
        },
        ledger={
            "initial": MASS * GRAVITY * RELEASE,
            "lost": {"adhesion": 0.02 * losses.sum(), "capillary": 0.98 * losses.sum()},
            "energy_balance_error": 3.1e-12,
        },
        warnings=[
            "About 0.07 asperities touch at closest approach: single impacts scatter widely."
        ],
        events={
            "closest_approach_time": np.array([t for t, _ in deepest]),
            "closest_approach_separation": np.array([d for _, d in deepest]),
            "apex_time": tops,
            "apex_separation": SURFACE + heights[1:],
        },
    )


def loading(*, case: Case | None = None, name: str = "published-exact") -> Curve:
    """A curve in and out, with a meniscus that pulls on the way out alone."""
    separation = np.linspace(60e-9, 44e-9, 200)
    gap = separation - SURFACE
    elastic = 3e-9 * np.exp(-gap / 2e-9)
    bridge = np.where(gap < 8e-9, -5e-8 * np.clip(1 - gap / 8e-9, 0, 1), 0.0)
    nothing = np.zeros_like(gap)
    return Curve(
        case=case or builtin("published-exact"),
        name=name,
        rigid_separation=separation,
        central_separation=separation + 1e-11,
        force_loading=elastic,
        force_unloading=elastic + bridge,
        components_loading={"elastic": elastic, "adhesion": nothing, "capillary": nothing},
        components_unloading={"elastic": elastic, "adhesion": nothing, "capillary": bridge},
        minimum_separation=44e-9,
        pull_off=float(-(elastic + bridge).min()),
        pull_off_separation=float(separation[np.argmin(elastic + bridge)]),
        work_of_separation=2.1e-16,
        preload=float(elastic.max()),
        loss=float(-np.trapezoid(bridge, -separation)),
        warnings=["About 0.07 asperities touch at closest approach."],
    )

"""Menisci that take time, by diffrax and by the steps of this program: time and agreement.

A first impact of a rigid rough body, with diffrax restarted at each event. It is the prototype
by which the page on architecture decides; the program does not depend on diffrax:

    python -m pip install --no-deps --require-hashes -r benchmarks/requirements.lock
    python -m benchmarks.diffrax_in_time
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

import diffrax
import equinox as eqx
import numpy as np
import optimistix

import asperity
from asperity._jax import jax, jnp
from asperity.config.resolve import resolve
from asperity.contact.delayed_formation import DelayedContact
from asperity.dynamics import Body, Limits, prepare
from asperity.dynamics.stepped_motion import integrate_stepped
from asperity.dynamics.time_collocation import BodyState
from asperity.dynamics.time_stepping import Frame
from asperity.errors import Tolerance
from asperity.model import build

METHODS = {"Dopri8": 1e-11, "Tsit5": 1e-10, "Kvaerno5": 1e-10}
"""Methods, and the tolerance of each at which its turning points agree to 1e-9."""

TIMES = ("1 ns", "10 us")  # formation times
_NUDGE = 1e-7  # of a first guess: an event function must not begin at 0
_CLOSE = optimistix.Newton(1e-13, 1e-13)


def field(_: Any, y: jax.Array, given: Any) -> jax.Array:
    """Rates of separation, speed, threshold of the menisci, and energy lost on menisci [J]."""
    contact, body, memory, forming = given[:4]
    separation, speed, threshold = y[0], y[1], y[2]

    def acts(level: jax.Array) -> tuple[jax.Array, jax.Array]:
        state = contact.state(separation, memory, level)
        return state.bonds[contact.meniscus_index], state.force

    bonds, force = jax.jacfwd(acts, has_aux=True)(threshold)
    goal = separation - contact.law.forming_gap
    rate = jnp.where(forming, (goal - threshold) / contact.time, 0.0)
    lost = bonds * rate * contact.loss(separation - threshold)
    drag = sum(film.drag(separation) for film in body.drags)
    pulled = (force - body.weight - drag * speed) / body.mass
    return jnp.stack([speed, pulled, rate, lost])


def _turns(t: Any, y: jax.Array, args: Any, **_: Any) -> jax.Array:
    return args[4] * y[1]


def _at_mark(t: Any, y: jax.Array, args: Any, **_: Any) -> jax.Array:
    return args[4] * (y[0] - args[5])


def _caught_up(t: Any, y: jax.Array, args: Any, **_: Any) -> jax.Array:
    contact, forming, sign = args[0], args[3], args[4]
    return jnp.where(forming & (sign > 0), y[0] - contact.law.forming_gap - y[2], -1e-9)


def stepping(method: str, rtol: float) -> Callable[..., Any]:
    """What goes to the next event: its time, state, events, steps, and whether it ended."""
    solver = getattr(diffrax, method)()

    @eqx.filter_jit
    def go_on(y: jax.Array, given: Any, span: float, scale: jax.Array) -> Any:
        start = y[1] == 0.0
        pull = field(0.0, y, given)[1] * jnp.where(start, _NUDGE * span, 0.0)
        begun = jnp.where(start, _NUDGE * span, 0.0)
        y = y.at[1].add(pull).at[0].add(0.5 * pull * begun)
        found = diffrax.diffeqsolve(
            diffrax.ODETerm(field), solver, 0.0, 1.0, 1e-3 * span, y, args=given,
            stepsize_controller=diffrax.PIDController(rtol=rtol, atol=rtol * scale),
            event=diffrax.Event([_turns, _at_mark, _caught_up], _CLOSE),
            max_steps=100_000, throw=False, saveat=diffrax.SaveAt(t1=True),
        )  # fmt: skip
        ended = found.result == diffrax.RESULTS.event_occurred
        return begun + found.ts[-1], found.ys[-1], found.event_mask, found.stats["num_steps"], ended

    return go_on


def first_impact(go_on: Any, frame: Frame, memory: Any) -> tuple[float, float, float, int]:
    """Closest approach and apex [m], the apex's time [s], and steps that were taken."""
    contact, body = frame.contact, frame.body
    goal, release = float(frame.forming[contact.meniscus_index]), float(body.release)
    fall = np.sqrt(2.0 * release / float(body.gravity))
    energy = float(body.weight) * release
    scale = jnp.array([release, float(body.gravity) * fall, release, energy])
    y, forming = jnp.array([release, -float(body.speed), release - goal, 0.0]), True
    clock, steps, turns = 0.0, 0, []
    for sign in (-1.0, 1.0):
        turned = False
        while not turned:
            here = BodyState(*map(np.asarray, (y[0], y[1], 0.0, y[2])), memory, forming)
            mark = frame.next_mark(here, int(sign))
            given = (contact, body, memory, jnp.asarray(forming), sign, mark)
            took, y, event, count, ended = go_on(y, given, 0.1 * fall, scale)
            if not bool(ended):
                raise RuntimeError("a go_on ended without an event")
            clock, steps = clock + float(took), steps + int(count)
            turned, marked, caught = (bool(each) for each in event)
            if caught:
                forming = False
            if marked:
                y = y.at[0].set(mark)
                forming = forming or (sign < 0 and mark <= float(y[2]) + goal + frame.close)
        turns.append(float(y[0]))
        memory = contact.base.update_memory(contact.with_threshold(memory, y[2]), y[0])
        broken = float(y[0]) - float(frame.breaking[contact.meniscus_index])
        y = y.at[1].set(0.0).at[2].set(max(float(y[2]), broken))
        forming = forming and (sign > 0 or float(y[2]) > float(y[0]) - goal + frame.close)
    return turns[0], turns[1], clock, steps


def _timed(work: Callable[[], Any]) -> tuple[Any, float, float]:
    """What some work gives, its first duration and the best of three more [s]."""
    took = []
    for _ in range(4):
        began = time.perf_counter()
        found = work()
        took.append(time.perf_counter() - began)
    return found, took[0], min(took[1:])


def main() -> None:
    """Print times and differences."""
    for formation_time in TIMES:
        _compare(formation_time)


def _compare(formation_time: str) -> None:
    base = {"counterface.deformation": "rigid", "capillary.formation_time": formation_time}
    problem = build(resolve(asperity.load("published-exact").replace(base)))
    contact, body, delayed = problem.contact, problem.body, problem.delayed
    assert isinstance(delayed, DelayedContact)
    assert isinstance(body, Body)
    table, reference = eqx.filter_jit(prepare)(contact, body)
    limits = Limits.of(Tolerance(max_impacts=1))

    def ours() -> Any:
        return integrate_stepped(
            contact, delayed, body, (table, reference), limits, lambda count: None
        )

    (motion, *_), cold, warm = _timed(ours)
    rows = motion.impacts
    wanted = (float(rows.closest_approach[0]), float(rows.apex[0]), float(rows.apex_time[0]))
    ledger = float(rows.energy_balance_error[0] / rows.maximum_kinetic[0])
    sys.stdout.write(
        f"formation in {formation_time}: ours {cold:.1f} s at first, then {1e3 * warm:.0f} ms; "
        f"ledger {ledger:.1e}\n"
    )
    frame = Frame.of(contact, delayed, body, table)
    for method, rtol in METHODS.items():
        go_on = stepping(method, rtol)
        found, cold, again = _timed(
            lambda go_on=go_on: first_impact(go_on, frame, contact.initial_memory())
        )
        off = [one / other - 1.0 for one, other in zip(found, wanted, strict=False)]
        sys.stdout.write(
            f"  {method}, {rtol:.0e}: {cold:.1f} s at first, then {1e3 * again:.0f} ms "
            f"({again / warm:.1f} times), {found[3]} steps; closest approach, apex and time off by "
            f"{off[0]:.1e}, {off[1]:.1e}, {off[2]:.1e}\n"
        )
        sys.stdout.flush()


if __name__ == "__main__":
    main()

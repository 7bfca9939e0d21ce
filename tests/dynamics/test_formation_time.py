"""Menisci that take time to form: both limits, explicit asperities, closed forms, the ledger."""

import threading
from math import pi, radians

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.stats import norm

import asperity
from asperity import InputError, Outcome, SimulationError, solver
from asperity._jax import jax, jnp
from asperity.config.resolve import resolve
from asperity.contact import RigidContact, SmoothContact
from asperity.contact.delayed_formation import DelayedContact
from asperity.contact.profile import Sphere
from asperity.dynamics import Body, Limits, prepare
from asperity.dynamics.gas_film import SqueezeFilm
from asperity.dynamics.motion import simulate
from asperity.dynamics.stepped_motion import integrate_stepped
from asperity.dynamics.time_collocation import BodyState, step
from asperity.errors import Tolerance
from asperity.interface.interface import Interface
from asperity.laws import ConstantVolume, Hertz, Jkr, Meniscus
from asperity.numerics.compilation import Program
from asperity.surfaces.heights import Gaussian
from chosen import long_but
from records import never_goes_back

RADIUS, BETA, SIGMA, E, N = 50e-6, 0.25e-9, 10.5e-9, 56.8e9, 1.69e16
MASS = 2200.0 * 4.0 / 3.0 * pi * RADIUS**3
HERTZ = Hertz(BETA, E)
WET = Meniscus(BETA, 0.0728, radians(20.0), 10e-9)
DROP = Body(MASS, 9.81, 120e-9)
AIR = Body(MASS, 9.81, 120e-9, 0.0, (SqueezeFilm(RADIUS, 18.2e-6, 75e-9, SIGMA),))
TWO = Tolerance(max_impacts=2)

_prepare = Program(prepare)


def rough(law):
    return RigidContact(Interface(law, Gaussian(SIGMA), N), Sphere(RADIUS))


def delayed(contact, body, time, tolerance=TWO):
    prepared = _prepare(contact, body)
    delayed = DelayedContact(contact, time)
    return integrate_stepped(
        contact, delayed, body, prepared, Limits.of(tolerance), lambda count: None
    )


@jax.jit
def at_once(contact, body):
    return simulate(contact, body, tolerance=TWO)


TURNS = ("closest_approach", "apex", "closest_approach_time", "apex_time")


def sphere(tension=0.0728):
    return Meniscus(RADIUS, tension, radians(73.0), 1.05e-9)


CASES = {
    "rough": (rough(HERTZ + WET), DROP),
    "rough in air": (rough(HERTZ + WET), AIR),
    "rough, adhesive, constant volume": (
        rough(Jkr(2e-7, E, 0.05) + ConstantVolume(BETA, 0.0728, radians(20.0), 1e-9, edge=False)),
        DROP,
    ),
    "smooth": (SmoothContact(Hertz(RADIUS, E) + sphere()), Body(MASS, 9.81, 1e-6, 0.05)),
    "smooth, adhesive": (
        SmoothContact(Jkr(RADIUS, E, 0.05) + sphere()), Body(MASS, 9.81, 1e-6, 0.05)),
}  # fmt: skip


@pytest.mark.parametrize(
    "name",
    long_but(["rough", "rough in air", "smooth", "smooth, adhesive"], "rough", "smooth, adhesive"),
)
def test_short_formation_tends_to_formation_at_once_in_proportion_to_the_time(name):
    contact, body = CASES[name]
    prompt = at_once(contact, body).impacts
    times = (1e-9, 1e-10)
    found = [delayed(contact, body, time)[0].impacts for time in times]
    for turn in TURNS:
        exact = np.asarray(getattr(prompt, turn))
        off = [np.asarray(getattr(rows, turn)) - exact for rows in found]
        np.testing.assert_allclose(off[0], 10.0 * off[1], rtol=0.05, atol=2e-11 * np.max(exact))


NONE = 1e-30  # N/m, a tension that pulls nothing, so that the programs are those of wet contacts
DRY = {
    "rough": rough(HERTZ + Meniscus(BETA, NONE, radians(20.0), 10e-9)),
    "smooth, adhesive": SmoothContact(Jkr(RADIUS, E, 0.05) + sphere(NONE)),
}


@pytest.mark.parametrize("name", DRY)
def test_long_formation_tends_to_the_dry_motion(name):
    contact, body = CASES[name]
    rows, wanted = delayed(contact, body, 1e6)[0].impacts, at_once(DRY[name], body).impacts
    assert len(rows.apex) >= 1
    for turn in TURNS:
        np.testing.assert_allclose(getattr(rows, turn)[0], getattr(wanted, turn)[0], rtol=1e-9)


def test_fewer_menisci_form_the_longer_they_take_and_lose_most_where_they_form_in_overlap():
    """Between both limits the loss has a maximum, where the delay is about the contact's time."""
    contact, body = CASES["rough"]
    times = (1e-9, 1e-7, 1e-6, 1e-5, 1e-3, 1e-2)
    rows = [delayed(contact, body, time)[0].impacts for time in times]
    assert np.all(np.diff([float(each.bonds[0, 0]) for each in rows]) < 0.0)
    lost = [float(each.lost[0, 0]) for each in rows]
    assert lost[0] < lost[1] < lost[2]
    assert lost[5] < 0.1 * lost[0]


@pytest.mark.parametrize("name", CASES)
def test_the_ledger_closes(name):
    contact, body = CASES[name]
    for time in (1e-8, 1e-6):
        motion, trajectory, _ = delayed(contact, body, time)
        rows = motion.impacts
        assert np.max(rows.energy_balance_error) < 1e-8 * rows.maximum_kinetic[0]
        assert np.all(np.diff(trajectory.lost, axis=0) >= -1e-9 * rows.maximum_kinetic[0])


def _mean(cells, weights, values, edge):
    """Sum over asperities higher than ``edge``; the cell that it cuts counts in part."""
    width = cells[1] - cells[0]
    share = np.clip((cells + 0.5 * width - edge) / width, 0.0, 1.0)
    return np.sum(weights * share * values)


def test_motion_is_that_of_explicit_asperities_each_with_its_relay():
    """Asperities of a sphere counted by z - r^2/(2 R), each bonded while that exceeds b."""
    time, contact = 2e-6, CASES["rough"][0]
    edges = np.linspace(-4.0 * SIGMA, 8.0 * SIGMA, 6001)
    above = (
        2.0
        * pi
        * RADIUS
        * N
        * SIGMA
        * (norm.pdf(edges / SIGMA) - edges / SIGMA * norm.sf(edges / SIGMA))
    )
    cells, weights = 0.5 * (edges[1:] + edges[:-1]), -np.diff(above)
    span, pull = float(WET.interaction_range), float(WET.pull)

    def forces(d, b):
        gap = d - cells
        hertz = 4.0 / 3.0 * E * np.sqrt(BETA) * np.maximum(-gap, 0.0) ** 1.5
        wet = -pull * np.clip(1.0 - gap / span, 0.0, 1.0)
        return np.sum(weights * hertz) + _mean(cells, weights, wet, b)

    def rate(_, y):
        d, v, b = y[0] * 1e-9, y[1] * 1e-3, y[2] * 1e-9
        push = forces(d, max(b, d - span)) / MASS - 9.81
        follow = (d - b) / time if d < b else 0.0
        return [v * 1e3, push * 1e-3, follow * 1e3]

    def turns(_, y):
        return y[1]

    turns.terminal = True
    y, clock, found = [120.0, -1e-9, 120.0], 0.0, []
    for sign in (-1, 1):
        turns.direction = -sign
        answer = solve_ivp(
            rate, (0.0, 1e3), y, "DOP853", events=turns, rtol=1e-9, atol=1e-10, max_step=5.0
        )
        y, clock = list(answer.y_events[0][0]), clock + answer.t_events[0][0]
        found.append((y[0] * 1e-9, clock * 1e-6))
        y[1] = -1e-9 * sign
    rows = delayed(contact, DROP, time, Tolerance(max_impacts=1))[0].impacts
    (deepest, first), (apex, last) = found
    drop = 120e-9 - apex
    assert drop > 1e-10
    assert 120e-9 - rows.apex[0] == pytest.approx(drop, rel=1e-3)
    assert rows.closest_approach[0] == pytest.approx(deepest, rel=1e-6)
    assert rows.closest_approach_time[0] == pytest.approx(first, rel=1e-6)
    assert rows.apex_time[0] == pytest.approx(last, rel=1e-5)


def test_meniscus_of_a_smooth_sphere_appears_when_the_closed_form_says():
    """At constant speed v from d0, b = d + v time (1 - exp(-t/time)), and b = 0 then."""
    time, speed, start = 2e-6, 1e-3, 5e-9
    contact = SmoothContact(Hertz(RADIUS, 1e3) + sphere())
    _, trajectory, _ = delayed(
        contact, Body(MASS, 0.0, start, speed), time, Tolerance(max_impacts=1)
    )
    wet = np.flatnonzero(trajectory.rows[:, 6] > 0.5)
    appears = brentq(
        lambda t: start - speed * t + speed * time * (1.0 - np.exp(-t / time)), 1e-6, 1e-4
    )
    assert trajectory.time[wet[0] - 1] == pytest.approx(appears, rel=1e-6)
    gap = start - speed * appears
    loss = float(sphere().pull) * (0.5 * float(sphere().interaction_range) - gap)
    assert trajectory.lost[wet[0], 0] == pytest.approx(loss, rel=1e-6)


@pytest.mark.parametrize("name", ["rough", "rough, adhesive, constant volume"])
def test_force_is_the_slope_of_the_energy_at_a_threshold_that_lags_behind(name):
    """While no bond breaks: no bond of any law is stretched to where it would."""
    place = 35e-9
    delayed = DelayedContact(CASES[name][0], 1e-6)
    memory = tuple(jnp.asarray(place - 0.5 * float(law.breaking_gap)) for law in delayed.laws)

    def at(part):
        return lambda d, b: getattr(delayed.state(d, memory, b), part)

    slope, force = jax.jit(jax.grad(at("stored"))), jax.jit(at("force"))
    for threshold in (place + 2e-9, place + 10e-9, place - 0.4e-9):
        here = jnp.asarray(place), jnp.asarray(threshold)
        assert float(slope(*here)) == pytest.approx(-float(force(*here)), rel=1e-9)


def test_a_step_is_of_high_order():
    """Against four quarters of it, the error of a step falls by over 2^12 when it is halved."""
    contact, body = CASES["rough"]
    delayed = DelayedContact(contact, 1e-5)
    one = Program(step)

    def end(span, parts):
        here = BodyState(
            *(jnp.asarray(x) for x in (44e-9, -1e-4, 0.0, 45e-9)),
            contact.initial_memory(),
            jnp.asarray(True),
        )
        for _ in range(parts):
            done = one(delayed, body, here, jnp.asarray(span / parts))
            here = here._replace(
                separation=done.separation[-1], speed=done.speed[-1], threshold=done.threshold[-1]
            )
        return float(here.speed)

    off = [abs(end(span, 1) - end(span, 4)) for span in (16e-6, 8e-6)]
    assert off[0] > 2.0**12 * off[1]


@pytest.fixture(scope="module")
def case():
    return asperity.load("published-exact").replace(
        {
            "counterface.deformation": "rigid",
            "capillary.formation_time": "10 us",
            "numerics.max_impacts": 3,
        }
    )


def test_a_case_with_a_formation_time_is_solved_measured_and_warned_of(case):
    for time in ("10 us", "1 ms"):
        result = solver.solve(case.replace({"capillary.formation_time": time}), critical=False)
        assert result.outcome is Outcome.MAX_IMPACTS
        assert result.ledger["energy_balance_error"] < 1e-6
        total = sum(result.energies.values())
        kinetic = np.max(result.energies["kinetic"])
        assert np.max(np.abs(total - result.ledger["initial"])) < 1e-6 * kinetic
        never_goes_back(result)
    assert any("menisci take 0.001 s to form" in line for line in result.warnings)


def test_restitution_in_gas_tends_to_that_with_menisci_at_once(case):
    found = [
        solver.solve(case.replace({**GAS, "capillary.formation_time": time}), critical=False)
        for time in (None, "1 ps")
    ]
    at_once, delayed = (result.measures["restitution"] for result in found)
    np.testing.assert_allclose(delayed, at_once, rtol=1e-8)


def test_a_time_of_zero_is_no_time(case):
    zero = case.replace({"capillary.formation_time": "0 s"})
    none = case.replace({"capillary.formation_time": None})
    assert asperity.model.build(resolve(zero)).delayed is None
    assert asperity.model.build(resolve(none)).delayed is None


def test_a_motion_can_be_stopped(case):
    stop = threading.Event()
    stop.set()
    with pytest.raises(SimulationError, match="before the first impact"):
        solver.solve(case, stop=stop, critical=False)
    stop = threading.Event()
    base = []

    def watch(fraction, text):
        base.append(text)
        if text == "impact 1":
            stop.set()

    result = solver.solve(case, stop=stop, progress=watch, critical=False)
    assert result.outcome is Outcome.INTERRUPTED
    assert len(result.measures["rebound_height"]) == 1


GAS = {"gas.viscosity": "18 uPa s", "gas.slip_length": "75 nm"}


@pytest.mark.parametrize(
    ("name", "changes", "reason"),
    [
        ("published-exact", GAS, "without a film"),  # on a half-space
        ("published-exact", {"capillary.formation": "capillary-condensation"}, "equilibrium"),
        ("published", {}, "publication"),
    ],
)
def test_what_has_no_delay_refuses_one(name, changes, reason):
    with pytest.raises(InputError, match=reason) as raised:
        asperity.load(name).replace({**changes, "capillary.formation_time": "1 us"})
    assert raised.value.key == "capillary.formation_time"

"""The publication's assumptions: its pressures, its contact, its case, and what they conserve."""

from dataclasses import replace
from math import cos, pi, radians

import equinox as eqx
import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.special import ndtr

import asperity
from asperity._jax import jax, jnp
from asperity.config.resolve import resolve
from asperity.contact import Contact, PublishedContact
from asperity.contact.profile import Sphere
from asperity.dynamics import Body, simulate
from asperity.errors import InputError, Outcome, Tolerance
from asperity.laws import HeightFunctions, PublishedPressure
from asperity.model import build
from asperity.results.measures import measure

RADIUS, BETA, SIGMA, E, N, W = 50e-6, 0.25e-9, 10.5e-9, 56.814e9, 1.69e16, 0.03
TENSION = 4.05 * 0.075 * cos(radians(73.0))
EDGE = 3.0
MASS = 2200.0 * 4.0 / 3.0 * pi * RADIUS**3
GRAVITY = 9.81


def pressure(functions=None, interaction_range=None, bands=100, edge=EDGE, **changes):
    values = {
        "density": N,
        "radius": BETA,
        "rms_height": SIGMA,
        "modulus": E,
        "work_of_adhesion": W,
        "tension": TENSION,
        **changes,
    }
    span = None if interaction_range is None else jnp.asarray(interaction_range)
    return PublishedPressure(functions or HeightFunctions(), bands, span, edge=edge, **values)


def contact(retraction_only=1.0, **options):
    return PublishedContact(pressure(**options), Sphere(RADIUS), retraction_only)


def phi(x):
    return np.exp(-0.5 * x * x) / np.sqrt(2.0 * pi)


@pytest.mark.parametrize("reduced", [-1.0, 0.5, 2.0, 2.9])
def test_pressures_are_those_of_equations_9_15_and_16(reduced):
    found = pressure()
    h = jnp.asarray(reduced * SIGMA)
    moment = quad(lambda s: (s - reduced) ** 1.5 * phi(s), reduced, reduced + 12.0)[0]
    hertz = 4.0 / 3.0 * N * np.sqrt(BETA) * SIGMA**1.5 * E * moment
    assert float(found.contact(h)) == pytest.approx(hertz, rel=1e-8)
    contacting = ndtr(-reduced)
    assert float(found.adhesion(h)) == pytest.approx(
        2.0 * pi * BETA * W * N * contacting, rel=1e-11
    )
    waiting = max(0.5 - contacting, 0.0)
    menisci = 4.0 * pi * BETA * TENSION * N * waiting
    assert float(found.capillary(h)) == pytest.approx(menisci, rel=1e-11)
    assert float(found.touching(h)) == pytest.approx(N * contacting, rel=1e-11)


def test_nothing_acts_beyond_the_end_of_the_conjunction():
    found, place = pressure(), jnp.asarray([EDGE, 3.5, 10.0]) * SIGMA
    for law in (found.contact, found.adhesion, found.capillary, found.touching):
        np.testing.assert_array_equal(law(place), 0.0)


def test_printed_polynomials_are_those_of_the_text():
    """Eq. 10 at 0 and 3, eq. 17 at 0 and at 3, added up by hand."""
    printed = HeightFunctions(1.0)
    assert float(printed.touching(jnp.asarray(0.0))) == 0.5
    assert float(printed.contact(jnp.asarray(0.0))) == 0.43
    assert float(printed.touching(jnp.asarray(3.0))) == pytest.approx(0.00202172, abs=1e-8)
    assert float(printed.contact(jnp.asarray(3.0))) == pytest.approx(-3.4910e-4, rel=1e-4)


def test_bands_without_end_are_the_integral_over_asperities_that_do_not_touch():
    """Eq. 15 with a Kelvin radius of 5 nm, as the number of bands grows: first order."""
    interaction_range, h = 3e-9, 2.5 * SIGMA
    low = max(h - interaction_range, 0.0) / SIGMA
    whole = quad(lambda z: phi(z) * (1.0 - (h - z * SIGMA) / interaction_range), low, h / SIGMA)[0]
    expected = 4.0 * pi * BETA * TENSION * N * whole

    def error(bands):
        found = pressure(interaction_range=interaction_range, bands=bands)
        return abs(float(found.capillary(jnp.asarray(h))) / expected - 1.0)

    errors = [error(bands) for bands in (50, 100, 200)]
    assert errors[2] < 0.01
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.02)
    assert errors[1] / errors[2] == pytest.approx(2.0, rel=0.02)
    endless = float(pressure(interaction_range=1e3, bands=7).capillary(jnp.asarray(h)))
    assert endless == pytest.approx(float(pressure().capillary(jnp.asarray(h))))


@pytest.mark.parametrize(
    "options", [{}, {"functions": HeightFunctions(1.0)}, {"interaction_range": 3e-9}]
)
def test_force_is_the_slope_of_the_energy_in_both_directions(options):
    """On the way in of the stored energy, on the way out less the work that the pulls take."""
    made, places = contact(**options), jnp.asarray([-5e-9, 1e-9, 20e-9, 31.2e-9])

    def energy_and_force(d, unloading):
        state = made.state(d, unloading)
        return state.stored - unloading * jnp.sum(state.bonds), state.force

    of_each = jax.jit(jax.vmap(jax.grad(energy_and_force, has_aux=True), (0, None)))
    for unloading in (0.0, 1.0):
        slopes, forces = of_each(places, jnp.asarray(unloading))
        np.testing.assert_allclose(forces, -slopes, rtol=1e-9)


def test_force_on_the_sphere_is_the_integral_over_the_conjunction():
    made, d = contact(), 30e-9
    state = made.state(jnp.asarray(d), jnp.asarray(1.0))
    end = np.sqrt(2.0 * RADIUS * (EDGE * SIGMA - d))

    def ring(r, law):
        return 2.0 * pi * r * float(law(jnp.asarray(d + r * r / (2.0 * RADIUS))))

    laws = (made.pressure.contact, made.pressure.adhesion, made.pressure.capillary)
    for part, law, sign in zip(state.parts, laws, (1.0, -1.0, -1.0), strict=True):
        whole = quad(ring, 0.0, end, args=(law,))[0]
        assert float(part) == pytest.approx(sign * whole, rel=1e-8)


def integrated(made, impacts=30):
    body = Body(MASS, GRAVITY, 41.5e-9, rebounds_from=made.pressure.end)
    motion = _simulated(made, body, tolerance=Tolerance(max_impacts=impacts))
    return motion, measure(motion, body)


_simulated = eqx.filter_jit(simulate)


@pytest.fixture(scope="module")
def published():
    """Motion and measures of the published sphere."""
    return integrated(contact())


def stepped(made, gap, impacts):
    """Apex separations and times by an integration in time that knows nothing of energy."""
    nodes, weights = np.polynomial.legendre.leggauss(30)
    p = made.pressure
    end, scale = float(p.end), 1e-9

    def force(d, unloading):
        if d >= end:
            return 0.0
        places = d + 0.5 * (end - d) * (nodes + 1.0)
        x = places / SIGMA
        push = moment(x) * 4.0 / 3.0 * N * np.sqrt(BETA) * SIGMA**1.5 * E
        contacting = ndtr(-x)
        pull = 2.0 * pi * BETA * W * N * contacting + 4.0 * pi * BETA * TENSION * N * (
            0.5 - contacting
        )
        total = push - unloading * pull
        return 2.0 * pi * RADIUS * float(0.5 * (end - d) * weights @ total)

    fine, weight = np.polynomial.legendre.leggauss(40)

    def moment(x):
        t = 0.5 * (fine + 1.0)  # s = x + 6 t^2
        return phi(x[:, None] + 6.0 * t**2) @ (0.5 * weight * 12.0 * t * (6.0 * t**2) ** 1.5)

    def rate(_, y, unloading):
        return [y[1], (force(y[0] * scale, unloading) / MASS - GRAVITY) * 1e-12 / scale]

    found, state, time = [], [gap / scale, 0.0], 0.0
    for _ in range(impacts):
        for unloading in (0.0, 1.0):
            turns = lambda t, y, _: y[1]  # noqa: E731
            turns.terminal, turns.direction = True, 1.0 - 2.0 * unloading
            reaches = lambda t, y, _: y[0] - end / scale  # noqa: E731
            reaches.terminal = True
            # Free flight and contact apart: the force jumps at neither end of a piece.
            for event in (reaches, turns):
                answer = solve_ivp(
                    rate, (0.0, 1e5), state, "DOP853", events=event, args=(unloading,),
                    rtol=1e-11, atol=1e-12,
                )  # fmt: skip
                time += float(answer.t_events[0][0])
                state = list(answer.y_events[0][0])
            state[1] = 0.0
        found.append((state[0] * scale, time * 1e-6))
    return np.array(found)


def test_motion_agrees_with_an_integration_in_time(published):
    """Three impacts of the published case: heights to 1e-7, times to 1e-8."""
    impacts, expected = published[0].impacts, stepped(contact(), 41.5e-9, 3)
    np.testing.assert_allclose(impacts.apex[:3] - EDGE * SIGMA,
                               expected[:, 0] - EDGE * SIGMA, rtol=1e-7)  # fmt: skip
    np.testing.assert_allclose(impacts.apex_time[:3], expected[:, 1], rtol=1e-8)


def test_pulls_in_both_directions_lose_nothing():
    _, found = integrated(contact(retraction_only=0.0))
    assert float(found.restitution[0]) == pytest.approx(1.0, abs=1e-8)


def test_the_ledger_closes_where_pulls_act_while_parting(published):
    motion, found = published
    made = np.asarray(motion.impacts.made)
    energy = float(motion.impacts.maximum_kinetic[0])
    assert np.max(np.asarray(motion.impacts.energy_balance_error)[made]) < 1e-10 * energy
    lost = float(np.sum(np.asarray(motion.impacts.lost)[made][0]))
    heights = 41.5e-9 - float(motion.impacts.apex[0])
    assert lost == pytest.approx(MASS * GRAVITY * heights, rel=1e-9)
    # What is lost is the work of the pulls on the way out, eq. 23.
    assert float(found.power_loss[0]) == pytest.approx(float(found.power_loss_published[0]))


def test_rebounds_count_from_the_edge_of_the_conjunction(published):
    motion, found = published
    made = np.asarray(motion.impacts.made)
    np.testing.assert_allclose(found.rebound_height[made], motion.impacts.apex[made] - EDGE * SIGMA)


def test_decrement_has_a_gradient_through_the_published_case():
    def decrement(factor):
        made = contact()
        made = replace(made, pressure=replace(made.pressure, tension=TENSION * factor))
        return integrated(made, 1)[1].log_decrement[0]

    value = jax.jit(jax.value_and_grad(decrement))
    slope = float(value(jnp.asarray(1.0))[1])
    step = 1e-4
    above, below = (float(value(jnp.asarray(1.0 + by))[0]) for by in (step, -step))
    assert slope == pytest.approx((above - below) / 2.0 / step, rel=1e-6)


@pytest.fixture(scope="module")
def case():
    return asperity.load("published")


def test_humidity_of_one_is_an_infinite_kelvin_radius_here_alone(case):
    assert resolve(case).kelvin_radius == np.inf
    assert build(resolve(case)).contact.pressure.interaction_range is None
    with pytest.raises(
        InputError, match=r"`humidity` must lie in \[0, 1\) without an `adsorbed_film_thickness`"
    ):
        case.replace({"publication": None})


@pytest.mark.parametrize(
    ("changes", "rule"),
    [
        ({"adhesion.model": "jkr"}, "`model` must be 'dmt' or 'none' with a"),
        ({"capillary.formation": "capillary-condensation"}, "`formation` must be 'on-contact' wit"),
        (
            {"roughness": None, "counterface.deformation": "half-space"},
            r"a \[roughness\] table must be given with \[publication\]",
        ),
        ({"publication.polynomials": "print"}, "did you mean 'printed'"),
        ({"publication.conjunction_ends": 0.0}, r"must lie in \[0.1, 8\]; got 0"),
        ({"publication.capillary_factor": -1.0}, "`capillary_factor` must lie in"),
        ({"publication.bands": 0}, "`bands` must lie in"),
    ],
)
def test_conflicting_models_are_refused(case, changes, rule):
    with pytest.raises(InputError, match=rule):
        case.replace(changes)


def test_the_built_in_case_rests_and_says_what_it_assumes(case):
    result = asperity.solve(case, critical=False)
    assert result.outcome is Outcome.REST
    assert any("[publication] follows a paper" in line for line in result.warnings)
    assert any("Kelvin radius is infinite" in line for line in result.warnings)
    assert sum(result.ledger["lost"].values()) == pytest.approx(result.ledger["initial"], rel=1e-3)


@pytest.mark.parametrize(
    "changes",
    [
        {"capillary.humidity": 0.6},
        {"capillary.model": "none"},
        {"publication.polynomials": "printed"},
        {"impact.speed": "0.1 m/s"},
    ],
)
def test_every_variant_closes_its_ledger(case, changes):
    result = asperity.solve(case.replace({**changes, "numerics.max_impacts": 5}), critical=False)
    assert result.ledger["energy_balance_error"] < 1e-6


def test_the_curve_of_the_published_case_loses_what_the_first_impact_loses(case):
    curve, result = asperity.curve(case), asperity.solve(case, critical=False)
    measures = result.measures
    lost = measures["power_loss"][0] * measures["rebound_period"][0]
    # From the deepest point to far apart, all that the pulls take.
    assert curve.loss == pytest.approx(lost, rel=1e-6)
    assert np.all(curve.force_unloading <= curve.force_loading + 1e-18)


@eqx.filter_jit
def menisci(law, places):
    """Pressures of the menisci at some places, and their slopes."""
    return law.capillary(places), jax.vmap(jax.grad(law.capillary))(places)


@pytest.mark.parametrize("interaction_range", [3e-9, 15e-9, 300e-9])
@pytest.mark.parametrize("edge", [3.0, 5.0])
def test_the_sum_over_narrow_bands_is_that_term_by_term(interaction_range, edge):
    """At a twentieth of an rms height a band, where the program takes the integral."""
    wide = pressure(interaction_range=interaction_range, edge=edge)
    h = jnp.linspace(-2.0, 0.9999 * edge, 300) * SIGMA
    one_by_one, slopes = menisci(wide, h)
    found, steep = menisci(replace(wide, fine=True), h)
    largest, steepest = float(jnp.max(one_by_one)), float(jnp.max(jnp.abs(slopes)))
    np.testing.assert_allclose(found, one_by_one, rtol=0.0, atol=1e-13 * largest)
    np.testing.assert_allclose(steep, slopes, rtol=0.0, atol=1e-12 * steepest)


@eqx.filter_jit
def curves(touched, ends, places):
    """Those summed panel by panel, and the integrals from each place."""
    return touched.curves(ends, places), Contact.curves(touched, ends, places)


@pytest.mark.parametrize("release", [41.5e-9, 20e-9])  # outside the conjunction, and within it
@pytest.mark.parametrize("interaction_range", [None, 15e-9])
def test_curves_summed_panel_by_panel_are_integrals_from_each_place(interaction_range, release):
    touched = contact(interaction_range=interaction_range)
    ends = touched.panels(jnp.asarray(-2.0 * SIGMA), jnp.asarray(release))
    points = np.polynomial.chebyshev.chebpts1(16)
    places = 0.5 * (ends[:-1] + ends[1:])[:, None] + 0.5 * jnp.diff(ends)[:, None] * points
    summed, each = curves(touched, ends, places)
    for name in ("force", "stored", "bonds", "parts", "contacting"):
        found, expected = getattr(summed, name), getattr(each, name)
        largest = float(jnp.max(jnp.abs(expected)))
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-11 * largest, err_msg=name)

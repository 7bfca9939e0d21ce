"""What a motion means: each measure against its definition and closed forms."""

from math import pi, radians, sqrt

import equinox as eqx
import numpy as np
import pytest

from asperity._jax import jnp
from asperity.contact import RigidContact
from asperity.contact.profile import Sphere
from asperity.dynamics import Body, simulate
from asperity.errors import Tolerance
from asperity.interface.interface import Interface
from asperity.laws import Dmt, Hertz, Meniscus
from asperity.numerics.height_integrals import height_integral
from asperity.regimes import load_parameter
from asperity.results.measures import measure
from asperity.surfaces.heights import Gaussian

RADIUS, BETA, SIGMA, E, N, W = 50e-6, 0.25e-9, 10.5e-9, 56.8e9, 1.69e16, 0.03
MASS = 2200.0 * 4.0 / 3.0 * pi * RADIUS**3
BODY = Body(MASS, 9.81, 200e-9)


def contact(tension):
    law = Hertz(BETA, E) + Dmt(BETA, W) + Meniscus(BETA, tension, radians(73.0), 1.05e-9)
    return RigidContact(Interface(law, Gaussian(SIGMA), N), Sphere(RADIUS))


CONTACT = contact(0.0728)


@eqx.filter_jit
def moved(contact, rest):
    """Four impacts, or as many as it takes to rest, and their measures."""
    motion = simulate(contact, BODY, tolerance=Tolerance(rest=rest, max_impacts=4))
    return motion, measure(motion, BODY)


REST = jnp.asarray(Tolerance().rest)


@pytest.fixture(scope="module")
def integrated():
    return moved(CONTACT, REST)


def test_impact_speed_is_that_of_free_fall_to_where_forces_begin(integrated):
    _, found = integrated
    fall = 200e-9 - float(found.contact_end)
    assert float(found.impact_speed) == pytest.approx(sqrt(2.0 * 9.81 * fall), rel=1e-6)


def test_the_largest_speed_is_that_at_the_static_equilibrium(integrated):
    """There the weight is carried: free fall less the stored energy."""
    motion, found = integrated
    weight = float(BODY.weight)
    ground = motion.reference
    fallen = weight * (200e-9 - float(ground.equilibrium)) - float(ground.stored)
    assert float(found.maximum_speed) == pytest.approx(sqrt(2.0 * fallen / MASS), rel=1e-4)


def test_rebound_heights_count_from_the_static_equilibrium(integrated):
    motion, found = integrated
    state = CONTACT.state(motion.reference.equilibrium, CONTACT.initial_memory())
    assert float(state.force) == pytest.approx(float(BODY.weight), rel=1e-7)
    heights = np.asarray(motion.impacts.apex) - float(motion.reference.equilibrium)
    np.testing.assert_allclose(found.rebound_height, heights, rtol=1e-12)


def test_decrement_is_the_logarithm_of_successive_heights(integrated):
    motion, found = integrated
    release = 200e-9 - float(motion.reference.equilibrium)
    heights = np.concatenate([[release], found.rebound_height])
    np.testing.assert_allclose(found.log_decrement, np.log(heights[:-1] / heights[1:]), rtol=1e-12)
    assert np.all(np.asarray(found.log_decrement) > 0.0)


def test_restitution_of_a_drop_is_the_root_of_the_ratio_of_heights(integrated):
    """Apart, all energy is m g (d - d_ref)."""
    motion, found = integrated
    above = np.concatenate([[200e-9], motion.impacts.apex]) - float(found.contact_end)
    np.testing.assert_allclose(found.restitution, np.sqrt(above[1:] / above[:-1]), rtol=1e-6)


def test_energies_are_compared_where_contact_ends(integrated):
    motion, found = integrated
    peak = float(motion.impacts.force[0])
    saturated = CONTACT.state(found.contact_end, CONTACT.branches()[-1])
    initial = CONTACT.state(found.contact_end, CONTACT.initial_memory())
    largest = max(abs(float(saturated.force)), abs(float(initial.force)))
    assert largest == pytest.approx(1e-6 * peak, rel=1e-3)


def test_rebound_period_is_from_maximum_to_maximum(integrated):
    motion, found = integrated
    times = np.concatenate([[0.0], motion.impacts.apex_time])
    np.testing.assert_allclose(found.rebound_period, np.diff(times), rtol=1e-12)


def test_power_loss_is_the_energy_missing_at_the_next_maximum(integrated):
    motion, found = integrated
    energy = np.concatenate([[float(motion.release)], motion.impacts.mechanical])
    power = -np.diff(energy) / np.asarray(found.rebound_period)
    np.testing.assert_allclose(found.power_loss, power, rtol=1e-5)


def test_loss_of_a_cycle_is_that_of_the_menisci_made(integrated):
    """All asperities that touch at the deepest point lose 2 pi beta gamma cos(theta) c each."""
    motion, _ = integrated
    formation, rupture = CONTACT.losses()
    count = 2.0 * pi * RADIUS * SIGMA * N
    count *= float(height_integral(1.0, motion.impacts.closest_approach[0] / SIGMA))
    expected = count * float(formation[0] + rupture[0])
    assert float(motion.impacts.lost[0, 0]) == pytest.approx(expected, rel=1e-8)


def test_published_power_loss_is_the_work_of_attraction_on_the_way_out():
    """Of DMT asperities: their whole adhesive energy at the deepest point, in closed form."""
    motion, found = moved(contact(0.0), REST)
    deepest = float(motion.impacts.closest_approach[0]) / SIGMA
    area = 2.0 * pi * RADIUS * SIGMA * 2.0 * pi * BETA * W * N * SIGMA
    work = area * float(height_integral(2.0, deepest)) / 2.0
    power = work / float(motion.impacts.apex_time[0])
    assert float(found.power_loss_published[0]) == pytest.approx(power, rel=1e-7)
    assert abs(float(found.power_loss[0])) < 1e-12 * power


def test_what_does_not_apply_is_not_a_number(integrated):
    _, found = integrated
    assert not bool(found.captured)
    assert np.isnan(float(found.time_to_rest))
    assert np.isnan(float(found.capture_time))


def test_a_body_that_rests_has_a_time_to_rest():
    motion, found = moved(CONTACT, jnp.asarray(2.0))
    assert float(found.time_to_rest) == float(motion.impacts.apex_time[0])


def test_load_parameter_of_one_rigid_asperity_pulled_off_is_two():
    pull = 2.0 * pi * W * BETA
    assert load_parameter(7.0 * pull, 7.0, W, BETA) == pytest.approx(2.0, rel=1e-14)

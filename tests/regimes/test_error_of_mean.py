"""By how much the mean field is off from single bodies: beside many of them, and the rule."""

import numpy as np
import pytest

from asperity._jax import jax, jnp
from asperity.asperity_laws import asperity_law
from asperity.config import load
from asperity.config.resolve import resolve
from asperity.contact.asperity_table import asperity_table
from asperity.interface.summit_field import GaussianField
from asperity.regimes.error_of_mean import LossesOfBodies, losses_of_bodies, mean_is_enough
from test_single_bodies import CASE

ENERGY = 1e-14  # J: no summit takes as much
WET = CASE.replace("6.3e13", "1.26e15")
LAWS = {"wet": WET, "wet, adhesive": WET.replace('"dmt"', '"jkr"')}


@pytest.mark.parametrize("name", LAWS)
def test_losses_are_those_of_bodies_drawn_at_random(name):
    """Each is pressed on some 40 summits until it has the energy of the mean."""
    inputs = resolve(load(LAWS[name]))
    rough, radius = inputs.asperities, inputs.radius
    rms, separation = rough.rms_height, 0.8 * rough.rms_height
    table = asperity_table([asperity_law(inputs, rough.asperity_radius)], ENERGY)
    one = table.of(jnp.zeros(1, jnp.int32))
    gaps = np.linspace(-5.0, 5.0, 20_001) * rms
    work = np.asarray(jax.jit(jax.vmap(lambda gap: one.work(gap[None])[0]))(gaps))
    lost, forming = np.asarray(one.lost)[:, 0], np.asarray(one.forming)[:, 0]
    field = GaussianField(radius, rough.asperity_density, rms)
    energy = -np.sum(
        np.diff(work) * field.expected_above(separation - 0.5 * (gaps[1:] + gaps[:-1]))
    )
    offsets = np.concatenate([field.summits(5, block, 512)[0] for block in range(16)])
    low, high = np.full(len(offsets), separation - rms), np.full(len(offsets), separation + rms)
    for _ in range(30):
        middle = 0.5 * (low + high)
        deep = np.sum(np.interp(middle[:, None] - offsets, gaps, work), axis=1) > energy
        low, high = np.where(deep, middle, low), np.where(deep, high, middle)
    met = low[:, None] - offsets
    losses = sum(each * np.sum(met <= gap, axis=1) for each, gap in zip(lost, forming, strict=True))
    touching = float(field.expected_above(separation))
    mean = sum(
        each * float(field.expected_above(separation - gap))
        for each, gap in zip(lost, forming, strict=True)
    )
    found = losses_of_bodies(inputs, separation, touching)
    assert 30.0 < touching < 60.0
    assert found.scatter == pytest.approx(np.std(losses) / mean, rel=0.05)
    error = np.std(losses) / mean / len(offsets) ** 0.5
    excess = np.mean(losses) / mean - 1.0
    assert excess > 5.0 * error
    assert found.excess == pytest.approx(excess, rel=0.1, abs=3.0 * error)


def test_they_fall_as_the_number_of_summits_grows():
    inputs = resolve(load(WET))
    some = losses_of_bodies(inputs, 1e-9, 10.0)
    more = losses_of_bodies(inputs, 1e-9, 40.0)
    assert more.excess == pytest.approx(some.excess / 4.0)
    assert more.scatter == pytest.approx(some.scatter / 2.0)
    assert some.fewer(0.25).scatter == pytest.approx(2.0 * some.scatter)


def test_summits_that_lose_nothing_have_no_scatter():
    dry = WET.replace('model = "equilibrium"', 'model = "none"')
    assert losses_of_bodies(resolve(load(dry)), 1e-9, 10.0) == LossesOfBodies(0.0, 0.0)


def test_the_error_is_that_of_a_mean_over_bodies():
    """Of the root of what is kept: to the first order in what is lost more, and in its variance."""
    few = LossesOfBodies(excess=0.01, scatter=0.04)
    assert few.error(0.75, 0.25) == pytest.approx(0.0025 / 1.5 + 0.01**2 / 8.0 / 0.75**2, rel=0.01)


@pytest.mark.parametrize(
    ("loaded", "excess", "scatter", "kept", "enough"),
    [
        (2.9, 0.0, 0.0, 1.0, False),  # too few carry the load
        (3.1, 0.0, 0.0, 1.0, True),
        (5.4, 0.17, 0.52, 0.62, False),  # off by 7.5 %
        (3.2, 0.18, 0.54, 0.79, True),  # by 2.8 %
        (100.0, 0.02, 0.15, 0.19, False),  # near capture
        (400.0, 0.005, 0.07, 0.19, True),
        (400.0, 0.005, 0.07, -0.15, False),
        (400.0, 0.005, 0.07, -0.30, True),  # all are captured
    ],
)
def test_a_mean_is_enough_away_from_capture_where_enough_carry_the_load(
    loaded, excess, scatter, kept, enough
):
    assert mean_is_enough(loaded, LossesOfBodies(excess, scatter), kept, 1.0 - kept) is enough

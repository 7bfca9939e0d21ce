"""Largest pull of the Maugis-Dugdale contact, from the rigid limit to the soft one."""

from functools import cache
from math import pi
from pathlib import Path

import equinox as eqx
import numpy as np
import pytest

from asperity._jax import jnp
from asperity.laws import Maugis
from asperity.laws.maugis import RANGE_PER_SPACING
from figures import Figure, misses

FILE = Path(__file__).parent.parent / "data" / "maugis_pull_off.csv"
ROWS = np.genfromtxt(FILE, delimiter=",", comments="#", skip_header=3)
RADIUS, E, W = 1e-6, 5e9, 0.05
DEPTH = (9.0 * pi**2 * W**2 * RADIUS / (16.0 * E**2)) ** (1.0 / 3.0)


@cache
def largest_pull(elasticity):
    """Over pi w R, by three grids, each around the minimum of the one before."""
    law = Maugis(RADIUS, E, W, 2.0 * DEPTH / (pi * elasticity) / RANGE_PER_SPACING)
    force = eqx.filter_jit(law.bonded_force)
    low, high = -3.0 * DEPTH, float(law.breaking_gap)
    for _ in range(3):
        gap = np.linspace(low, high, 4001)
        pull = -np.asarray(force(jnp.asarray(gap)))
        k = int(np.argmax(pull))
        low, high = gap[max(k - 1, 0)], gap[min(k + 1, 4000)]
    return float(pull.max()) / (pi * W * RADIUS)


LIMITS = ((0.005, 2.0, "Bradley (1932), 2 pi w R"), (50.0, 1.5, "JKR (1971), 1.5 pi w R"))


def figure(elasticity, pull_off, source, limit):
    problem = f"Maugis-Dugdale contact, lambda {elasticity:g}: pull-off"
    return Figure(problem, source, pull_off, largest_pull(elasticity), "pi w R", limit)


def solved(row):
    return figure(*row, "Maugis (1992), solved apart", 1e-4)


def limits():
    return [figure(*known, 1e-3) for known in LIMITS]


def figures():
    return [*map(solved, ROWS), *limits()]


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_pull_off_of_one_contact(row):
    assert solved(row).holds


def test_pull_off_tends_to_that_of_rigid_bodies_and_to_that_of_soft_ones():
    """2 pi w R (Bradley) and 1.5 pi w R (JKR), from between them."""
    assert not misses(limits())
    pulls = [largest_pull(elasticity) for elasticity in (0.005, 0.05, 0.5, 5.0, 50.0)]
    assert np.all(np.diff(pulls) < 0.0)
    assert 1.5 < pulls[-1] < pulls[0] < 2.0


def test_all_pull_offs_are_read():
    assert ROWS.shape == (6, 2)

"""Largest pull of the Maugis-Dugdale contact, from the rigid limit to the soft one."""

from functools import cache
from math import pi

import equinox as eqx
import numpy as np

from asperity.laws import Maugis
from asperity.laws.maugis import RANGE_PER_SPACING
from figures import Figure, misses
from validation.known import largest_pull, rows

ROWS = rows("maugis_pull_off", 3, 6)
RADIUS, E, W = 1e-6, 5e9, 0.05
DEPTH = (9.0 * pi**2 * W**2 * RADIUS / (16.0 * E**2)) ** (1.0 / 3.0)


@cache
def pull_off(elasticity):
    """Over pi w R."""
    law = Maugis(RADIUS, E, W, 2.0 * DEPTH / (pi * elasticity) / RANGE_PER_SPACING)
    found = largest_pull(eqx.filter_jit(law.bonded_force), -3.0 * DEPTH, float(law.breaking_gap))
    return found / (pi * W * RADIUS)


LIMITS = ((0.005, 2.0, "Bradley (1932), 2 pi w R"), (50.0, 1.5, "JKR (1971), 1.5 pi w R"))


def figure(elasticity, known, source, limit):
    problem = f"Maugis-Dugdale contact, lambda {elasticity:g}: pull-off"
    return Figure(problem, source, known, pull_off(elasticity), "pi w R", limit)


def figures():
    solved = [figure(*row, "Maugis (1992), solved apart", 1e-4) for row in ROWS]
    return [*solved, *(figure(*known, 1e-3) for known in LIMITS)]


def test_known_figures_are_met():
    assert misses(figures()) == []


def test_pull_off_tends_to_that_of_rigid_bodies_and_to_that_of_soft_ones():
    """2 pi w R (Bradley) and 1.5 pi w R (JKR), from between them."""
    pulls = [pull_off(elasticity) for elasticity in (0.005, 0.05, 0.5, 5.0, 50.0)]
    assert np.all(np.diff(pulls) < 0.0)
    assert 1.5 < pulls[-1] < pulls[0] < 2.0

"""Largest pull of spheres under the Lennard-Jones pressure, near the rigid and the soft limit."""

from math import pi

import numpy as np

from asperity._jax import jnp
from asperity.laws import LennardJones
from figures import Figure, misses

RADIUS, W, SPACING = 1e-6, 0.05, 3e-10


def largest_pull(tabor):
    """Over pi w R, by three grids, each around the minimum of the one before."""
    modulus = W * (RADIUS / (tabor * SPACING) ** 3) ** 0.5
    law = LennardJones(RADIUS, modulus, W, SPACING)
    low, high = -20.0 * SPACING, float(law.breaking_gap)
    for _ in range(3):
        gap = np.linspace(low, high, 2001)
        pull = -np.asarray(law.bonded_force(jnp.asarray(gap)))
        k = int(np.argmax(pull))
        low, high = gap[max(k - 1, 0)], gap[min(k + 1, 2000)]
    return float(pull.max()) / (pi * W * RADIUS)


LIMITS = (
    (0.01, 2.0, "Bradley (1932), 2 pi w R", 1e-2),
    (5.0, 1.5, "JKR (1971), 1.5 pi w R, the limit of a larger Tabor number", 2e-2),
)


def figures():
    return [
        Figure(f"Lennard-Jones pressure, mu {tabor:g}: pull-off", source, known,
               largest_pull(tabor), "pi w R", limit)
        for tabor, known, source, limit in LIMITS
    ]  # fmt: skip


def test_pull_off_near_both_limits():
    assert misses(figures()) == []

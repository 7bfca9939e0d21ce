"""Largest pull of spheres under the Lennard-Jones pressure, near the rigid and the soft limit."""

from math import pi

from asperity.laws import LennardJones
from figures import Figure, misses
from validation.known import largest_pull

RADIUS, W, SPACING = 1e-6, 0.05, 3e-10


def pull_off(tabor):
    """Over pi w R."""
    modulus = W * (RADIUS / (tabor * SPACING) ** 3) ** 0.5
    law = LennardJones(RADIUS, modulus, W, SPACING)
    found = largest_pull(law.bonded_force, -20.0 * SPACING, float(law.breaking_gap))
    return found / (pi * W * RADIUS)


LIMITS = (
    (0.01, 2.0, "Bradley (1932), 2 pi w R", 1e-2),
    (5.0, 1.5, "JKR (1971), 1.5 pi w R, the limit of a larger Tabor number", 2e-2),
)


def figures():
    return [
        Figure(f"Lennard-Jones pressure, mu {tabor:g}: pull-off", source, known,
               pull_off(tabor), "pi w R", limit)
        for tabor, known, source, limit in LIMITS
    ]  # fmt: skip


def test_pull_off_near_both_limits():
    assert misses(figures()) == []

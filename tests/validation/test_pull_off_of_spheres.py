"""Pull-off and work of separation of smooth spheres, whatever the speed of the impact before."""

from functools import cache
from math import pi

from asperity.config import load
from asperity.config.resolve import resolve
from asperity.solver import curve
from figures import Figure, misses

SPEEDS = ("0.3 m/s", "2 m/s", "20 m/s")
LIMIT = 1e-12


@cache
def unloaded(model, speed):
    """The case of a polystyrene sphere on silica, and its curve."""
    case = load(
        f"""
        [body]
        radius = "1 um"
        material = "polystyrene"
        [counterface]
        material = "silica"
        [adhesion]
        model = "{model}"
        work = "100 mJ/m^2"
        equilibrium_spacing = "0.2 nm"
        [impact]
        speed = "{speed}"
        gravity = "0 m/s^2"
        """
    )
    return case, curve(case)


def jkr(speed):
    case, found = unloaded("jkr", speed)
    known = 1.5 * pi * case.adhesion.work * case.body.radius
    source = "Johnson, Kendall and Roberts (1971), 1.5 pi w R"
    return Figure(
        f"JKR sphere at {speed}: pull-off force", source, known, found.pull_off, "N", LIMIT
    )


def dmt(speed):
    """Work against the pull 2 pi w R and Hertz's force, from where they balance to no overlap."""
    case, found = unloaded("dmt", speed)
    radius, pull = case.body.radius, 2.0 * pi * case.adhesion.work * case.body.radius
    modulus = float(resolve(case).modulus)
    known = 0.6 * pull * (0.75 * pull / (modulus * radius**0.5)) ** (2.0 / 3.0)
    problem = f"DMT sphere at {speed}: work of separation"
    source = "(3/5) 2 pi w R delta_0"
    return Figure(problem, source, known, found.work_of_separation, "J", LIMIT)


def figures():
    return [each(speed) for each in (jkr, dmt) for speed in SPEEDS]


def test_pull_off_and_work_do_not_depend_on_the_speed():
    assert misses(figures()) == []
    assert all(unloaded("jkr", speed)[1].preload is None for speed in SPEEDS)

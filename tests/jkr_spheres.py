"""Two soft spheres that adhere, JKR's theory of them, and their critical velocity."""

from math import pi, sqrt

from scipy.integrate import quad

import asperity
from asperity.config.case_file import load

W, RADIUS, MODULUS = 0.1, 1e-6, 1e9 / (2.0 * (1.0 - 0.2**2))

SMOOTH = """
schema = 1
[body]
radius = "1 um"
material = "soft"
[counterface]
material = "soft"
[materials.soft]
youngs_modulus = "1 GPa"
poisson = 0.2
density = "2500 kg/m^3"
[adhesion]
model = "jkr"
work = "100 mJ/m^2"
equilibrium_spacing = "0.2 nm"
[impact]
speed = "2 m/s"
gravity = "0 m/s^2"
"""

SPRUNG = (
    SMOOTH.replace('gravity = "0 m/s^2"', 'release_separation = "300 nm"')
    + """
[suspension]
stiffness = "1 N/m"
rest_gap = "50 nm"
"""
)
"""The same on a spring."""


def smooth(model: str, speed: str = "2 m/s") -> asperity.Case:
    return load(SMOOTH.replace('"jkr"', f'"{model}"').replace('"2 m/s"', f'"{speed}"'))


def jkr(a: float) -> tuple[float, float]:
    """Force and overlap at a contact radius, for w = R = E* = 1 (Johnson 1985, ch. 5.5)."""
    return 4.0 * a**3 / 3.0 - sqrt(8.0 * pi * a**3), a * a - sqrt(2.0 * pi * a)


UNIT = (W**5 * RADIUS**4 / MODULUS**2) ** (1.0 / 3.0)
MASS = 2500.0 * 4.0 / 3.0 * pi * RADIUS**3


def cycle_loss():
    """What a JKR contact loses over in and out, for w = R = E* = 1: 7.092196."""
    first, last = (2.0 * pi) ** (1.0 / 3.0), (pi / 8.0) ** (1.0 / 3.0)
    return quad(lambda a: jkr(a)[0] * (2.0 * a - sqrt(0.5 * pi / a)), last, first)[0] * -1.0


CRITICAL = sqrt(2.0 * abs(cycle_loss()) * UNIT / MASS)

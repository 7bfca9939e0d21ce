"""Published sticking speeds and rebounds, and those of smooth elastic spheres that adhere."""

from math import log, pi, sqrt

from asperity._jax import jnp
from asperity.contact import SmoothContact
from asperity.laws import Jkr
from asperity.materials.solids import SOLIDS, Solid, contact_modulus
from figures import Figure
from measured import Comparison, value

SILVER = Solid("silver", 83e9, 0.37, 10490.0, source="handbook value")
ALUMINIUM = Solid("aluminium", 70e9, 0.35, 2700.0, source="handbook value")
ICE = Solid("ice", 9.3e9, 0.33, 917.0, source="handbook value")
SILICA, GLASS, STEEL = (SOLIDS[name] for name in ("silica", "soda-lime glass", "steel"))
WORKS = (0.02, 0.4)  # J/m^2, of silicates from humid to dry
SILICATE = "w 0.02 to 0.4 J/m^2"


def sticking_speed(radius: float, work: float, body: Solid, plane: Solid) -> float:
    """Speed [m/s] below which a smooth JKR sphere does not come off: sqrt(2 W/m)."""
    law = Jkr(radius, contact_modulus(body, plane), work)
    lost = float(sum(jnp.sum(loss) for loss in SmoothContact(law).losses()))
    return sqrt(2.0 * lost / (body.density * 4.0 / 3.0 * pi * radius**3))


def speeds(radii, works, body: Solid, plane: Solid) -> tuple[float, float]:
    """The least and the largest sticking speed [m/s] over radii and works of adhesion."""
    found = [sticking_speed(r, w, body, plane) for r in radii for w in works]
    return min(found), max(found)


def silver() -> list[Comparison]:
    """One work of adhesion for both sizes cannot meet both speeds."""
    works, swept = (0.05, 1.0), "w 0.05 to 1 J/m^2"
    target = "silver on aluminium: sticking speed"
    small = speeds((10e-9,), works, SILVER, ALUMINIUM)
    large = speeds((500e-9,), works, SILVER, ALUMINIUM)
    exponent = log(small[0] / large[0]) / log(20.0 / 1000.0)
    needed = [
        (value(name) / sticking_speed(radius, 1.0, SILVER, ALUMINIUM)) ** 1.2
        for name, radius in (("ARF1", 10e-9), ("ARF2", 500e-9))
    ]
    why = f"needs w = {needed[0]:.2g} J/m^2 of the elastic sphere; yielding would ask for less"
    roughness = (
        f"needs w = {needed[1]:.2g} J/m^2: not yielding, which makes a sphere stick at higher "
        "speeds, but a smaller adhesion, such as roughness leaves"
    )
    slope = "-5/6 for smooth elastic spheres at any w; yielding and roughness change it with size"
    return [
        Comparison("ARF1", f"{target}, 20 nm", *small, swept, why),
        Comparison("ARF2", f"{target}, 1 um", *large, swept, roughness),
        Comparison(
            "ARF3", f"{target}, exponent in the diameter", exponent, exponent, "none", slope
        ),
    ]


def benchmark() -> tuple[Solid, Solid]:
    """The sphere and the wall of a published model."""
    sphere = Solid("ammonium fluorescein", value("PB2"), value("PB3"), value("PB1"))
    return sphere, Solid("silicon wall", value("PB6"), value("PB7"))


def elastic_benchmark() -> Figure:
    """The sticking speed without yielding, from the inputs of the published model."""
    found = sticking_speed(2.45e-6, value("PB4"), *benchmark())
    problem = "ammonium fluorescein sphere: elastic sticking speed"
    return Figure(problem, "closed form, inputs of Pasha et al. (2014)", 0.567, found, "m/s", 1e-3)


def fluorescein() -> list[Comparison]:
    work = value("PB4")
    model = speeds((2.45e-6,), (work,), *benchmark())
    measured = speeds((1.3e-6, 3.45e-6), (work,), *benchmark())
    target = "ammonium fluorescein: sticking speed"
    why = "a published model that yields (35.3 MPa); the elastic sphere rebounds sooner"
    near = "the lowest speed of a series, said to be near the threshold; its sizes not attached"
    return [
        Comparison("PAS1", f"{target}, 4.9 um", *model, "none: inputs as published", why),
        Comparison("WAL1", f"{target}, 2.6 to 6.9 um", *measured, "diameter; w 0.2 J/m^2", near),
    ]


def dust() -> list[Comparison]:
    silicate = speeds((0.5e-6, 1e-6), WORKS, SILICA, SILICA)
    ice = speeds((0.7e-6, 2.3e-6), (2.0 * value("GUN3"),), ICE, ICE)
    wall = "smooth spheres on a plane; the grains hit others of their kind"
    why = (
        "the grains hit an aggregate of grains, which gives way; a smooth elastic sphere on a plane"
    )
    target = "sticking speed"
    return [
        Comparison("HIL1", f"silicate dust: {target}", *silicate,
                   f"diameter 1 to 2 um, {SILICATE}", wall),
        Comparison("GB1", f"water ice grains: {target}", *ice,
                   "radius 0.7 to 2.3 um; w twice the published surface energy", why),
    ]  # fmt: skip


def glass() -> list[Comparison]:
    """Grains that hardly adhere: a bound on the sticking speed, and a restitution."""
    grains = speeds((225e-6,), WORKS, GLASS, STEEL)
    slow = speeds((0.5e-3,), WORKS, GLASS, GLASS)
    rebound = [sqrt(1.0 - speed**2) for speed in reversed(slow)]
    why = (
        "adhesion takes nothing; waves in the bodies, friction in the solid and damage are left out"
    )
    return [
        Comparison("JUN1", "glass of 450 um on metal, little charge: sticking speed", *grains,
                   SILICATE, "charge and roughness left out"),
        Comparison("BOG1", "glass of 1 mm on glass at 1 m/s: restitution", *rebound,
                   SILICATE, why),
    ]  # fmt: skip


def impacts() -> list[Comparison]:
    return [*silver(), *fluorescein(), *dust(), *glass()]

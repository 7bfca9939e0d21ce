"""What each law costs beside Hertz with DMT, in one run: values, and whole motions, in batches."""

from __future__ import annotations

import time
from collections.abc import Callable
from math import pi
from typing import Any

import equinox as eqx
import numpy as np

from asperity._jax import jax, jnp
from asperity.contact import RigidContact, RigidPlasticContact, SmoothContact
from asperity.contact.profile import Sphere
from asperity.dynamics import Body, simulate
from asperity.dynamics.gas_film import SqueezeFilm
from asperity.errors import Tolerance
from asperity.interface.interface import Interface
from asperity.interface.plastic_interface import PlasticInterface
from asperity.laws import Bradley, ConstantVolume, Dmt, Hertz, Jkr, Law, Maugis, Meniscus
from asperity.laws.plastic import KogutEtsion
from asperity.surfaces.heights import Gaussian

MODULUS, WORK, SPACING, TENSION, ANGLE = 50e9, 0.05, 0.3e-9, 0.0728, 0.5
IMPACTS = 3
FILM = SqueezeFilm(5e-6, 18.2e-6, 75e-9, 1e-9)

LAWS: dict[str, Callable[[float], Law]] = {
    "Hertz + DMT": lambda r: Hertz(r, MODULUS) + Dmt(r, WORK),
    "Hertz + Bradley": lambda r: Hertz(r, MODULUS) + Bradley(r, WORK, SPACING),
    "JKR": lambda r: Jkr(r, MODULUS, WORK),
    "Maugis-Dugdale": lambda r: Maugis(r, MODULUS, WORK, SPACING),
    "Hertz + meniscus": lambda r: Hertz(r, MODULUS) + Meniscus(r, TENSION, ANGLE, 1e-9),
    "Hertz + bridge": lambda r: Hertz(r, MODULUS) + ConstantVolume(r, TENSION, ANGLE, 1e-9),
}


def _seconds(action: Callable[[], Any], repeats: int = 15) -> float:
    jax.block_until_ready(action())
    times = []
    for _ in range(repeats):
        begun = time.perf_counter()
        jax.block_until_ready(action())
        times.append(time.perf_counter() - begun)
    return min(times)


def _values(make: Callable[[float], Law]) -> float:
    """Forces of the bonded branch at 1e5 gaps."""
    law = make(50e-9)
    gaps = jnp.linspace(-20e-9, 2e-9, 100_000)
    force = eqx.filter_jit(
        lambda gaps: sum(part.bonded_force(gaps) for part in getattr(law, "parts", (law,)))
    )
    return _seconds(lambda: force(gaps))


def _smooth(make: Callable[[float], Law], film: SqueezeFilm | None = None) -> float:
    """200 motions of a smooth sphere of 5 um, at speeds from 0.1 to 1 m/s."""
    contact = SmoothContact(make(5e-6))
    return _motions(contact, 5e-6, jnp.linspace(0.1, 1.0, 200), film)


def _rough(make: Callable[[float], Law]) -> float:
    """20 motions of a rough sphere of 20 um."""
    plane = Interface(make(50e-9), Gaussian(2e-9), 1e14)
    return _motions(RigidContact(plane, Sphere(20e-6)), 20e-6, jnp.linspace(1e-3, 1e-2, 20))


def _yielding() -> str:
    """20 motions of 20 impacts on asperities that yield, over those on elastic ones."""
    tip, heights, density = 50e-9, Gaussian(2e-9), 1e14
    beside = Dmt(tip, 0.2 * WORK) + Meniscus(tip, TENSION, 1.4, 0.5e-9)  # weak: all bounce
    contact = KogutEtsion(tip, MODULUS, 0.1 * MODULUS, 0.3)
    elastic = Interface(Hertz(tip, MODULUS) + beside, heights, density)
    plastic = PlasticInterface(contact, beside, heights, density)
    sphere, speeds = Sphere(20e-6), jnp.linspace(0.05, 0.1, 20)
    bodies = RigidContact(elastic, sphere), RigidPlasticContact(plastic, sphere)
    before, after = (_motions(body, 20e-6, speeds, impacts=20) for body in bodies)
    return f"{after / before:8.2f}"


def _motions(
    contact: Any,
    radius: float,
    speeds: jax.Array,
    film: SqueezeFilm | None = None,
    impacts: int = IMPACTS,
) -> float:
    mass = 2000.0 * 4.0 / 3.0 * pi * radius**3

    def one(speed: jax.Array) -> jax.Array:
        drags = () if film is None else (film,)
        body = Body(mass, 9.81, 100e-9, speed, drags)
        motion = simulate(contact, body, tolerance=Tolerance(max_impacts=impacts))
        return motion.impacts.apex_time

    batch = jax.jit(jax.vmap(one))
    return _seconds(lambda: batch(speeds), repeats=7)


def rows() -> list[tuple[str, str]]:
    """Ratios to Hertz with DMT: of single values, of smooth and of rough motions."""
    out, base = [], np.ones(3)
    for name, make in LAWS.items():
        taken = np.array([_values(make), _smooth(make), _rough(make)])
        base = taken if name == "Hertz + DMT" else base
        ratios = " ".join(f"{ratio:8.2f}" for ratio in taken / base)
        out.append((f"{name}: values, smooth motions, rough motions", ratios))
    out.append(
        ("Kogut-Etsion + DMT + meniscus: rough motions of 20 impacts, to elastic", _yielding())
    )
    gas = _smooth(LAWS["Hertz + DMT"], FILM) / base[1]
    out.append(("Hertz + DMT through gas: smooth motions", f"{gas:8.2f}"))
    return out

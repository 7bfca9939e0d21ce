"""Measured surfaces: a map described, a million summits as a law, and motions on them."""

from __future__ import annotations

import resource
import time
from collections.abc import Callable
from math import pi, radians
from typing import Any

import numpy as np

from asperity._jax import jax, jnp
from asperity.contact import RigidContact
from asperity.contact.profile import Sphere
from asperity.dynamics import Body, simulate
from asperity.errors import Tolerance
from asperity.interface.interface import Interface
from asperity.interface.measured_summits import measured_surface
from asperity.laws import Dmt, Hertz, Jkr, Law, Meniscus
from asperity.surfaces.description.describe import describe
from asperity.surfaces.generation.generate import self_affine
from asperity.surfaces.heights import Gaussian

RADIUS, RMS, DENSITY, BALL = 50e-9, 2e-9, 1e14, 20e-6
SPEEDS = 200
TURNS = 12
Row = tuple[str, str, str]


def _seconds(action: Callable[[], Any]) -> float:
    begun = time.perf_counter()
    jax.block_until_ready(action())
    return time.perf_counter() - begun


def _wet(radius: Any) -> Law:
    meniscus = Meniscus(radius, 0.0728, radians(40.0), 1e-9)
    return Hertz(radius, 50e9) + Dmt(radius, 0.03) + meniscus


def _jkr(radius: Any) -> Law:
    return Jkr(radius, 50e9, 0.05)


def _summits(count: int) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(1)
    heights = RMS * random.standard_normal(count)
    return heights, RADIUS * np.exp(0.3 * random.standard_normal(count) - 0.1 * heights / RMS)


def _described() -> list[Row]:
    """One map of 2048 x 2048 pixels."""
    made = self_affine(
        (2048, 2048), (2e-9, 2e-9), hurst=0.8, rolloff=400e-9, cutoff=20e-9, rms_height=2e-9, seed=1
    )
    taken = _seconds(lambda: describe(made))
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    return [
        ("a map of 2048 x 2048 pixels described", f"{taken:.2f} s", "5 s"),
        ("  peak memory of this run so far", f"{peak:.2f} GB", "1 GB"),
    ]


def _law() -> list[Row]:
    """A million summits to a pressure at 64 separations."""
    heights, radii = _summits(1_000_000)
    places = jnp.linspace(0.0, 4.0, 64) * RMS
    pressure = jax.jit(lambda surface, memory: surface.pressure(places, memory))

    def made() -> jax.Array:
        surface = measured_surface(_wet, heights, radii, DENSITY, radius=RADIUS)
        return pressure(surface, surface.initial_memory(places))

    first = _seconds(made)
    warm = min(_seconds(made) for _ in range(3))
    return [
        ("a million summits to a pressure law, first time", f"{first:.2f} s", "2 s"),
        ("  the same, after that", f"{warm:.2f} s", "2 s"),
    ]


def _batch(surface: Any, speeds: np.ndarray) -> Callable[[], Any]:
    """Rigid motions of three impacts, all speeds in one vmap, compiled."""
    contact = RigidContact(surface, Sphere(BALL))
    mass = 2000.0 * 4.0 / 3.0 * pi * BALL**3

    def one(speed: jax.Array) -> jax.Array:
        body = Body(mass, 9.81, 100e-9, speed)
        return simulate(contact, body, tolerance=Tolerance(max_impacts=3)).impacts.apex_time

    batch = jax.jit(jax.vmap(one))
    jax.block_until_ready(batch(speeds))
    return lambda: batch(speeds)


def _motions() -> list[Row]:
    """Motions on summits over those on their Gaussian fit."""
    heights, radii = _summits(1_000_000)
    speeds, out = np.linspace(1e-3, 1e-2, SPEEDS), []
    for name, law, some in (("DMT, menisci", _wet, SPEEDS), ("JKR, 6 classes", _jkr, 50)):
        fitted = Interface(law(RADIUS), Gaussian(RMS), DENSITY)
        summits = measured_surface(law, heights, radii, DENSITY, radius=RADIUS)
        batches = [_batch(surface, speeds[:some]) for surface in (summits, fitted)]
        # In turn, so that both meet the machine's faster and slower moments.
        turns = [[_seconds(batch) for batch in batches] for _ in range(TURNS)]
        taken = [min(each) for each in zip(*turns, strict=True)]
        what = f"{some} rigid motions on summits, {name}, ms each"
        out.append((what, f"{1e3 * taken[0] / some:.2f}", ""))
        out.append(("  over those on the Gaussian fit", f"{taken[0] / taken[1]:.2f}", "1"))
    return out


def rows() -> list[Row]:
    """What was measured, the figure, and its goal."""
    return [*_described(), *_law(), *_motions()]

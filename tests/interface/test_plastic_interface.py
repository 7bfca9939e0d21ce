"""Many asperities that yield: limits, energies and derivatives of their means."""

from itertools import pairwise
from math import pi

import equinox as eqx
import numpy as np
import pytest

from asperity._jax import jax, jnp
from asperity.interface.interface import Interface
from asperity.laws import Hertz
from asperity.laws.law import Sum, terms
from asperity.surfaces.heights import Gaussian
from plastic_asperities import (
    BATCH,
    BESIDE,
    BETA,
    NU,
    REACH,
    SIGMA,
    YIELD,
    E,
    N,
    asperities,
    every_law,
    every_sum,
    every_yield,
    measured,
    worst,
)

# -- limits ----------------------------------------------------------------------------------

LOADED = np.linspace(-0.5, 3.5, 9) * SIGMA


def from_psi(psi):
    """Yield overlap in rms at a plasticity index (E*/H) sqrt(rms/radius)."""
    return (0.5 * pi * (0.454 + 0.41 * NU) / psi) ** 2


@pytest.mark.parametrize(("psi", "tolerance"), [(0.3, 1e-3), (1e-4, 1e-9)])
@every_sum
def test_hard_asperities_are_those_of_hertz(beside, integrated, psi, tolerance):
    interface = asperities(beside, from_psi(psi))
    elastic = Interface(Sum((Hertz(BETA, E), *terms(BESIDE[beside]))), Gaussian(SIGMA), N)
    for turn in (np.inf, -0.5 * SIGMA):
        memory = tuple(
            b if np.isinf(turn) else np.asarray(turn) for b in interface.initial_memory()
        )
        found = measured(interface, LOADED, memory, integrated)
        exact = elastic.measure(
            jnp.asarray(LOADED), tuple(jnp.full(LOADED.shape, b) for b in memory[1:]), integrated
        )
        assert worst(found.parts, exact.parts) < tolerance
        assert worst(found.energy, exact.energy, 0.1) < tolerance  # adhesion cancels contact
        assert worst(found.bonds[1:], exact.bonds) < tolerance
        assert np.max(np.abs(found.bonds[0])) <= 1e-9 * np.max(np.abs(found.energy))


# -- energies --------------------------------------------------------------------------------


@eqx.filter_jit
def slopes(interface, separation, memory, integrated):
    """Pressure, and slopes of the energy and of that with all that was lost on the way."""

    def energies(h):
        found = interface.measure(h, memory, integrated)
        spent = jnp.tensordot(interface.losses()[0], found.bonds, 1)
        return jnp.sum(found.parts, axis=0), found.energy, found.energy + spent

    ways = jnp.ones_like(separation)
    (pressure, *_), (_, *both) = jax.jvp(energies, (separation,), (ways,))
    return pressure, *both


@pytest.mark.parametrize("integrated", [0, 1])
def test_pressure_is_the_slope_of_energy_and_of_the_work_of_first_approach(integrated):
    for overlap in YIELD:
        interface = asperities("dmt + meniscus", overlap)
        h = jnp.linspace(-1.5, 3.0, BATCH) * SIGMA
        fresh = tuple(jnp.full(h.shape, b) for b in interface.initial_memory())
        pressure, _, work = slopes(interface, h, fresh, integrated)
        assert worst(-work, pressure, 1e-3) < 1e-7
        # Menisci neither form nor break within their reach of the closest approach.
        turns = h - jnp.linspace(0.05, 0.95, BATCH) * REACH
        unloading = tuple(turns for _ in interface.initial_memory())
        pressure, energy, _ = slopes(interface, h, unloading, integrated)
        assert worst(-energy, pressure, 1e-3) < 1e-7


@eqx.filter_jit
def approached(interface, separation, memory, integrated):
    return interface.first_approach(separation, integrated)


@eqx.filter_jit
def left_by(interface, memory):
    """The interface as its closest approach left it."""
    return interface.as_flattened(interface.flattened(memory, 0))


def work_between(interface, memory, first, last):
    """Work per area [J/m^2] done on the surfaces along a way, and the means at its end."""
    node, weight = np.polynomial.legendre.leggauss(BATCH)
    # Bonds begin to change where their memory is used up; the first force may be a jump.
    begin = min(first + REACH, last) if last > first else max(first - REACH, last)
    ends = np.concatenate([np.linspace(first, begin, 5), np.linspace(begin, last, 31)[1:]])
    span = np.diff(ends)[:, None]
    place = ends[:-1, None] + 0.5 * span * (1.0 + node)
    deeper = last < float(memory[0])
    here = interface if deeper else left_by(interface, memory)
    call = {"call": approached} if deeper else {}
    pressure = measured(here, place.ravel(), memory, **call).parts.sum(axis=0).reshape(place.shape)
    end = measured(here, [last], memory, **call)
    work = -float(np.sum(0.5 * span * pressure * weight))
    return work, end, interface.remember(memory, jnp.asarray(last))


@every_yield
@every_law
def test_work_over_a_cycle_is_what_was_kept_and_what_bonds_lost(beside, overlap):
    """First law from apart to apart: in, part of the way out, in deeper, and out."""
    interface = asperities(beside, overlap)
    formed, broken = (np.asarray(x) for x in interface.losses())
    far = 9.5 * SIGMA
    memory, done, lost, before = interface.initial_memory(), 0.0, 0.0, 0.0
    scale = 0.0
    for first, last in pairwise([far, 1.0 * SIGMA, 1.7 * SIGMA, 0.2 * SIGMA, far]):
        # Going in again, the surfaces come to where they were closest first.
        stops = [last]
        if float(memory[0]) < np.inf and last < float(memory[0]):
            stops = [float(memory[0]), last]
        for stop in stops:
            work, end, memory = work_between(interface, memory, first, stop)
            change, before = end.bonds[:, 0] - before, end.bonds[:, 0]
            done, first = done + work, stop
            lost += float(formed @ np.maximum(change, 0.0) + broken @ np.maximum(-change, 0.0))
            scale = max(scale, abs(done))
            assert done == pytest.approx(float(end.energy[0]) + lost, abs=1e-6 * scale)
    kept = float(before[0])
    assert float(end.energy[0]) == pytest.approx(0.0, abs=1e-9 * scale)
    assert done == pytest.approx(lost, abs=1e-6 * max(lost, 1e-4 * scale), rel=1e-6)
    assert kept >= 0.0
    assert (kept > 1e-3 * scale) == (overlap < 1.0)


# -- numbers ---------------------------------------------------------------------------------


@eqx.filter_jit
def slope_along(interface, direction, separation, memory):
    """Change of the mean pressure as the interface changes."""
    push = lambda i: jnp.sum(i.measure(separation, memory).parts, axis=0)  # noqa: E731
    return jax.jvp(push, (interface,), (direction,))[1]


@pytest.mark.parametrize("quantity", ["hardness", "rms height"])
@pytest.mark.parametrize("overlap", YIELD[:2])
def test_slope_of_the_pressure_is_that_of_differences(quantity, overlap):
    place = (lambda i: i.contact.hardness) if quantity == "hardness" else (
        lambda i: i.heights.rms_height)  # fmt: skip
    interface = asperities("dmt + meniscus", overlap)
    h = np.linspace(-0.5, 2.5, BATCH) * SIGMA
    turns = np.where(np.arange(BATCH) % 2, h - 0.25 * SIGMA, np.inf)
    memory = (turns, turns)
    zero = jax.tree.map(jnp.zeros_like, interface)
    direction = eqx.tree_at(place, zero, place(interface))
    slope = slope_along(interface, direction, jnp.asarray(h), tuple(map(jnp.asarray, memory)))

    def pressure(factor):
        changed = eqx.tree_at(place, interface, place(interface) * factor)
        return measured(changed, h, memory).parts.sum(axis=0)

    step = 2e-4
    near, far = ((pressure(1.0 + s) - pressure(1.0 - s)) / (2.0 * s) for s in (step, 2.0 * step))
    assert worst(slope, (4.0 * near - far) / 3.0, 1e-3) < 1e-6

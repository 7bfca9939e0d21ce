"""Asperities that were pressed flat, tabulated once, beside integrals at every separation."""

import dataclasses

import equinox as eqx
import numpy as np
import pytest

import asperity.interface.residual_profile as tabulated
import asperity.interface.virgin_loading as module
from asperity._jax import jax, jnp
from asperity.contact import ElasticContact, RigidContact
from asperity.contact.profile import Sphere
from asperity.errors import InputError
from asperity.interface.interface import Interface
from asperity.interface.layers import Layers
from asperity.interface.plastic_interface import PlasticInterface
from asperity.interface.virgin_loading import first_loading
from asperity.laws import Dmt, KelvinFilling
from asperity.laws.plastic import JacksonGreen, ThorntonNing
from asperity.surfaces.heights import Gaussian
from chosen import long_but
from plastic_asperities import (
    BATCH,
    BESIDE,
    BETA,
    DMT,
    NU,
    REACH,
    SIGMA,
    E,
    N,
    asperities,
    every_yield,
    integrated_means,
    worst,
)

CLOSEST = [3.0, 0.0, -30.0]  # rms
OTHERS = {
    "jackson-green": JacksonGreen(BETA, E, 0.01 * E, NU),
    "thornton-ning": ThorntonNing(BETA, E, 0.02 * E),
}


@eqx.filter_jit
def both(interface, separation, memory):
    """Means by integration and by the table of what the closest approach left."""
    tabulated = interface.as_flattened(interface.flattened(memory, 1))
    rows = tuple(jnp.broadcast_to(b, separation.shape) for b in memory)
    plain = isinstance(interface, PlasticInterface)
    exact = integrated_means if plain else type(interface).measure
    return exact(interface, separation, rows, 1), tabulated.measure(separation, rows, 1)


def differences(interface, closest):
    """Largest error of each mean over separations and bonds, relative to its size."""
    above = np.append(np.geomspace(1e-3, 6.0, BATCH - 2), [10.0, 25.0]) * SIGMA
    separation = jnp.asarray(closest * SIGMA + above)
    errors = {}
    for threshold in (-np.inf, closest * SIGMA + 0.3 * REACH, np.inf):
        bonds = [jnp.asarray(threshold)] * len(interface.hysteretic)
        exact, found = both(interface, separation, (jnp.asarray(closest * SIGMA), *bonds))
        for name in exact._fields:
            row = worst(getattr(found, name), getattr(exact, name), 1e-4)
            errors[name] = max(errors.get(name, 0.0), row)
    return errors


@every_yield
@pytest.mark.parametrize("closest", CLOSEST)
def test_a_table_of_what_was_flattened_is_the_integral_over_all_asperities(closest, overlap):
    errors = differences(asperities("dmt + meniscus", overlap), closest)
    assert max(errors.values()) < 2e-7, errors


@pytest.mark.parametrize("law", long_but(OTHERS, "thornton-ning"))
def test_it_is_so_for_other_laws(law):
    interface = PlasticInterface(OTHERS[law], BESIDE["dmt + meniscus"], Gaussian(SIGMA), N)
    errors = differences(interface, 0.0)
    assert max(errors.values()) < 2e-7, errors


@eqx.filter_jit
def first_approach(interface, separation, integrated):
    return interface.first_approach(separation, integrated)


def test_more_points_change_nothing(monkeypatch):
    """What is tabulated, and the first approach, are as close as their tolerance says."""
    coarse = asperities("dmt + meniscus", 0.03)
    place = jnp.asarray(0.2 * SIGMA)
    memory = coarse.remember(coarse.initial_memory(), place)

    separation = place + jnp.geomspace(0.01, 2.0, 8) * SIGMA
    rows = tuple(jnp.full(8, b) for b in memory)

    def at_places():
        @jax.jit
        def found():
            table = coarse.as_flattened(coarse.flattened(memory, 1))
            contact, heights = coarse.contact, coarse.heights
            first = first_loading(contact, heights, (0.0, 1.0), place, 1, module.NODES)
            return table.measure(separation, rows, 1), first

        return found()

    means, first = at_places()
    monkeypatch.setattr(tabulated, "_EVEN", 14)
    monkeypatch.setattr(tabulated, "_STEPS", 8)
    monkeypatch.setattr(module, "NODES", 40)
    finer, first_finer = at_places()
    for name in means._fields:
        assert worst(getattr(means, name), getattr(finer, name), 1e-4) < 3e-8, name
    for name in first._fields:
        assert worst(getattr(first, name), getattr(first_finer, name), 1e-4) < 1e-9, name


@every_yield
@pytest.mark.parametrize("integrated", [0, 1])
def test_the_first_approach_is_that_of_surfaces_that_remember_nothing(integrated, overlap):
    interface = asperities("dmt + meniscus", overlap)
    separation = jnp.linspace(-3.0, 4.0, BATCH) * SIGMA
    rows = tuple(jnp.full(BATCH, b) for b in interface.initial_memory())
    exact = eqx.filter_jit(integrated_means)(interface, separation, rows, integrated)
    found = first_approach(interface, separation, integrated)
    for name in exact._fields:
        assert worst(getattr(found, name), getattr(exact, name), 1e-3) < 1e-7, name


@eqx.filter_jit
def work_of_approach(interface, separation):
    """The bound of the work, and the work itself."""
    means = interface.first_approach(separation, 1)
    return interface.work_of_approach(separation, 1), means.energy + means.bonds[0]


@every_yield
def test_the_work_of_approach_is_a_bound(overlap):
    """By few points, and never more than the work itself."""
    separation = jnp.linspace(-20.0, 4.0, BATCH) * SIGMA
    bound, work = work_of_approach(asperities("dmt", overlap), separation)
    assert np.all(np.asarray(bound) < np.asarray(work))
    np.testing.assert_allclose(bound, work, rtol=0.03)


class Unknown(Dmt):
    """A law of which no powers are known."""

    def powers(self, bond_gap):
        return None


def test_a_law_without_powers_is_refused():
    with pytest.raises(InputError, match="must be truncated powers of exponents 0 to 2; Unknown"):
        dataclasses.replace(asperities("dmt", 0.1), law=Unknown(DMT.radius, DMT.work_of_adhesion))


def test_liquid_on_the_surface_lies_beside_what_was_flattened():
    yielding = asperities("dmt", 0.1)
    filling = Interface(KelvinFilling(0.0728, 0.5, 0.5e-9), Gaussian(2.0 * SIGMA), 1.0)
    layers = Layers((yielding, filling))
    memory = layers.remember(layers.initial_memory(), jnp.asarray(0.5 * SIGMA))
    place = jnp.asarray([0.7, 1.5]) * SIGMA
    exact, found = both(layers, place, memory)
    for name in exact._fields:
        assert worst(getattr(found, name), getattr(exact, name), 1e-3) < 1e-7, name
    rows = tuple(jnp.full(2, b) for b in layers.initial_memory())
    fresh = eqx.filter_jit(layers.measure)(place, rows, 1)
    first = first_approach(layers, place, 1)
    for name in exact._fields:
        assert worst(getattr(first, name), getattr(fresh, name), 1e-3) < 1e-7, name


@pytest.mark.parametrize("kind", [RigidContact, ElasticContact])
def test_a_contact_that_does_not_yield_refuses_asperities_that_do(kind):
    more = {"modulus": 1e10} if kind is ElasticContact else {}
    with pytest.raises(InputError, match=f"need a RigidPlasticContact; got {kind.__name__}"):
        kind(asperities("dmt", 0.1), Sphere(20e-6), **more)

"""Planes that read the branch of approach from a table are the planes themselves."""

from pathlib import Path

import numpy as np
import pytest

import asperity
from asperity._jax import jax, jnp
from asperity.config.resolve import resolve
from asperity.contact import ElasticContact
from asperity.contact.continuation import table_ends, with_table
from asperity.contact.profile import Sphere
from asperity.interface.interface import Interface
from asperity.interface.layers import Layers
from asperity.laws import Bradley, ConstantVolume, Dmt, Hertz, Jkr, Maugis, Meniscus
from asperity.model import build
from asperity.surfaces.heights import Gaussian

SOURCE = Path(__file__).parents[2]

RMS, R, E, W, EPS = 2e-9, 5e-7, 3e9, 0.05, 3e-10
HEIGHTS, DENSITY = Gaussian(RMS), 1e12
WATER = Meniscus(R, 0.0728, 0.5, 1e-9)


def planes(law):
    return Interface(law, HEIGHTS, DENSITY)


PLANES = {
    "Maugis": planes(Maugis(R, E, W, EPS)),
    "JKR beside menisci": planes(Jkr(R, E, W) + WATER),
    "bridges": planes(Hertz(R, E) + Dmt(R, W) + ConstantVolume(R, 0.0728, 0.5, 1e-9)),
    "Bradley": planes(Hertz(R, E) + Bradley(R, W, EPS)),
    "layers": Layers([planes(Maugis(R, E, W, EPS)), planes(WATER)]),
}


def compared(interface, pieces):
    """Largest error of each mean over its largest value, at separations with any memory."""
    contact = ElasticContact(interface, Sphere(1e-5), 1e11)
    low, high = jnp.asarray(-4.0 * RMS), contact.interaction_range
    rng = np.random.default_rng(5)
    place = jnp.asarray(rng.uniform(-4.0 * RMS, 15.0 * RMS, 400))

    @jax.jit
    def both(interface, place, thresholds):
        tables = interface.approach_tables(table_ends(contact, low, high))
        reading = interface.reading(tables, pieces)
        return tuple(
            (one.measure(place, thresholds), one.pressure(place, thresholds))
            for one in (reading, interface)
        )

    before = jnp.asarray(rng.uniform(-4.0 * RMS, 15.0 * RMS, 400))
    thresholds = tuple(
        jnp.clip(before, place - law.breaking_gap, place - law.forming_gap)
        for law in interface.hysteretic
    )
    found, known = map(jax.tree_util.tree_leaves, both(interface, place, thresholds))
    return [
        float(np.max(np.abs(a - b)) / np.max(np.abs(b)))
        for a, b in zip(found, known, strict=True)
        if np.size(b)
    ]


@pytest.mark.parametrize("name", PLANES)
def test_means_with_any_memory_are_those_of_quadratures(name):
    pieces = ElasticContact(PLANES[name], Sphere(1e-5), 1e11).pieces_beside
    assert max(compared(PLANES[name], pieces)) < 1e-11


def test_a_contact_takes_pieces_enough_also_for_steep_bridges():
    """The attraction of a bridge of 0.3 nm falls off over a thirtieth of its stretch."""
    steep = planes(ConstantVolume(R, 0.0728, 0.5, 3e-10))
    contact = ElasticContact(steep, Sphere(1e-5), 1e11)
    assert max(compared(steep, contact.pieces_beside)) < 5e-8


def test_more_pieces_for_the_bonds_leave_less_of_an_error():
    wide = planes(ConstantVolume(R, 0.0728, 0.5, 1e-8))
    coarse, fine = (max(compared(wide, pieces)) for pieces in (1, 4))
    assert coarse > 1e-9
    assert fine < 1e-2 * coarse


def test_means_over_measured_heights_are_read_as_closely_as_stated():
    """Their density is a spline, followed less well: off by 7e-6 with an eighth of the panels."""
    case = asperity.load(SOURCE / "examples" / "measured-surface.toml")
    case = case.replace({"counterface.deformation": "half-space"})
    contact = build(resolve(case)).contact
    assert isinstance(contact, ElasticContact)
    low, high = -3.0 * contact.interface.scale.rms, contact.interaction_range
    places = jnp.linspace(low, high, 1500)

    @jax.jit
    def both(contact):
        held = contact.branches()[0].thresholds
        table = with_table(contact, low, high, held).interface
        each = tuple(jnp.full(places.shape, b[-1]) for b in held)
        return [one.measure(places, each).parts for one in (table, contact.interface)], table.error

    (found, known), error = both(contact)
    size = np.max(np.abs(known), axis=1, keepdims=True)
    assert float(np.max(np.abs(found - known) / size)) < 1e-7
    assert float(error) < 1e-7


def test_planes_without_a_quadrature_have_no_table():
    contact = ElasticContact(planes(Hertz(R, E) + WATER), Sphere(1e-5), 1e11)
    assert contact.means(jnp.asarray(-4.0 * RMS), contact.interaction_range) == ()
    assert contact.reading(()) is contact


def test_beyond_a_table_energies_fall_as_one_power_less_than_pressures():
    """Rings of a body that attraction draws from afar lie ten times as far as it.

    They fall with the separation plus a length: with the separation alone they were 9e-5 off.
    """
    interface, outermost = PLANES["Bradley"], 200.0 * RMS
    contact = ElasticContact(interface, Sphere(1e-5), 1e11)
    end = jnp.asarray(outermost)
    memory = interface.branch_memory((), jnp.asarray(False))
    table = with_table(contact, jnp.asarray(0.0), end, memory).interface
    far = jnp.asarray([10.0, 30.0, 100.0]) * outermost
    read, known = table.measure(far, memory), interface.measure(far, memory)
    np.testing.assert_allclose(read.energy, known.energy, rtol=1e-6)
    np.testing.assert_allclose(read.parts, known.parts, rtol=1e-6)

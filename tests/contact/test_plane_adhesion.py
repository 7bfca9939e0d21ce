"""Rough planes have a work and a range of their own, and adhere beyond a Tabor number as one."""

import numpy as np
import pytest
from scipy.integrate import quad

from asperity._jax import jnp
from asperity.contact import ElasticContact
from asperity.contact.plane_adhesion import LIMIT, tabor_number_of_planes
from asperity.contact.profile import Sphere
from asperity.errors import InputError
from asperity.interface.interface import Interface
from asperity.laws import Dmt, Hertz
from asperity.surfaces.heights import Gaussian

RMS, TIP, STIFF, W, DENSITY, RADIUS = 5e-9, 5e-8, 33e6, 0.05, 2e14, 1e-5
E = 3e6


def on_bulk(modulus):
    planes = Interface(Hertz(TIP, STIFF) + Dmt(TIP, W), Gaussian(RMS), DENSITY)
    return ElasticContact(planes, Sphere(RADIUS), modulus)


def tension(h):
    """Of Hertz's contacts and DMT's pull over Gaussian heights [Pa]."""

    def mean(value):
        def share(z):
            return value(z - h) * np.exp(-0.5 * (z / RMS) ** 2) / (RMS * np.sqrt(2.0 * np.pi))

        return quad(share, h, max(h, 0.0) + 9.0 * RMS, limit=200, epsabs=0.0, epsrel=1e-8)[0]

    push = 4.0 / 3.0 * STIFF * TIP**0.5 * mean(lambda x: x**1.5)
    return DENSITY * (2.0 * np.pi * TIP * W * mean(lambda x: 1.0) - push)


def test_the_tabor_number_is_that_of_their_work_and_pull():
    places = np.linspace(-4.0 * RMS, 9.0 * RMS, 800)
    pulls = np.maximum([tension(h) for h in places], 0.0)
    work = np.trapezoid(pulls, places)
    expected = (RADIUS * np.max(pulls) ** 3 / (E**2 * work)) ** (1.0 / 3.0)
    assert expected > LIMIT
    with pytest.raises(InputError, match="draws the rough surfaces together as one") as raised:
        tabor_number_of_planes(on_bulk(E))
    words = str(raised.value).split()
    assert float(words[words.index("mJ/m^2") - 1]) == pytest.approx(work * 1e3, rel=2e-3)
    number = float(words[words.index("(the") - 1])
    assert number == pytest.approx(expected, rel=5e-3)
    # The number falls with the modulus of the bulk to the power 2/3; planes stay as they are.
    limit = E * (number / LIMIT) ** 1.5
    found = tabor_number_of_planes(on_bulk(1.1 * limit))
    assert found == pytest.approx(LIMIT * 1.1 ** (-2.0 / 3.0), rel=5e-3)
    with pytest.raises(InputError):
        tabor_number_of_planes(on_bulk(0.9 * limit))


def test_planes_that_do_not_attract_are_let_through():
    planes = Interface(Hertz(TIP, STIFF), Gaussian(RMS), DENSITY)
    assert tabor_number_of_planes(ElasticContact(planes, Sphere(RADIUS), jnp.asarray(1e3))) == 0.0

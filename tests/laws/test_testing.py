"""The proof of a law: it passes the package's own and says what is wrong with others."""

import runpy
from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest

from asperity.errors import InputError
from asperity.laws import Bradley, ByKelvinGap, Dmt, Hertz, Jkr, Law, Meniscus, TruncatedPower
from asperity.laws.law import Real, quantity
from asperity.laws.testing import check_law

HERTZ = Hertz(25e-9, 5.7e10)


@pytest.mark.parametrize(
    "law",
    [
        HERTZ,
        Bradley(25e-9, 0.03, 0.2e-9),
        Dmt(25e-9, 0.03),
        Jkr(1e-6, 3e9, 0.1),
        Meniscus(25e-9, 0.073, 0.5, 5e-9),
        Meniscus(25e-9, 0.073, 0.5, 5e-9, ByKelvinGap()),
        HERTZ + Dmt(25e-9, 0.03) + Meniscus(25e-9, 0.073, 0.5, 5e-9),
    ],
    ids=["hertz", "bradley", "dmt", "jkr", "meniscus", "meniscus-kelvin", "sum"],
)
def test_laws_of_the_package_keep_the_rules(law):
    check_law(law)


OWN_LAW = Path(__file__).parents[2] / "examples" / "own_law.py"
Tether = runpy.run_path(str(OWN_LAW))["Tether"]
"""The page's own law, into which each test puts a fault."""

TETHER_DIMENSIONS = {"stiffness": (-1, 1), "extent": (1, 0)}


def test_a_law_of_ones_own_passes():
    check_law(Tether(2.0, 5e-9), dimensions=TETHER_DIMENSIONS)


class CutOff(Law):
    """An attraction that stops at its range."""

    stiffness: Real = quantity()
    extent: Real = quantity()

    kinks = property(lambda self: (self.extent,))

    def force(self, gap):
        return jnp.where(gap < self.extent, -self.stiffness * self.extent, 0.0)

    def energy(self, gap):
        return -self.stiffness * self.extent * jnp.maximum(self.extent - gap, 0.0)


def test_a_cut_off_is_a_law_once_the_powers_of_its_values_are_known():
    check_law(CutOff(2.0, 5e-9), dimensions=TETHER_DIMENSIONS)
    message = "`dimensions` must give the powers .* of `stiffness` of CutOff"
    with pytest.raises(InputError, match=message):
        check_law(CutOff(2.0, 5e-9), dimensions={})


FAULTY = {}
"""Laws with a fault, and what is said of it."""


def said(message):
    def keep(law):
        FAULTY[law] = message
        return law

    return keep


@said(r"bonded branch: the force must be -d\(energy\)/d\(gap\) .* at the gap")
class WrongSign(Tether):
    def bonded_force(self, gap):
        return self.stiffness * jnp.maximum(gap, 0.0)


@said(r"bonded branch: the force must be -d\(energy\)/d\(gap\)")
class WrongEnergy(Tether):
    def bonded_energy(self, gap):
        return self.stiffness * jnp.maximum(gap, 0.0) ** 2


@said("a bond must break .* forms at 1e-08 m and breaks at 5e-09 m")
class BreakingBeforeForming(Tether):
    forming_gap = property(lambda self: 2.0 * self.extent)


@said("energy must not be gained where a bond breaks; at the gap 5e-09 m")
class Gaining(Tether):
    def bonded_energy(self, gap):
        return super().bonded_energy(gap) - self.stiffness * self.extent**2


@said("free branch: the energy must fall by the force's work; between the gaps")
class Jumping(CutOff):
    def energy(self, gap):
        return jnp.where(gap < self.extent, self.stiffness * self.extent * gap, 0.0)


@said("free branch: the energy must tend to 0 far away")
class FarEnergy(CutOff):
    def energy(self, gap):
        return super().energy(gap) + self.stiffness * self.extent**2


@said("free branch: beyond `interaction_range` = 2.5e-09 m the force must be below")
class ShortReach(CutOff):
    interaction_range = property(lambda self: 0.5 * self.extent)


@said("free branch: the force does not work under jit, vmap and grad")
class Untraceable(CutOff):
    def force(self, gap):
        return np.where(np.asarray(gap) < 5e-9, -1e-8, 0.0)


@said("free branch: the force must be float64; got float32")
class SinglePrecision(CutOff):
    def force(self, gap):
        return super().force(gap).astype(jnp.float32)


@said("free branch: the force must be finite; at the gap")
class UnguardedRoot(CutOff):
    def force(self, gap):
        return super().force(gap) + 0.0 * jnp.sqrt(gap)


@said("free branch: with lengths times 7 and forces times 3 the force")
class BareLength(CutOff):
    def force(self, gap):
        return jnp.where(gap < self.extent, -self.stiffness * 5e-9, 0.0)

    def energy(self, gap):
        return -self.stiffness * 5e-9 * jnp.maximum(self.extent - gap, 0.0)


@said(r"`powers\(-inf\)` must be the energy: at the gap")
class WrongPowers(CutOff):
    def powers(self, bond_gap):
        pull = -self.stiffness * self.extent
        energy = TruncatedPower(2.0 * pull, 1.0, self.extent)
        return (TruncatedPower(pull, 0.0, self.extent),), (energy,)


@said(r"`response` must name .energy. and the forces of .*, 'magnet'\]")
class Uncounted(CutOff):
    counts = frozenset({"magnet"})


@pytest.mark.parametrize("law", FAULTY)
def test_a_fault_is_found_and_named(law):
    with pytest.raises(AssertionError, match=f"{law.__name__}[:,] {FAULTY[law]}"):
        check_law(law(2.0, 5e-9), dimensions=TETHER_DIMENSIONS)

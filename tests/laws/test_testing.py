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


def refuse(kind, message, dimensions=TETHER_DIMENSIONS, error=AssertionError):
    with pytest.raises(error, match=message):
        check_law(kind(2.0, 5e-9), dimensions=dimensions)


def test_a_law_of_ones_own_passes():
    check_law(Tether(2.0, 5e-9), dimensions=TETHER_DIMENSIONS)


def test_force_of_the_wrong_sign_is_found():
    class Wrong(Tether):
        def bonded_force(self, gap):
            return self.stiffness * jnp.maximum(gap, 0.0)

    refuse(Wrong, r"Wrong, bonded branch: the force must be -d\(energy\)/d\(gap\) .* at the gap")


def test_energy_that_does_not_match_is_found():
    class Wrong(Tether):
        def bonded_energy(self, gap):
            return self.stiffness * jnp.maximum(gap, 0.0) ** 2

    refuse(Wrong, r"Wrong, bonded branch: the force must be -d\(energy\)/d\(gap\)")


def test_breaking_before_forming_is_found():
    class Wrong(Tether):
        forming_gap = property(lambda self: 2.0 * self.extent)

    refuse(Wrong, r"Wrong: a bond must break .* forms at 1e-08 m and breaks at 5e-09 m")


def test_a_bond_that_gains_energy_is_found():
    class Wrong(Tether):
        def bonded_energy(self, gap):
            return super().bonded_energy(gap) - self.stiffness * self.extent**2

    refuse(Wrong, r"Wrong: energy must not be gained where a bond breaks; at the gap 5e-09 m")


class CutOff(Law):
    """An attraction that stops at its range."""

    stiffness: Real = quantity()
    extent: Real = quantity()

    kinks = property(lambda self: (self.extent,))

    def force(self, gap):
        return jnp.where(gap < self.extent, -self.stiffness * self.extent, 0.0)

    def energy(self, gap):
        return -self.stiffness * self.extent * jnp.maximum(self.extent - gap, 0.0)


def test_a_cut_off_is_a_law():
    check_law(CutOff(2.0, 5e-9), dimensions=TETHER_DIMENSIONS)


def test_an_energy_that_jumps_at_a_cut_off_is_found():
    class Wrong(CutOff):
        def energy(self, gap):
            inside = self.stiffness * self.extent * gap
            return jnp.where(gap < self.extent, inside, 0.0)

    refuse(Wrong, "Wrong, free branch: the energy must fall by the force's work; between the gaps")


def test_energy_that_does_not_vanish_far_away_is_found():
    class Wrong(CutOff):
        def energy(self, gap):
            return super().energy(gap) + self.stiffness * self.extent**2

    refuse(Wrong, "Wrong, free branch: the energy must tend to 0 far away")


def test_a_reach_too_short_is_found():
    class Wrong(CutOff):
        interaction_range = property(lambda self: 0.5 * self.extent)

    refuse(
        Wrong, "Wrong, free branch: beyond `interaction_range` = 2.5e-09 m the force must be below"
    )


def test_a_law_that_cannot_be_traced_is_found():
    class Wrong(CutOff):
        def force(self, gap):
            return np.where(np.asarray(gap) < 5e-9, -1e-8, 0.0)

    refuse(Wrong, "Wrong, free branch: the force does not work under jit, vmap and grad")


def test_single_precision_is_found():
    class Wrong(CutOff):
        def force(self, gap):
            return super().force(gap).astype(jnp.float32)

    refuse(Wrong, "Wrong, free branch: the force must be float64; got float32")


def test_a_root_without_guard_is_found():
    class Wrong(CutOff):
        def force(self, gap):
            return super().force(gap) + 0.0 * jnp.sqrt(gap)

    refuse(Wrong, "Wrong, free branch: the force must be finite; at the gap")


def test_a_length_without_dimension_is_found():
    class Wrong(CutOff):
        def force(self, gap):
            return jnp.where(gap < self.extent, -self.stiffness * 5e-9, 0.0)

        def energy(self, gap):
            return -self.stiffness * 5e-9 * jnp.maximum(self.extent - gap, 0.0)

    refuse(Wrong, "Wrong, free branch: with lengths times 7 and forces times 3 the force")


def test_unknown_dimensions_are_asked_for():
    refuse(CutOff, "`dimensions` must give the powers .* of `stiffness` of CutOff", {}, InputError)


def test_wrong_powers_are_found():
    class Wrong(CutOff):
        def powers(self, bond_gap):
            pull = -self.stiffness * self.extent
            return (TruncatedPower(pull, 0.0, self.extent),), (
                TruncatedPower(2.0 * pull, 1.0, self.extent),
            )

    refuse(Wrong, r"Wrong: `powers\(-inf\)` must be the energy: at the gap")


def test_a_force_that_would_be_lost_in_the_sum_is_found():
    class Wrong(CutOff):
        counts = frozenset({"magnet"})

    refuse(Wrong, r"Wrong: `response` must name .energy. and the forces of .*, 'magnet'\]")

"""When folds are looked for, and what a run says that has looked for them in vain."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from asperity._jax import jax
from asperity.contact import ElasticContact, RigidContact
from asperity.contact.plane_adhesion import FOLDS, tabor_number_of_planes
from asperity.contact.profile import Sphere
from asperity.errors import InputError, SimulationError
from asperity.integration import jumping
from asperity.integration.panel_cuts import PATIENCE, Unsolved
from asperity.interface.interface import Interface
from asperity.laws import Dmt, Hertz
from asperity.surfaces.heights import Gaussian

RMS, TIP, STIFF, W, DENSITY, RADIUS = 5e-9, 5e-8, 33e6, 0.05, 2e14, 1e-5
PLANES = Interface(Hertz(TIP, STIFF) + Dmt(TIP, W), Gaussian(RMS), DENSITY)


def problem(modulus):
    contact = ElasticContact(PLANES, Sphere(RADIUS), modulus)
    return SimpleNamespace(contact=contact, in_time=False)


SOFT, STIFF_ONE = problem(33e6), problem(500e6)


class Runs:
    """A run that has no equilibrium on problems of this list; it keeps what it was asked."""

    def __init__(self, unsolved):
        self.unsolved, self.asked = unsolved, []

    def __call__(self, one, patience):
        self.asked.append((one, patience))
        if one in self.unsolved:
            raise Unsolved("no equilibrium")
        return "answer"


def test_the_planes_tell_where_folds_are_likely():
    assert tabor_number_of_planes(SOFT.contact) > FOLDS
    assert tabor_number_of_planes(STIFF_ONE.contact) < FOLDS


def test_of_a_batch_those_are_likely_to_jump_that_are_alone():
    moduli = np.geomspace(20e6, 500e6, 10)
    batch = jax.tree_util.tree_map(
        lambda leaf: np.repeat(np.asarray(leaf)[None], moduli.size, axis=0), SOFT.contact
    )
    likely = jumping.likely_to_jump(dataclasses.replace(batch, modulus=moduli), moduli.size)
    alone = []
    for modulus in moduli:
        try:
            alone.append(tabor_number_of_planes(problem(modulus).contact) > FOLDS)
        except InputError:
            alone.append(True)
    np.testing.assert_array_equal(likely, alone)
    assert 0 < likely.sum() < moduli.size
    rigid = RigidContact(PLANES, Sphere(RADIUS))
    assert not np.any(jumping.likely_to_jump(rigid, 3))


def test_folds_are_looked_for_first_where_they_are_likely(monkeypatch):
    monkeypatch.setattr(jumping, "jumping", lambda _: "folded")
    runs = Runs([])
    assert jumping.over_folds(SOFT, runs) == "answer"
    assert runs.asked == [("folded", PATIENCE)]


def test_elsewhere_they_are_looked_for_where_no_equilibrium_follows(monkeypatch):
    monkeypatch.setattr(jumping, "jumping", lambda _: "folded")
    runs = Runs([])
    assert jumping.over_folds(STIFF_ONE, runs) == "answer"
    assert runs.asked == [(STIFF_ONE, 0)]
    runs = Runs([STIFF_ONE])
    assert jumping.over_folds(STIFF_ONE, runs) == "answer"
    assert runs.asked == [(STIFF_ONE, 0), ("folded", PATIENCE)]


def test_a_search_in_vain_leaves_the_curves_their_turn_and_else_gives_its_reason(monkeypatch):
    def sharp(_):
        raise SimulationError("the edge is too sharp")

    monkeypatch.setattr(jumping, "jumping", sharp)
    runs = Runs([])
    assert jumping.over_folds(SOFT, runs) == "answer"
    assert runs.asked == [(SOFT, PATIENCE)]
    with pytest.raises(SimulationError, match="too sharp"):
        jumping.over_folds(SOFT, Runs([SOFT]))


@pytest.mark.parametrize(
    ("relaxation", "key", "why"),
    [
        ("creeps", "viscoelasticity.relaxed_modulus_ratio", "the bulk once it has relaxed"),
        (None, "capillary.formation_time", "menisci take time to form"),
    ],
)
def test_a_body_that_is_stepped_in_time_is_refused_where_it_would_jump(relaxation, key, why):
    soft = SimpleNamespace(contact=SOFT.contact, in_time=True, relaxation=relaxation)
    runs = Runs([])
    assert jumping.over_folds(soft, runs) == "answer"
    assert runs.asked == [(soft, PATIENCE)]
    with pytest.raises(InputError, match=why) as raised:
        jumping.over_folds(soft, Runs([soft]))
    assert raised.value.key == key
    stiff = SimpleNamespace(contact=STIFF_ONE.contact, in_time=True, relaxation=relaxation)
    with pytest.raises(Unsolved):  # no fold is likely: the numerics have failed
        jumping.over_folds(stiff, Runs([stiff]))


def test_a_run_without_folds_says_what_it_lacks(monkeypatch):
    monkeypatch.setattr(jumping, "jumping", lambda one: one)
    with pytest.raises(Unsolved, match="no equilibrium"):
        jumping.over_folds(SOFT, Runs([SOFT]))

"""What is run again, where the first run does not answer a case or its balance does not close."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from tools.valid_cases import drawn, text_of

from asperity import solve
from asperity.config import builtin, load
from asperity.config.resolve import resolve
from asperity.dynamics import Impacts
from asperity.errors import Outcome, SimulationError
from asperity.integration import refinements
from asperity.integration.refinements import refined, with_deeper_curves, with_more_rings
from asperity.model import build

SOFT = build(resolve(builtin("published-exact").replace({"counterface.deformation": "half-space"})))


def on_rings(count):
    return SOFT._replace(contact=dataclasses.replace(SOFT.contact, rings=count))


def moved(missing):
    """A motion of one impact, whose balance misses a share of its energy."""
    rows = Impacts(**dict.fromkeys(Impacts._fields))._replace(
        made=np.array([True]),
        energy_balance_error=np.array([missing]),
        lost=np.zeros((1, 1)),
        maximum_kinetic=np.array([1.0]),
    )
    return SimpleNamespace(impacts=rows)


class Runs:
    """Solutions whose balances miss less on more rings; every problem that was run."""

    def __init__(self, missing):
        self.missing, self.rings = missing, []

    def __call__(self, problem, run, report):
        self.rings.append(problem.contact.rings)
        missing = self.missing[problem.contact.rings]
        if missing is None:
            raise SimulationError("stopped before the first impact")
        return SimpleNamespace(motion=moved(missing), contact=problem.contact, outcome=Outcome.REST)


@pytest.mark.parametrize(
    ("missing", "rings", "answer"),
    [
        ({80: 4e-5, 160: 2e-11}, [80, 160], 160),
        ({80: 4e-5, 160: 5e-5}, [80, 160], 80),  # no better: the warning names the rings in use
        ({80: 4e-5, 160: None}, [80, 160], 80),
        ({80: 4e-7}, [80], 80),
        ({80: np.nan}, [80], 80),
        ({32: 4e-5}, [32], 32),  # asked for, to be quick
        ({208: 4e-5}, [208], 208),  # twice as many are more than a case may ask for
    ],
)
def test_a_half_space_whose_balance_does_not_close_is_run_again_on_twice_the_rings(
    monkeypatch, missing, rings, answer
):
    runs, told = Runs(missing), []
    monkeypatch.setattr(refinements, "over_folds", runs)
    found = refined(on_rings(rings[0]), None, lambda *line: told.append(line))
    assert runs.rings == rings
    assert found.contact.rings == answer
    assert told == [(0.875, "twice the rings")][: len(rings) - 1]


def test_what_has_no_rings_or_is_stepped_in_time_is_not_run_on_more():
    rigid = SOFT._replace(contact=SOFT.contact.rigid)
    assert with_more_rings(rigid, moved(4e-5)) is None
    assert with_more_rings(SOFT._replace(delayed="menisci that take time"), moved(4e-5)) is None


def left(deepest, kinetic, contact=SOFT.contact, **more):
    """A motion that ended at a separation of curves that begin at 0."""
    rows = moved(0.0).impacts._replace(
        closest_approach=np.array([deepest]), maximum_kinetic=np.array([kinetic])
    )
    motion = SimpleNamespace(impacts=rows, table=SimpleNamespace(ends=np.array([0.0, 1.0])))
    usual = {"outcome": Outcome.FAILED, "trajectory": None, "contact": contact}
    return SimpleNamespace(motion=motion, **{**usual, **more})


def test_a_body_that_leaves_its_curves_gets_deeper_ones_by_the_energy_that_it_has_there():
    body = SOFT.body
    given = body.release, body.kinetic, body.load.potential
    deeper = with_deeper_curves(left(0.0, 1e-12))
    assert float(deeper.lower_bound(*given)) < float(SOFT.contact.lower_bound(*given))
    # Where that was not enough, it is twice as much at least.
    again = with_deeper_curves(left(0.0, 1.1 * float(deeper.drawn), deeper))
    assert float(again.drawn) == 2.0 * float(deeper.drawn)
    # Not what ended within them, or further out, or by a number that is none.
    for other in (
        left(0.5, 1.0),
        left(np.nan, 1.0),
        left(0.0, 1.0, outcome=Outcome.REST),
        left(0.0, 1.0, trajectory="stepped"),
        left(0.0, 1.0, SOFT.contact.rigid),
    ):
        assert with_deeper_curves(other) is None


def test_curves_are_made_deeper_until_the_body_stays_within_them(monkeypatch):
    monkeypatch.setattr(refinements, "over_folds", lambda problem, run, report: run(problem, 1))
    monkeypatch.setattr(refinements, "balanced", lambda problem, run, report: run(problem, report))
    drawn = []

    def run(problem, report, patience):
        drawn.append(problem.contact.drawn)
        stays = len(drawn) == 3
        return left(0.0, 1.0, problem.contact, outcome=Outcome.REST if stays else Outcome.FAILED)

    assert refined(SOFT, run, None).outcome is Outcome.REST
    assert drawn == [0.0, 1.0, 2.0]


@pytest.mark.long
def test_a_body_that_attraction_draws_in_deep_is_answered():
    """A million times the energy that it brings; it left its curves."""
    found = solve(load(text_of(drawn(401, 89))), critical=False)
    assert found.outcome is Outcome.ESCAPED
    assert found.events["closest_approach_separation"][0] < -6e-10


@pytest.mark.long
def test_a_soft_flooded_body_closes_on_twice_the_rings():
    """4e-5 on the 80 rings that it asks for."""
    found = solve(load(text_of(drawn(123, 3))), critical=False)
    assert found.ledger["energy_balance_error"] < 1e-7
    assert not any("ledger" in line for line in found.warnings)

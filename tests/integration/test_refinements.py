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
from asperity.integration.refinements import refined, with_more_rings
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


@pytest.mark.long
def test_a_soft_flooded_body_closes_on_twice_the_rings():
    """4e-5 on the 80 rings that it asks for."""
    found = solve(load(text_of(drawn(123, 3))), critical=False)
    assert found.ledger["energy_balance_error"] < 1e-7
    assert not any("ledger" in line for line in found.warnings)

"""Over which energy a balance is told."""

import numpy as np
import pytest
from tools.valid_cases import drawn, text_of

from asperity import solve
from asperity.config import load
from asperity.dynamics import Impacts, Motion
from asperity.regimes.accuracy import balance_error, balance_errors, energy_at_stake


def impacts(made, missing, lost, kinetic):
    none = dict.fromkeys(Impacts._fields)
    return Impacts(**none)._replace(
        made=np.array(made),
        energy_balance_error=np.array(missing),
        lost=np.array(lost),
        maximum_kinetic=np.array(kinetic),
    )


# Two impacts, the second not made in the first body: it loses 1000 times what it brings, the other
# a part of that. Two mechanisms lose.
MANY = impacts(
    made=[[True, False], [True, True]],
    missing=[[1e-3, 0.0], [1e-6, 4e-6]],
    lost=[[[400.0, 600.0], [0.0, 0.0]], [[0.1, 0.2], [0.2, 0.3]]],
    kinetic=[[1.0, 0.0], [2.0, 2.0]],
)


def test_a_balance_is_told_over_the_larger_of_the_impact_energy_and_that_lost():
    np.testing.assert_allclose(energy_at_stake(MANY), [[1000.0, 1.0], [2.0, 2.0]])
    np.testing.assert_allclose(balance_errors(MANY), [1e-6, 2e-6])
    # One motion is told as it is among many.
    alone = Impacts(*(None if leaf is None else leaf[0] for leaf in MANY))
    assert balance_error(Motion(alone, None, None, None, None)) == pytest.approx(1e-6)


@pytest.mark.long
def test_menisci_that_take_far_more_than_a_slow_body_brings_are_balanced_by_what_they_take():
    """They take 13,000 times the impact energy, of which the balance misses 2e-3."""
    ledger = solve(load(text_of(drawn(123, 6))), critical=False).ledger
    assert ledger["lost"]["capillary"] > 1e4 * ledger["initial"]
    assert ledger["energy_balance_error"] < 5e-7

"""Cases drawn from the stated domain are valid, and the table counts what became of them."""

import numpy as np
from tools.valid_cases import Found, drawn, structure_of, table, text_of

from asperity.config import load
from asperity.config.resolve import resolve
from asperity.errors import InputError
from asperity.regimes.dimensionless_numbers import tabor_number

BY_RULE = {"adhesion.work", "adhesion.model", "impact.speed", "capillary.model"}
"""Keys of the rules that refuse what is drawn: one contact, Tabor numbers beside those of a table
where the modulus ends, waves, and models side by side."""


def test_nine_in_ten_are_valid_and_the_others_are_refused_by_a_known_rule():
    valid, refused = [], []
    for number in range(200):
        try:
            valid.append(resolve(load(text_of(drawn(5, number)))))
        except InputError as error:
            refused.append(error.key)
    assert len(valid) > 170
    assert set(refused) <= BY_RULE
    tabor = [
        tabor_number(i.tip_radius, i.work_of_adhesion, i.modulus, i.equilibrium_spacing)
        for i in valid
        if i.equilibrium_spacing > 0.0 and i.work_of_adhesion > 0.0
    ]
    assert np.log10(min(tabor)) < -2.0
    assert np.log10(max(tabor)) > 1.5
    assert len({structure_of(drawn(5, number)) for number in range(200)}) > 60


def test_a_case_is_known_by_its_seed_and_number():
    assert drawn(3, 41) == drawn(3, 41)
    assert drawn(3, 41) != drawn(3, 42)
    assert drawn(3, 41) != drawn(4, 41)


def test_the_table_counts_ends_times_and_balances():
    found = [
        Found(0, "rough rigid jkr gas", "answered", "rest", 2.0, 1e-9),
        Found(1, "rough rigid jkr", "failed", "why", 4.0, np.nan),
        Found(2, "smooth half-space dmt", "refused", "rule", 0.1, np.nan),
    ]
    lines = [line.split() for line in table(found).splitlines()]
    assert lines[1][:8] == ["rough", "rigid", "jkr", "1", "0", "1", "0", "0"]
    assert lines[2][3:8] == ["0", "1", "0", "0", "0"]
    assert lines[3][:6] == ["all", "1", "1", "1", "0", "0"]
    assert lines[3][6:] == ["3.0", "s", "3.9", "s", "4.0", "s", "1e-09"]

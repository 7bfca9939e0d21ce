"""Shares of what is lost: they add up to 100 % as they are written."""

from __future__ import annotations

import dataclasses
import re
from decimal import Decimal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from asperity.results import summary
from asperity.results.shares import percentages, share_texts
from fake_result import bounce

PARTS = st.lists(st.floats(0.0, 1e-9), min_size=1, max_size=6).filter(lambda p: sum(p) > 1e-200)


@given(PARTS, st.integers(0, 3))
def test_shares_add_up_to_a_hundred_and_are_near_what_they_round(parts: list[float], places: int):
    shares = percentages(parts, places)
    assert sum(Decimal(str(share)) for share in shares) == 100
    for part, share in zip(parts, shares, strict=True):
        assert abs(share - 100.0 * (part / sum(parts))) < 10.0**-places * (1.0 + 1e-9)


@pytest.mark.parametrize(
    ("parts", "wanted"),
    [
        ([1.0, 1.0, 1.0], [34.0, 33.0, 33.0]),
        ([0.505, 0.495], [51.0, 49.0]),  # each rounded alone: 51 and 50 (101 %)
        ([0.334, 0.333, 0.333], [34.0, 33.0, 33.0]),  # each rounded alone: 99 %
        ([3.0, -1e-30], [100.0, 0.0]),
        ([0.0, 0.0], [0.0, 0.0]),
    ],
)
def test_what_rounding_leaves_goes_to_the_largest_remainder(
    parts: list[float], wanted: list[float]
):
    assert percentages(parts, 0) == wanted


def test_a_part_too_small_for_a_share_is_not_called_none():
    assert share_texts([1.0, 1e-9, 0.0]) == ["100 %", "< 0.1 %", "0 %"]


@pytest.mark.parametrize(
    "lost", [(0.505, 0.495, 0.0), (1.0, 1.0, 1.0), (0.7, 0.2996, 0.0004), (2.0, 4.0, 1e-7)]
)
def test_a_summary_gives_shares_of_what_is_lost_that_add_up(lost: tuple[float, ...]):
    result = bounce(impacts=3)
    names = ("adhesion", "capillary", "gas")
    energies = {n: e * result.ledger["initial"] for n, e in zip(names, lost, strict=True)}
    ledger = {**result.ledger, "lost": energies}
    said = summary.brief(dataclasses.replace(result, ledger=ledger))
    shares = re.findall(r"lost to .*\((?:< )?([\d.]+) % of the energy lost\)", said)
    tiny = re.findall(r"lost to .*\(< ([\d.]+) % of the energy lost\)", said)
    assert sum(map(Decimal, shares)) - sum(map(Decimal, tiny)) == 100
    assert max(map(len, said.splitlines())) <= summary.WIDTH


def test_a_summary_says_how_much_of_the_energy_at_release_is_lost():
    result = bounce(impacts=3)
    for share, words in ((0.25, "25 % of that at release"), (1.1, "with what attraction adds")):
        ledger = {**result.ledger, "lost": {"gas": share * result.ledger["initial"]}}
        said = summary.brief(dataclasses.replace(result, ledger=ledger))
        (line,) = (line for line in said.splitlines() if line.startswith("  energy lost "))
        assert words in line
        assert "110" not in said

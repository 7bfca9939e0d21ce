"""The frozen set's rule: what it lets pass, and what it does not."""

import math

import pytest
from tools.frozen.rules import (
    BALANCE,
    FLOOR,
    TIMES,
    allowed,
    differences,
    response_of,
    sentence,
)


def answer(**kinds):
    return {"values": {}, "bounds": {}, "exact": {}, "sentences": {}, **kinds}


def quantities(stored, found):
    return [each.quantity for each in differences(stored, found)]


def values(stored, response, found):
    before, now = {"x": [stored, response]}, {"x": found}
    return quantities(answer(values=before), answer(values=now))


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_value_may_differ_by_ten_times_its_response(sign):
    assert values(2.0, 1e-6, 2.0 + sign * 0.99e-5) == []
    assert values(2.0, 1e-6, 2.0 + sign * 1.01e-5) == ["values.x"]


def test_a_value_without_response_may_differ_by_some_units_in_the_last_place():
    assert allowed(-3.0, 0.0) == pytest.approx(TIMES * FLOOR * 3.0)
    assert values(3.0, 0.0, 3.0 * (1.0 + 3e-15)) == []
    assert values(3.0, 0.0, 3.0 * (1.0 + 6e-15)) == ["values.x"]
    assert values(0.0, 0.0, 0.0) == []
    assert values(0.0, 0.0, 1e-300) == ["values.x"]


@pytest.mark.parametrize("found", [None, math.nan, "inf", True, [2.0]])
def test_a_value_stays_a_number(found):
    assert values(2.0, 1e-6, found) == ["values.x"]


def test_what_was_no_number_stays_none():
    assert values(None, None, None) == []
    assert values(None, None, 1.0) == ["values.x"]
    assert values("inf", None, "inf") == []


def test_what_comes_or_goes_by_rounding_has_no_bound():
    assert values(2.0, math.inf, 5.0) == values(2.0, math.inf, None) == []


def test_elements_of_a_list_have_responses_of_their_own():
    assert values([1.0, None, 1.0], [1e-3, None, 0.0], [1.009, None, 1.0]) == []
    assert values([1.0, None, 1.0], [1e-3, None, 0.0], [1.0, None, 1.009]) == ["values.x[2]"]
    assert values([1.0, 1.0], [0.0, 0.0], [1.0]) == ["values.x"]


def test_a_response_is_the_largest_change():
    assert response_of(1.0, [1.25, 0.5]) == 0.5
    assert response_of([1.0, None], [[1.25, None], [1.0, None]]) == [0.25, None]
    assert response_of(1.0, [1.0, None]) == math.inf
    assert response_of([1.0], [[1.0, 2.0]]) == [math.inf]
    assert response_of(None, [1.0]) is None


@pytest.mark.parametrize(
    ("stored", "found", "same"),
    [
        (1e-12, -0.9 * BALANCE, True),
        (1e-12, 1.1 * BALANCE, False),
        (-1e-6, 9e-6, True),
        (-1e-6, 1.1e-5, False),
        (1e-6, math.nan, False),
        (1e-6, None, False),
        (None, None, True),
    ],
)
def test_a_balance_is_a_bound(stored, found, same):
    found = answer(bounds={"energy_balance_error": found})
    assert quantities(answer(bounds={"energy_balance_error": stored}), found) == [
        "bounds.energy_balance_error"
    ] * (not same)


def test_counts_switches_and_words_are_the_same():
    stored = answer(exact={"impacts": 3, "outcome": "rest"})
    assert quantities(stored, answer(exact={"impacts": 3, "outcome": "rest"})) == []
    assert quantities(stored, answer(exact={"impacts": 4, "outcome": "rest"})) == ["exact.impacts"]


def test_a_quantity_on_one_side_alone_differs():
    stored = answer(exact={"error": "SimulationError"}, values={"x": [1.0, 0.0]})
    assert quantities(stored, answer(values={"y": 1.0})) == ["values.x", "values.y", "exact.error"]


def test_a_warning_is_known_by_its_words_and_not_by_its_numbers():
    first = "the body sinks in by 12 % of its radius: half-space below 2 %"
    other = "the body sinks in by 3.4e-2 of its radius: half-space below 5 %"
    assert sentence(first) == sentence(other) == "the body sinks in by of its radius"
    assert sentence("at 950 nm the film ends") == sentence("at 1.2 um, the film ends")
    assert sentence("the gas film is thin") != sentence("the contact is not quasi-static")

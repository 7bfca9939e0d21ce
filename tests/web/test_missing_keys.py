"""What a choice on the page asks for: filled in, or refused with what would mend it."""

from __future__ import annotations

from typing import Any

import pytest

from asperity.config import BUILTINS, Case, load
from asperity.config.case_file import builtin_text, tables
from asperity.config.problems import check
from asperity.errors import InputError
from asperity.web.form import form
from asperity.web.missing_keys import completed, remedies
from web_client import refusal

Tables = dict[str, Any]
FORM = {table["name"]: table for table in form() if not table["named"]}


def given(name: str) -> Tables:
    """The tables of a built-in case."""
    return tables(builtin_text(name), None)


def ticked(case: Tables, table: str) -> Tables:
    """A case with one table more, as the page begins it: with the keys that it shows."""
    keys = FORM[table]["keys"]
    shown = {key["key"]: key["example"] for key in keys if key["shown"]}
    return {**case, table: {key: value for key, value in shown.items() if value is not None}}


def chosen(case: Tables, table: str, **values: Any) -> Tables:
    begun = case if table in case else ticked(case, table)
    return {**begun, table: {**begun[table], **values}}


def refused(case: Tables) -> tuple[InputError, ...]:
    try:
        check(Case, case)
    except InputError as error:
        return error.problems
    return ()


def mended(case: Tables, remedy: dict[str, Any]) -> Tables:
    table, _, key = remedy["key"].partition(".")
    if not key:
        return {name: each for name, each in case.items() if name != table}
    keys = {**case.get(table, {}), key: remedy["value"]}
    return {**case, table: {name: each for name, each in keys.items() if each is not None}}


def assert_within_reach(after: Tables, before: Tables) -> None:
    """A choice is complete, or what forbids it is told with what mends it, again and again."""
    case = completed(after, before)
    for _ in range(4):
        problems = refused(case)
        if not problems:
            return
        assert all(one.key for one in problems)
        found = remedies(case)
        assert found, [str(one) for one in problems]
        case = mended(case, found[0])
    assert not refused(case)


CHOICES = [
    (table, key["key"], choice)
    for table, about in FORM.items()
    for key in about["keys"]
    for choice in key["choices"]
    if not key["beside"]
]


@pytest.mark.parametrize("name", BUILTINS)
@pytest.mark.parametrize("table", [name for name, about in FORM.items() if not about["needed"]])
def test_every_table_can_be_taken_in_and_out(name, table):
    case = given(name)
    if table in case:
        assert_within_reach({key: each for key, each in case.items() if key != table}, case)
    else:
        assert_within_reach(ticked(case, table), case)


@pytest.mark.parametrize("name", BUILTINS)
@pytest.mark.parametrize(("table", "key", "choice"), CHOICES)
def test_every_choice_can_be_made(name, table, key, choice):
    case = given(name)
    assert_within_reach(chosen(case, table, **{key: choice}), case)


def test_gas_comes_with_air_and_with_the_gap_from_which_its_film_counts():
    case = given("published-exact")
    case["impact"] = {"speed": "10 mm/s"}
    found = completed({**case, "gas": {"name": "air"}}, case)
    assert found["gas"] == {"name": "air", "pressure": "101.325 kPa", "temperature": "20 degC"}
    assert found["impact"] == {"speed": "10 mm/s", "release_separation": "1 um"}
    assert not refused(found)


def test_what_was_missing_before_a_choice_stays_missing():
    """Nobody asked for it to be filled in."""
    case = given("published-exact")
    del case["body"]["radius"]
    found = completed({**case, "gas": {"name": "air"}}, case)
    assert "radius" not in found["body"]
    assert found["gas"]["pressure"] == "101.325 kPa"


def test_a_value_that_is_given_is_never_overwritten():
    case = given("published-exact")
    after = chosen(case, "gas", pressure="-1 Pa")
    assert completed(after, case) == after


def test_remedies_name_a_choice_or_take_out_what_does_not_go():
    case = chosen(given("published-exact"), "plasticity", model="kogut-etsion", hardness="9 GPa")
    assert [(one.key) for one in refused(case)] == ["counterface.deformation"]
    key = "counterface.deformation"
    assert remedies(case) == [{"at": key, "key": key, "value": "rigid"}]
    case = given("published")
    case["gas"] = {"name": "air", "pressure": "1 bar", "temperature": "20 degC"}
    assert {"at": "gas", "key": "gas", "value": None} in remedies(case)
    case = given("published-exact")
    case["body"]["radius"] = "-1 um"  # nobody can know what was meant
    assert remedies(case) == []


def test_a_case_tells_all_that_is_wrong_with_it_at_once(client):
    case = given("published-exact")
    case["body"]["radius"] = "-5 um"
    case["capillary"]["humidity"] = 1.5
    case["adhesion"] = {"model": "dmt"}
    case["bodi"] = {}
    error = refusal(client, "/api/explore", json={"case": case})
    assert {one["key"] for one in error["problems"]} == {
        "bodi", "body.radius", "capillary.humidity", "adhesion.work",
        "adhesion.equilibrium_spacing",
    }  # fmt: skip
    assert error["problems"][0] == {key: error[key] for key in ("key", "message")}
    assert error["key"] == "bodi"
    for one in error["problems"]:
        assert "\n" not in one["message"]


def test_rules_between_tables_are_all_told(client):
    case = given("published-exact")
    case["publication"] = {}
    case["adhesion"]["model"] = "jkr"
    case["capillary"]["adsorbed_film_thickness"] = "1 nm"
    case["numerics"] = {"rings": 400, "max_impacts": 10**4}
    error = refusal(client, "/api/explore", json={"case": case})
    assert {one["key"] for one in error["problems"]} == {
        "counterface.deformation", "adhesion.model", "capillary.adsorbed_film_thickness",
    }  # fmt: skip
    del case["publication"]
    error = refusal(client, "/api/explore", json={"case": case})
    wanted = ["numerics.rings", "numerics.max_impacts"]
    assert [one["key"] for one in error["problems"]] == wanted


def test_an_error_of_the_library_has_its_problems_and_the_lines_of_the_first():
    text = builtin_text("published-exact").replace('"50 um"', '"-5 um"').replace("0.6\n", "6\n")
    with pytest.raises(InputError, match=r"body.radius \(line \d+\): `radius`") as caught:
        load(text, file="drop.toml")
    first, second = caught.value.problems
    assert first is caught.value
    assert (second.key, second.file) == ("capillary.humidity", "drop.toml")
    assert "(line " in str(second)
    assert str(second) not in str(first)


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ('{"case": {}}', "`before` must be an object"),
        ('{"case": [], "before": {}}', "`case` must be an object"),
        ('{"case": {}, "before": {}, "name": ""}', "keys among case, before"),
        ('{"case": {"a": null}, "before": {}}', "no null"),
        ("[", "JSON object"),
    ],
)
def test_what_is_no_choice_is_refused(client, body, words):
    assert words in refusal(client, "/api/complete", content=body)["message"]


def test_choices_of_strange_tables_are_answered(client):
    for case in ({"body": 3}, {"materials": {"a.b": {"density": []}}}, {"gas": {"name": {}}}):
        answer = client.post("/api/complete", json={"case": case, "before": {}})
        assert answer.status_code == 200, answer.text

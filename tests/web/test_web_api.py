"""What the server answers: the schema as a form, a case's numbers, refusals, files, a verdict."""

from __future__ import annotations

import base64
import csv
import dataclasses
import io
import json
import sys
from math import pi
from types import SimpleNamespace
from typing import Annotated, Any, NamedTuple
from urllib.parse import quote

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from starlette.routing import Route
from starlette.testclient import TestClient

import asperity
from asperity.config import BUILTINS, FIRST, Case, load
from asperity.config.base_table import Table
from asperity.config.case_file import builtin_text
from asperity.config.fields import Length, Number, entry
from asperity.config.key_labels import label
from asperity.config.problems import tables_of
from asperity.config.resolve import resolve
from asperity.errors import InputError, Outcome
from asperity.results.read_record import read
from asperity.results.record_layout import json_object
from asperity.results.result import Curve, Result
from asperity.results.verdict import sentence, verdict
from asperity.solver import explore
from asperity.web.answer import _seen
from asperity.web.exploring import FILES
from asperity.web.form import form
from commands import answered
from fake_result import bounce
from fake_solve import solver
from jkr_spheres import SMOOTH
from web_client import client_of, refusal, strict, told


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "asperity.solver", solver())


def changed(tables: dict[str, Any], table: str, **values: Any) -> dict[str, Any]:
    return {**tables, table: {**tables.get(table, {}), **values}}


def explored(client: TestClient, tables: dict[str, Any], name: str = "drop") -> Any:
    return told(client, tables, name=name)[-1]


# The form


def test_the_form_has_every_key_of_the_schema(client):
    found = client.get("/api/form").json()
    shown = {table["name"]: {key["key"] for key in table["keys"]} for table in found["tables"]}
    assert shown == {
        name: set(table.model_fields)
        for name, field in Case.model_fields.items()
        for table in tables_of(field.annotation)
        if name != "output"
    }
    assert [table["name"] for table in found["tables"] if table["named"]] == ["materials"]
    assert found["cases"] == [*BUILTINS]
    assert found["first"] == FIRST
    assert FIRST in BUILTINS


def test_every_field_says_what_it_is(client):
    for table in client.get("/api/form").json()["tables"]:
        assert table["help"], table["name"]
        assert table["label"] == label(table["name"])
        for key in table["keys"]:
            assert key["help"], key
            assert key["label"] == label(f"{table['name']}.{key['key']}")
            assert key["kind"] == "choice" or not key["choices"]
            assert key["example"] is not None
            slides = key["kind"] in ("quantity", "number", "whole")
            assert (key["slider"] is not None) == slides, key
            if key["kind"] == "quantity":
                assert key["unit"] not in ("", "1"), key


def test_kinds_choices_and_spans_are_those_of_the_schema(client):
    tables = client.get("/api/form").json()["tables"]
    keys = {f"{table['name']}.{key['key']}": key for table in tables for key in table["keys"]}
    assert keys["body.radius"]["kind"] == "quantity"
    assert keys["body.radius"]["slider"] == {"scale": "factor"}
    assert {"none", "dmt", "jkr", "maugis"} <= set(keys["adhesion.model"]["choices"])
    assert set(keys["counterface.deformation"]["choices"]) == {"rigid", "half-space"}
    assert keys["capillary.humidity"]["slider"] == {
        "scale": "linear", "low": 0.0, "high": 1.0, "unit": "",
    }  # fmt: skip
    assert keys["capillary.humidity"]["span"] == "0 to 1"
    assert keys["capillary.contact_angle"]["slider"]["unit"] == "deg"
    assert keys["roughness.source"]["beside"] == "files"
    assert keys["roughness.rms_height"]["beside"] == ""
    assert keys["roughness.files"]["kind"] == "list"
    assert keys["numerics.rings"]["kind"] == "whole"
    assert "silica" in keys["body.material"]["among"]


class Wear(Table):
    """What wears off."""

    depth: Length = entry("m", "Depth that is worn.", "1 nm")
    share: Annotated[float, Number("[0, 0.5]")] | None = entry("1", "Share.", 0.1, default=None)
    sudden: bool = entry("", "Whether at once.", False, default=False)


class Worn(Case):
    """A case of one more table."""

    wear: Wear | None = None


def test_a_new_key_appears_by_itself(monkeypatch):
    monkeypatch.setattr("asperity.web.form.Case", Worn)
    (table,) = (table for table in form() if table["name"] == "wear")
    assert (table["help"], table["needed"]) == ("What wears off.", False)
    depth, share, sudden = table["keys"]
    assert (depth["key"], depth["kind"], depth["unit"]) == ("depth", "quantity", "m")
    assert (depth["needed"], depth["slider"]) == (True, {"scale": "factor"})
    assert (share["kind"], share["slider"]["high"], share["needed"]) == ("number", 0.5, False)
    assert (sudden["kind"], sudden["default"]) == ("switch", False)


# Cases


@pytest.mark.parametrize("name", BUILTINS)
def test_copy_case_gives_the_text_that_run_takes(client, name):
    tables = client.get(f"/api/cases/{name}").json()["tables"]
    text = client.post("/api/toml", json={"case": tables}).json()["toml"]
    assert load(text) == load(builtin_text(name))
    assert f'"{tables["body"]["radius"]}"' in text  # as it was given


def test_copy_case_keeps_what_the_page_does_not_show(client, tables):
    solid = {"youngs_modulus": "70 GPa", "poisson": 0.2, "density": "2500 kg/m^3"}
    tables = {
        **changed(tables, "body", material='glass, "soft"\t\x01é'),
        "materials": {'glass, "soft"\t\x01é': solid},
        "output": {"motion": False},
    }
    text = client.post("/api/toml", json={"case": tables}).json()["toml"]
    case = load(text)
    assert resolve(case).body.youngs_modulus == 70e9
    assert case.output.motion is False
    assert client.post("/api/read", content=text.encode()).json()["tables"] == tables


def test_the_page_opens_with_the_users_own_case():
    text = builtin_text("published").replace("50 um", "20 um")
    with client_of(("mine", text)) as client:
        assert client.get("/api/form").json()["first"] == "mine"
        assert client.get("/api/cases/mine").json()["tables"]["body"]["radius"] == "20 um"


class Answer(NamedTuple):
    """What the page shows of a case, and what `explore` finds for it."""

    found: dict[str, Any]
    case: Case
    result: Result
    curve: Curve


@pytest.fixture(scope="module")
def answer(client: TestClient, tables: dict[str, Any]) -> Answer:
    found = explored(client, tables)["answer"]
    case = load(client.post("/api/toml", json={"case": tables}).json()["toml"])
    return Answer(found, case, *explore(case, name="drop"))


def test_an_answer_is_that_of_explore_to_the_last_digit_and_of_solve_to_1e_9(answer):
    """The page cuts its curves at least as finely, in ways that are fewer."""
    found, result = answer.found, answer.result
    wanted = strict(json.dumps(json_object(result)))
    assert {key: found[key] for key in wanted} == wanted
    solved = asperity.solve(answer.case, name="drop", critical=False, beside=True)
    assert_close(found["measures"], solved.measures)
    assert found["outcome"] == solved.outcome.value
    assert found["warnings"] == solved.warnings
    assert found["verdict"] == sentence(result)
    assert found["message"] == result.outcome.message
    assert (found["name"], found["motion"]["impacts"]) == ("drop", 12)


def assert_close(found: dict[str, Any], wanted: dict[str, Any]) -> None:
    for name, value in wanted.items():
        if value is None or isinstance(value, bool):
            assert found[name] == value, name
        else:
            assert found[name] == pytest.approx(value, rel=1e-9), name


def unpacked(text: str) -> np.ndarray:
    return np.frombuffer(base64.b64decode(text, validate=True), "<f4")


def test_a_motion_and_a_curve_unpack_to_their_numbers(answer):
    found, _, result, curve = answer
    motion = found["motion"]
    assert motion["drawn"] == 12
    begin, end = motion["first_contact"]
    seen = _seen(result, motion["first_contact"])
    assert {0, len(result.time) - 1} <= set(seen)
    assert set(np.flatnonzero((begin <= result.time) & (result.time <= end))) <= set(seen)
    assert len(seen) < 0.6 * len(result.time)
    assert np.array_equal(unpacked(motion["time"]), result.time[seen].astype("<f4"))
    for part, wanted in (("forces", result.forces), ("energies", result.energies)):
        assert list(motion[part]) == list(wanted)
    series = {name: getattr(result, name) for name in ("separation", "central_separation", "speed")}
    for values, drawn in (
        (series, motion),
        (result.forces, motion["forces"]),
        (result.energies, motion["energies"]),
    ):
        for name, whole in values.items():
            assert np.array_equal(unpacked(drawn[name]), whole[seen].astype("<f4")), name
            between = np.interp(result.time, result.time[seen], whole[seen])
            assert np.max(np.abs(between - whole)) <= 0.01 * np.ptp(whole), name
    approach = unpacked(found["curve"]["loading"])
    assert approach.shape == unpacked(found["curve"]["separation"]).shape
    assert np.allclose(approach, curve.force_loading, rtol=1e-6)
    assert found["curve"]["pull_off"] == curve.pull_off
    deepest, apex = result.events["closest_approach_time"][0], result.events["apex_time"][0]
    assert begin < deepest < end < 1.2 * apex


def test_what_is_drawn_keeps_small_late_bounces_jumps_and_what_is_no_number():
    time = np.linspace(0.0, 1.0, 1201)
    height = np.abs(np.cos(12.0 * pi * time)) * 10.0 ** (-3.0 * np.floor(12.0 * time + 0.5) / 12.0)
    pull = np.where(time > 0.303, -1.0, 0.0)
    pull[7] = np.nan
    result: Any = SimpleNamespace(
        time=time, separation=height, speed=0.0 * time, forces={"a": pull}
    )
    seen = _seen(result, [0.1, 0.11])
    between = np.interp(time, time[seen], height[seen])
    for number in range(12):
        during = np.floor(12.0 * time + 0.5) == number
        assert np.max(np.abs(between - height)[during]) < 0.02 * np.max(height[during])
    jump = int(np.argmax(time > 0.303))
    assert {jump - 1, jump} <= set(seen)
    assert len(seen) < 800


def test_the_map_has_its_lines_and_the_case_its_place(client, tables):
    found = client.get("/api/map").json()
    assert found["lines"]
    for line in found["lines"]:
        elasticity, load_ = unpacked(line["elasticity"]), unpacked(line["load"])
        assert elasticity.shape == load_.shape
        assert len(line["between"]) == 2
        assert np.isfinite(elasticity).any()


# Refusals

ROUTES = ("/api/toml", "/api/explore", "/api/files/record.nc")


BAD = [
    ("body", {"raduis": "50 um"}, "body.raduis", "did you mean 'radius'"),
    ("bodi", {"radius": "50 um"}, "bodi", "did you mean 'body'"),
    ("body", {"radius": "-50 um"}, "body.radius", "must be positive"),
    ("body", {"radius": 50}, "body.radius", "unit"),
    ("body", {"radius": ["50 um"]}, "body.radius", "unit"),
    ("capillary", {"humidity": True}, "capillary.humidity", "must be a number"),
    ("numerics", {"rings": 400}, "numerics.rings", "at most 160 on this page"),
    ("numerics", {"max_impacts": 10**5}, "numerics.max_impacts", "at most 2000 on this page"),
]


@pytest.mark.parametrize("path", ROUTES)
def test_bad_input_names_the_field_the_rule_and_the_value(client, tables, path):
    for table, values, key, words in BAD:
        error = refusal(client, path, json={"case": changed(tables, table, **values)})
        assert (error["kind"], error["key"]) == ("input", key)
        assert words in error["message"]


DEEP = b'{"case": {"a": ' + b"[" * 9 + b"]" * 9 + b"}}"
CASE = b'{"case": {"body": {"radius": %s}}}'


@pytest.mark.parametrize(
    ("body", "status", "words"),
    [
        (b"", 422, "JSON object"),
        (b"radius = 1", 422, "JSON object"),
        (b"\xff\xfe", 422, "JSON object"),
        (b"[]", 422, "JSON object"),
        (b"null", 422, "JSON object"),
        (b"{}", 422, "`case` must be an object"),
        (b'{"case": []}', 422, "`case` must be an object"),
        (b'{"case": {}, "path": "/etc"}', 422, "keys among"),
        (b'{"case": {}, "name": 5}', 422, "`name`"),
        (b'{"case": {}, "asker": "%s"}' % (b"a" * 101), 422, "`asker`"),
        (b'{"case": {}, "surfaces": {"a": {}}}', 422, "`surfaces`"),
        (CASE % b"NaN", 422, "JSON object"),
        (CASE % b"-Infinity", 422, "JSON object"),
        (CASE % b"1e999", 422, "inf"),
        (CASE % (b"9" * 5000), 422, "JSON object"),
        (CASE % b'"\\ud800"', 422, "whole characters"),
        (CASE % b"null", 422, "no null"),
        (b'{"case": {"gas": null}}', 422, "no null"),
        (DEEP, 422, "8 deep"),
        (b"[" * 200_000, 422, "JSON object"),
        (b'{"case": {}, "name": "%s"}' % (b"a" * (1 << 20)), 413, "1 MiB"),
    ],
)
def test_what_is_no_question_is_refused_in_a_line(client, body, status, words):
    for path in ROUTES:
        error = refusal(client, path, status, content=body)
        assert error["kind"] == ("input" if status == 422 else "request")
        assert words in error["message"]


def test_a_length_beyond_the_limit_is_refused_before_it_is_sent(client):
    headers = {"content-length": str(1 << 40)}
    error = refusal(client, "/api/surfaces/a.csv", 413, content=b"1", headers=headers)
    assert "64 MiB" in error["message"]


def test_a_body_without_a_length_is_read_to_the_limit_alone(client):
    endless = (b"#" * (1 << 16) for _ in range(48))
    refusal(client, "/api/read", 413, content=endless)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (b"", "empty"),
        (b"a = [", "TOML"),
        (b"a = 1979-05-27", "no dates"),
        (b"a = inf", "infinite"),
        (b"\xff", "UTF-8"),
        (b"a\0", "binary"),
        (b"a = " + b"[\n" * 300 + b"]\n" * 300, "8 deep"),
        (b"[" + b"a." * 490 + b"a]\n" + b"a." * 490 + b"a = 1", "8 deep"),
    ],
)
def test_a_file_that_is_no_case_is_refused(client, text, words):
    assert words in refusal(client, "/api/read", content=text)["message"]


def test_a_case_that_run_would_refuse_is_not_copied(client, tables):
    for output in ({"a": [{"b": 1}]}, {"directory": "x" * 2000}, {"motion": 3}, [], 5):
        refusal(client, "/api/toml", json={"case": {**tables, "output": output}})


def test_what_only_the_solver_finds_is_told_beside_its_field(client, tables):
    error = explored(client, changed(tables, "impact", release_separation="30 nm"))["error"]
    assert (error["kind"], error["key"]) == ("input", "impact.release_separation")
    assert "got 30 nm" in error["message"]


def test_a_way_or_a_thing_that_is_not_there_is_told(client):
    for method, path, status in (
        ("GET", "/api/explore", 405),
        ("DELETE", "/api/form", 405),
        ("GET", "/nothing", 404),
        ("POST", "/api/files/motion.exe", 404),
        ("GET", "/api/cases/none", 404),
    ):
        answer = client.request(method, path)
        assert (answer.status_code, answer.json()["error"]["kind"]) == (status, "request")
        assert status != 405 or answer.headers["allow"]


# Files


def downloaded(client: TestClient, tables: dict[str, Any], name: str) -> bytes:
    answer = client.post(f"/api/files/{name}", json={"case": tables, "name": "drop"})
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"] == FILES[name]
    assert answer.headers["content-disposition"] == f'attachment; filename="{name}"'
    return answer.content


def test_pictures_are_pictures_and_a_summary_is_text(client, tables, quick):
    for name in (name for name in FILES if name.endswith(".png")):
        content = downloaded(client, tables, name)
        assert content.startswith(b"\x89PNG\r\n\x1a\n")
        assert content.rstrip().endswith(b"IEND\xaeB`\x82")
    assert downloaded(client, tables, "summary.txt").decode().startswith("drop")


def test_a_record_is_that_of_run_and_runs_again(client, tables, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "record.nc").write_bytes(downloaded(client, tables, "record.nc"))
    found = read("record.nc")
    assert isinstance(found, Result)
    assert (found.name, len(found.measures["restitution"])) == ("drop", 12)
    result = asperity.solve(found.case, name="drop")
    assert json_object(found) == json_object(result)
    assert np.array_equal(found.separation, result.separation)
    assert answered("run", "record.nc") == strict(json.dumps(json_object(found)))
    (tmp_path / "curve.nc").write_bytes(downloaded(client, tables, "curve.nc"))
    assert read("curve.nc").case == found.case


def test_tables_have_a_column_a_quantity_named_with_its_unit(client, tables, quick):
    result = bounce(impacts=6)
    head, *rows = csv.reader(io.StringIO(downloaded(client, tables, "motion.csv").decode()))
    assert head[:2] == ["time [s]", "separation [m]"]
    assert {"speed [m/s]", "force_contact [N]", "energy_kinetic [J]"} <= set(head)
    found = np.array(rows, dtype=float)
    assert np.array_equal(found[:, 0], result.time)
    assert np.array_equal(found[:, 1], result.separation)
    head, *rows = csv.reader(io.StringIO(downloaded(client, tables, "curve.csv").decode()))
    assert {"rigid_separation [m]", "force_unloading [N]"} <= set(head)
    assert len(rows) == 200


# The verdict


def ending(outcome: Outcome, impacts: int = 6, **measures: Any) -> Result:
    """A result made by hand that ends in some way."""
    result = bounce(impacts=impacts, outcome=outcome)
    return dataclasses.replace(result, measures={**result.measures, **measures})


def captured_at(impact: int) -> Result:
    """A result whose body sticks in an impact, counted from 0."""
    when = bounce(impacts=6).events["closest_approach_time"][impact]
    return ending(Outcome.OSCILLATING, captured=impact == 0, capture_time=when)


def pushed_alone() -> Result:
    """A result of a body that came to rest in a gas, on a surface that never pulled."""
    result = captured_at(5)
    forces = {**result.forces, "contact": np.abs(result.forces["contact"])}
    return dataclasses.replace(result, forces=forces)


def stopped_at(rebounds: float) -> Result:
    """A result that a time limit ended after so many rebounds."""
    result = ending(Outcome.TIME_LIMIT)
    times = np.concatenate([[0.0], result.events["apex_time"]])
    limit = f"{times[int(rebounds)] + 1e-9} s"
    return dataclasses.replace(result, case=result.case.replace({"numerics.time_limit": limit}))


@pytest.mark.parametrize(
    ("result", "words"),
    [
        (captured_at(1), "sticks after 1 rebound"),
        (captured_at(3), "sticks after 3 rebounds"),
        (ending(Outcome.REST), "comes to rest after 6 rebounds"),
        (ending(Outcome.OSCILLATING), "goes on for ever: its last cycle loses nothing"),
        (pushed_alone(), "comes to rest, held by its weight alone, after 5 rebounds"),
        (stopped_at(0.0), "had not come back once where the run was stopped"),
        (stopped_at(2.0), "still bounces after 2 rebounds, where the run was stopped"),
        (ending(Outcome.ESCAPED, impacts=1), "does not come back"),
        (
            ending(Outcome.MAX_IMPACTS),
            "still bounces after 6 rebounds, where the run was stopped",
        ),
        (ending(Outcome.TIME_LIMIT), "still bounces after 6 rebounds, where the run was stopped"),
        (ending(Outcome.INTERRUPTED), "still bounces after 6 rebounds, where the run was stopped"),
        (ending(Outcome.FAILED), "the numerics failed before there was an answer"),
    ],
)
def test_a_verdict_says_how_it_ends(result, words):
    kept = result.measures["restitution"][0]
    first = f"leaves the first impact with e = {kept:.3g} and "
    assert verdict(result).split("; ")[0] == first + words


def test_a_verdict_begins_with_the_first_impact():
    assert verdict(captured_at(0)).split("; ")[0] == "is captured at the first impact"
    kept = ending(Outcome.ESCAPED, impacts=1, restitution=[None])  # by a gas alone, say
    assert verdict(kept).split("; ")[0] == "does not come back"


def test_a_verdict_says_who_takes_the_energy():
    result = ending(Outcome.REST)

    def taken(**lost: float) -> str:
        ledger = {**result.ledger, "lost": lost}
        return verdict(dataclasses.replace(result, ledger=ledger)).split("; ")[1]

    energy = result.ledger["initial"]
    assert taken(adhesion=0.3 * energy, capillary=0.1 * energy) == (
        "dry adhesion takes 75 % of the energy lost"
    )
    assert taken(adhesion=0.0004 * energy, capillary=0.1 * energy) == (
        "menisci take 99.6 % of the energy lost"
    )
    assert taken(adhesion=1.4, capillary=98.6) == "menisci take 99 % of the energy lost"
    assert taken(adhesion=0.0, plastic=energy) == "yielding takes all of the energy lost"
    assert taken(gas=0.2 * energy) == "the gas film takes all of the energy lost"
    assert taken(adhesion=1e-12 * energy, capillary=0.0) == "no energy is lost"
    assert taken() == "no energy is lost"


def test_an_answer_stands_without_the_chart_of_single_bodies(client, tables, monkeypatch):
    def refused(*_: Any) -> None:
        raise InputError("too many summits")

    monkeypatch.setattr("asperity.sweeps.capture_probability.capture_nearby", refused)
    found = explored(client, tables)["answer"]
    assert found["capture"] is None
    assert found["verdict"].startswith("Of single bodies")
    assert found["warnings"][-1] == "there is no chart of single bodies: too many summits"


def test_nothing_is_lost_without_adhesion_and_liquid(client, tables):
    """Elastic asperities alone give back all that they take."""
    tables = changed(tables, "impact", release_separation="300 nm")  # else not one asperity touches
    tables = changed(tables, "roughness", placement="mean")
    dry = {**tables, "adhesion": {"model": "none"}, "capillary": {"model": "none"}}
    found = explored(client, dry)["answer"]
    assert found["measures"]["captured"] is False
    assert found["verdict"] == (
        "The body leaves the first impact with e = 1 and bounces for ever; no energy is lost"
    )
    wet = explored(client, tables)["answer"]["verdict"]
    assert "and still bounces after 12 rebounds, where the run was stopped; menisci" in wet


def test_the_critical_velocity_is_asked_for_apart_and_is_that_of_solve(client):
    tables = client.post("/api/read", content=SMOOTH).json()["tables"]
    assert "critical_velocity" not in explored(client, tables)["answer"]["measures"]
    found = client.post("/api/critical", json={"case": tables}).json()
    wanted = asperity.solve(load(SMOOTH)).measures["critical_velocity"]
    assert found["critical_velocity"] == pytest.approx(wanted, rel=1e-9)
    refusal(client, "/api/critical", json={"case": {**tables, "impact": {}}})


# Any question at all

VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=10)
    | st.sampled_from(["1 m", "1 um", "20 degC", "silica", "dmt", "none", "water"]),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=6), inner),
    max_leaves=5,
)  # fmt: skip
KEYS = sorted((table["name"], key["key"]) for table in form() for key in table["keys"])
NAMES = st.sampled_from([*FILES, *BUILTINS, "surface.csv"]) | st.text(max_size=20)


@settings(max_examples=200)
@given(st.data())
def test_any_question_is_answered_or_refused(client, tables, data):
    """At every route, with other values of a case, other keys of a request, or anything at all."""
    routes = {route.path: route for route in client.app.routes if isinstance(route, Route)}
    path = data.draw(st.sampled_from(sorted(routes)))
    body = {"case": tables, **({"before": tables} if path == "/api/complete" else {})}
    for table, key in data.draw(st.lists(st.sampled_from(KEYS), max_size=2)):
        body["case"] = changed(body["case"], table, **{key: data.draw(VALUES)})
    others = st.sampled_from(["before", "name", "asker", "surfaces", "path"])
    body |= data.draw(st.dictionaries(others, VALUES, max_size=1))
    texts = [json.dumps(body).encode(), builtin_text(FIRST).encode()]
    content = data.draw(st.sampled_from(texts) | st.binary(max_size=40))
    method = "POST" if "POST" in routes[path].methods else "GET"
    path = path.replace("{name}", quote(data.draw(NAMES), safe=""))
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, "asperity.solver", solver())
        answer = client.request(method, path, content=content)
    assert answer.status_code in (200, 404, 422)
    if answer.status_code != 200 or path == "/api/explore":
        last = strict(answer.text.splitlines()[-1])
        assert "answer" in last or last["error"]["kind"] in ("input", "numerics", "request")

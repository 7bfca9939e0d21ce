"""How objects show themselves in Python and in notebooks: one line, and a small HTML table."""

import html.parser
import re

import numpy as np

import asperity
from asperity.amounts import amount
from asperity.config import load
from asperity.sweeps.study.study import parse
from fake_result import bounce, loading
from jkr_spheres import SMOOTH


class Balanced(html.parser.HTMLParser):
    """Reads HTML and refuses tags that do not close, scripts, and whatever would load something."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.text: list[str] = []
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        assert tag in {"div", "p", "strong", "table", "tr", "th", "td", "ul", "li", "code"}
        assert {name for name, _ in attrs} <= {"style", "colspan"}
        self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += [data] if data.strip() else []


def shown(thing: object) -> list[str]:
    """Texts of an object's HTML, in order."""
    return Balanced(thing._repr_html_()).text


def after(texts: list[str], label: str) -> str:
    return texts[texts.index(label) + 1]


def test_a_case_shows_its_values_with_units():
    case = asperity.load("published-exact")
    texts = shown(case)
    assert texts[0] == "published-exact"
    assert after(texts, "radius") == "50 um"
    assert after(texts, "contact_angle") == "73 deg"
    assert after(texts, "temperature") == "293.15 K"
    assert "viscoelasticity" not in texts
    assert repr(case).startswith("<Case published-exact: sphere of silica, radius 50 um, on silic")
    assert str(case) == repr(case)


def test_a_result_shows_its_answer_and_its_warnings():
    result = bounce(impacts=6, case=load(SMOOTH), name="<b>&drop</b>")
    result.warnings.append("few asperities <touch>")
    texts = shown(result)
    assert texts[0] == "<b>&drop</b>"
    assert "few asperities <touch>" in texts
    assert texts.index("Warnings") < texts.index("Motion")
    assert after(texts, "restitution") == "0.8"
    assert "-" not in texts
    count = len(result.warnings)
    told = f"<Result <b>&drop</b>: rest, 6 impacts, first restitution 0.8, {count} warnings?>"
    assert re.fullmatch(told, repr(result))


def test_a_curve_shows_its_pull_off_and_its_warnings():
    curve = loading()
    curve.warnings[:] = ["beyond the law"]
    texts = shown(curve)
    assert "beyond the law" in texts
    assert after(texts, "pull-off force").startswith(amount(curve.pull_off, "N"))
    assert repr(curve).endswith(", 1 warning>")


def test_keys_in_a_warning_are_code():
    curve = loading()
    curve.warnings[:] = ["a smaller `numerics.rest_height_ratio` <tells> more"]
    assert (
        "a smaller <code>numerics.rest_height_ratio</code> &lt;tells&gt; more"
        in curve._repr_html_()
    )


def test_a_restitution_curve_shows_where_capture_ends():
    speed = np.geomspace(0.01, 1.0, 5)
    curve = asperity.RestitutionCurve(
        case=load(SMOOTH),
        name="drop",
        speed=speed,
        restitution=np.array([0.0, 0.0, 0.4, 0.7, 0.9]),
        captured=speed < 0.05,
        critical_velocity=0.05,
        capture_edges=[0.05],
        note=None,
        own_speed=0.2,
        warnings=["a warning"],
    )
    texts = shown(curve)
    assert after(texts, "critical velocity") == "50 mm/s"
    assert after(texts, "10 mm/s") == "captured"
    assert after(texts, "1 m/s") == "0.9000"
    assert "a warning" in texts
    told = "<RestitutionCurve drop: 5 speeds, critical velocity 50 mm/s, 1 warning>"
    assert repr(curve) == told


def test_a_study_shows_its_axes_with_units():
    study = parse(
        'base = "published-exact"\n[axes]\n'
        '"body.radius" = {from = "1 um", to = "9 um", steps = 9}\n'
        '"adhesion.model" = {values = ["dmt", "none"]}\n'
    )
    texts = shown(study)
    assert after(texts, "body.radius") == "9 values from 1 um to 9 um"
    assert after(texts, "adhesion.model") == "dmt, none"
    assert repr(study) == "<Study of published-exact: 18 cases over body.radius, adhesion.model>"


def test_a_study_that_cannot_be_computed_warns_of_it():
    study = parse('base = "published"\n[axes]\n"counterface.deformation" = {values=["half-space"]}')
    assert any("can be computed" in text for text in shown(study))


def test_a_reproduction_shows_its_claims_and_problems():
    claim = {"claim": "a <law>", "published": "1", "found": "2", "verdict": "does not hold"}
    done = asperity.Reproduction([{}] * 3, [], {}, [], [claim], {}, ["no fit"])
    texts = shown(done)
    assert after(texts, "a <law>") == "does not hold"
    assert "no fit" in texts
    assert repr(done) == "<Reproduction: 3 published numbers, 1 claim, 1 problem>"

"""The package from Python: its names, what a case may be given as, other values of a case."""

import os
import pydoc
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import asperity
from asperity import InputError
from asperity.config import load
from fake_result import bounce
from jkr_spheres import SMOOTH

PUBLIC = sorted([*asperity.__all__, "__version__"])


@pytest.fixture
def place(tmp_path, monkeypatch):
    """A folder with a smooth sphere in `glass-drop.toml`."""
    (tmp_path / "glass-drop.toml").write_text(SMOOTH)
    monkeypatch.chdir(tmp_path)
    return tmp_path


# --- names -------------------------------------------------------------------------------------


def test_dir_shows_the_public_names_alone_before_and_after_first_use():
    code = (
        "import sys, asperity; before = dir(asperity); assert 'jax' not in sys.modules; "
        "asperity.Case; asperity.load('published'); print(before == dir(asperity), *before)"
    )
    ran = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert ran.stdout.split() == ["True", *PUBLIC]


def test_help_documents_the_public_names_alone():
    shown = pydoc.render_doc(asperity, renderer=pydoc.plaintext)
    classes = set(re.findall(r"^    class (\w+)", shown, re.MULTILINE))
    functions = set(re.findall(r"^    (\w+)\(", shown.split("\nFUNCTIONS\n")[1], re.MULTILINE))
    assert classes | functions == set(asperity.__all__)
    assert "\nDATA\n" not in shown


def test_the_package_says_what_each_public_name_is_for():
    assert {name for name in asperity.__all__ if f"`{name}`" not in asperity.__doc__} == set()


def test_every_public_name_is_there_and_documented():
    for name in asperity.__all__:
        assert getattr(asperity, name).__doc__, name
    with pytest.raises(AttributeError, match="slove"):
        _ = asperity.slove


# --- a case, or the name or path of one --------------------------------------------------------


@pytest.mark.parametrize("compute", [asperity.solve, asperity.curve, asperity.restitution_curve])
@pytest.mark.parametrize(
    ("given", "kind"), [(5, "int"), (None, "NoneType"), ({"body": 1}, "dict"), (b"drop", "bytes")]
)
def test_what_is_no_case_is_said(compute, given, kind):
    with pytest.raises(InputError, match=rf"`case` must be a case, or .*; got .*\({kind}\)"):
        compute(given)


def test_a_sweep_of_no_case_says_so():
    with pytest.raises(InputError, match=r"`case` must be a case, or .*\(int\)"):
        asperity.sweep(5, {"body.radius": [1e-6]})
    with pytest.raises(InputError, match=r"must be the name or path of a case.*\(list\)"):
        asperity.load([])


def test_a_case_by_its_path_gives_the_same_motion_and_its_name(place):
    by_case = asperity.solve(load(SMOOTH), critical=False)
    by_path = asperity.solve(Path("glass-drop.toml"), critical=False)
    by_text = asperity.curve("./glass-drop.toml")
    assert (by_case.name, by_path.name, by_text.name) == ("case", "glass-drop", "glass-drop")
    np.testing.assert_array_equal(by_case.separation, by_path.separation)
    assert asperity.solve("glass-drop.toml", name="mine", critical=False).name == "mine"


def test_a_case_has_the_name_of_its_file_which_is_no_part_of_it(place):
    case = asperity.load("glass-drop.toml")
    assert case.name == case.replace({"body.radius": 2e-6}).name == "glass-drop"
    assert case == load(SMOOTH)
    assert case.toml() == load(SMOOTH).toml()
    assert "name" not in case.model_dump()
    assert asperity.load("published-exact").name == "published-exact"
    assert load(SMOOTH).name == "case"


def test_a_record_stands_for_its_case(place):
    bounce(case=asperity.load("glass-drop.toml"), name="kept").save("out")
    case = asperity.load("out/record.nc")
    assert case == asperity.load("glass-drop.toml")
    assert case.name == "kept"


@pytest.mark.parametrize(
    ("given", "hint"),
    [
        ("publishd", "did you mean 'published'?"),
        ("glass-drop", "there is a file glass-drop.toml here"),
        ("glas-drop", "there is a file glass-drop.toml here"),
        ("glas-drop.toml", "did you mean 'glass-drop.toml'?"),
        (Path("glas-drop.toml"), "did you mean 'glass-drop.toml'?"),
    ],
)
def test_a_misspelt_case_is_answered_by_the_near_one(place, given, hint):
    with pytest.raises(InputError) as refused:
        asperity.load(given)
    assert hint in str(refused.value)


def test_a_near_file_in_another_folder_is_named_with_it(place):
    (place / "mine").mkdir()
    (place / "glass-drop.toml").rename(place / "mine" / "glass-drop.toml")
    with pytest.raises(InputError, match=f"did you mean 'mine{os.sep}glass-drop.toml'"):
        asperity.load("mine/glas-drop.toml")
    with pytest.raises(InputError) as refused:
        asperity.load("mine/silica.toml")
    assert "did you mean" not in str(refused.value)


def test_a_file_with_two_problems_tells_of_both(place):
    Path("bad.toml").write_text(SMOOTH.replace('"1 um"', '"-1 um"').replace("0.2\n", "0.7\n"))
    with pytest.raises(InputError) as refused:
        asperity.load("bad.toml")
    assert [problem.key for problem in refused.value.problems] == [
        "body.radius",
        "materials.soft.poisson",
    ]


# --- replace -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("key", "text", "number"),
    [
        ("body.radius", "10 um", 1e-5),
        ("body.radius", "10 um", np.float64(1e-5)),
        ("body.radius", "1 m", 1),
        ("adhesion.work", "50 mJ/m^2", np.array(0.05)),
        ("impact.gravity", "0 m/s^2", np.int64(0)),
        ("capillary", None, None),
        ("numerics.max_impacts", 7, np.int32(7)),
        ("numerics.tolerance", 0.0009765625, np.float32(0.0009765625)),
        ("materials.soft.density", "3000 kg/m^3", 3000.0),
    ],
)
def test_numbers_in_si_and_text_give_equal_cases(key, text, number):
    case = load(SMOOTH)
    assert case.replace({key: number}) == case.replace({key: text})


def test_a_table_takes_numbers_in_si_too():
    wet = {"model": "equilibrium", "liquid": "water", "humidity": 0.5}
    numbers = {"temperature": 293.15, "contact_angle": np.pi / 6}
    texts = {"temperature": "20 degC", "contact_angle": f"{np.pi / 6} rad"}
    case = load(SMOOTH.replace('"jkr"', '"dmt"'))
    assert case.replace({"capillary": wet | numbers}) == case.replace({"capillary": wet | texts})


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"body.radius": True}, "body.radius: `radius` must be a number in m, or text with a unit"),
        ({"body.radius": np.bool_(True)}, "got True"),
        ({"body.radius": float("nan")}, "body.radius: `radius` must be a finite number; got nan m"),
        ({"body.radius": np.inf}, "must be a finite number; got inf m"),
        ({"body.radius": 10**400}, "must be a finite number"),
        ({"body.radius": -1e-5}, "body.radius: `radius` must be positive; got '-1e-05 m'"),
        ({"body.raduis": 1e-5}, "did you mean 'radius'?"),
        ({"boddy.radius": 1e-5}, "did you mean 'body'?"),
        ({"radius": 1e-5}, "it belongs in [body]"),
        ({"numerics.max_impacts": 2.0}, "must be a whole number"),
        ({"numerics.rest_height_ratio": float("nan")}, "must be finite"),
        ({5: 1e-5}, "a key must be text, such as 'body.radius'; got 5"),
        ("body.radius", "`changes` must be values by their dotted key"),
    ],
)
def test_values_that_no_key_can_have_are_refused_in_one_line(changes, words):
    with pytest.raises(InputError) as refused:
        load(SMOOTH).replace(changes)
    assert words in str(refused.value)

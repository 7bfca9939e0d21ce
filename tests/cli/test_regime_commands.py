"""The commands `regime` and `adhesion-map`, and the adhesion law that the program chooses."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path

import numpy as np
import pytest

import asperity
from asperity import solver
from asperity.config import Case
from asperity.config.resolve import resolve
from asperity.plots import adhesion_map
from asperity.regimes import Frame, Place
from asperity.results.read_record import read
from commands import answered, assert_narrow, assert_one_line, call, names, refused

EXAMPLES = Path(__file__).parents[2] / "examples"
BOUNCE = str(EXAMPLES / "jkr-bounce.toml")


def smooth(**changes: object) -> Case:
    """The bouncing polystyrene sphere with other values."""
    dotted = {key.replace("__", "."): value for key, value in changes.items()}
    return asperity.load(BOUNCE).replace(dotted)


def written(name: str, case: Case) -> str:
    Path(name).write_text(case.toml(), encoding="utf-8")
    return name


def test_regime_gives_the_publications_numbers():
    """Its mu = 0.02, lambda = 0.0235; Kelvin radius of water at 60 %, summits 7.69 nm apart."""
    built_in = answered("regime", "published-exact")
    numbers = built_in["regime"]
    assert round(numbers["tabor_number"]["value"], 2) == 0.02
    assert numbers["elasticity_parameter"]["value"] == pytest.approx(0.0235, rel=0.02)
    assert numbers["kelvin_radius"] == {
        "value": pytest.approx(1.054e-9, rel=1e-3),
        "unit": "m",
        "verdict": "3.8 molecules of 0.28 nm",
    }
    ratio = numbers["kelvin_radius_over_spacing"]["value"]
    assert ratio == pytest.approx(1.054e-9 * math.sqrt(1.69e16), rel=1e-3)
    assert numbers["liquid_regime"]["value"] == "pendular"
    assert numbers["adhesion_law"] == {"value": "dmt", "unit": "", "verdict": "as the case says"}
    assert any("the plasticity index is 40.9" in warning for warning in built_in["warnings"])
    assert any("asperities are expected to touch" in warning for warning in built_in["warnings"])


@pytest.mark.parametrize("limit", [None, "1 ns"])
@pytest.mark.parametrize(("time", "slow"), [("1 us", False), ("1 ms", True)])
def test_regime_warns_of_slow_menisci_as_a_run_does_whatever_its_time_limit(time, slow, limit):
    """On a rigid plane, from above the reach of all forces; the first contact lasts 10.5 us."""
    case = asperity.load("published-exact").replace(
        {"counterface.deformation": "rigid", "impact.release_separation": "2 um",
         "capillary.formation_time": time, "numerics.time_limit": limit,
         "numerics.max_impacts": 1}
    )  # fmt: skip
    for found in (solver.assess(case), asperity.solve(case, critical=False)):
        assert any("menisci take" in warning for warning in found.warnings) is slow


def test_menisci_of_a_smooth_sphere_that_take_longer_than_its_contact_are_slow():
    """A sphere of 1 um, some 8 nm deep at about 0.9 m/s: in and out take about 19 ns."""
    water = {"model": "equilibrium", "liquid": "water", "humidity": 0.6, "temperature": "20 degC",
             "contact_angle": "40 deg"}  # fmt: skip
    for time, slow in (("10 ns", False), ("30 ns", True)):
        wet = {"capillary": water | {"formation_time": time}}
        case = smooth(**wet, body__radius="1 um", impact__speed="0.864 m/s")
        found = solver.assess(case).warnings
        assert any("menisci take" in warning for warning in found) is slow


def test_regime_finds_the_load_of_the_run_it_stands_for():
    shown = answered("regime", BOUNCE)["regime"]
    run = asperity.solve(asperity.load(BOUNCE), critical=False).regime
    for name in ("tabor_number", "elasticity_parameter", "load_parameter", "plasticity_index"):
        assert shown[name]["value"] == run[name]


def test_load_of_a_fast_smooth_sphere_is_that_of_hertzs_impact():
    """Energy m v^2/2 = (8/15) E* sqrt(R) delta^2.5, force (4/3) E* sqrt(R) delta^1.5."""
    case = smooth(adhesion__model="dmt", impact__speed="50 m/s")
    shown = answered("regime", written("fast.toml", case))["regime"]
    first, second = resolve(case).body, resolve(case).counterface
    modulus = asperity.materials.contact_modulus(first, second)
    radius, work = case.body.radius, case.adhesion.work
    energy = 0.5 * resolve(case).body.density * 4.0 / 3.0 * math.pi * radius**3 * 50.0**2
    depth = (15.0 / 8.0 * energy / (modulus * math.sqrt(radius))) ** 0.4
    force = 4.0 / 3.0 * modulus * math.sqrt(radius) * depth**1.5
    expected = force / (math.pi * work * radius)
    assert shown["load_parameter"]["value"] == pytest.approx(expected, rel=2e-2)


def test_a_number_that_does_not_apply_is_a_dash_with_its_reason():
    ran = call("regime", BOUNCE)
    assert ran.exit_code == 0, ran.output
    assert names() == []
    assert_narrow(ran.stdout)
    shown = dict(line[2:].split("  ", 1) for line in ran.stdout.splitlines() if "  -  " in line)
    assert shown["plasticity index"].split(maxsplit=1) == ["-", "the body is smooth"]
    assert shown["Kelvin radius"].split(maxsplit=1) == ["-", "no menisci: dry"]
    found = answered("regime", BOUNCE)["regime"]
    assert found["plasticity_index"]["value"] is None


@pytest.mark.parametrize("command", ["regime", "adhesion-map"])
@pytest.mark.parametrize("change", [("radius", "radios"), ('model = "jkr"', 'model = "jrk"'), None])
def test_errors_are_those_of_a_run(command, change):
    if change is not None:
        text = Path(BOUNCE).read_text(encoding="utf-8")
        Path("case.toml").write_text(text.replace(*change), encoding="utf-8")
    assert refused(command, "case.toml") == refused("run", "case.toml")


def test_a_release_inside_contact_is_refused_as_by_a_run():
    low = asperity.load("published-exact").replace({"impact.release_separation": "40 nm"})
    said = refused("run", written("low.toml", low))
    assert "release_separation" in said
    assert refused("regime", "low.toml") == said


@pytest.fixture(scope="module")
def auto() -> Case:
    """A stiff sphere whose law the program chooses: DMT, near the border to Bradley."""
    return asperity.load("published-exact").replace(
        {"adhesion.model": "auto", "roughness": None, "capillary": None, "body.radius": "1 nm",
         "adhesion.work": "15 mJ/m^2",
         "impact": {"speed": "10 m/s", "gravity": "0 m/s^2"}}
    )  # fmt: skip


def test_a_chosen_law_gives_the_motion_of_the_law_named_and_says_where_a_border_is_near(auto):
    chosen = asperity.solve(auto, critical=False)
    named = asperity.solve(auto.replace({"adhesion.model": "dmt"}), critical=False)
    assert chosen.regime["adhesion_law"] == named.regime["adhesion_law"] == "dmt"
    assert chosen.measures == named.measures
    assert "0.0206 < 0.1" in chosen.regime["adhesion_reason"]
    assert named.regime["adhesion_reason"] is None
    (warning,) = [text for text in chosen.warnings if "border" in text]
    for part in ("0.0239", "Bradley and DMT", "0.0201", "5 %", "'bradley'"):
        assert part in warning
    assert not any("border" in text for text in named.warnings)


@pytest.mark.usefixtures("undrawn")
def test_record_terminal_and_summary_say_why_the_law_was_chosen(auto, place):
    ran = call("run", written("auto.toml", auto), "-o", "first")
    assert ran.exit_code == 0, ran.output
    for text in (ran.stdout, (place / "first" / "summary.txt").read_text()):
        joined = " ".join(text.split())
        assert "Adhesion law chosen: DMT. Tabor number 0.0206 < 0.1" in joined
        assert_narrow(text)
    record = read("first/record.nc")
    assert record.case == auto
    assert record.case.adhesion.model == "auto"
    assert record.regime["adhesion_law"] == "dmt"
    assert record.regime["adhesion_reason"]
    assert call("run", "first/record.nc", "-o", "second").exit_code == 0
    for name in ("record.nc", "summary.txt"):
        assert (place / "first" / name).read_bytes() == (place / "second" / name).read_bytes()


@pytest.mark.parametrize(
    ("radius", "speed", "law"), [("1 um", "2 m/s", "jkr"), ("1 nm", "50 m/s", "maugis")]
)
def test_a_soft_sphere_is_chosen_jkr_and_a_smaller_one_maugis(radius, speed, law):
    """mu grows with R^(1/3): 5.1 at 1 um, 0.51 at 1 nm."""
    case = smooth(adhesion__model="auto", body__radius=radius, impact__speed=speed)
    assert solver.assess(case).regime.adhesion_law == law


def test_a_weakly_adhering_tip_is_chosen_bradley(auto):
    """mu grows with w^(2/3): 0.0062 at 2.5 mJ/m^2."""
    weak = auto.replace({"adhesion.work": "2.5 mJ/m^2"})
    assert solver.assess(weak).regime.adhesion_law == "bradley"


def test_the_map_is_a_picture_twice_and_a_table(place):
    ran = call("adhesion-map", BOUNCE, written("slow.toml", smooth(impact__speed="0.05 m/s")))
    assert ran.exit_code == 0, ran.output
    assert names(place) == ["adhesion-map.csv", "adhesion-map.png", "adhesion-map.svg", "slow.toml"]
    assert (place / "adhesion-map.png").read_bytes().startswith(b"\x89PNG")
    assert ">slow<" in (place / "adhesion-map.svg").read_text()
    text = (place / "adhesion-map.csv").read_text().splitlines()
    rows = list(csv.DictReader(io.StringIO("\n".join(text[1:]))))
    load = {row["series"]: float(row["load parameter [1]"]) for row in rows}
    assert load["case slow"] < load["case jkr-bounce"]
    assert {"Hertz | adhesive", "Bradley | DMT", "Maugis-Dugdale | JKR"} < set(load)


def test_the_maps_json_places_a_case_by_the_numbers_of_its_regime(place):
    found = answered("adhesion-map", BOUNCE)
    numbers = answered("regime", BOUNCE)["regime"]
    (case,) = found["cases"]
    assert case["elasticity_parameter"] == numbers["elasticity_parameter"]["value"]
    assert case["load_parameter"] == numbers["load_parameter"]["value"]
    assert (case["region"], case["adhesion_law"]) == ("JKR", "jkr")
    assert len(found["boundaries"]) == 4
    assert names(place) == []


def test_an_earlier_map_is_kept_unless_forced(place):
    Path("map.csv").write_text("mine")
    assert_one_line(refused("adhesion-map", BOUNCE, "-o", "map.png"), "map.csv", "--force")
    assert call("adhesion-map", BOUNCE, "-o", "map.png", "--force").exit_code == 0
    assert names(place) == ["map.csv", "map.png", "map.svg"]
    assert Path("map.csv").read_text() != "mine"


def test_the_maps_file_must_be_a_png():
    said = refused("adhesion-map", BOUNCE, "-o", "map.pdf")
    assert "map.pdf: must end in .png; got '.pdf'" in said


@pytest.mark.parametrize(
    ("changes", "parts"),
    [
        ({"adhesion": None}, ("adhesion.model", "got 'none'")),
        ({"adhesion.equilibrium_spacing": None}, ("adhesion.equilibrium_spacing", "must be given")),
    ],
)
def test_a_case_without_a_place_is_refused_with_what_it_lacks(changes, parts):
    written("bare.toml", asperity.load(BOUNCE).replace(changes))
    assert_one_line(refused("adhesion-map", BOUNCE, "bare.toml"), "bare.toml", *parts)


def test_cases_of_one_name_are_told_apart():
    Path("soft").mkdir()
    written("soft/drop.toml", smooth())
    written("drop.toml", smooth(impact__speed="0.3 m/s"))
    found = answered("adhesion-map", "drop.toml", "soft/drop.toml")
    assert [case["name"] for case in found["cases"]] == ["drop.toml", "soft/drop.toml"]


def scattered(seed: int) -> list[Place]:
    """One to six cases, half of them close together, some off the map."""
    chance = np.random.default_rng(seed)
    count = 1 + seed % 6
    middle = chance.uniform((-3.0, -1.0), (2.0, 5.0))
    spread = np.where(chance.random((count, 1)) < 0.5, 0.1, 4.0)
    logs = middle + spread * chance.standard_normal((count, 2))
    return [Place(f"case-number-{k}", *(10.0**pair)) for k, pair in enumerate(logs)]


CROWDS = {
    "all in one place": [Place(f"published-exact-{k}", 0.0239, 7e3) for k in range(6)],
    "all on a region's name": [Place(f"published-exact-{k}", 0.6, 6.0) for k in range(6)],
    "all off one corner": [Place(f"published-exact-{k}", 1e9, 1e30) for k in range(6)],
    "untouched": [Place("never", 0.02, math.nan)],
    "long": [Place("a case with a name " * 5, 50.0, 1e3)],
    **{f"scattered {seed}": scattered(seed) for seed in range(6)},
}


@pytest.mark.parametrize("crowd", CROWDS)
def test_no_name_on_the_map_lies_on_another_or_on_a_mark(crowd):
    places = CROWDS[crowd]
    frame = Frame.around(places)
    figure = adhesion_map.figure(frame, frame.boundaries(), places)
    figure.canvas.draw()
    (axes,) = figure.axes
    assert len(axes.texts) == len(adhesion_map.REGIONS) + len(places)
    boxes = [text.get_window_extent() for text in axes.texts]
    for number, box in enumerate(boxes):
        assert not any(box.overlaps(other) for other in boxes[number + 1 :])
        assert axes.bbox.x0 <= box.x0
        assert box.x1 <= axes.bbox.x1
        assert axes.bbox.y0 <= box.y0
        assert box.y1 <= axes.bbox.y1
    marks = [line for line in axes.lines if line.get_marker() != "None"]
    assert len(marks) == len(places)
    for mark in marks:
        spot = axes.transAxes.transform(mark.get_xydata()[0])
        assert not any(box.contains(*spot) for box in boxes)


def test_a_case_off_the_map_is_an_arrow_at_its_edge():
    frame = Frame.around([far := Place("far", 0.1, 1e30)])
    figure = adhesion_map.figure(frame, frame.boundaries(), [far])
    (mark,) = [line for line in figure.axes[0].lines if line.get_marker() != "None"]
    assert mark.get_marker() == "^"
    assert mark.get_ydata()[0] == 1.0

"""Single bodies of a case: from its text to probabilities, files and pictures."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import asperity
from asperity.cli import app
from asperity.config import load
from asperity.config.resolve import resolve
from asperity.dynamics.summit_path import Launch
from asperity.errors import InputError
from asperity.interface.summit_field import MeasuredField, SampledField
from asperity.model import build
from asperity.single_bodies import SingleBodies, launching

CASE = """
[body]
material = "silica"
radius = "25 um"
[counterface]
material = "silicon carbide"
deformation = "rigid"
[roughness]
asperity_density = "6.3e13 1/m^2"
asperity_radius = "450 nm"
rms_height = "1.64 nm"
placement = "random"
realisations = 256
seed = 3
[adhesion]
model = "dmt"
work = "50 mJ/m^2"
equilibrium_spacing = "0.3 nm"
[capillary]
model = "equilibrium"
liquid = "water"
humidity = 0.5
contact_angle = "20 deg"
temperature = "20 degC"
[impact]
speed = "3 mm/s"
[numerics]
max_impacts = 5
"""
PLACED = 'placement = "random"\nrealisations = 256\nseed = 3\n'
OPEN = CASE.replace(PLACED, "")
"""The mean over all bodies, with single ones beside it where it is not enough."""


@pytest.fixture(scope="module")
def result():
    return asperity.solve(load(CASE), critical=False)


def bodies_of(text=CASE):
    problem = build(resolve(load(text)))
    return problem, SingleBodies(problem, 2e-9)


def launches(problem, count, speed=3e-3):
    energy = 0.5 * float(problem.body.mass) * speed**2
    return Launch(np.full(count, energy), np.full(count, np.inf))


def test_a_run_answers_with_the_probability_of_capture(result):
    found = result.realisations
    assert found.size == 256
    low, high = found.capture_interval
    assert low < found.capture_probability < high
    # Of a hundred thousand others 63.87 %.
    assert found.capture_probability == pytest.approx(0.6387, abs=4.0 * np.sqrt(0.23 / 256))
    assert f"{100 * found.capture_probability:.3g} % are captured" in result.summary()
    assert "no verdict" not in result.summary()
    assert "Mean field: The" in " ".join(result.summary().split())
    assert set(found.lost) == {"capillary"}


def test_a_body_falls_until_something_carries_it(result):
    """Every body turns on a summit at least, where the mean field expects 1.5."""
    assert result.realisations.values["contacting"].min() >= 1.0
    assert result.regime["contacting_asperities"] == pytest.approx(1.475, abs=0.01)
    assert result.realisations.quantiles("pull_off")[1] > 5.0 * result.measures["pull_off"]


def test_the_first_body_stands_on_its_summits(result):
    """Where they are, their heights and its turning point make their gaps."""
    first, values = result.realisations.first, result.realisations.values
    assert np.sum(first["gap"] < 0.0) == values["contacting"][0]
    offsets = values["closest_approach"][0] - first["gap"]
    heights = offsets + (first["x"] ** 2 + first["y"] ** 2) / (2.0 * 25e-6)
    assert np.all(np.abs(heights) < 6.0 * 1.64e-9)


def test_a_record_holds_every_body(result, tmp_path: Path):
    result.save(tmp_path)
    again = asperity.read(tmp_path / "record.nc").realisations
    np.testing.assert_array_equal(again.captured, result.realisations.captured)
    for name, values in result.realisations.values.items():
        np.testing.assert_array_equal(again.values[name], values)
    np.testing.assert_array_equal(again.lost["capillary"], result.realisations.lost["capillary"])
    for name, values in result.realisations.first.items():
        np.testing.assert_array_equal(again.first[name], values)
    for name in ("bodies", "summits"):
        assert (tmp_path / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    assert result.dataset()["body_restitution"].dims == ("realisation",)


def test_the_same_seed_gives_the_same_bodies_in_any_number_and_order():
    problem, bodies = bodies_of()
    few = bodies.impacts(launches(problem, 40))
    bodies.impacts(launches(problem, 300, 20e-3))  # which meet more summits
    many = bodies.impacts(launches(problem, 300))
    np.testing.assert_allclose(few.restitution, many.restitution[:40], rtol=1e-12)
    other = bodies_of(CASE.replace("seed = 3", "seed = 4"))[1].impacts(launches(problem, 40))
    assert np.any(np.asarray(other.closest_approach) != np.asarray(few.closest_approach))


def beside(text):
    """What a text gives without its critical velocity, with single bodies where they belong."""
    return asperity.solve(load(text), critical=False, beside=True)


def of_few(result):
    """What it says of the few asperities that are expected to touch."""
    return [line for line in result.warnings if "expected to touch" in line]


def test_single_bodies_stand_beside_a_mean_of_few_asperities():
    result = beside(OPEN)
    assert result.regime["loaded_asperities"] < 1.0
    assert result.realisations.size == 256
    assert "rebounds" not in result.realisations.values
    assert "Of single bodies" in result.summary().split("Regime")[0]
    assert of_few(result) == []


def test_a_mean_stands_alone_where_it_is_asked_for_or_enough():
    alone = beside(OPEN.replace("[adhesion]", 'placement = "mean"\n[adhesion]'))
    assert alone.realisations is None
    (line,) = of_few(alone)
    assert "asperity run" not in line
    (line,) = of_few(asperity.solve(load(OPEN), critical=False))
    assert line.endswith("`asperity run` has single bodies beside it")
    fast = beside(OPEN.replace("3 mm/s", "60 mm/s"))
    assert fast.regime["loaded_asperities"] > 3.0
    assert fast.realisations is None
    assert of_few(fast) == []


def test_a_mean_says_why_no_single_bodies_stand_beside_it(monkeypatch):
    monkeypatch.setattr(launching, "MOST_SUMMITS", 2)
    result = beside(OPEN)
    assert result.realisations is None
    assert "there are no single bodies beside this mean: single bodies" in result.warnings[-1]
    assert not [line for line in result.warnings if "`asperity run`" in line]


def crowded(times, speed):
    """With so many times the summits."""
    return OPEN.replace("6.3e13", f"{6.3e13 * times}").replace("3 mm/s", speed)


def test_they_stand_beside_a_mean_that_is_close_to_capture_however_many_carry_it():
    result = beside(crowded(10, "9.5 mm/s"))
    assert result.regime["loaded_asperities"] > 5.0
    assert result.measures["restitution"][0] > 0.6
    assert result.realisations.capture_probability > 0.2


@pytest.mark.parametrize(("times", "speed"), [(1, "12 mm/s"), (40, "30 mm/s")])
def test_they_do_not_where_it_is_off_by_less_than_five_per_cent(times, speed):
    """By how much it is off, `validation/test_single_bodies_and_their_mean.py` tells."""
    assert beside(crowded(times, speed)).realisations is None


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('placement = "random"\n', "", "`realisations` must be absent without placement"),
        ("seed = 3", "seed = 1.5", "`seed` must be a whole number"),
        ("seed = 3", "seed = -1", "`seed` must"),
        ("realisations = 256", "realisations = 0", "`realisations` must"),
        (
            '"equilibrium"',
            '"kelvin-filling"\nsurface_rms_height = "2 nm"',
            "`model` must not be 'kelvin-filling'",
        ),
        ('"random"', '"strewn"', "`placement` must be"),
        (
            '"rigid"',
            '"half-space"\n[viscoelasticity]\nmodel = "standard-linear-solid"\n'
            'relaxed_modulus_ratio = 0.5\nrelaxation_time = "1 ms"',
            "[viscoelasticity] must be absent with single bodies",
        ),
    ],
)
def test_what_single_bodies_do_not_have_is_refused(old, new, words):
    with pytest.raises(InputError) as told:
        load(CASE.replace(old, new))
    assert words in str(told.value)


LATE = CASE.replace("[capillary]", '[capillary]\nformation_time = "1 us"')


def test_menisci_that_take_longer_than_bodies_touch_capture_none():
    """The mean, whose few summits carry it longer, still loses a sixth; so are its rebounds."""
    slow = asperity.solve(load(LATE), critical=False)
    bodies = slow.realisations
    assert slow.measures["restitution"][0] < 0.95
    assert bodies.capture_probability == 0.0
    assert np.max(bodies.lost["capillary"]) == 0.0
    assert np.all(np.isinf(bodies.values["rebounds"]))
    faster = asperity.solve(load(LATE.replace("1 us", "100 ns")), critical=False).realisations
    assert faster.capture_probability > 0.6


def test_single_bodies_stand_beside_a_mean_whose_menisci_take_time():
    result = beside(LATE.replace(PLACED, ""))
    assert result.realisations.size == 256
    assert result.realisations.capture_probability == 0.0


def test_menisci_that_take_time_are_refused_on_a_half_space():
    with pytest.raises(InputError, match="`formation_time` must be absent with single") as told:
        load(LATE.replace('"rigid"', '"half-space"'))
    assert told.value.key == "capillary.formation_time"


def test_summits_under_menisci_that_take_time_are_counted(monkeypatch):
    monkeypatch.setattr(launching, "MOST_DELAYED", 3)
    with pytest.raises(InputError, match=r"up to 3 summits each that feel a force; here \d"):
        asperity.solve(load(LATE), critical=False)


def test_too_many_summits_are_refused_with_their_number(monkeypatch):
    monkeypatch.setattr(launching, "MOST_SUMMITS", 3)
    with pytest.raises(InputError, match=r"up to 3 summits each that feel a force; here \d"):
        asperity.solve(load(CASE), critical=False)


def test_summits_too_few_to_carry_most_bodies_are_refused():
    few = "6.3e13 1/m^2", "1e11 1/m^2"
    with pytest.raises(InputError, match=r"92\.6 % would meet none above -4\.92 nm") as told:
        bodies_of(CASE.replace(*few))
    assert told.value.key == "roughness.asperity_density"
    alone = beside(OPEN.replace(*few))
    assert alone.realisations is None
    assert "no single bodies beside this mean: single bodies need summits" in alone.warnings[-1]


def test_bodies_that_come_deeper_than_summits_stand_are_counted():
    """At least a share exp(-n), with n that stand under a body on average: these meet none."""
    found = asperity.solve(load(CASE.replace("6.3e13", "1.5e12")), critical=False)
    under = 2.0 * np.pi * 25e-6 * 1.5e12 * 1.64e-9 * 3.00038
    sunk = int(np.sum(found.realisations.values["closest_approach"] < -3.0 * 1.64e-9))
    assert np.exp(-under) - 0.08 < sunk / 256 < 0.7
    (line,) = [line for line in found.warnings if "come deeper than -4.92 nm" in line]
    assert line.startswith(f"{sunk} of 256 single bodies")


def test_a_seed_is_an_axis_of_a_study(result):
    """Each case has the numbers of its run; where it has no single bodies, none."""
    keep = ["captured", "capture_probability", "capture_probability_high", "median_pull_off"]
    found = asperity.sweep(load(CASE), {"roughness.seed": [3, 4]}, keep=keep)
    first, second = found["capture_probability"].values
    assert first == result.realisations.capture_probability
    assert abs(second - 0.6387) < 4.0 * np.sqrt(0.23 / 256)
    assert second != first
    high = result.realisations.capture_interval[1]
    assert float(found["capture_probability_high"][0]) == high
    assert float(found["median_pull_off"][0]) == pytest.approx(
        result.realisations.quantiles("pull_off")[1], rel=1e-9
    )
    both = asperity.sweep(load(OPEN), {"roughness.placement": ["mean", "random"]}, keep=keep)
    assert np.isnan(both["capture_probability"].values[0])
    assert both["capture_probability"].values[1] > 0.5
    assert np.array_equal(both["captured"].values, [0, 0])


def test_a_study_whose_single_bodies_cannot_be_launched_says_why(monkeypatch):
    monkeypatch.setattr(launching, "MOST_SUMMITS", 3)
    found = asperity.sweep(load(CASE), {"impact.speed": [1e-3, 2e-3]}, keep=["capture_probability"])
    assert found.attrs["failed"] == 2
    assert "up to 3 summits each that feel a force" in str(found["reason"].values[0])


def test_a_study_keeps_measures_of_single_bodies_where_it_has_some():
    with pytest.raises(InputError, match="`keep` must name a measure of single bodies, such as"):
        asperity.sweep(load(CASE), {"impact.speed": [1e-3, 2e-3]})
    with pytest.raises(InputError, match="`keep` must not name 'capture_probability' without"):
        asperity.sweep(load(OPEN), {"impact.speed": [1e-3, 2e-3]}, keep=["capture_probability"])


def test_a_release_on_a_summit_is_refused():
    problem, bodies = bodies_of()
    low = launches(problem, 256)._replace(release=np.full(256, 4e-9))
    with pytest.raises(InputError, match="must lie above the highest summit of every single body"):
        bodies.impacts(low)


def test_a_curve_says_that_it_is_the_mean():
    curve = asperity.curve(load(CASE), load=1e-6)
    assert "this is the mean over all bodies" in curve.warnings[-1]


def test_restitution_draws_the_share_that_is_captured(tmp_path: Path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("case.toml").write_text(CASE)
    speeds = "1 mm/s, 10 mm/s"
    asked = ["restitution", "case.toml", "--speeds", speeds, "--points", "7"]
    ran = CliRunner().invoke(app, asked)
    assert ran.exit_code == 0, ran.output
    told = json.loads(Path("case-out/restitution.json").read_text())["single_bodies"]
    share = np.array(told["probability"])
    assert share[0] == 1.0
    assert share[-1] == 0.0
    assert np.all(np.array(told["low"]) <= share)
    assert np.all(share <= told["high"])
    low, high = told["half_interval"]
    assert 2e-3 < low <= told["half_velocity"] <= high < 6e-3
    assert "half are captured at" in ran.output
    table = np.genfromtxt("case-out/restitution.csv", delimiter=",", skip_header=1)
    np.testing.assert_array_equal(table[:, 3], share)
    np.testing.assert_array_equal(table[:, 6], told["mean"])
    assert np.all(table[:, 6] <= 1.0 - share + 1e-12)  # each rebound keeps less than all


def test_rebounds_follow_one_another_as_impacts_do(result):
    """Bodies captured at their second impact flew for as long as their first one lets them."""
    rebounds, flight = (result.realisations.values[name] for name in ("rebounds", "flight_time"))
    np.testing.assert_array_equal(rebounds == 0.0, result.realisations.captured)
    problem, _ = bodies_of()
    mass, weight = float(problem.body.mass), float(problem.body.weight)
    once = np.flatnonzero(rebounds == 1.0)
    assert once.size > 20
    energy = result.realisations.values["restitution"][once] ** 2 * 0.5 * mass * 3e-3**2
    speed = np.sqrt(2.0 * energy / mass)
    # The fall from the release adds 2 % to the speed.
    np.testing.assert_allclose(flight[once], 2.0 * speed * mass / weight, rtol=0.03)


def test_without_weight_a_body_leaves_for_good():
    text = CASE.replace('speed = "3 mm/s"', 'speed = "3 mm/s"\ngravity = "0 m/s^2"')
    found = asperity.solve(load(text), critical=False).realisations
    assert set(found.values["rebounds"]) == {0.0, np.inf}
    assert f"{100 * found.capture_probability:.3g}" not in ("0", "100")


@pytest.fixture(scope="module")
def map_file(tmp_path_factory):
    """A map that is wide enough for bodies of 10 um to be put down on it."""
    file = tmp_path_factory.mktemp("maps") / "wide.nc"
    shape = ["--rms-height", "2 nm", "--roll-off", "1 um", "--cut-off", "150 nm", "--points", "256"]
    ran = CliRunner().invoke(app, ["generate", str(file), "--size", "6 um x 6 um", *shape])
    assert ran.exit_code == 0, ran.output
    return file


def on_map(file, placement):
    numbers = CASE[CASE.index("asperity_density") : CASE.index("realisations")]
    given = f'files = ["{file}"]\nsource = "summits"\nplacement = "{placement}"\n'
    return CASE.replace(numbers, given).replace("25 um", "10 um").replace("3 mm/s", "10 mm/s")


def test_measured_summits_are_drawn_with_their_radii_or_left_where_they_are(map_file: Path):
    """Every body meets some of them, at other depths where they stand as they do on the map."""
    found = {}
    for placement in ("random", "measured"):
        text = on_map(map_file, placement)
        result = asperity.solve(load(text), critical=False)
        found[placement] = result.realisations.values
        assert result.realisations.values["contacting"].min() >= 1.0
    random, measured = (found[name]["closest_approach"] for name in ("random", "measured"))
    assert np.std(measured) == pytest.approx(np.std(random), rel=0.5)
    assert not np.any(random == measured)


def test_where_a_map_is_given_and_the_rest_left_open_bodies_stand_on_it(map_file: Path):
    """At random places where the map is too small, and that is said."""
    kinds = []
    for radius in ("10 um", "1 mm"):
        given = 'placement = "measured"\nrealisations = 256\nseed = 3\n'
        text = on_map(map_file, "measured").replace(given, "")
        problem = build(resolve(load(text.replace("10 um", radius))))
        bodies = SingleBodies(problem._replace(inputs=problem.inputs.with_bodies()), 2e-9)
        kinds.append((type(bodies.field), bodies.note[:47]))
    assert kinds == [
        (MeasuredField, ""),
        (SampledField, "single bodies stand on summits at random places"),
    ]


def test_a_map_smaller_than_the_summits_within_range_is_refused(map_file: Path):
    text = on_map(map_file, "measured").replace("10 um", "1 mm")
    with pytest.raises(InputError, match=r"the map is smaller than the summits within range"):
        bodies_of(text)


def test_summits_of_a_map_yield_where_they_are(map_file: Path):
    """Each with its own radius; the harder they are, the less they keep."""
    text = on_map(map_file, "measured").replace('source = "summits"\n', "")
    kept = []
    for hardness in ("2 GPa", "3 GPa"):
        given = f'\n[plasticity]\nmodel = "kogut-etsion"\nhardness = "{hardness}"\n'
        problem, bodies = bodies_of(text + given)
        found = bodies.impacts(launches(problem, 64, 20e-3))
        free = ~found.captured
        assert np.sum(free) > 8
        lost = found.lost[free] / found.impact_energy[free, None]
        np.testing.assert_allclose(1.0 - found.restitution[free] ** 2, lost.sum(axis=1), atol=1e-8)
        kept.append(np.mean(found.lost[:, -1] / found.impact_energy))
    assert kept[0] > max(0.01, 2.0 * kept[1])


def test_measured_places_need_a_map():
    with pytest.raises(InputError, match="`placement` must be 'random' without `files`"):
        load(CASE.replace('"random"', '"measured"'))


IN_AIR = """release_separation = "1 um"
gravity = "0 m/s^2"
[gas]
name = "air"
pressure = "1 bar"
temperature = "20 degC"
[numerics]"""


def test_single_bodies_stand_beside_no_mean_that_gas_stops():
    """The film alone decides, and it is the same for all; asked for, they stand still too."""
    still = OPEN.replace("25 um", "2 um").replace("[numerics]", IN_AIR)
    result = beside(still)
    assert result.outcome is asperity.Outcome.STOPPED
    assert result.realisations is None
    asked = beside(
        still.replace("[adhesion]", 'placement = "random"\nrealisations = 32\n[adhesion]')
    )
    assert asked.realisations.capture_probability == 0.0
    assert not asked.realisations.values["restitution"].any()
    assert np.isinf(asked.realisations.values["rebounds"]).all()

"""The publication's ten decrements and stiction times, with one set of inputs."""

import csv
from pathlib import Path

import pytest

import asperity
from asperity.studies.comparison import mean_power_loss
from asperity.studies.tables import read_tables

FILE = Path(__file__).parents[1] / "data" / "publication_tables.csv"


def rows():
    lines = [line for line in FILE.read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


@pytest.fixture(scope="module")
def motions():
    case = asperity.load("published")
    out = {}
    for row in rows():
        surface = row["asperity_radius_nm"], row["rms_height_nm"]
        changes = {
            "roughness.asperity_radius": f"{surface[0]} nm",
            "roughness.rms_height": f"{surface[1]} nm",
        }
        out[surface] = asperity.solve(case.replace(changes))
    return out


@pytest.mark.parametrize("row", rows(), ids=lambda r: f"{r['table']}-{r['asperity_radius_nm']}")
def test_decrements_within_3_and_stiction_times_within_5_percent(motions, row):
    measures = motions[row["asperity_radius_nm"], row["rms_height_nm"]].measures
    decrement, time = measures["log_decrement"][0], measures["stiction_time"]
    assert decrement == pytest.approx(float(row["log_decrement"]), rel=0.03)
    assert time * 1e6 == pytest.approx(float(row["stiction_time_us"]), rel=0.05)


def test_power_loss_of_the_first_impact_is_some_two_and_a_half_times_the_published_one(motions):
    """Published over computed 0.35 to 0.41: not explained."""
    for row in rows():
        found = motions[row["asperity_radius_nm"], row["rms_height_nm"]]
        published = float(row["power_loss_1e-4_nW"]) * 1e-13
        assert 0.34 < published / found.measures["power_loss"][0] < 0.42


def test_power_loss_has_the_published_trend(motions):
    """More with the asperities' radius, less with their rms height."""
    by_radius = [mean_power_loss(motions[r, "10.5"]) for r in ("0.20", "0.25", "0.30")]
    by_height = [mean_power_loss(motions["0.25", h]) for h in ("9.0", "10.5", "12.0")]
    assert by_radius == sorted(by_radius)
    assert by_height == sorted(by_height, reverse=True)


def test_the_package_holds_the_same_tables():
    ours = [(e.table, *(round(x * 1e9, 6) for x in e.surface), e.values["log_decrement"])
            for e in read_tables()]  # fmt: skip
    theirs = [
        (int(r["table"]), float(r["asperity_radius_nm"]), float(r["rms_height_nm"]),
         float(r["log_decrement"]))
        for r in rows()
    ]  # fmt: skip
    assert ours == theirs

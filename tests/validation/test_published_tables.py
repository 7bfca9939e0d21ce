"""The publication's ten decrements and stiction times, with one set of inputs."""

import csv
from functools import cache
from pathlib import Path

import asperity
from asperity.publication.comparison import mean_power_loss
from asperity.publication.published_tables import read_tables
from figures import Figure, misses

FILE = Path(__file__).parents[1] / "data" / "publication_tables.csv"


def rows():
    lines = [line for line in FILE.read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


@cache
def motion(radius, height):
    """The case `published` on asperities of a radius and a rms height, both [nm]."""
    changes = {
        "roughness.asperity_radius": f"{radius} nm",
        "roughness.rms_height": f"{height} nm",
    }
    return asperity.solve(asperity.load("published").replace(changes), critical=False)


def compared(row):
    """A row's decrement and stiction time, with the assumptions of the case `published`."""
    surface = row["asperity_radius_nm"], row["rms_height_nm"]
    measures = motion(*surface).measures
    decrement, time = measures["log_decrement"][0], measures["time_to_rest"] * 1e6
    problem = f"published case, beta {surface[0]} nm, rms {surface[1]} nm"
    source = "the publication, Tables 2 and 3"
    known = float(row["log_decrement"]), float(row["time_to_rest_us"])
    return (
        Figure(f"{problem}: decrement", source, known[0], decrement, "", 0.03),
        Figure(f"{problem}: stiction time", source, known[1], time, "us", 0.05),
    )


def figures():
    return [figure for row in rows() for figure in compared(row)]


def test_decrements_within_3_and_times_to_rest_within_5_percent():
    assert misses(figures()) == []


def test_power_loss_of_the_first_impact_is_some_two_and_a_half_times_the_published_one():
    """Published over computed 0.35 to 0.41: not explained."""
    for row in rows():
        found = motion(row["asperity_radius_nm"], row["rms_height_nm"])
        published = float(row["power_loss_1e-4_nW"]) * 1e-13
        assert 0.34 < published / found.measures["power_loss"][0] < 0.42


def test_power_loss_has_the_published_trend():
    """More with the asperities' radius, less with their rms height."""
    by_radius = [mean_power_loss(motion(r, "10.5")) for r in ("0.20", "0.25", "0.30")]
    by_height = [mean_power_loss(motion("0.25", h)) for h in ("9.0", "10.5", "12.0")]
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

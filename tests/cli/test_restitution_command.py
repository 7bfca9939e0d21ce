"""``asperity restitution`` and ``curve --load``: what they answer, write and refuse."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

import asperity
from asperity.results.read_record import read
from commands import answered, call, refused
from jkr_spheres import CRITICAL, SMOOTH, smooth

FILES = [f"restitution.{kind}" for kind in ("csv", "json", "png", "svg", "txt")]


@pytest.fixture(autouse=True)
def cases(place: Path) -> None:
    """A folder with two cases: a sphere by JKR, and the same without an [impact] table."""
    for name in ("drop.toml", "other.toml"):
        Path(name).write_text(SMOOTH)
    Path("still.toml").write_text(SMOOTH[: SMOOTH.index("[impact]")])


def test_restitution_is_a_table_a_picture_and_json(place):
    ran = call("restitution", "drop.toml", "--points", "7")
    assert ran.exit_code == 0, ran.output
    assert f"critical velocity         {CRITICAL * 1e3:.4g} mm/s" in ran.stdout
    assert sorted(path.name for path in (place / "drop-out").iterdir()) == FILES
    table = np.genfromtxt(place / "drop-out" / "restitution.csv", delimiter=",", skip_header=1)
    found = json.loads((place / "drop-out" / "restitution.json").read_text())
    np.testing.assert_array_equal(table[:, 0], found["speed"])
    np.testing.assert_array_equal(table[:, 1], found["restitution"])
    assert found["critical_velocity"] == pytest.approx(CRITICAL, rel=1e-8)
    assert (place / "drop-out" / "restitution.png").read_bytes().startswith(b"\x89PNG")
    ran = call("restitution", "drop.toml", "--points", "3")
    assert ran.exit_code == 0, ran.output
    assert "written to drop-out, in place of the earlier results" in ran.output
    assert "drop-out" in refused("restitution", "other.toml", "-o", "drop-out")


def test_speeds_are_as_asked_and_json_writes_no_files(place):
    found = answered("restitution", "drop.toml", "--speeds", "1 m/s, 4 m/s", "--points", "3")
    assert found["speed"] == pytest.approx([1.0, 2.0, 4.0], rel=1e-9)
    expected = [np.sqrt(1.0 - (CRITICAL / v) ** 2) for v in found["speed"]]
    assert found["restitution"] == pytest.approx(expected, abs=1e-7)
    assert found["captured"] == [False] * 3
    assert not (place / "drop-out").exists()


@pytest.mark.parametrize(
    ("command", "options", "words"),
    [
        ("restitution", ("--speeds", "1 m/s"), "--speeds"),
        ("restitution", ("--speeds", "2 m/s, 1 m/s"), "--speeds"),
        ("restitution", ("--speeds", "0 m/s, 1 m/s"), "--speeds"),
        ("restitution", ("--speeds", "1 m, 2 m"), "--speeds"),
        ("restitution", ("--speeds", "a, b"), "--speeds"),
        ("curve", ("--load", "1 uN", "--depth", "1 nm"), "must be given without `--depth`"),
        ("curve", ("--load", "1 nm"), "--load"),
        ("curve", ("--depth", "soon"), "--depth"),
    ],
)
def test_speeds_and_loads_that_are_none_are_refused(command, options, words):
    assert words in refused(command, "drop.toml", *options)


def test_a_case_without_an_impact_has_a_curve_and_no_motion(place):
    ran = call("curve", "still.toml", "--load", "1 uN")
    assert ran.exit_code == 0, ran.output
    curve = read(place / "still-out" / "curve.nc")
    assert isinstance(curve, asperity.Curve)
    assert curve.force_loading[0] == pytest.approx(1e-6, rel=1e-9)
    assert curve.preload is None  # any larger load gives the same
    shutil.rmtree(place / "still-out")
    found = answered("curve", "still.toml", "--depth", "3 nm")
    assert found["minimum_separation"] == pytest.approx(-3e-9, rel=1e-9)
    assert found["pull_off"] == pytest.approx(curve.pull_off, rel=1e-9)
    for command in ("run", "curve", "regime", "restitution"):
        assert "[impact] table must be given" in refused(command, "still.toml", "--json")


def test_a_curve_says_its_warnings_in_the_terminal_and_in_json(place):
    (place / "dmt.toml").write_text(SMOOTH.replace('"jkr"', '"dmt"'))
    found = answered("curve", "dmt.toml")
    assert found["warnings"] == asperity.curve(smooth("dmt")).warnings
    assert "the Tabor number is 16.6" in call("curve", "dmt.toml").stdout


def test_the_headline_is_the_first_impact_and_the_end_follows():
    result = asperity.solve(smooth("jkr"))
    leaves = result.summary()
    assert "The body leaves the first impact with e = 0.942 and does not come" in leaves
    assert "is captured at the first impact" in asperity.solve(smooth("jkr", "0.1 m/s")).summary()
    for row in ("critical velocity", "contact time", "largest force", "pull-off force"):
        assert row in leaves
    assert "decrement" not in leaves
    assert "decrement" in result.summary(published=True)  # the publication's columns


def test_a_curve_of_restitution_is_a_dataset_and_draws_itself():
    curve = asperity.restitution_curve(smooth("jkr"), np.array([0.3, 1.0, 3.0]))
    dataset = curve.dataset()
    assert dataset["restitution"].attrs["units"] == "1"
    assert dataset["speed"].attrs["units"] == "m/s"
    assert curve.plot().axes[0].get_ylabel() == "coefficient of restitution [-]"

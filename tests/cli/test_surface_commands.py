"""The commands `surface` and `generate`, and measured surfaces in `reproduce`."""

from __future__ import annotations

import json
import math
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest

from asperity.surfaces import Topography
from asperity.surfaces.files.read_surface import read_surface
from asperity.surfaces.files.write_surface import write_topography
from asperity.surfaces.generation.generate import self_affine
from commands import answered, assert_narrow, assert_one_line, call, imported, names, refused

KEYS = {
    "rms_height", "skewness", "kurtosis", "summit_density", "summit_radius", "summit_rms_height",
    "bandwidth", "moments", "gaussian", "missing_pixels", "pixel_size", "physical_size",
}  # fmt: skip
FILES = ["surface.json", "surface.png", "surface.svg", "surface.txt"]
LONG_NAME = f"{'a long name ' * 4}.npy"
PIXEL = (20e-9, 20e-9)
SIZE = ["--size", "1 um x 1 um"]
HEIGHT = ["--rms-height", "5 nm"]


def described(*arguments: str) -> Any:
    return answered("surface", *arguments)


def generated(name: str, *options: str) -> str:
    """What is said of a file with a surface made anew."""
    ran = call("generate", name, *SIZE, *options)
    assert ran.exit_code == 0, ran.output
    return str(ran.stdout)


def rough(name: str = "rough.csv", seed: int = 1, rms: float = 10e-9, points: int = 64) -> str:
    """A file with a Gaussian self-affine surface of pixels that resolve it."""
    made = self_affine(
        (points, points), PIXEL, hurst=0.8, rolloff=400e-9, cutoff=160e-9, rms_height=rms, seed=seed
    )
    write_topography(made, name)
    return name


def with_gaps(name: str = "gaps.csv", count: int = 7) -> str:
    heights = read_surface(rough("whole.nc")).topography.heights.copy()
    heights[10, 5 : 5 + count] = np.nan
    write_topography(Topography(heights, PIXEL), name)
    return name


def test_a_lattice_of_paraboloids_has_its_radius_and_density():
    """Tops of one radius R on a square lattice: 1/R is the curvature, 1/pitch^2 the density."""
    radius, pitch, count = 2e-6, 400e-9, 24
    step = pitch / 16
    place = (np.arange(count * 16) - 8) * step
    about = (place + 0.5 * pitch) % pitch - 0.5 * pitch
    heights = -(about**2 + about[:, None] ** 2) / (2.0 * radius)
    write_topography(Topography(heights, (step, step)), "lattice.nc")
    found = described("lattice.nc", "--form-removal", "none")
    assert found["summit_radius"] == pytest.approx(radius, rel=1e-6)
    assert found["summit_density"] == pytest.approx(1.0 / pitch**2, rel=0.02)


def test_json_of_a_surface_has_the_figures_in_si_and_no_others(place):
    found = described(rough())
    assert set(found) == KEYS
    assert set(found["gaussian"]) == {"statistic", "p_value"}
    assert found["physical_size"] == pytest.approx([64 * 20e-9] * 2)
    assert found["pixel_size"] == pytest.approx([20e-9] * 2)
    assert found["moments"][0] == pytest.approx(found["rms_height"] ** 2)
    m0, m2, m4 = found["moments"]
    assert found["bandwidth"] == pytest.approx(m0 * m4 / m2**2)
    assert names() == ["rough.csv"]


def test_json_of_two_surfaces_adds_their_variances():
    """Whatever the distributions are, variances and third cumulants of a sum add up."""
    files = [rough("a.csv", 1, 10e-9), rough("b.nc", 2, 20e-9)]
    found = described(*files)
    first, second = found["surfaces"]
    both = found["composite"]
    assert set(first) == set(second) == KEYS
    assert set(both) == KEYS | {"by_convolution", "by_adding"}
    assert both["rms_height"] == pytest.approx(
        math.hypot(first["rms_height"], second["rms_height"]), rel=1e-3
    )
    third = sum(one["skewness"] * one["rms_height"] ** 3 for one in (first, second))
    assert both["skewness"] == pytest.approx(third / both["rms_height"] ** 3, abs=2e-3)
    alone = described(files[0])
    assert first == alone
    whole = {**both, **both["by_adding"]}
    assert whole["rms_height"] ** 2 == pytest.approx(both["moments"][0])


def test_a_surface_is_described_in_80_columns_with_its_steps_models_and_verdicts(place):
    ran = call("surface", rough())
    assert ran.exit_code == 0, ran.output
    assert_narrow(ran.stdout)
    for words in (
        "missing pixels        0 of 4096", "tilt removed", "; Sq ", "McCool", "Nayak",
        "Effect of the pixel size", "Verdicts", "rms height Sq", "bandwidth m0 m4/m2^2",
    ):  # fmt: skip
        assert words in ran.stdout
    assert names("rough-out") == FILES
    assert (place / "rough-out/surface.png").read_bytes().startswith(b"\x89PNG")
    text = (place / "rough-out/surface.txt").read_text()
    assert ran.stdout.split("written to")[0].strip() in text
    record = json.loads((place / "rough-out/surface.json").read_text())
    assert set(record) > KEYS
    assert record["mccool"]["density"] > 0.0
    assert record["preparation"]["steps"][0]["rms_before"] > 0.0


@pytest.mark.usefixtures("undrawn")
def test_two_surfaces_have_a_page_each_and_one_for_both(place):
    ran = call("surface", rough("a.csv", 1), rough("b.csv", 2), "-q")
    assert (ran.exit_code, ran.output) == (0, "")
    pages = [f"{n}.{k}" for n in ("composite", "surface-1", "surface-2") for k in ("png", "svg")]
    assert names("a-b-out") == sorted([*pages, "surface.json", "surface.txt"])
    text = (place / "a-b-out/surface.txt").read_text()
    assert "by convolution   by adding" in text
    assert_narrow(text)
    # One surface in the place of two leaves no page of theirs.
    assert call("surface", "a.csv", "-o", "a-b-out", "--force").exit_code == 0
    assert names("a-b-out") == FILES


@pytest.mark.usefixtures("undrawn")
def test_an_earlier_result_is_kept_unless_forced(place):
    rough()
    (place / "rough-out").mkdir()
    (place / "rough-out/surface.txt").write_text("mine")
    assert "--force" in refused("surface", "rough.csv")
    assert (place / "rough-out/surface.txt").read_text() == "mine"
    (place / "rough-out/record.nc").touch()
    (place / "rough-out/surface.txt").unlink()
    assert call("surface", "rough.csv").exit_code == 0  # beside the files of a run


@pytest.mark.usefixtures("undrawn")
def test_missing_pixels_are_refused_kept_or_filled_and_counted():
    said = refused("surface", with_gaps())
    assert "gaps.csv: 7 of 4096 pixels are missing" in said
    assert "--missing fill" in said
    kept, filled = (described("gaps.csv", "--missing", how) for how in ("keep", "fill"))
    assert kept["missing_pixels"] == filled["missing_pixels"] == 7
    assert filled["rms_height"] == pytest.approx(described("whole.nc")["rms_height"], rel=0.01)
    ran = call("surface", "gaps.csv", "--missing", "keep")
    assert "missing pixels        7 of 4096 (0.1709 %)" in ran.stdout


def test_a_cut_of_short_waves_leaves_fewer_and_rounder_summits():
    whole, cut = described(rough(points=128)), described("rough.csv", "--s-filter", "300 nm")
    assert cut["summit_density"] < whole["summit_density"]
    assert cut["summit_radius"] > whole["summit_radius"]


def test_an_array_takes_its_size_and_unit_from_the_options():
    np.save("bare.npy", read_surface(rough()).topography.heights * 1e9)
    options = ["--size", "1.28 um x 1280 nm", "--unit", "nm"]
    found, known = described("bare.npy", *options), described("rough.csv")
    assert found["rms_height"] == pytest.approx(known["rms_height"], rel=1e-9)
    assert found["pixel_size"] == pytest.approx(known["pixel_size"])
    assert "--size" in refused("surface", "bare.npy", "--unit", "nm")
    assert "--unit" in refused("surface", "bare.npy", *options[:2])


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--form-removal", "plane"], "`--form-removal` must be one of none, mean, tilt"),
        (["--line-levelling", "median", "--direction", "x"], "`--direction` must be"),
        (["--degree", "9"], "`--degree` must be a whole number from 0 to 5; got 9"),
        (["--missing", "maybe"], "`--missing` must be one of refuse, keep, fill"),
        (["--s-filter", "5"], "`--s-filter` must have a unit"),
        (["--l-filter", "1 m"], "rough.csv: `--l-filter` must lie between two pixels"),
        (["--size", "10 um"], "`--size` must be 2 lengths, such as '10 um x 10 um'"),
        (["--unit", "volt"], "rough.csv: the unit must be a length"),
        (["--channel", "3"], "rough.csv: holds one map and no channels; got 3"),
        (["--short", "40 nm"], "no such option: --short; it is called --s-filter now"),
        (["--align", "median"], "no such option: --align; it is called --line-levelling now"),
        (["rough.csv", "rough.csv"], "one or two files must be given; got 3"),
    ],
)
def test_an_option_that_cannot_be_used_is_named(options, words):
    assert words in refused("surface", rough(), *options)


def test_a_file_that_is_no_surface_is_refused_with_its_name():
    Path("bare.csv").write_text("1 2 3\n4 5 6\n7 8 9\n")
    assert_one_line(refused("surface", "bare.csv"), "bare.csv", "--unit nm")
    assert_one_line(refused("surface", "none.csv"), "none.csv", "no such file")


def test_a_flat_map_and_one_with_few_summits_are_refused():
    write_topography(Topography(np.ones((9, 9)), PIXEL), "flat.nc")
    write_topography(Topography(np.arange(25.0).reshape(5, 5) ** 2 * 1e-9, PIXEL), "few.nc")
    for name in ("flat.nc", "few.nc"):
        rule = "summits need at least 10; got 0; measure a larger area"
        assert_one_line(refused("surface", name), name, rule)


def test_no_command_on_surfaces_waits_for_jax():
    code = (
        "from asperity.cli import app; from typer.testing import CliRunner; import shlex; "
        "ran = [CliRunner().invoke(app, shlex.split(line)) for line in sys.argv[1:]]; "
        "assert all(one.exit_code == 0 for one in ran), ran"
    )
    made = "generate made.nc --points 64 --size '1 um x 1 um' --rms-height '5 nm'"
    assert not imported(code, made, "surface made.nc --json") & {"jax"}


@pytest.mark.usefixtures("undrawn")
def test_a_full_disk_is_exit_4_and_leaves_nothing(disk_of):
    rough()
    with disk_of(1000):
        assert "rough-out" in refused("surface", "rough.csv", code=4)
        said = refused("generate", "made.npy", *SIZE, *HEIGHT, code=4)
    assert "made.npy: cannot be written: File too large" in said


def test_ctrl_c_ends_a_description_and_a_generation_and_leaves_nothing(place):
    write_topography(self_affine((4096, 4096), PIXEL, hurst=0.8, rms_height=1e-8, seed=1), "b.nc")
    for arguments in (
        ["surface", "b.nc"],
        ["generate", "made.csv", *SIZE, *HEIGHT, "--points", "4096"],
    ):
        command = [sys.executable, "-m", "asperity", *arguments]
        running = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        working = psutil.Process(running.pid)
        while working.cpu_times().user < 2.5:  # it has begun, however busy the machine is
            assert running.poll() is None
            time.sleep(0.05)
        running.send_signal(signal.SIGINT)
        start = time.monotonic()
        _, said = running.communicate(timeout=20)
        assert time.monotonic() - start < 5.0
        assert running.returncode == 130
        assert said == "asperity: interrupted; nothing was written\n"
    assert names() == ["b.nc"]


def test_ctrl_c_while_drawing_keeps_the_text(monkeypatch):
    from asperity.cli import working
    from asperity.plots import surface

    monkeypatch.setattr(working, "PATIENCE", 0.05)

    def stopped(found: object) -> dict[str, bytes]:
        signal.raise_signal(signal.SIGINT)
        time.sleep(0.5)
        return {"surface.png": b""}

    monkeypatch.setattr(surface, "files", stopped)
    ran = call("surface", rough(), "-q")
    assert ran.exit_code == 130
    assert names("rough-out") == ["surface.json", "surface.txt"]


def test_a_folder_without_permission_is_exit_4(place):
    rough()
    (place / "file").touch()
    assert "Not a directory" in refused("surface", "rough.csv", "-o", "file", code=4)
    assert "No such file" in refused("generate", "none/a.npy", *SIZE, *HEIGHT, code=4)


@pytest.mark.parametrize(
    "name",
    ["made.npy", "made.csv", "made.xyz", "made.nc", "a b.csv.gz", f"{'a long name ' * 4}.npy"],
)
def test_a_made_surface_is_read_back_by_the_command_that_is_printed(name):
    said = generated(name, *HEIGHT, "--points", "48x32", "--size", "3 um x 2 um")
    command = said.partition("describe it with:\n")[2]
    script = f'asperity() {{ printf "%s\\n" "$@"; }}\n{command}'
    paste = subprocess.run(["sh", "-c", script], capture_output=True, text=True, check=True)
    words = paste.stdout.splitlines()
    assert words[:2] == ["surface", name]
    found = described(*words[1:], "--form-removal", "none")
    assert found["rms_height"] == pytest.approx(5e-9, rel=1e-9)
    assert found["physical_size"] == pytest.approx([3e-6, 2e-6])
    assert found["pixel_size"] == pytest.approx([62.5e-9, 62.5e-9])


def test_the_seed_makes_the_surface():
    for name, seed in (("a.npy", "1"), ("b.npy", "1"), ("c.npy", "2")):
        generated(name, *HEIGHT, "--points", "16", "--seed", seed)
    contents = [Path(f"{name}.npy").read_bytes() for name in "abc"]
    assert contents[0] == contents[1] != contents[2]


def test_a_made_surface_takes_the_heights_of_an_array_or_of_a_surface():
    heights = np.random.default_rng(3).exponential(size=16 * 16)
    np.save("drawn.npy", heights)
    for name, source in (("b.nc", rough("own.csv")), ("a.nc", "drawn.npy")):
        assert source in generated(name, *HEIGHT, "--points", "16", "--heights", source)
    got = np.sort(read_surface("a.nc").topography.heights, axis=None) / 5e-9
    wanted = np.sort((heights - heights.mean()) / heights.std())
    np.testing.assert_allclose(got, wanted, atol=1e-9)


def test_an_rms_slope_is_met():
    """Of the Fourier series; neighbouring pixels give less."""
    waves = ["--cut-off", "120 nm", "--roll-off", "300 nm"]
    generated("made.nc", "--points", "256", "--rms-slope", "0.2", *waves)
    found = described("made.nc", "--form-removal", "none")
    assert math.sqrt(2.0 * found["moments"][1]) == pytest.approx(0.2, rel=0.03)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ([], "`--size` must be given"),
        ([*SIZE], "one of `--rms-height` and `--rms-slope` must be given; got neither"),
        ([*SIZE, *HEIGHT, "--rms-slope", "1"], "got both"),
        ([*SIZE, *HEIGHT, "--hurst", "2"], "`--hurst` must lie in (0, 1]; got 2.0"),
        ([*SIZE, *HEIGHT, "--points", "2"], "`--points` must be whole, 3 or more; got 2, 2"),
        ([*SIZE, *HEIGHT, "--points", "9e9"], "`--points` must be N or NxM"),
        ([*SIZE, *HEIGHT, "--points", "999999999"], "`--points` must be at most"),
        ([*SIZE, *HEIGHT, "--seed", "-1"], "`--seed` must be whole, 0 or more"),
        ([*SIZE, *HEIGHT, "--roll-off", "2 um"], "`--roll-off` must lie between two pixels"),
        ([*SIZE, "--rms-height", "5"], "`--rms-height` must have a unit"),
        ([*SIZE, "--rms-slope", "nan"], "`--rms-slope` must be positive; got nan"),
        ([*SIZE, *HEIGHT, "--skewness", "2"], "kurtosis above skewness^2 + 1 = 5; got 3"),
        ([*SIZE, *HEIGHT, "--heights", "none.npy"], "none.npy: no such file"),
        ([*SIZE, *HEIGHT, "--heights", "x.npy", "--skewness", "1"], "exclude each other"),
    ],
)
def test_a_surface_that_cannot_be_made_is_refused_with_the_option(options, words):
    assert words in refused("generate", "made.npy", *options)


def test_a_file_is_never_overwritten_without_force(place):
    (place / "made.csv").write_text("mine")
    made = ["generate", "made.csv", "--points", "8", *SIZE, *HEIGHT]
    assert "--force" in refused(*made)
    assert (place / "made.csv").read_text() == "mine"
    assert call(*made, "--force").exit_code == 0
    assert "must end in one of .npy .csv" in refused("generate", "made.foo", *SIZE, *HEIGHT)


def test_heights_of_a_damaged_or_pickled_array_are_refused():
    Path("half.npy").write_bytes(b"\x93NUMPY\x01\x00")
    assert "half.npy" in refused("generate", "m.nc", *SIZE, *HEIGHT, "--heights", "half.npy")
    np.save("object.npy", np.array([{}, 1], dtype=object), allow_pickle=True)
    said = refused("generate", "m.nc", *SIZE, *HEIGHT, "--heights", "object.npy")
    assert "object.npy" in said


def test_measured_surfaces_of_the_reproduction_are_read_before_anything_is_computed():
    assert "none.csv" in refused("reproduce", "--surfaces", rough(), "none.csv")
    assert "`--size` must go with `--surfaces`" in refused("reproduce", *SIZE)
    assert "--missing fill" in refused("reproduce", "--surfaces", "rough.csv", with_gaps())


@pytest.mark.usefixtures("undrawn")
def test_figures_2_and_3_of_the_reproduction_are_those_of_two_files(place):
    """Their variances add up, as in the publication's convolution."""
    files = [rough("one.csv", 1, 10e-9), rough("two.nc", 2, 20e-9)]
    found = answered("reproduce", "--surfaces", *files, "-o", "out")["surfaces"]
    each = [one["rms_height"] for one in found["surfaces"]]
    assert found["composite"]["rms_height"] == pytest.approx(math.hypot(*each), rel=1e-3)
    for number in (2, 3):
        title = (place / f"out/figure-{number}.csv").read_text().splitlines()[0]
        assert "one.csv + two.nc" in title
        assert "synthetic" not in title
        assert (place / f"out/figure-{number}.png").is_file()

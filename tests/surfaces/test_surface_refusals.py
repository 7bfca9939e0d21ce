"""Files that are no surface are refused in one line: file, rule, remedy. Nothing is guessed."""

import gzip
import os
from pathlib import Path

import numpy as np
import pytest

from asperity.errors import InputError
from asperity.surfaces import Topography
from asperity.surfaces.files import netcdf_heights
from asperity.surfaces.files.read_surface import read_surface
from asperity.surfaces.files.write_surface import write_topography
from refused_input import refusal
from vendor_files import gwyddion, x3p

HEAD = "# size[um] 4 3\n# unit nm\n"
POINTS = "# x[um] y[um] z[nm]\n"
PLAIN = "1 2 3\n4 5 6\n7 8 9\n"
SURFACE = Topography(np.arange(30.0).reshape(5, 6) ** 1.5 * 1e-9, (1e-6, 2e-6))
WHOLE = {
    ".x3p": x3p(SURFACE.heights, SURFACE.pixel_size),
    ".gwy": gwyddion({"z": (SURFACE.heights, "m")}, SURFACE.physical_size),
}


def refused(path, **asked):
    """The message of a refusal, after the file's name."""
    error = refusal(read_surface, path, **asked)
    assert str(error).startswith(f"{path}: ")
    assert error.file == str(path)
    return str(error).removeprefix(f"{path}: ")


def written(folder, name, content):
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


@pytest.mark.parametrize(
    ("content", "rule"),
    [
        (PLAIN, "heights must have a unit; got none; give it with --unit nm (key `unit` in a case"),
        ("# unit nm\n" + PLAIN, 'size of the map must be known; got none; give it with --size "10'),
        (HEAD, "a text without numbers"),
        (HEAD + "1 2 3\n4 x 6\n7 8 9\n", "line 4: must hold numbers alone; got 'x'"),
        ("x y z\n" + HEAD + PLAIN, "line 2: header lines must stand before the first number"),
        (HEAD + "1 2 3\n4 5\n7 8 9\n", "line 4: every line must have 3 numbers, as the first; got"),
        (HEAD + "1 2 3\n\n4 5 6\n7 8 9\n", "line 4: a matrix must have a row on every line"),
        (HEAD + "# left\n1 2 3\n4 inf 6\n7 8 9\n", "line 5: heights must be finite; got inf"),
        (HEAD + "1,5;2,0\n3,5;4,0\n", "line 3: must hold numbers alone; got '1,5'; write decimal"),
        (HEAD + "nan nan nan\n" * 3, "all pixels are missing"),
        (HEAD + "7\n", "at least 3 x 3 pixels; got 1 x 1"),
        (HEAD + "# pixels 3 4\n" + PLAIN, "must have 3 x 4 pixels, as the file states; got 3 x 3"),
        ("# size[um] 4 -3\n# unit nm\n" + PLAIN, "line 1: the size must be positive"),
        ("# size[kg] 4 3\n# unit nm\n" + PLAIN, "line 1: `size` must be a length"),
        (HEAD + "# unit um\n" + PLAIN, "line 3: the unit must be stated once; got 'um' after 'nm'"),
        ("# size[um] 4 3\n# unit volt\n" + PLAIN, "line 2: the unit must be a length; got 'volt'"),
        (HEAD.encode() + b"1 2 3\n4 \0 6\n", "must be plain text; got binary data"),
        (POINTS + "1 2 3 4\n" * 4, "line 2: every line must have 3 numbers; got 4"),
        ("# size[um] 4\n# unit nm\n" + PLAIN, "line 1: must read `# x[m] y[m] z[nm]` or `# size"),
    ],
)
def test_a_matrix_without_a_meaning_is_refused(tmp_path, content, rule):
    assert rule in refused(written(tmp_path, "a.csv", content))


def grid(columns=4, rows=3):
    return [f"{x} {y} {x * y}" for y in range(rows) for x in range(columns)]


@pytest.mark.parametrize(
    ("lines", "rule"),
    [
        (grid()[:-2], "the last scan line must be whole; got one that ends early"),
        ([*grid(), "1 1 7"], "must have one height a place; got two points at one"),
        ([*grid()[:-1], "3.4 2 1"], "x must stand on even steps; got one off by"),
        ([*grid()[:-1], "nan 2 1"], "every x must be finite"),
        (["1 2 3"] * 4, "must have points at several x; got 1"),
        ([f"{n} {n} 1" for n in range(9)], "must fill a regular grid; got 9 points for 9 x 9"),
        ([*grid(), "1e300 0 1", "-1e300 0 1"], "must have one height a place"),
        (["# pixels 4 4", *grid()], "must have 4 x 4 pixels, as the file states; got 4 x 3"),
    ],
)
def test_points_that_make_no_whole_grid_are_refused(tmp_path, lines, rule):
    path = written(tmp_path, "a.xyz", "\n".join(lines) + "\n")
    assert rule in refused(path, unit="nm")


def header(shape, kind="<f8"):
    text = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}\n".encode()
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text


@pytest.mark.parametrize(
    ("content", "rule"),
    [
        (header("(40000, 40000)") + bytes(64), "12800000000 bytes) over 64 bytes"),
        (header("(3, 3)") + bytes(71), "a header of (3, 3) numbers (72 bytes) over 71 bytes"),
        (header("(-3, -3)") + bytes(72), "a header of (-3, -3)"),
        (header("(3, 3, 1)") + bytes(72), "a plane of heights, rows by columns; got shape (3, 3"),
        (header("(3, 3)", "<c8") + bytes(72), "must hold real numbers; got complex64"),
        (header("(3, 3)", "|O") + bytes(72), "must hold real numbers; got object"),
        (header("(3, 3)", "|b1") + bytes(9), "must hold real numbers; got bool"),
        (header("(" * 4000 + ")" * 4000), "must be a whole .npy file of real numbers"),
        (b"PK\x03\x04 a zip", "must be a whole .npy file"),
        (header("(3, 3)") + np.full(9, np.inf).tobytes(), "heights must be finite"),
    ],
)
def test_an_array_is_checked_before_memory_is_taken(tmp_path, content, rule):
    path = written(tmp_path, "a.npy", content)
    assert rule in refused(path, size=(1e-6, 1e-6), unit="nm")


def test_size_and_unit_that_a_file_does_not_state_are_asked_for(tmp_path):
    array = tmp_path / "a.npy"
    np.save(array, SURFACE.heights)
    for path in (array, written(tmp_path, "a.hgt", bytes(range(72)))):
        assert "must have a unit; got none; give it with --unit nm" in refused(path)
        assert 'give it with --size "10 um x 10 um" (key `size`' in refused(path, unit="nm")
    for size in ((0.0, 1e-6), (-1e-6, 1e-6), (float("nan"), 1.0), (1.0, np.inf)):
        assert "must be two positive lengths" in refused(array, size=size, unit="nm")


def test_a_unit_is_a_length(tmp_path):
    path = written(tmp_path, "a.csv", "# size[um] 4 3\n" + PLAIN)
    assert read_surface(path, unit="nm\n").topography.heights[0, 0] == 1e-9
    for unit in ("", "kg", "10 nm", "furlongs per hour"):
        assert "the unit must be a length; got" in refused(path, unit=unit)


def whole(folder, suffix):
    """A file of the surface, and what it does not state."""
    path = folder / f"a{suffix}"
    if suffix in WHOLE:
        path.write_bytes(WHOLE[suffix])
    elif suffix == "4.nc":
        plane(path, ["z"])
    else:
        write_topography(SURFACE, path)
    return path, {"unit": "m", "size": SURFACE.physical_size} if ".npy" in suffix else {}


@pytest.mark.parametrize("suffix", [".csv", ".xyz", ".nc", ".x3p", ".gwy"])
def test_file_and_caller_may_not_contradict(tmp_path, suffix):
    path, _ = whole(tmp_path, suffix)
    assert "the unit must be the one in the file" in refused(path, unit="nm")
    assert "the size must be the one in the file" in refused(path, size=(6e-6, 9e-6))
    agreed = read_surface(path, unit="m", size=SURFACE.physical_size).topography
    np.testing.assert_array_equal(agreed.heights, read_surface(path).topography.heights)


SUFFIXES = [".npy", ".csv", ".txt", ".xyz", ".nc", ".csv.gz", ".npy.gz", *WHOLE, "4.nc"]


@pytest.mark.parametrize("part", [0.05, 0.5, 0.9])
@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_file_cut_short_is_refused(tmp_path, suffix, part):
    path, asked = whole(tmp_path, suffix)
    read_surface(path, **asked)
    path.write_bytes(path.read_bytes()[: int(part * path.stat().st_size)])
    refused(path, **asked)


def plane(path, names, kind="f8", dimensions=("y", "x")):
    """A netCDF-4 file with planes of some names, all with units and coordinates."""
    from netCDF4 import Dataset

    with Dataset(path, "w") as held:
        for name in dimensions:
            held.createDimension(name, 5)
            axis = held.createVariable(name, "f8", (name,))
            axis[:], axis.units = np.arange(5.0), "um"
        for name in names:
            made = held.createVariable(name, kind, dimensions)
            made.units = "nm"
            if kind != "S1":
                made[:] = 1.0
    return path


def test_a_netcdf_has_one_plane_or_a_channel_is_named(tmp_path):
    path = tmp_path / "a.nc"
    for how in ({"names": []}, {"names": ["a"], "kind": "S1"},
                {"names": ["a"], "dimensions": ("t", "y", "x")}):  # fmt: skip
        assert "one variable of two dimensions with the heights; got none" in refused(
            plane(path, **how)
        )
    plane(path, ["a", "b"])
    assert "one variable of two dimensions with the heights; got a, b" in refused(path)
    assert read_surface(path, channel="b").topography.heights[0, 0] == 1e-9
    assert "one of a, b; got 'c'" in refused(path, channel="c")


def test_a_netcdf_plane_larger_than_memory_is_refused_unread(tmp_path):
    from netCDF4 import Dataset

    path = tmp_path / "a.nc"
    with Dataset(path, "w") as held:
        held.createDimension("y", 10**6)
        held.createDimension("x", 10**6)
        held.createVariable("z", "f8", ("y", "x"), chunksizes=(1000, 1000)).units = "m"
    assert path.stat().st_size < 10**6
    assert "more than" in refused(path)


def test_a_netcdf_plane_without_pixels_is_refused(tmp_path):
    """Found by mutation: a dimension of length zero."""
    from scipy.io import netcdf_file

    path = tmp_path / "a.nc"
    with netcdf_file(path, "w", version=2) as held:
        held.createDimension("t", None)
        held.createDimension("x", 4)
        held.createVariable("z", "f8", ("t", "x")).units = "m"
    assert "got a plane of 4 x 0 pixels" in refused(path, size=(1e-6, 1e-6))


def test_a_damaged_netcdf_that_never_ends_is_given_up(tmp_path, monkeypatch):
    """Found by mutation: the C library follows a loop in the file."""
    monkeypatch.setattr(netcdf_heights, "_LONGEST", 1)
    content = (Path(__file__).parents[1] / "data").joinpath("surfaces", "endless.nc").read_bytes()
    assert "must be whole; got a netCDF-4 file" in refused(written(tmp_path, "a.nc", content))


@pytest.mark.parametrize("name", ["a.gwy", "a.png", "a", "a.unknown"])
def test_an_unknown_format_is_refused(tmp_path, name):
    path = written(tmp_path, name, b"\x89PNG\r\n\x1a\n" + bytes(range(256)))
    assert "in a known format (.npy .csv .txt .dat .xyz .nc, or one that" in refused(path)


def test_a_format_known_by_its_ending_alone_is_not_guessed(tmp_path):
    """A square of 16-bit numbers fits any file of that length; only a .hgt is one."""
    path = written(tmp_path, "a.bin", bytes(range(72)))
    assert "in a known format" in refused(path, size=(1e-6, 1e-6), unit="m")
    path = written(tmp_path, "a.hgt", bytes(range(72)))
    surface = read_surface(path, size=(1e-6, 3e-6), unit="nanometer").topography
    assert surface.heights[0, 1] == (2 * 256 + 3) / 1e9
    assert surface.pixel_size == pytest.approx((1e-6 / 6, 3e-6 / 6), rel=1e-15)


def test_no_file_a_folder_and_no_permission_are_told_apart(tmp_path):
    assert refused(tmp_path / "none.csv") == "no such file; check the path"
    assert "must be a regular file; got a folder" in refused(tmp_path)
    os.mkfifo(tmp_path / "pipe.csv")
    assert "must be a regular file" in refused(tmp_path / "pipe.csv")
    assert "empty file" in refused(written(tmp_path, "a.csv", ""))
    with pytest.raises(InputError, match="no such file"):
        read_surface("a\0.csv")


def test_a_file_that_may_not_be_read_says_why(tmp_path, monkeypatch):
    def denied(self):
        raise PermissionError(13, "Permission denied")

    path = written(tmp_path, "a.csv", HEAD + PLAIN)
    monkeypatch.setattr(Path, "read_bytes", denied)
    assert refused(path) == "must be readable; got: Permission denied; check its permissions"


def test_a_packed_file_is_unpacked_within_bounds(tmp_path, monkeypatch):
    monkeypatch.setattr("asperity.surfaces.files.content.MOST_BYTES", 10**5)
    path = written(tmp_path, "a.csv.gz", gzip.compress(bytes(10**6)))
    assert "must have at most 100000 bytes, unpacked" in refused(path)
    assert "cannot be unpacked" in refused(written(tmp_path, "b.csv.gz", b"not packed"))


def test_a_text_has_no_channels(tmp_path):
    path = written(tmp_path, "a.csv", HEAD + PLAIN)
    assert "holds one map and no channels; got 1" in refused(path, channel=1)

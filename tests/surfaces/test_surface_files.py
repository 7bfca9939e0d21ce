"""Surfaces from files: metres, orientation, size, unit, channel; what is written reads back."""

import gzip
import logging
import sys
import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from asperity.errors import InputError, OutputError
from asperity.surfaces import Topography
from asperity.surfaces.files.read_surface import read_surface
from asperity.surfaces.files.write_surface import write_topography
from vendor_files import gwyddion, x3p

# Not square, no symmetry, one pixel missing: a transposed or flipped map differs.
HEIGHTS = np.array([[1.0, 2.0, 3.5, 4.0], [5.0, np.nan, 7.25, 8.0], [-9.0, 10.0, 11.0, 12.5]])  # nm
SIZE = (4e-6, 1.5e-6)
STEP = (1e-6, 0.5e-6)
FORMATS = [".npy", ".csv", ".txt", ".dat", ".xyz", ".nc", ".csv.gz", ".npy.gz", ".nc.gz"]

maps = arrays(
    np.float64,
    st.tuples(st.integers(3, 6), st.integers(3, 6)),
    elements=st.one_of(st.floats(-1e-3, 1e-3), st.just(float("nan"))),
).filter(lambda heights: np.isfinite(heights).any())
lengths = st.floats(1e-12, 1e-2)


def written(folder, name, content):
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def assert_is_the_map(surface):
    np.testing.assert_allclose(surface.heights, HEIGHTS * 1e-9, rtol=1e-15)
    assert surface.pixel_size == pytest.approx(STEP, rel=1e-12)
    assert surface.missing_pixels == 1


def asked(path, surface):
    """What an .npy does not state."""
    bare = ".npy" in path.suffixes
    return {"size": surface.physical_size, "unit": "m"} if bare else {}


@pytest.mark.parametrize("suffix", FORMATS)
@settings(max_examples=30)
@given(heights=maps, step=st.tuples(lengths, lengths))
def test_a_map_written_is_the_map_read(tmp_path_factory, suffix, heights, step):
    path = tmp_path_factory.getbasetemp() / f"map{suffix}"
    surface = Topography(heights, step)
    write_topography(surface, path, force=True)
    again = read_surface(path, **asked(path, surface)).topography
    np.testing.assert_array_equal(again.heights, heights)
    # The text and the size of an .npy hold the whole map's size: divided again, one rounding.
    exact = ".nc" in path.suffixes
    assert again.pixel_size == (step if exact else pytest.approx(step, rel=1e-15, abs=0.0))
    assert again.source == str(path)


MATRIX = "1,2,3.5,4\n5,,7.25,8\n-9,10,11,12.5\n"
HEADER = "# size[um] 4 1.5\n# unit nm\n# pixels 4 3\n"
GWYDDION = "# Channel: Topo\n# Width: 4.0 µm\n# Height: 1500 nm\n# Value units: nm\n"
POINTS = [(x * 1.0, y * 0.5, HEIGHTS[y, x]) for y in range(3) for x in range(4) if (x, y) != (1, 1)]


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("comma.csv", HEADER + MATRIX),
        ("blanks.csv", HEADER + MATRIX.replace(",,", ",nan,").replace(",", "   ")),
        ("semicolon.csv", HEADER + MATRIX.replace(",", " ; ")),
        ("tabs.txt", HEADER + MATRIX.replace(",", "\t")),
        ("ended.csv", HEADER + MATRIX.replace("\n", ",\n")),
        ("windows.csv", (HEADER + MATRIX).replace("\n", "\r\n")),
        ("mac.csv", (HEADER + MATRIX).replace("\n", "\r")),
        ("marked.csv", b"\xef\xbb\xbf" + (HEADER + MATRIX).encode()),
        ("remarks.csv", "# by hand\n#\n\n" + HEADER + MATRIX.replace("4\n", "4 # edge\n")),
        ("metres.csv", HEADER.replace("[um] 4 1.5", "[m] 4e-6 1.5e-6") + MATRIX),
        ("gwyddion.txt", GWYDDION + MATRIX),
        ("old_code_page.txt", (GWYDDION + MATRIX).encode("latin-1")),
    ],
)
def test_a_matrix_has_x_along_its_lines(tmp_path, name, content):
    assert_is_the_map(read_surface(written(tmp_path, name, content)).topography)


@pytest.mark.parametrize("order", ["x fastest", "y fastest", "y downwards", "shuffled"])
@pytest.mark.parametrize("name", ["points.xyz", "points.csv"])
def test_points_find_their_place_in_any_order(tmp_path, order, name):
    points = np.array(POINTS)
    rng = np.random.default_rng(2)
    arranged = {
        "x fastest": points,
        "y fastest": points[np.lexsort((points[:, 1], points[:, 0]))],
        "y downwards": points[::-1],
        "shuffled": rng.permutation(points),
    }[order]
    lines = [f"{x} {y} {z}" for x, y, z in arranged]
    text = "# x[um] y[um] z[nm]\n" + "\n".join(lines) + "\n"
    assert_is_the_map(read_surface(written(tmp_path, name, text)).topography)


@pytest.mark.parametrize("digits", [2, 3, 5])
def test_rounded_coordinates_still_make_an_even_grid(tmp_path, digits):
    """A pixel of 0.234375 written with few digits: rounding does not add up over 300 columns."""
    step, columns, rows = 0.234375, 300, 3
    rng = np.random.default_rng(1)
    heights = rng.standard_normal((rows, columns))
    lines = [
        f"{x * step:.{digits}f} {y * step:.{digits}f} {heights[y, x]:.17g}"
        for y in range(rows)
        for x in range(columns)
    ]
    path = written(tmp_path, "rounded.xyz", "\n".join(lines) + "\n")
    surface = read_surface(path, unit="nm").topography
    np.testing.assert_allclose(surface.heights, heights * 1e-9, rtol=1e-15)
    assert surface.pixel_size[0] == pytest.approx(step * 1e-9, rel=10.0**-digits)


@settings(max_examples=50)
@given(
    heights=arrays(np.float64, (3, 4), elements=st.floats(-1e3, 1e3)),
    unit=st.sampled_from([("m", 1e-9), ("um", 1e-3), ("nm", 1.0), ("pm", 1e3), ("angstrom", 10.0)]),
)
def test_the_unit_of_the_file_does_not_matter(tmp_path_factory, heights, unit):
    name, factor = unit
    path = tmp_path_factory.getbasetemp() / "unit.npy"
    np.save(path, heights * factor)
    found = read_surface(path, size=SIZE, unit=name).topography.heights
    np.testing.assert_allclose(found, heights * 1e-9, rtol=1e-15, atol=1e-320)


def test_a_decimal_height_is_the_float_nearest_to_it_in_metres(tmp_path):
    path = written(tmp_path, "a.csv", "50 0.1 3\n" * 3)
    assert read_surface(path, size=SIZE, unit="nm").topography.heights[0].tolist() == [
        5e-8,
        1e-10,
        3e-9,
    ]


@pytest.mark.parametrize("kind", ["<f4", ">f8", "<i2", "u1", "F"])
def test_arrays_of_any_real_kind_and_order_are_read(tmp_path, kind):
    values = np.arange(12).reshape(3, 4)
    path = tmp_path / "a.npy"
    np.save(path, np.asfortranarray(values) if kind == "F" else values.astype(kind))
    np.testing.assert_array_equal(
        read_surface(path, size=SIZE, unit="m").topography.heights, values.astype(float)
    )


def netcdf(path, *, format="NETCDF4", dimensions=("y", "x"), packed=False, falling=False):
    from netCDF4 import Dataset

    stored = np.where(np.isnan(HEIGHTS), -1e30, HEIGHTS)
    with Dataset(path, "w", format=format) as held:
        for name, count, step in (("y", 3, 500.0), ("x", 4, 1000.0)):
            held.createDimension(name, count)
            axis = held.createVariable(name, "f8", (name,))
            axis.units = "nm"
            axis[:] = 70.0 + step * np.arange(count)[:: -1 if falling and name == "y" else 1]
        kind, fill = ("i2", -99) if packed else ("f8", -1e30)
        heights = held.createVariable("z", kind, dimensions, fill_value=fill)
        heights.set_auto_maskandscale(False)
        heights.units = "nm"
        if packed:
            heights.scale_factor, heights.add_offset = 0.25, 2.0
            stored = np.where(np.isnan(HEIGHTS), -99, (HEIGHTS - 2.0) / 0.25)
        stored = stored[::-1] if falling else stored
        heights[:] = stored.T if dimensions == ("x", "y") else stored
    return path


@pytest.mark.parametrize("format", ["NETCDF4", "NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET"])
@pytest.mark.parametrize(
    "how",
    [{}, {"dimensions": ("x", "y")}, {"packed": True}, {"falling": True}],
    ids=["plain", "transposed", "packed", "falling"],
)
def test_netcdf_is_oriented_by_its_dimensions_and_coordinates(tmp_path, format, how):
    assert_is_the_map(read_surface(netcdf(tmp_path / "a.nc", format=format, **how)).topography)


def test_what_was_never_written_to_a_netcdf_is_missing(tmp_path):
    from netCDF4 import Dataset

    path = tmp_path / "a.nc"
    with Dataset(path, "w") as held:
        held.createDimension("y", 3)
        held.createDimension("x", 4)
        heights = held.createVariable("z", "i8", ("y", "x"))
        heights[:2] = 5
    surface = read_surface(path, size=SIZE, unit="nm").topography
    assert surface.missing_pixels == 4
    assert surface.rms_height == 0.0


def test_a_formats_own_size_and_unit_reach_metres(tmp_path):
    path = written(tmp_path, "a.x3p", x3p(HEIGHTS * 1e-9, STEP))
    assert_is_the_map(read_surface(path).topography)
    packed = written(tmp_path, "b.x3p.gz", gzip.compress(path.read_bytes()))
    assert_is_the_map(read_surface(packed).topography)


def gwyddion_file(folder, **units):
    fields = {
        name: (np.nan_to_num(HEIGHTS) * 1e-9 * (1 + number), unit)
        for number, (name, unit) in enumerate(units.items())
    }
    return written(folder, "a.gwy", gwyddion(fields, SIZE, mask=np.isnan(HEIGHTS)))


def test_a_channel_is_taken_by_number_or_name_and_said(tmp_path):
    path = gwyddion_file(tmp_path, Height="m", Sensor="m")
    default = read_surface(path)
    assert (default.channel, default.channels) == ("0 Height", ("0 Height", "1 Sensor"))
    assert_is_the_map(default.topography)
    for channel in (1, "1", "Sensor"):
        sensor = read_surface(path, channel=channel)
        assert sensor.channel == "1 Sensor"
        assert sensor.topography.heights[2, 3] == pytest.approx(25e-9, rel=1e-15)


def test_an_unknown_channel_and_one_of_volts_are_answered_by_those_of_heights(tmp_path):
    path = gwyddion_file(tmp_path, Height="m", Sensor="m")
    with pytest.raises(InputError, match=r"one of heights: 0 Height, 1 Sensor; got 'Phase'"):
        read_surface(path, channel="Phase")
    path = gwyddion_file(tmp_path, Potential="V", Height="m")
    assert read_surface(path).channels == ("0 Height",)
    with pytest.raises(InputError, match=r"one of heights: 0 Height; got 'Potential'"):
        read_surface(path, channel="Potential")


def test_text_is_read_without_the_library(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "SurfaceTopography.IO", None)
    assert_is_the_map(read_surface(written(tmp_path, "a.csv", HEADER + MATRIX)).topography)


def test_what_the_library_warns_of_is_a_note(tmp_path, monkeypatch):
    import SurfaceTopography.IO as library

    opened = library.open_topography

    def warning(stream):
        warnings.warn("the scan was stopped", UserWarning, stacklevel=1)
        warnings.warn("an old function", DeprecationWarning, stacklevel=1)
        return opened(stream)

    monkeypatch.setattr(library, "open_topography", warning)
    path = gwyddion_file(tmp_path, Height="m")
    assert read_surface(path).notes == ("the scan was stopped",)


def test_the_library_prints_nothing(tmp_path, capfd):
    path = written(tmp_path, "a.ibw", b"\x05\0" + bytes(range(256)) * 8)
    with pytest.raises(InputError):
        read_surface(path)
    assert capfd.readouterr() == ("", "")
    assert logging.getLogger("igor2").propagate


def test_a_file_is_replaced_only_when_forced_and_only_in_a_format_and_a_folder_there(tmp_path):
    surface = Topography(HEIGHTS * 1e-9, STEP)
    path = tmp_path / "a.csv"
    write_topography(surface, path)
    with pytest.raises(InputError, match="--force"):
        write_topography(surface, path)
    write_topography(surface, path, force=True)
    with pytest.raises(OutputError, match="cannot be written"):
        write_topography(surface, tmp_path / "none" / "a.csv")
    with pytest.raises(InputError, match=r"must end in one of \.npy \.csv"):
        write_topography(surface, tmp_path / "a.gwy")
    assert [one.name for one in tmp_path.iterdir()] == ["a.csv"]

"""Records: what goes in comes out, the same bytes each time, and nothing is ever half there."""

from __future__ import annotations

import dataclasses
import json
import os
import subprocess
import sys
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray
from hypothesis import given, settings
from hypothesis import strategies as st

from asperity.config import Case, builtin
from asperity.errors import InputError, Outcome, OutputError
from asperity.results import netcdf_record, record_layout, results_folder
from asperity.results.read_record import read
from asperity.results.result import Curve, Result

sys.path.insert(0, str(Path(__file__).parents[1]))

from fake_result import bounce, loading


@pytest.fixture(scope="module")
def result() -> Result:
    return bounce(impacts=4)


@pytest.fixture(scope="module")
def curve() -> Curve:
    return loading()


def stored(content: bytes, folder: Path, name: str = "record.nc") -> Path:
    path = folder / name
    path.write_bytes(content)
    return path


def with_output(**changes: object) -> Case:
    return builtin("published-exact").replace(
        {f"output.{key}": value for key, value in changes.items()}
    )


def assert_same(found: Result | Curve, wanted: Result | Curve) -> None:
    for field in dataclasses.fields(wanted):
        a, b = getattr(found, field.name), getattr(wanted, field.name)
        if field.name == "input_sha256":
            continue
        if isinstance(b, dict) and any(isinstance(value, np.ndarray) for value in b.values()):
            assert list(a) == list(b)
            for key in b:
                np.testing.assert_array_equal(a[key], b[key])
        elif isinstance(b, np.ndarray):
            np.testing.assert_array_equal(a, b)
        else:
            assert a == b, field.name


def again(result: Result | Curve, folder: Path) -> Result | Curve:
    """What is read from the record of a result."""
    found = read(stored(netcdf_record.encode(result), folder))
    assert type(found) is type(result)
    return found


def test_results_curves_and_many_impacts_come_back_from_their_records(
    result: Result, curve: Curve, tmp_path: Path
):
    many = [0.1 + 1e-9 * number for number in range(10_000)]
    long = dataclasses.replace(result, measures={**result.measures, "restitution": many})
    for one in (result, curve, long):
        assert_same(again(one, tmp_path), one)


def test_xarray_reads_a_record_as_the_dataset(result: Result, tmp_path: Path):
    path = stored(netcdf_record.encode(result), tmp_path)
    with xarray.open_dataset(path) as found:
        xarray.testing.assert_equal(found.load(), result.dataset())
        assert found["time"].dtype == float
        assert found["rebound_height"].dims == ("impact",)


def test_the_same_result_gives_the_same_bytes_in_another_process(result: Result, tmp_path: Path):
    here = netcdf_record.encode(result)
    program = (
        "import sys; sys.path.insert(0, sys.argv[1]); from fake_result import bounce; "
        "from asperity.results import netcdf_record; "
        "sys.stdout.buffer.write(netcdf_record.encode(bounce(impacts=4)))"
    )
    command = [sys.executable, "-c", program, str(Path(__file__).parents[1])]
    there = subprocess.run(command, capture_output=True, check=True).stdout
    assert here == there
    assert netcdf_record.encode(read(stored(here, tmp_path))) == here


def test_a_record_says_what_made_it(result: Result, tmp_path: Path):
    given = dataclasses.replace(result, input_sha256="ab" * 32)
    path = stored(netcdf_record.encode(given), tmp_path)
    with netCDF4.Dataset(path) as held:
        said = {name: held.getncattr(name) for name in held.ncattrs()}
    assert said["input_sha256"] == "ab" * 32
    assert said["outcome"] == "rest"
    for name in ("asperity", "jax", "jaxlib", "numpy", "python"):
        assert said[f"{name}_version"]
    assert json.loads(said["measures"]) == result.measures
    assert os.uname().nodename not in str(said).replace(result.name, "")


def test_every_variable_of_a_record_has_a_unit_and_a_meaning(result: Result, curve: Curve):
    for dataset in (result.dataset(), curve.dataset()):
        for variable in dataset.variables.values():
            assert variable.attrs["units"]
            assert variable.attrs["long_name"]
    wanted = {"separation": "m", "speed": "m/s", "force_contact": "N", "power_loss": "W"}
    for name, unit in {**wanted, "energy_lost_capillary": "J"}.items():
        assert result.dataset()[name].attrs["units"] == unit


def test_without_motion_a_record_keeps_the_measures_alone(tmp_path: Path):
    result = bounce(impacts=4, case=with_output(motion=False))
    found = again(result, tmp_path)
    assert found.time.size == 0
    assert found.forces == {}
    assert found.measures == result.measures
    assert (tmp_path / "record.nc").stat().st_size < 10_000


def test_a_motion_without_an_impact_is_kept_too(result: Result, tmp_path: Path):
    measures = {
        key: [] if isinstance(value, list) else None for key, value in result.measures.items()
    }
    events = dict.fromkeys(result.events, np.empty(0))
    escaped = {"outcome": Outcome.ESCAPED, "measures": measures, "events": events}
    result = dataclasses.replace(result, **escaped)
    found = again(result, tmp_path)
    assert_same(found, result)
    assert "impacts" in found.summary()


def test_a_record_cut_short_is_refused(result: Result, tmp_path: Path):
    whole = netcdf_record.encode(result)
    for length in (0, 3, 100, 2000, -8000, -8, -1):
        with pytest.raises(InputError, match=r"record\.nc: must be a"):
            read(stored(whole[:length], tmp_path))


@given(data=st.data())
def test_a_changed_record_is_refused(result: Result, tmp_path_factory, data):
    content = bytearray(netcdf_record.encode(result))
    place = data.draw(st.integers(4, len(content) - 1))
    content[place] ^= data.draw(st.integers(1, 255))
    path = tmp_path_factory.getbasetemp() / "changed.nc"
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"changed\.nc: must be a"):
        read(path)


def test_what_is_no_record_is_refused(tmp_path: Path):
    other = tmp_path / "other.nc"
    with netCDF4.Dataset(other, "w", format="NETCDF3_64BIT_OFFSET") as dataset:
        dataset.createDimension("day", 3)
        dataset.createVariable("rain", "f8", ("day",))[:] = 1.0
    text, hdf = stored(b"hello", tmp_path, "text.nc"), b"\x89HDF\r\n\x1a\n" + bytes(50)
    for path, rule in (
        (other, "got another file"),
        (text, "text.nc: must be a record"),
        (stored(hdf, tmp_path, "hdf.nc"), "hdf.nc: must be a record"),
        (stored(b"", tmp_path, "empty.nc"), "empty.nc: must be a record"),
        (tmp_path / "none.nc", "no such file"),
        (tmp_path, "regular file"),
    ):
        with pytest.raises(InputError, match=rule):
            read(path)


@given(st.recursive(st.none() | st.floats() | st.text(max_size=9), st.lists, max_leaves=5))
@settings(max_examples=40)
def test_json_is_strict_whatever_the_values(value: object):
    text = json.dumps(record_layout.plain({"a": value, "b": np.float64("nan")}), allow_nan=False)
    assert json.loads(text)["b"] is None


def test_json_of_a_result_has_the_documented_keys(result: Result, curve: Curve):
    found = record_layout.json_object(result)
    assert list(found) == ["outcome", "regime", "measures", "ledger", "warnings"]
    assert found["outcome"] == "rest"
    assert found["regime"]["load_parameter"] is None
    assert list(record_layout.json_object(curve)) == [
        *("rigid_separation", "central_separation", "force_loading", "force_unloading"),
        *("minimum_separation", "pull_off", "pull_off_separation", "work_of_separation", "preload"),
        *("loss", "warnings"),
    ]


def test_a_result_saves_itself(result: Result, tmp_path: Path):
    folder = tmp_path / "new" / "folder"
    written = result.save(folder)
    assert [path.name for path in written] == list(results_folder.RUN_FILES)
    assert sorted(folder.iterdir()) == sorted(written)
    assert list(tmp_path.iterdir()) == [tmp_path / "new"]
    assert "came to rest" in (folder / "summary.txt").read_text()


def test_pictures_are_left_out_where_the_case_says_so(tmp_path: Path):
    case = with_output(pictures=False)
    assert list(bounce(impacts=2, case=case).files()) == ["record.nc", "summary.txt"]
    assert list(loading(case=case).files()) == ["curve.nc", "curve.txt"]


def write(folder: Path, *, force: bool = False, **files: bytes) -> list[Path]:
    named = {name.replace("_", "."): content for name, content in files.items()}
    return results_folder.write_folder(folder, named, results_folder.RUN_FILES, force=force)


def test_a_folder_in_use_is_refused_without_force(tmp_path: Path):
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(InputError, match=r"must be empty.*got mine\.txt"):
        results_folder.check_folder(tmp_path, results_folder.RUN_FILES)
    with pytest.raises(InputError, match="must be empty"):
        write(tmp_path, record_nc=b"1")
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]


def test_force_replaces_earlier_results_and_nothing_else(tmp_path: Path):
    (tmp_path / "mine.txt").write_text("mine")
    write(tmp_path, force=True, record_nc=b"1", motion_png=b"1", summary_txt=b"1")
    write(tmp_path, force=True, record_nc=b"2", summary_txt=b"2")
    found = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    assert found == {"mine.txt": b"mine", "record.nc": b"2", "summary.txt": b"2"}


def test_run_and_curve_of_a_case_share_a_folder_even_the_current_one(tmp_path: Path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    results_folder.check_folder(".", results_folder.RUN_FILES)
    assert write(Path(), record_nc=b"1") == [Path("record.nc")]
    results_folder.write_folder(tmp_path, {"curve.nc": b"2"}, results_folder.CURVE_FILES)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["curve.nc", "record.nc"]
    with pytest.raises(InputError, match="must be empty"):
        results_folder.check_folder(tmp_path, results_folder.CURVE_FILES)


def test_new_files_have_the_usual_rights(tmp_path: Path):
    plain = tmp_path / "plain"
    plain.mkdir()
    (plain / "file").touch()
    write(tmp_path / "new", record_nc=b"1")
    assert (tmp_path / "new").stat().st_mode == plain.stat().st_mode
    assert (tmp_path / "new" / "record.nc").stat().st_mode == (plain / "file").stat().st_mode


@pytest.mark.parametrize(
    ("failure", "told", "words"),
    [
        (OSError(28, "No space"), OutputError, r"motion\.png: cannot be written: No space"),
        (KeyboardInterrupt(), KeyboardInterrupt, None),
    ],
)
def test_a_failure_leaves_nothing_behind_and_an_earlier_result(
    tmp_path: Path, monkeypatch, failure, told, words
):
    write(tmp_path / "earlier", record_nc=b"1", summary_txt=b"1")
    original = Path.write_bytes

    def fail(path: Path, content: bytes) -> int:
        if path.name == "motion.png":
            raise failure
        return original(path, content)

    monkeypatch.setattr(Path, "write_bytes", fail)
    for folder, force in (("a/b", False), ("earlier", True)):
        with pytest.raises(told, match=words):
            write(tmp_path / folder, force=force, record_nc=b"2", motion_png=b"2")
    assert [path.name for path in tmp_path.iterdir()] == ["earlier"]
    found = {path.name: path.read_bytes() for path in (tmp_path / "earlier").iterdir()}
    assert found == {"record.nc": b"1", "summary.txt": b"1"}


def test_a_place_that_cannot_be_written_is_found_before_computing(tmp_path: Path):
    (tmp_path / "file").touch()
    (tmp_path / "taken" / "record.nc").mkdir(parents=True)
    (tmp_path / "link").symlink_to("nowhere")
    for place in ("file", "file/below", "link", "x" * 300):
        with pytest.raises(OutputError, match="cannot be written"):
            results_folder.check_folder(tmp_path / place, results_folder.RUN_FILES)
    with pytest.raises(OutputError, match="Is a directory"):
        results_folder.check_folder(tmp_path / "taken", results_folder.RUN_FILES, force=True)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file", "link", "taken"]

"""Cases whose roughness is measured: what they take from files, refuse, record and compute."""

import dataclasses
import json

import numpy as np
import pytest
from typer.testing import CliRunner

import asperity
from asperity.cli import app
from asperity.config import load, load_file
from asperity.config.resolve import resolve
from asperity.errors import Outcome
from asperity.model import build
from asperity.regimes.validity import CLASSED, _one_law, _surface
from asperity.results import netcdf_record, record_layout
from asperity.results.read_record import read
from asperity.surfaces import Topography
from asperity.surfaces.description.sum_of_maps import added
from asperity.surfaces.description.summits import find_summits
from asperity.surfaces.files.write_surface import write_topography
from asperity.surfaces.generation.generate import self_affine
from asperity.surfaces.heights import Gaussian
from asperity.surfaces.preparation.prepare import Preparation, prepared
from fake_result import loading
from refused_input import refusal

MADE = self_affine(
    (128, 128), (10e-9, 10e-9), hurst=0.8, rolloff=240e-9, cutoff=50e-9, rms_height=2e-9, seed=4
)
CASE = """
[body]
radius = "20 um"
material = "silica"
[counterface]
material = "silicon"
deformation = "rigid"
[roughness]
files = ["surface.nc"]
source = "summits"
[adhesion]
model = "dmt"
work = "30 mJ/m^2"
equilibrium_spacing = "0.2 nm"
[capillary]
model = "equilibrium"
liquid = "water"
humidity = 0.5
temperature = "20 degC"
contact_angle = "50 deg"
[impact]
speed = "10 mm/s"
[numerics]
max_impacts = 3
"""
FILES = "roughness.files"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A case beside the surface that it names."""
    place = tmp_path_factory.mktemp("measured")
    write_topography(MADE, place / "surface.nc")
    (place / "case.toml").write_text(CASE, encoding="utf-8")
    return place


@pytest.fixture(scope="module")
def holed(folder):
    """A surface of which some pixels are missing."""
    heights = np.array(MADE.heights)
    heights[40:44, 50:53] = np.nan
    write_topography(Topography(heights, MADE.pixel_size), folder / "holed.nc")
    return str(folder / "holed.nc")


@pytest.fixture(scope="module")
def case(folder):
    return load_file(folder / "case.toml")


@pytest.fixture(scope="module")
def solved(case):
    return asperity.solve(case, name="measured", critical=False)


def refused(action, *parts):
    """The one line with which an action refuses its input."""
    message = str(refusal(action))
    assert all(part in message for part in parts), message


def changed(case, **changes):
    return case.replace({f"roughness.{key}": value for key, value in changes.items()})


def test_files_of_a_case_are_looked_for_in_its_folder(folder, case, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert case.roughness.files == [str(folder / "surface.nc")]
    assert (
        resolve(load_file(folder / "case.toml")).asperities.summits.count
        == resolve(case).asperities.summits.count
    )


def test_a_case_has_the_summits_of_its_levelled_map(case):
    found, rough = find_summits(prepared(MADE, Preparation()).topography), resolve(case).asperities
    assert rough.asperity_density == pytest.approx(found.density)
    assert rough.asperity_radius == pytest.approx(found.radius)
    assert rough.rms_height == pytest.approx(found.heights.std())
    assert rough.mean_height == pytest.approx(found.heights.mean())
    np.testing.assert_allclose(rough.summits.heights, found.heights)


def test_gaussian_takes_rms_mean_height_density_and_radius_of_the_summits(case):
    built = build(resolve(changed(case, source="gaussian"))).contact.interface
    rough = resolve(case).asperities
    assert isinstance(built.heights, Gaussian)
    assert float(built.heights.rms_height) == pytest.approx(rough.rms_height)
    assert float(built.heights.mean_height) == pytest.approx(rough.mean_height)
    assert float(built.density) == pytest.approx(rough.asperity_density)
    assert float(built.law.parts[0].radius) == pytest.approx(rough.asperity_radius)


def test_the_ledger_of_measured_summits_closes(solved):
    assert solved.outcome is Outcome.MAX_IMPACTS
    assert solved.ledger["energy_balance_error"] < 1e-6
    assert solved.ledger["lost"]["capillary"] > 0.0
    assert solved.measures["restitution"][0] < 1.0


DRY = {"adhesion": None, "capillary": None, "numerics.max_impacts": 1}


def test_hertz_alone_on_measured_summits_returns_all_energy(case, holed):
    bare = changed(case, files=[holed], missing="keep").replace(DRY)
    result = asperity.solve(bare, critical=False)
    assert any("12 of 16384 pixels" in line for line in result.warnings)
    assert result.measures["restitution"][0] == pytest.approx(1.0, abs=1e-8)
    assert result.ledger["energy_balance_error"] < 1e-6


@pytest.mark.long
@pytest.mark.parametrize(
    ("source", "changes", "limit"),
    [
        ("gaussian", {}, 1e-6),
        ("gaussian", {"adhesion.model": "jkr", "capillary": None}, 1e-6),
        ("summits", {"adhesion.model": "jkr", "capillary": None}, 1e-6),
        ("gaussian", {"counterface.deformation": "half-space"}, 1e-6),
        ("summits", {"counterface.deformation": "half-space", "numerics.rings": 200}, 1e-6),
    ],
)
def test_the_ledger_closes_with_either_source_on_either_body(case, source, changes, limit):
    """Few summits make a coarse law: with 80 rings the last closes to 2.5e-6, and says so."""
    changes = {"numerics.max_impacts": 2, **changes}
    result = asperity.solve(changed(case, source=source).replace(changes), critical=False)
    assert result.ledger["energy_balance_error"] < limit


def test_record_and_json_hold_the_surface_and_come_back(solved, folder, tmp_path):
    path = tmp_path / "record.nc"
    path.write_bytes(netcdf_record.encode(solved))
    surface = read(path).surface
    assert surface == record_layout.plain(solved.surface)
    assert surface["source"] == "summits"
    assert surface["summits"] == resolve(solved.case).asperities.summits.count
    (file,) = surface["files"]
    assert (file["file"], len(file["sha256"])) == (str(folder / "surface.nc"), 64)
    found = json.loads(json.dumps(record_layout.json_object(solved), allow_nan=False))
    assert found["surface"] == surface
    assert "Surface" in solved.summary()


def call(*arguments):
    return CliRunner().invoke(app, [str(each) for each in arguments])


def recorded(solved, folder, surface=None):
    """A record of a case of its own folder."""
    (folder / "case.toml").write_text(CASE, encoding="utf-8")
    case, record = load_file(folder / "case.toml"), folder / "record.nc"
    surface = solved.surface if surface is None else resolve(case).asperities.facts
    record.write_bytes(
        netcdf_record.encode(dataclasses.replace(solved, case=case, surface=surface))
    )
    return record


def test_a_surface_file_that_has_gone_is_one_line(solved, tmp_path):
    """Of a case, and of a record, which names the file and does not hold it."""
    record = recorded(solved, tmp_path)
    for file in (tmp_path / "case.toml", record):
        found = call("run", file, "-o", tmp_path / "out")
        assert found.exit_code == 2
        assert found.stderr.count("\n") == 1
        assert "surface.nc" in found.stderr


def test_a_record_is_not_run_again_on_a_surface_that_has_changed(solved, tmp_path):
    """Another answer under the same name would be no record of it."""
    surface = tmp_path / "surface.nc"
    write_topography(MADE, surface)
    record = recorded(solved, tmp_path, surface)
    assert call("regime", record).exit_code == 0
    there = load_file(tmp_path / "case.toml")
    facts = resolve(there).asperities.facts
    write_topography(MADE.with_heights(2.0 * MADE.heights), surface, force=True)
    found = call("run", record, "-o", tmp_path / "out")
    assert found.exit_code == 2
    assert "surface.nc, which has changed since" in found.stderr
    curve = tmp_path / "curve.nc"
    curve.write_bytes(netcdf_record.encode(dataclasses.replace(loading(case=there), surface=facts)))
    assert "surface.nc, which has changed since" in call("run", curve).stderr


def test_a_changed_file_is_read_anew(tmp_path):
    path = tmp_path / "surface.nc"
    write_topography(MADE, path)
    case = load(CASE).replace({FILES: [str(path)]})
    before = resolve(case).asperities.rms_height
    write_topography(MADE.with_heights(2.0 * MADE.heights), path, force=True)
    assert resolve(case).asperities.rms_height == pytest.approx(2.0 * before)


def test_two_files_are_the_sum_of_their_maps(folder, case, tmp_path):
    other = self_affine(
        (128, 128), (10e-9, 10e-9), hurst=0.5, rolloff=300e-9, cutoff=60e-9, rms_height=1e-9, seed=9
    )
    write_topography(other, tmp_path / "other.nc")
    both = changed(case, files=[str(folder / "surface.nc"), str(tmp_path / "other.nc")])
    maps = [prepared(each, Preparation()).topography for each in (MADE, other)]
    whole = added(*maps)
    assert resolve(both).surface_rms_height == pytest.approx(whole.rms_height)
    assert resolve(both).asperities.summits.count == find_summits(whole).count
    assert resolve(both).asperities.facts["added"]
    refused(lambda: changed(case, files=["a", "b", "c"]), "roughness.files")


def test_missing_pixels_are_refused_kept_or_filled_and_counted(case, holed):
    refused(lambda: resolve(changed(case, files=[holed])).asperities, "holed.nc", "12", "missing")
    for choice in ("keep", "fill"):
        rough = resolve(changed(case, files=[holed], missing=choice)).asperities
        assert rough.facts["files"][0]["missing_pixels"] == 12
        assert any("12 of 16384 pixels" in line for line in rough.warnings)
    # What is missing has the density of what was measured.
    kept = resolve(changed(case, files=[holed], missing="keep")).asperities
    found = find_summits(kept.surface)
    assert found.searched < 1.0
    assert kept.asperity_density == pytest.approx(found.density / found.searched)


REFUSED = [
    ({"rms_height": "1 nm"}, "`rms_height` and `files` exclude each other"),
    ({"asperity_density": "1e14 1/m^2"}, "`asperity_density` and `files` exclude each other"),
    ({"source": "summit"}, "did you mean 'summits'"),
    ({"source": "gaussian", "radius_classes": 4}, "must be absent without source = 'summits'"),
    ({"radius_classes": 0}, "[1, 64]"),
    ({"size": "10 kg"}, "`size`"),
    ({"files": []}, "`files`"),
    ({"files": None, "source": None}, "is missing; give it, or `files` of measured surfaces"),
    ({"s_filter": "2 um", "l_filter": "1 um"}, "`s_filter`"),
]


@pytest.mark.parametrize(("changes", "rule"), REFUSED, ids=range(len(REFUSED)))
def test_a_table_that_contradicts_itself_is_refused(case, changes, rule):
    refused(lambda: changed(case, **changes), rule)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("size", "1 um x 1 um"),
        ("unit", "nm"),
        ("source", "gaussian"),
        ("missing", "keep"),
        ("form_removal", "tilt"),
        ("s_filter", "10 nm"),
    ],
)
def test_what_is_for_files_is_refused_without_them(case, key, value):
    numbers = {"asperity_density": "1e14 1/m^2", "asperity_radius": "1 nm", "rms_height": "1 nm"}
    refused(lambda: case.replace({"roughness": {**numbers, key: value}}), f"`{key}` must be absent")


def test_too_few_summits_are_refused_with_file_and_number(case, tmp_path):
    smooth = self_affine(
        (48, 48), (10e-9, 10e-9), hurst=0.8, cutoff=240e-9, rms_height=1e-9, seed=1
    )
    write_topography(smooth, tmp_path / "smooth.nc")
    few = changed(case, files=[str(tmp_path / "smooth.nc")])
    refused(
        lambda: resolve(few).asperities, "smooth.nc", "at least 10; got", "measure a larger area"
    )


def test_a_surface_smaller_than_the_contact_is_refused_by_run(folder, tmp_path):
    """A fast and large sphere sinks in until the contact is wider than the map."""
    text = CASE.replace('"20 um"', '"2 mm"').replace('"10 mm/s"', '"1 m/s"')
    text = text.replace('["surface.nc"]', f'["{folder}/surface.nc"]')
    path = tmp_path / "large.toml"
    path.write_text(text, encoding="utf-8")
    found = call("run", path, "-o", tmp_path / "out")
    assert (found.exit_code, found.stderr.count("\n")) == (2, 1)
    for part in ("large.toml", "roughness.files", "larger than the contact", "um wide"):
        assert part in found.stderr


FILLED = {"capillary.model": "kelvin-filling", "capillary.humidity": 0.9}


@pytest.mark.parametrize("source", ["gaussian", "summits"])
def test_liquid_on_the_surface_sees_its_rms_height_not_that_of_the_summits(case, source):
    filled = changed(case, source=source).replace(FILLED)
    layers = build(resolve(filled)).contact.interface
    surface = prepared(MADE, Preparation()).topography.rms_height
    assert float(layers.parts[-1].heights.rms_height) == pytest.approx(surface)
    assert surface > 1.02 * resolve(filled).asperities.rms_height
    rule = "`surface_rms_height`"
    refused(lambda: filled.replace({"capillary.surface_rms_height": "3 nm"}), rule)


def test_menisci_that_take_time_go_with_weighted_summits_and_not_with_classes(case):
    late = case.replace({"capillary.formation_time": "1 us"})
    assert build(resolve(late)).delayed is not None
    changes = {"adhesion.model": "jkr", "capillary.model": "constant-volume"}
    classed = changed(late, radius_classes=1).replace(changes)
    refused(lambda: build(resolve(classed)), "formation_time")


def test_a_case_with_files_comes_back_from_its_text(case):
    given = changed(
        case, radius_classes=4, missing="fill", l_filter="1 um", size="1.28 um x 1.28 um"
    )
    assert load(given.toml()) == given
    assert load(case.toml()) == case


def test_radius_classes_are_in_use_where_a_law_needs_them_and_too_few_are_warned_of(case):
    """One class would leave out more of the bonds' work than passes without a warning."""
    assert build(resolve(case)).class_error == 0.0
    jkr = case.replace({"adhesion.model": "jkr", "capillary": None})
    coarse, fine = (build(resolve(changed(jkr, radius_classes=count))) for count in (1, 6))
    assert coarse.class_error < -CLASSED < fine.class_error < 0.0
    assert (coarse.contact.interface.count, fine.contact.interface.count) == (1, 6)
    lines = _surface(coarse)
    assert any("1 classes of tip radius" in line and "too small" in line for line in lines)
    assert not any("classes of tip radius" in line for line in _surface(fine))


def test_a_law_chosen_for_all_radii_that_would_differ_is_named(case):
    """Tips whose Tabor numbers lie on both sides of a border of the laws."""
    adhesion = case.adhesion.model_copy(update={"model": "auto", "equilibrium_spacing": 3e-10})
    said = {}
    for work in (1e-4, 0.017):
        each = case.model_copy(update={"adhesion": adhesion.model_copy(update={"work": work})})
        said[work] = _one_law(resolve(each))
    assert said[1e-4] == []
    assert len(said[0.017]) == 1
    assert "DMT and Maugis-Dugdale" in said[0.017][0]

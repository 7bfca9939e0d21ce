"""Results of a study looked at: dataset, pictures, tables, what particle codes read."""

import csv
import dataclasses
import importlib
import json
import math
import re
import shutil
from collections.abc import Callable
from pathlib import Path

import hypothesis.extra.numpy as arrays
import numpy as np
import pytest
import xarray
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure

import asperity
from asperity.cli import exporting, study_plots
from asperity.errors import InputError, OutputError
from asperity.plots import study, style
from asperity.plots.study.drawn_quantities import axis_quantity
from asperity.plots.study.maps import boundary
from asperity.results.result import Curve
from asperity.sweeps.analysis import force_table, restitution_table
from asperity.sweeps.analysis.export import export
from asperity.sweeps.analysis.pareto import Goal, front_of, goal_of, undominated
from asperity.sweeps.analysis.view import at, view_of, words
from asperity.sweeps.store.dataset import open_study
from asperity.sweeps.store.store import Store
from asperity.sweeps.study.study import parse
from commands import names
from study_results import GRID, KEEP, REST, SAMPLE, SPEEDS, law, stored

ROUGH, HUMID, SPEED = "roughness.rms_height", "capillary.humidity", "impact.speed"
LOST = frozenset({5, *range(100, 130)})
MANY = KEEP + (
    '[axes]\n"roughness.rms_height" = {from = "8 nm", to = "12 nm", steps = 12}\n'
    '"capillary.humidity" = {from = 0.1, to = 0.5, steps = 10}\n'
    '"impact.speed" = {values = ["0.1 m/s", "0.15 m/s", "0.2 m/s"]}\n'
    '"adhesion.model" = {values = ["dmt", "none"]}\n'
)


@pytest.fixture(scope="module")
def stores(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    one = KEEP + '[axes]\n"capillary.humidity" = {values = [0.2]}\n'
    texts = {"grid": GRID, "speeds": SPEEDS, "sample": SAMPLE, "many": MANY, "one case": one}
    failed = {"grid": LOST}
    return {
        name: stored(tmp_path_factory.mktemp("store"), text, failed.get(name, frozenset()))
        for name, text in texts.items()
    }


@pytest.fixture(scope="module")
def grid(stores: dict[str, Path]) -> xarray.Dataset:
    return open_study(stores["grid"])


# The dataset


def test_a_grid_has_its_axes_as_dimensions_with_units(grid):
    assert dict(grid.sizes) == {ROUGH: 41, HUMID: 21, "impact": 1}
    np.testing.assert_allclose(grid[ROUGH], 8e-9 * 1.5 ** (np.arange(41) / 40.0), rtol=1e-14)
    np.testing.assert_allclose(grid[HUMID], 0.1 + 0.02 * np.arange(21), rtol=1e-14)
    assert grid[ROUGH].attrs["units"] == "m"
    assert grid["time_to_rest"].attrs["units"] == "s"
    assert "reason" not in grid
    assert asperity.open_study is open_study


def test_every_case_of_a_grid_stands_at_its_own_values(grid):
    rough, humid = np.meshgrid(grid[ROUGH], grid[HUMID], indexing="ij")
    _, bounce = law({ROUGH: rough.ravel(), HUMID: humid.ravel()})
    bounce[list(LOST)] = np.nan
    np.testing.assert_array_equal(grid["restitution"].values.ravel(), bounce)


def test_a_sample_has_its_cases_as_dimension_and_the_axes_along_it(stores):
    found = open_study(stores["sample"])
    assert dict(found.sizes) == {"case": 256, "impact": 1}
    values = {key: found[key].values for key in (ROUGH, HUMID, "adhesion.model")}
    np.testing.assert_array_equal(found["restitution"].values[:, 0], law(values)[1])


def test_failed_cases_keep_their_reason_and_are_counted(stores):
    found = open_study(stores["grid"], ["reason"])
    assert set(found.data_vars) == {"outcome", "reason"}
    texts = found["reason"].values.ravel()
    assert [case for case, text in enumerate(texts) if text] == sorted(LOST)
    assert texts[5] == "the contact folds: é"
    assert (found.attrs["failed"], found.attrs["computed"]) == (31, 861)
    meanings = found["outcome"].attrs["flag_meanings"].split()
    codes = found["outcome"].attrs["flag_values"]
    assert meanings[list(codes).index(found["outcome"].values.ravel()[5])] == "failed"


def test_cases_not_computed_are_counted_and_empty(tmp_path):
    text = GRID.replace("[axes]", '[axes]\n"adhesion.model" = {values = ["jkr", "dmt"]}')
    study, store = parse(text), stored(tmp_path, text, tasks=1)
    assert study.tasks > 1
    found = open_study(store)
    assert found.attrs["cases"] == study.size
    done = len(study.task(0))
    assert found.attrs["computed"] == done
    rest = found["restitution"].values.reshape(study.size)[done:]
    assert np.all(np.isnan(rest))
    assert np.all(found["captured"].values.ravel()[done:] == -1)
    with export(store, tmp_path / "part.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == study.size
    assert rows[-1]["outcome"] == "not_computed"
    assert rows[-1]["restitution [1]"] == rows[-1]["impacts [1]"] == ""


@pytest.mark.parametrize("name", ["grid", "many", "sample"])
def test_xarray_alone_opens_a_store_with_coordinates_and_units(stores, name):
    found, whole = xarray.open_zarr(stores[name], chunks=None), open_study(stores[name])
    assert set(found.coords) == set(whole.coords)
    for key in (*whole.coords, *whole.data_vars):
        assert found[key].dims == whole[key].dims
        assert found[key].attrs.get("units") == whole[key].attrs.get("units")
        assert found[key].attrs["long_name"] == whole[key].attrs["long_name"]
        values = found[key].values
        if whole[key].dtype == object and "flag_meanings" in found[key].attrs:
            values = np.array(found[key].attrs["flag_meanings"].split())[values]
        np.testing.assert_array_equal(values.astype(whole[key].dtype), whole[key].values)
    for key in ("outcome", "captured"):
        assert found[key].attrs["flag_meanings"] == whole[key].attrs["flag_meanings"]


def test_an_unknown_column_is_refused_with_the_one_meant(stores):
    with pytest.raises(InputError, match="did you mean 'restitution'"):
        open_study(stores["grid"], ["restitutio"])


def damage_chunk(store: Path) -> None:
    (chunk,) = (store / "restitution").glob("c*")
    chunk.write_bytes(chunk.read_bytes()[:-1] + b"?")


def drop_array(store: Path) -> None:
    shutil.rmtree(store / "restitution")


@pytest.mark.parametrize("harm", [damage_chunk, drop_array])
def test_a_harmed_store_is_refused_with_what_to_do(tmp_path, harm):
    store = stored(tmp_path, SPEEDS)
    harm(store)
    with pytest.raises(InputError, match=r"restitution.*--repair") as caught:
        open_study(store)
    assert str(store) in str(caught.value)
    assert "\n" not in str(caught.value)
    if harm is damage_chunk:  # the others stay readable
        assert open_study(store, ["captured"]).attrs["computed"] == 19


def test_a_store_of_a_newer_schema_is_refused(tmp_path):
    store = stored(tmp_path, SPEEDS)
    about = json.loads((store / "zarr.json").read_text())
    about["attributes"]["schema"] = 4
    (store / "zarr.json").write_text(json.dumps(about))
    with pytest.raises(InputError, match=r"schema.*got 4"):
        open_study(store)


def test_what_is_no_store_is_refused(tmp_path):
    (tmp_path / "file.zarr").write_text("no store")
    for name in ("none.zarr", "file.zarr", "."):
        with pytest.raises(InputError, match="store"):
            open_study(tmp_path / name)


# What is drawn over what


def test_two_long_axes_of_numbers_make_a_map(grid):
    view = view_of(grid)
    assert (view.kind, view.x, view.y, view.measures) == ("map", ROUGH, HUMID, ("restitution",))


def test_a_short_axis_is_colours_and_words_go_before_numbers(stores):
    held, _ = at(open_study(stores["many"]), {HUMID: "0.3"})
    view = view_of(held)
    assert (view.kind, view.x, view.series, view.facet) == (
        "lines", ROUGH, "adhesion.model", SPEED
    )  # fmt: skip


def test_too_many_axes_are_refused_with_what_to_hold_fixed(stores):
    with pytest.raises(InputError, match=r"add --at adhesion\.model=none$"):
        view_of(open_study(stores["many"]))


@pytest.mark.parametrize("kind", ["map", "lines"])
def test_axes_of_one_value_are_held_unasked(grid, kind):
    wider = grid.expand_dims({SPEED: [0.1]}, axis=1)
    wider[SPEED].attrs = {"units": "m/s", "long_name": "impact speed", "scale": "linear"}
    wider.attrs["axes"] = [ROUGH, SPEED, HUMID]
    held = {HUMID: "0.3"} if kind == "lines" else {}
    assert study.pictures(wider, held=held) == study.pictures(grid, held=held)


def test_held_axes_take_the_nearest_value_in_their_own_scale(grid):
    values = grid[ROUGH].values
    between = float(np.sqrt(values[10] * values[11]))  # their arithmetic mean is farther
    for shift, index in ((0.9999, 10), (1.0001, 11)):
        held, words = at(grid, {ROUGH: f"{between * shift!r} m"})
        assert float(held[ROUGH]) == values[index]
        assert words == f"rms height {values[index] * 1e9:.4g} nm"


@pytest.mark.parametrize(
    ("held", "words"),
    [
        ({"capillary.humidty": "0.2"}, "did you mean 'capillary.humidity'"),
        ({ROUGH: "9"}, "unit"),
        ({ROUGH: "9 kg"}, "a length"),
        ({HUMID: "wet"}, "must be a number"),
        ({HUMID: "nan"}, "must be a number"),
    ],
)
def test_held_values_must_be_of_the_axis(grid, held, words):
    with pytest.raises(InputError, match=words):
        at(grid, held)


@pytest.mark.parametrize(
    ("name", "options", "words"),
    [
        ("grid", {"measure": "restitutio"}, "did you mean 'restitution'"),
        ("grid", {"x": "roughness"}, "`x` must name an axis"),
        ("grid", {"x": ROUGH, "y": ROUGH}, "two axes"),
        ("many", {"y": "adhesion.model"}, "axis of numbers"),
        ("sample", {"y": HUMID}, "sample"),
        ("speeds", {"y": SPEED}, "another axis"),
        ("one case", {}, "one case"),
    ],
)
def test_pictures_that_cannot_be_are_refused(stores, name, options, words):
    with pytest.raises(InputError, match=words):
        study.pictures(open_study(stores[name]), **options)


def test_a_measure_that_says_nothing_new_gets_no_panel(stores, grid):
    found = open_study(stores["speeds"])
    assert view_of(found).measures == ("restitution", "time_to_rest")  # over the speed itself
    assert view_of(found, measure="impact_speed").measures == ("impact_speed",)
    found["time_to_rest"].values[...] = np.nan
    assert view_of(found).measures == ("restitution",)
    held, _ = at(grid.copy(deep=True), {HUMID: "0.3"})
    assert view_of(held).measures == ("restitution", "time_to_rest")  # of one impact speed
    held["impact_speed"].values[:10] *= 1.1
    assert view_of(held).measures == ("restitution", "time_to_rest", "impact_speed")


def test_panels_side_by_side_span_the_same_values(stores):
    found = open_study(stores["speeds"])
    found["time_to_rest"].values[9:] = np.nan  # these never come to rest
    _, drawn = study.figure(found)
    first, second = (axes.get_xlim() for axes in drawn.axes)
    assert first == second
    assert first[0] < 50.0 < 500.0 < first[1]


def test_capture_is_drawn_before_how_the_motion_ended(tmp_path):
    text = SPEEDS.replace('"impact_speed", "restitution", "time_to_rest"', '"impact_speed"')
    found = open_study(stored(tmp_path, text))
    assert view_of(found).measures[0] == "captured"


# The boundary between capture at the first impact and rebound


def disagreeing(found: xarray.Dataset) -> xarray.Dataset:
    """Results of which only the first half is captured, though all come to rest in the end."""
    found = found.copy(deep=True)
    assert set(found["outcome"].values.ravel()) == {REST}
    found["captured"].values.ravel()[:] = np.arange(found["captured"].size) < 10
    found["impacts"].values[...] = 1
    return found


def legend_of(drawn: Figure) -> list[str]:
    (legend,) = drawn.legends
    return [text.get_text() for text in legend.get_texts()]


def test_lines_shade_capture_at_the_first_impact_and_not_rest(stores):
    found = disagreeing(open_study(stores["speeds"]))
    _, drawn = study.figure(found)
    assert legend_of(drawn) == ["captured at the first impact"]
    speeds = 1e3 * found[SPEED].values
    for axes in drawn.axes:
        (span,) = axes.patches
        ends = span.get_x(), span.get_x() + span.get_width()
        assert [bool(ends[0] < v < ends[1]) for v in speeds] == (np.arange(19) < 10).tolist()


def test_maps_and_points_tell_capture_at_the_first_impact_from_rebound(stores):
    found = disagreeing(open_study(stores["sample"]))
    _, drawn = study.figure(found)
    assert legend_of(drawn) == ["rebounds", "captured at the first impact"]
    assert [line.get_xdata().size for line in drawn.axes[0].lines] == [246, 10]
    _, drawn = study.figure(open_study(stores["grid"]), measure="outcome")
    assert legend_of(drawn) == ["rest", "captured at the first impact | rebounds", "failed"]
    _, drawn = study.figure(open_study(stores["grid"]), measure="captured")
    assert legend_of(drawn) == ["rebounds", "captured at the first impact", "failed"]


@given(arrays.arrays(int, arrays.array_shapes(min_dims=2, max_dims=2), elements=st.integers(-1, 1)))
def test_the_boundary_runs_between_every_pair_of_cells_that_differ(held):
    rows, columns = held.shape
    x, y = np.arange(columns + 1.0), np.arange(rows + 1.0) ** 2
    wanted = set()
    for row in range(rows):
        for column in range(columns):
            here = held[row, column]
            if column + 1 < columns and {here, held[row, column + 1]} == {0, 1}:
                wanted.add((x[column + 1], y[row], x[column + 1], y[row + 1]))
            if row + 1 < rows and {here, held[row + 1, column]} == {0, 1}:
                wanted.add((x[column], y[row + 1], x[column + 1], y[row + 1]))
    found = [tuple(piece.ravel()) for piece in boundary((x, y), held)]
    assert len(found) == len(wanted)
    assert set(found) == wanted


def test_a_map_draws_the_boundary_where_the_law_has_it(stores):
    found = open_study(stores["grid"])
    _, drawn = study.figure(found)
    lines = [c for c in drawn.axes[0].collections if type(c).__name__ == "LineCollection"]
    points = np.concatenate(lines[0].get_segments())
    # law: sticks where (0.1/0.2)^2 (humidity/0.2) > (rms height/10 nm)^4
    rough = points[:, 0] * 1e-9 / 1e-8
    exact = 0.2 * rough**4 / 0.25
    step = 0.02 + 4 * 0.8 * rough**3 * rough * math.log(1.5) / 40.0
    assert drawn.axes[0].get_ylabel().endswith("[%]")
    assert (drawn.axes[0].get_xscale(), drawn.axes[0].get_yscale()) == ("log", "linear")
    assert np.all(np.abs(points[:, 1] / 100.0 - exact) <= step)


def test_failed_cells_are_hatched_and_no_others(grid):
    _, drawn = study.figure(grid)
    (hatched,) = (c for c in drawn.axes[0].collections if type(c).__name__ == "PolyCollection")
    centres = {divmod(case, 21) for case in LOST}
    inside = set()
    for path in hatched.get_paths():
        box = path.get_extents()
        x, y = grid[ROUGH].values * 1e9, 100.0 * grid[HUMID].values
        inside |= {
            (i, j)
            for i in np.flatnonzero((x > box.x0) & (x < box.x1))
            for j in np.flatnonzero((y > box.y0) & (y < box.y1))
        }
    assert inside == centres


# The Pareto front

POINTS = st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6)), min_size=1, max_size=30)


@given(POINTS)
def test_the_front_holds_what_no_other_point_beats(points):
    pairs = np.array(points, dtype=float)
    found = {tuple(pair) for pair in pairs[undominated(*pairs.T)]}
    wanted = {
        (a, b) for a, b in points
        if not any(c <= a and d <= b and (c, d) != (a, b) for c, d in points)
    }  # fmt: skip
    assert found == wanted
    assert len(found) == undominated(*pairs.T).size


@pytest.mark.parametrize("ways", ["min min", "min max", "max min", "max max"])
def test_goals_say_which_way_is_better(grid, ways):
    first, second = (way == "max" for way in ways.split())
    goals = (Goal("impact_speed", first), Goal("restitution", second))
    front = front_of(grid, goals)  # one speed: the front is the best restitution alone
    pick = np.nanmax if second else np.nanmin
    assert front.values[1, front.best].tolist() == [pick(grid["restitution"].values)]


@pytest.mark.parametrize("text", ["restitution", "best:restitution", "min:", ""])
def test_goals_of_another_form_are_refused(text):
    with pytest.raises(InputError, match="min:MEASURE or max:MEASURE"):
        goal_of(text)


def test_the_front_is_listed_with_the_axes_of_its_cases(stores):
    found = open_study(stores["sample"])
    goals = (goal_of("min:time_to_rest"), goal_of("max:restitution"))
    listed = study.pictures(found, pareto=goals)["pareto.csv"].decode().splitlines()
    assert listed[0] == f"{ROUGH} [m],{HUMID} [1],adhesion.model,time_to_rest [s],restitution [1]"
    for row in csv.reader(listed[1:]):
        values = {ROUGH: np.array([float(row[0])]), HUMID: np.array([float(row[1])]),
                  "adhesion.model": np.array([row[2]])}  # fmt: skip
        assert float(row[4]) == law(values)[1][0]


# Pictures

DRAWN = {
    "map": ("grid", {}),
    "flags": ("grid", {"measure": "captured"}),
    "outcomes": ("grid", {"measure": "outcome"}),
    "lines": ("grid", {"held": {HUMID: "0.33"}}),
    "speeds": ("speeds", {}),
    "facets": ("many", {"held": {"adhesion.model": "none"}}),
    "series": ("many", {"held": {HUMID: "0.3"}}),
    "close values": ("close", {"held": {"adhesion.model": "none"}, "measure": "restitution"}),
    "flags along a line": ("grid", {"held": {HUMID: "0.33"}, "measure": "outcome"}),
    "sample": ("sample", {}),
    "sample over one axis": ("sample", {"x": "adhesion.model", "measure": "time_to_rest"}),
}


def drawable(stores: dict[str, Path], name: str) -> xarray.Dataset:
    """Results by name; "close" has numbers of many digits along its axes."""
    found = open_study(stores["many" if name == "close" else name])
    if name == "close":
        found["restitution"].values[...] = 0.9999 + 1e-5 * found["restitution"].values
    return found


@pytest.mark.parametrize("what", ["map", "facets", "sample"])
def test_pictures_are_png_and_svg_and_the_same_twice(stores, what):
    name, options = DRAWN[what]
    found = drawable(stores, name)
    pictures = study.pictures(found, **options)
    assert {file.rpartition(".")[2] for file in pictures} == {"png", "svg"}
    assert pictures == study.pictures(found, **options)


def texts(figure: Figure) -> list[tuple[str, tuple[float, float, float, float]]]:
    """Labels, titles, ticks and legend texts of a drawn figure, with their boxes."""
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()  # type: ignore[attr-defined]
    found = [*figure.texts]
    for legend in figure.legends:
        found += [legend.get_title(), *legend.get_texts()]
    for axes in figure.axes:
        found += [axes.xaxis.label, axes.yaxis.label, axes._left_title]  # type: ignore[attr-defined]
        for axis in (axes.xaxis, axes.yaxis):
            for tick in axis._update_ticks():  # type: ignore[attr-defined]
                found += [tick.label1, tick.label2]
    shown = [text for text in found if text.get_visible()]
    boxes = [(text.get_text(), text.get_window_extent(renderer)) for text in shown]
    return [(text, box.extents) for text, box in boxes if text.strip()]


@pytest.mark.parametrize("what", DRAWN)
def test_no_text_of_a_picture_leaves_it_or_lies_on_another(stores, what):
    name, options = DRAWN[what]
    _, drawn = study.figure(drawable(stores, name), **options)
    wide = 25.4 * drawn.get_size_inches()[0]
    assert min(abs(wide - style.COLUMN), abs(wide - style.PAGE)) < 0.2
    placed = texts(drawn)
    width, height = drawn.bbox.size
    outside = [
        text for text, (x0, y0, x1, y1) in placed if min(x0, y0) < 0 or x1 > width or y1 > height
    ]
    assert outside == []
    lying = [
        (one, other)
        for number, (one, a) in enumerate(placed)
        for other, b in placed[number + 1 :]
        if a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]
    ]
    assert lying == []


def test_lines_stand_at_the_values_in_the_unit_of_the_label(stores):
    found = open_study(stores["speeds"], ["restitution", "time_to_rest"])
    _, drawn = study.figure(found)
    speed, bounce = law({SPEED: found[SPEED].values})
    for axes, values in zip(drawn.axes, (bounce, 1e3 * 1e-3 * (1.0 + bounce)), strict=True):
        (line,) = axes.lines
        np.testing.assert_allclose(line.get_xdata(), speed * 1e3)
        np.testing.assert_allclose(line.get_ydata(), values)
        assert axes.get_xlabel() == "speed at release [mm/s]"
    assert "[ms]" in drawn.axes[1].get_ylabel()


def test_angles_are_drawn_and_told_in_degrees():
    angle = xarray.DataArray(
        np.radians([30.0, 73.0]), dims="angle", attrs={"units": "rad", "long_name": "contact angle"}
    )
    drawn = axis_quantity(angle)
    np.testing.assert_allclose(drawn.values, [30.0, 73.0])
    assert drawn.label == "contact angle [deg]"
    assert words(math.radians(73.0), "rad") == "73 deg"


def test_a_value_between_two_that_do_not_apply_is_drawn(grid):
    with_gaps = grid.copy(deep=True)
    measure = with_gaps["restitution"]
    measure[{ROUGH: slice(0, None, 2)}] = np.nan
    kind, drawn = study.figure(with_gaps, measure="restitution", held={HUMID: "0.1"})
    assert kind == "lines"
    marked = [line for line in drawn.axes[0].lines if line.get_marker() == "o"]
    known = np.isfinite(measure.sel({HUMID: 0.1}, method="nearest").values.ravel())
    assert [line.get_xdata().size for line in marked] == [np.count_nonzero(known)]


def test_listed_values_are_drawn_in_the_order_of_their_size(tmp_path):
    text = KEEP + '[axes]\n"impact.speed" = {values = ["0.3 m/s", "0.1 m/s", "0.2 m/s"]}\n'
    _, drawn = study.figure(open_study(stored(tmp_path, text)), measure="restitution")
    (line,) = drawn.axes[0].lines
    np.testing.assert_allclose(line.get_xdata(), [100.0, 200.0, 300.0])
    np.testing.assert_allclose(line.get_ydata(), law({SPEED: np.array([0.1, 0.2, 0.3])})[1])


def test_a_map_of_listed_values_has_each_case_in_its_own_cell(tmp_path):
    speeds, humid = [0.3, 0.1, 0.5, 0.2], [0.4, 0.1, 0.2]
    text = (
        KEEP + f'[axes]\n"impact.speed" = {{values = {[f"{v} m/s" for v in speeds]}}}\n'
        f'"capillary.humidity" = {{values = {humid}}}\n'
    )
    found = open_study(stored(tmp_path, text))
    _, drawn = study.figure(found, measure="restitution", x=SPEED, y=HUMID)
    (mesh,) = (c for c in drawn.axes[0].collections if type(c).__name__ == "QuadMesh")
    x, y = np.meshgrid(sorted(speeds), sorted(humid))
    bounce = law({SPEED: x.ravel(), HUMID: y.ravel()})[1].reshape(x.shape)
    np.testing.assert_array_equal(np.ma.filled(mesh.get_array(), np.nan), bounce)


def test_a_picture_says_what_failed_and_what_was_held(grid):
    _, drawn = study.figure(grid, held={HUMID: "0.33"})
    assert drawn.legends[0].get_title().get_text() == "relative humidity 0.34, 1 of 41 cases failed"


# Tables


def test_csv_has_a_row_a_case_with_units_and_every_digit(stores, tmp_path):
    with export(stores["grid"], tmp_path / "all.csv").open(newline="") as stream:
        head, *rows = csv.reader(stream)
    assert head[:3] == [f"{ROUGH} [m]", f"{HUMID} [1]", "outcome"]
    assert len(rows) == 861
    found = open_study(stores["grid"])
    column = head.index("restitution [1]")
    read = np.array([float(row[column] or "nan") for row in rows])
    np.testing.assert_array_equal(read, found["restitution"].values.ravel())
    rough = np.array([float(row[0]) for row in rows])
    np.testing.assert_array_equal(rough, np.repeat(found[ROUGH].values, 21))
    lost = rows[5]
    assert (lost[2], lost[head.index("reason")], lost[head.index("captured")]) == (
        "failed", "the contact folds: é", ""
    )  # fmt: skip
    assert {row[head.index("captured")] for row in rows} == {"", "true", "false"}


def test_parquet_keeps_types_units_and_what_is_absent(stores, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    table = parquet.read_table(export(stores["grid"], tmp_path / "all.parquet"))
    found = open_study(stores["grid"])
    assert table.num_rows == 861
    assert table.schema.field("time_to_rest").metadata == {b"unit": b"s"}
    assert table.column("captured").null_count == len(LOST)
    read = table.column("restitution").to_numpy()
    np.testing.assert_array_equal(read, found["restitution"].values.ravel())
    assert table.schema.metadata[b"fingerprint"].decode() == found.attrs["fingerprint"]
    assert parse(table.schema.metadata[b"study"].decode()) == parse(GRID)


def test_parquet_without_its_writer_says_how_to_get_it(stores, tmp_path, monkeypatch):
    def missing(name: str) -> None:
        raise ImportError(name)

    monkeypatch.setattr(importlib, "import_module", missing)
    with pytest.raises(InputError, match=r"pip install 'asperity\[parquet\]'"):
        export(stores["grid"], tmp_path / "all.parquet")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["grid", "sample"])
def test_netcdf_gives_the_same_dataset_back(stores, tmp_path, name):
    file = export(stores[name], tmp_path / "all.nc")
    found = open_study(stores[name])
    with xarray.open_dataset(file) as read:
        for variable in found.variables:
            np.testing.assert_array_equal(read[variable].values, found[variable].values)
            assert read[variable].attrs.get("units") == found[variable].attrs.get("units")
        assert read.attrs["fingerprint"] == found.attrs["fingerprint"]


def test_files_are_replaced_only_when_asked_and_what_cannot_be_written_is_told(stores, tmp_path):
    file = tmp_path / "all.csv"
    file.write_text("mine")
    with pytest.raises(InputError, match="--force"):
        export(stores["speeds"], file)
    assert file.read_text() == "mine"
    export(stores["speeds"], file, force=True)
    assert file.read_text().startswith(SPEED)
    with pytest.raises(OutputError, match="No such file"):
        export(stores["speeds"], tmp_path / "none" / "all.csv")
    with pytest.raises(InputError, match=r"\.csv \.parquet \.nc; got '\.xls'"):
        export(stores["speeds"], tmp_path / "all.xls")
    assert [path.name for path in tmp_path.iterdir()] == ["all.csv"]


def test_a_store_without_results_is_refused(tmp_path):
    store = Store.create(tmp_path / "empty.zarr", parse(SPEEDS))
    store.close()
    with pytest.raises(InputError, match="--resume"):
        export(store.path, tmp_path / "all.csv")


# Restitution against speed

NUMBER = r"[-+0-9.e]+"
READERS: dict[str, Callable[[str], list[tuple[str, str]]]] = {
    ".dat": lambda text: [tuple(r.split()) for r in text.splitlines() if not r.startswith("#")],
    ".txt": lambda text: [tuple(r.split()) for r in text.splitlines() if not r.startswith("%")],
    ".csv": lambda text: [tuple(row) for row in csv.reader(text.splitlines()[1:])],
    ".foam": lambda text: re.findall(rf"\(({NUMBER}) ({NUMBER})\)", text),
    ".h": lambda text: list(
        zip(*(re.findall(NUMBER, part) for part in re.findall(r"\{.*?\*/(.*?)\}", text, re.DOTALL)),
            strict=True)
    ),
}  # fmt: skip


@pytest.mark.parametrize("ending", READERS)
def test_a_table_of_restitution_reads_back_to_the_same_floats(stores, tmp_path, ending):
    table = restitution_table.restitution_of(open_study(stores["speeds"]))
    file = restitution_table.write_restitution(table, tmp_path / f"e{ending}")
    rows = np.array(READERS[ending](file.read_text()), dtype=float)
    speed = open_study(stores["speeds"])[SPEED].values
    np.testing.assert_array_equal(rows, np.stack(law({SPEED: speed}), axis=1))
    assert np.any(rows[:, 1] == 0.0)
    assert table.about[-1] == (
        "coefficient of restitution of the first impact, 0 where it captures"
    )


@pytest.mark.parametrize("ending", READERS)
def test_a_table_of_single_bodies_holds_their_mean_and_how_many_are_captured(
    stores, tmp_path, ending
):
    found = open_study(stores["speeds"])
    share = np.linspace(1.0, 0.0, found[SPEED].size)
    kept = {
        "mean_restitution": 1.0 - share, "mean_restitution_error": 0.01 * share,
        "capture_probability": share, "capture_probability_low": 0.9 * share,
        "capture_probability_high": share,
    }  # fmt: skip
    bodies = found.assign({name: (SPEED, x) for name, x in kept.items()})
    table = restitution_table.restitution_of(bodies)
    text = restitution_table.write_restitution(table, tmp_path / f"e{ending}").read_text()
    wanted = [found[SPEED].values, *kept.values()]
    if ending == ".foam":
        wanted = wanted[:2]
        assert f"// capture probability: {share.tolist()}" in text
        rows = np.array(READERS[ending](text), dtype=float)
    elif ending == ".h":
        names = re.findall(r"double asperity_(\w+)", text)
        assert names[1:4] == ["restitution", "standard_error", "capture_probability"]
        rows = np.array(READERS[ending](text), dtype=float)
    else:
        assert re.search("(?i)restitution.*standard error.*capture probability", text)
        rows = np.array(READERS[ending](text), dtype=float)
    np.testing.assert_array_equal(rows, np.stack(wanted, axis=1))
    assert "single bodies" in table.about[-1]
    with pytest.raises(InputError, match="`keep` must hold impact_speed and mean_restitution"):
        restitution_table.restitution_of(bodies.drop_vars("mean_restitution"))


def test_a_table_of_restitution_needs_one_axis(stores):
    found = open_study(stores["many"])
    with pytest.raises(InputError, match=rf"--at {ROUGH}=VALUE --at {HUMID}=VALUE"):
        restitution_table.restitution_of(found)
    held = {ROUGH: "10 nm", HUMID: "0.2", "adhesion.model": "dmt"}
    one, words = at(found, held)
    table = restitution_table.restitution_of(one, words)
    assert table.speed.tolist() == [0.1, 0.15, 0.2]
    assert words in table.about


def test_a_table_of_restitution_refuses_what_it_cannot_hold(stores):
    with pytest.raises(InputError, match="sample"):
        restitution_table.restitution_of(open_study(stores["sample"]))
    with pytest.raises(InputError, match="`keep` must hold"):
        restitution_table.restitution_of(open_study(stores["speeds"], ["restitution"]))
    same_speed, _ = at(open_study(stores["grid"]), {HUMID: "0.2"})
    with pytest.raises(InputError, match="one value for each speed"):
        restitution_table.restitution_of(same_speed)


def test_cases_without_restitution_are_left_out_and_counted(tmp_path):
    found = open_study(stored(tmp_path, SPEEDS, failed=frozenset({3, 4})))
    table = restitution_table.restitution_of(found)
    assert table.speed.size == 17
    assert "2 of 19 cases have no restitution and are left out" in table.about


# Force against distance

STIFF, ATTRACTION, SHIFT = 3e3, 2e-7, 4e-9


def linear_curve() -> Curve:
    """A spring of stiffness `STIFF` whose pull on the way out reaches farther by `SHIFT`."""
    separation = np.unique(np.concatenate([np.linspace(-5e-9, 5e-9, 41), [1e-8, 2e-8]]))
    push = -STIFF * separation
    gone = np.where(separation < 5e-9, 1.0, 0.0)
    approach, unloading = push * gone, (push - ATTRACTION) * gone
    return Curve(
        asperity.load("published"), "spring", separation, separation, approach, unloading, {}, {},
        float(separation[0]), ATTRACTION, float(separation[0]), 0.0, None, 1e-15, [],
    )  # fmt: skip


def read_sections(text: str) -> dict[str, tuple[list[str], np.ndarray]]:
    """A table file as LAMMPS reads one: comments, then keyword, parameters, a line, rows."""
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    found, number = {}, 0
    while number < len(lines):
        if not lines[number].strip():
            number += 1
            continue
        name, parameters = lines[number].split()[0], lines[number + 1].split()
        count = int(parameters[parameters.index("N") + 1])
        assert lines[number + 2] == ""
        rows = [line.split() for line in lines[number + 3 : number + 3 + count]]
        assert [row[0] for row in rows] == [str(k) for k in range(1, count + 1)]
        found[name] = (parameters, np.array(rows, dtype=float)[:, 1:].T)
        number += 3 + count
    return found


@pytest.fixture(scope="module")
def sections(tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[list[str], np.ndarray]]:
    file = tmp_path_factory.mktemp("force") / "spring.table"
    return read_sections(force_table.write_force_table(linear_curve(), file).read_text())


def test_a_force_table_reads_back_to_the_same_forces(sections):
    curve = linear_curve()
    assert list(sections) == ["LOADING", "UNLOADING"]
    for name, force in (("LOADING", curve.force_loading), ("UNLOADING", curve.force_unloading)):
        distance, _, read = sections[name][1]
        np.testing.assert_array_equal(read, force)
        np.testing.assert_array_equal(distance, curve.rigid_separation + curve.case.body.radius)


def test_the_energy_of_a_force_table_is_the_work_of_the_force():
    separation = np.linspace(-4e-9, 6e-9, 201)
    cubic = STIFF * 1e9 * (separation - 6e-9) ** 2  # a polynomial, so that the spline is exact
    curve = dataclasses.replace(
        linear_curve(), rigid_separation=separation, force_loading=cubic, force_unloading=cubic
    )
    branch, _ = force_table.branches_of(curve)
    work = STIFF * 1e9 * (6e-9 - separation) ** 3 / 3.0
    np.testing.assert_allclose(branch.energy, work, rtol=1e-6, atol=1e-9 * work[0])
    np.testing.assert_allclose(branch.slopes, [-2.0 * STIFF * 1e9 * 1e-8, 0.0], atol=1e-3)


def test_forces_of_a_table_agree_with_its_energies_as_lammps_checks(sections):
    # Its reader warns where a force lies beyond both secants beside it, off inflections.
    distance, energy, force = sections["LOADING"][1]
    secants = -np.diff(energy) / np.diff(distance)
    inner = slice(1, 38)  # the spring; beyond it the force jumps to nothing
    low = np.minimum(secants[:-1], secants[1:])[inner]
    high = np.maximum(secants[:-1], secants[1:])[inner]
    slack = 1e-6 * np.abs(force).max()
    assert np.all((force[1:-1][inner] >= low - slack) & (force[1:-1][inner] <= high + slack))


def test_both_sections_of_a_force_table_differ_by_the_loss_of_the_cycle():
    # The curve's loss counts bonds made and broken; the table's energies integrate forces.
    curve = asperity.curve(asperity.load("published"), name="published")
    approach, unloading = force_table.branches_of(curve)
    assert approach.energy[0] - unloading.energy[0] == pytest.approx(curve.loss, rel=1e-4)
    assert np.all(approach.force - unloading.force >= -1e-12 * np.abs(approach.force).max())


def test_a_force_table_refuses_other_endings_and_files_that_are_there(tmp_path):
    with pytest.raises(InputError, match=r"end in \.table; got '\.txt'"):
        force_table.write_force_table(linear_curve(), tmp_path / "f.txt")
    (tmp_path / "f.table").write_text("mine")
    with pytest.raises(InputError, match="--force"):
        force_table.write_force_table(linear_curve(), tmp_path / "f.table")


# The commands


@pytest.mark.usefixtures("undrawn")
def test_plot_writes_a_folder_beside_the_store_and_says_what_failed(tmp_path, capsys):
    store = stored(tmp_path, GRID, LOST)
    for _ in range(2):  # drawn again in place
        study_plots.plot(str(store), output=None, force=False)
    out, error = capsys.readouterr()
    assert names(tmp_path / "study-out") == ["map.png", "map.svg"]
    assert "map.png map.svg" in out
    assert "31 of 861 cases failed" in error


def test_plot_lists_the_front(stores, tmp_path, capsys):
    goals = ("max:impact_speed", "max:restitution")
    study_plots.plot(str(stores["speeds"]), output=str(tmp_path), force=False, pareto=goals)
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "Pareto front of max:impact_speed, max:restitution: 1 of 19 cases"
    assert lines[3].split() == ["500", "mm/s", "500", "mm/s", "0.9798"]
    assert {p.name for p in tmp_path.iterdir()} == {"pareto.png", "pareto.svg", "pareto.csv"}


@pytest.mark.parametrize("given", ["humidity", "=3", "capillary.humidity="])
def test_held_axes_of_the_command_are_key_and_value(stores, tmp_path, given):
    with pytest.raises(InputError, match="KEY=VALUE"):
        study_plots.plot(str(stores["grid"]), output=str(tmp_path), force=False, at=[given])


def test_export_wants_one_kind_of_file(stores):
    with pytest.raises(InputError, match="got none"):
        exporting.export(str(stores["grid"]))
    with pytest.raises(InputError, match="--output and --restitution"):
        exporting.export(str(stores["grid"]), output="a.csv", restitution="b.csv")
    with pytest.raises(InputError, match="of a case; got a store"):
        exporting.export(str(stores["grid"]), force_table="f.table")


def test_export_writes_restitution_at_held_values(stores, tmp_path, capsys):
    file = tmp_path / "e.csv"
    held = [f"{ROUGH}=10 nm", f"{HUMID}=0.2", "adhesion.model=none"]
    exporting.export(str(stores["many"]), restitution=str(file), at=held)
    assert capsys.readouterr().out.split() == ["written", "to", str(file)]
    assert len(file.read_text().splitlines()) == 4

"""A study: which cases it holds, in which tasks, and why one of them fails."""

import itertools
import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from asperity.config import builtin, load
from asperity.config.resolve import resolve
from asperity.errors import InputError
from asperity.sweeps.study.blocks import Blocks
from asperity.sweeps.study.columns import DEFAULT_KEEP, REASON_SIZE
from asperity.sweeps.study.structure import task_size
from asperity.sweeps.study.study import parse, read
from study_texts import GRID, HUMIDITY, RMS, sample, study


def test_grid_holds_every_value_with_every_other_and_the_first_axis_is_slowest():
    found = study(GRID)
    rms = [8e-9 * 1.5 ** (i / 4) for i in range(5)]
    product = itertools.product(rms, [0.2, 0.4, 0.3], ["dmt", "none"], [True, False])
    columns = [list(column) for column in zip(*product, strict=True)]
    assert found.shape == (5, 3, 2, 2)
    assert found.size == 60
    values = found.values(0, 60)
    assert list(values) == [axis.key for axis in found.axes]
    assert values[RMS] == pytest.approx(columns[0], rel=1e-15)
    assert [v.tolist() for v in values.values()][1:] == columns[1:]
    assert [v.dtype for v in values.values()] == [np.float64, np.float64, object, np.bool_]
    changes = {
        RMS: "12 nm",
        HUMIDITY: 0.3,
        "adhesion.model": "none",
        "publication.attraction_during_retraction_only": False,
    }
    assert found.case(59) == builtin("published").replace(changes)


@given(st.integers(0, 60), st.integers(0, 60))
def test_part_of_a_grid_is_that_part_of_the_whole(one, other):
    found, (start, stop) = study(GRID), sorted((one, other))
    whole, part = found.values(0, 60), found.values(start, stop)
    for key in whole:
        assert part[key].tolist() == whole[key][start:stop].tolist()


@given(
    st.floats(1e-12, 1e-3), st.floats(1.001, 1e3), st.integers(2, 300),
    st.sampled_from(["linear", "log"]),
)  # fmt: skip
def test_range_has_exact_ends_and_even_steps(low, factor, steps, scale):
    high = min(low * factor, 1.0)
    axis = study(
        f'"{RMS}" = {{from = "{low!r} m", to = "{high!r} m", steps = {steps}, scale = "{scale}"}}'
    ).axes[0]
    values = axis.values
    assert (values[0], values[-1], len(values)) == (low, high, steps)
    if scale == "log":
        # A ratio of two rounded powers is good to a few roundings, and to the exponent's.
        bound = 1e-15 * (10.0 + math.log(high / low))
        assert values[1:] / values[:-1] == pytest.approx(
            (high / low) ** (1 / (steps - 1)), rel=bound
        )
    else:
        assert np.diff(values) == pytest.approx((high - low) / (steps - 1), abs=1.5e-15 * high)


def test_values_of_a_long_range_are_those_of_its_formula_without_being_held():
    found = study(
        f'"{RMS}" = {{from = "8 nm", to = "12 nm", steps = 1_000_001}}\n'
        f'"{HUMIDITY}" = {{from = 0, to = 1, steps = 1_000_000_000}}'
    )
    assert found.size == 1_000_000_000 * 1_000_001
    last = found.values(found.size - 1, found.size)
    assert {key: value.tolist() for key, value in last.items()} == {RMS: [1.2e-8], HUMIDITY: [1.0]}
    axis = found.axes[1]
    ends = np.array([0, 1, 250_000_000, 999_999_999])
    assert axis.at(ends).tolist() == pytest.approx([0, 1e-9, 0.25, 1.0], rel=1e-8)
    assert axis.at(ends)[-1] == 1.0


@pytest.mark.parametrize("other", ["0.008 um", "8e-6 mm", "80 angstrom", "8e-9 m"])
def test_study_does_not_depend_on_the_units_of_its_text(other):
    lines = f'"{RMS}" = {{from = "8 nm", to = "12 nm", steps = 7}}'
    assert study(lines.replace("8 nm", other)).fingerprint == study(lines).fingerprint


@pytest.mark.parametrize("text", ["50 um", "8 nm", "0.1 mm", "1e-7 m", "3.3 um", "10.5 nm"])
def test_value_of_an_axis_is_the_float_of_a_case_file(text):
    base = builtin("published")
    found = study(f'"impact.release_separation" = {{values = ["{text}"]}}')
    expected = base.replace({"impact.release_separation": text}).impact.release_separation
    assert found.values(0, 1)["impact.release_separation"][0] == expected
    assert found.case(0).impact.release_separation == expected


def test_whole_numbers_stay_whole_and_differ():
    found = study(
        '"numerics.max_impacts" = {from = 1, to = 1000, steps = 4, scale = "log"}\n'
        '"numerics.rings" = {from = 16, to = 20, steps = 3}'
    )
    values = found.values(0, 12)
    assert values["numerics.max_impacts"].dtype == np.int64
    assert values["numerics.max_impacts"][::3].tolist() == [1, 10, 100, 1000]
    assert values["numerics.rings"][:3].tolist() == [16, 18, 20]
    assert found.case(11).numerics.max_impacts == 1000
    # Listed ones too, beside an equal number of the axis before.
    whole = study('"numerics.max_impacts" = {values = [1]}')
    assert study(f'"{HUMIDITY}" = {{values = [1.0]}}').values(0, 1)[HUMIDITY].dtype == np.float64
    assert whole.values(0, 1)["numerics.max_impacts"].dtype == np.int64
    assert load(whole.case(0).toml()) == whole.case(0)


def test_number_of_no_case_is_refused():
    found = study(GRID)
    for start, stop in ((-1, 1), (0, 61), (5, 4)):
        with pytest.raises(IndexError, match="60 cases"):
            found.values(start, stop)
    with pytest.raises(IndexError):
        found.case(60)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("impact.gravity", "0 m/s^2"),
        ("adhesion.model", "jkr"),
        ("body.youngs_modulus", "70 GPa"),
        ("body.material", "silicaa"),
        ("gas.pressure", "1 kPa"),
        ("capillary.contact_angle", "120 deg"),
        ("capillary.formation_time", "1 us"),
        ("roughness.degree", 2),
    ],
)
def test_case_fails_for_the_reason_that_its_file_would(key, value):
    with pytest.raises(InputError) as wanted:
        builtin("published").replace({key: value})
    found = study(f'"{key}" = {{values = [{json.dumps(value)}]}}')
    with pytest.raises(InputError) as caught:
        found.case(0)
    assert (str(caught.value), caught.value.key) == (str(wanted.value), wanted.value.key)


def test_study_none_of_whose_cases_can_be_computed_says_so_beforehand():
    (warning,) = study('"gas.pressure" = {values = ["1 kPa", "2 kPa"]}').warnings
    assert warning.startswith("no case of those tried (2) can be computed: gas.name: ")
    some = study('"impact.gravity" = {values = ["9.81 m/s^2", "0 m/s^2"]}')
    assert some.warnings == []
    assert some.case(0) == builtin("published")


def test_table_that_the_base_lacks_is_made_of_the_axes():
    gas = {"name": "air", "temperature": "20 degC", "pressure": "100 kPa"}
    lines = "\n".join(f'"gas.{key}" = {{values = ["{value}"]}}' for key, value in gas.items())
    found = study(lines.replace('["100 kPa"', '["1 kPa", "100 kPa"'), EXACT)
    assert found.case(1) == builtin("published-exact").replace({"gas": gas})


def test_material_of_the_base_can_vary():
    glass = {"youngs_modulus": "70 GPa", "poisson": 0.2, "density": "2500 kg/m^3"}
    changes = {"body.material": "my glass", "materials": {"my glass": glass}}
    base = builtin("published-exact").replace(changes).toml().replace("\n[", "\n[base.")
    found = parse(
        f'[axes]\n"materials.my glass.density" = {{values = ["2 g/cm^3"]}}\n[base]\n{base}'
    )
    assert resolve(found.case(0)).body.density == pytest.approx(2000.0)
    assert found.axes[0].label == "density of my glass"


@given(st.data())
@settings(max_examples=25)
def test_quick_case_is_the_case_of_its_file(data):
    """Rules between keys are looked at without reading the text again, to the same end."""
    found = sample(64)
    number = data.draw(st.integers(0, 63))
    values = {key: array.tolist()[0] for key, array in found.values(number, number + 1).items()}
    case = found.case_of(values)
    written = {axis.key: axis.written(values[axis.key]) for axis in found.axes}
    assert case == found.base.replace(written)
    assert load(case.toml()) == case


def test_tasks_hold_every_case_once_in_order():
    found = study(f'"{RMS}" = {{from = "8 nm", to = "12 nm", steps = 20_001}}')
    assert task_size(found) == 4096
    assert [len(found.task(i)) for i in range(found.tasks)] == [4001, 4001, 4001, 4001, 3997]
    cases = itertools.chain.from_iterable(found.task(i) for i in range(found.tasks))
    assert list(cases) == list(range(20_001))
    for number in (-1, found.tasks):
        with pytest.raises(IndexError):
            found.task(number)


@given(st.lists(st.integers(1, 9), min_size=1, max_size=4), st.integers(1, 500))
def test_a_block_is_a_part_of_the_grid_whose_cases_follow_each_other(shape, most):
    blocks, numbers = Blocks.of(tuple(shape), most), np.arange(math.prod(shape)).reshape(shape)
    assert blocks.largest <= most
    begun = 0
    for task in range(blocks.count):
        sides = zip(blocks.index(task), blocks.block, blocks.extent(task), strict=True)
        part = numbers[tuple(slice(at * side, at * side + size) for at, side, size in sides)]
        assert part.ravel().tolist() == list(blocks.cases(task))
        assert blocks.cases(task).start == begun
        begun = blocks.cases(task).stop
    assert begun == numbers.size


EXACT = 'base = "published-exact"'
RIGID = '"counterface.deformation" = {values = ["rigid"]}'


@pytest.mark.parametrize(
    ("key", "values", "size"),
    [
        ("adhesion.model", '["dmt", "jkr"]', 512),
        ("adhesion.model", '["dmt", "none"]', 4096),
        ("gas.pressure", '["1 kPa"]', 512),
        ("waves.model", '["hunter"]', 512),
        ("waves.model", '["none"]', 4096),
        ("plasticity.model", '["none", "kogut-etsion"]', 512),
        ("capillary.formation_time", '["1 us"]', 512),
        ("capillary.formation_time", '["0 s"]', 4096),
    ],
)
def test_task_on_a_rigid_plane_has_as_many_cases_as_their_slowest_kind_allows(key, values, size):
    assert task_size(study(f'{RIGID}\n"{key}" = {{values = {values}}}', EXACT)) == size


def test_task_on_a_half_space_has_few_cases_and_one_of_the_publication_many():
    rms = f'"{RMS}" = {{values = ["8 nm"]}}'
    assert task_size(study(rms)) == 4096
    assert task_size(study(RIGID, EXACT)) == 4096
    assert task_size(study(rms, EXACT)) == 64
    assert task_size(study(RIGID.replace("]", ', "half-space"]'), EXACT)) == 64


def test_smooth_body_is_quick_on_a_half_space(tmp_path):
    smooth = builtin("published-exact").replace({"roughness": None, "capillary": None})
    (tmp_path / "drop.toml").write_text(smooth.toml())
    (tmp_path / "map.toml").write_text(
        'base = "drop.toml"\n[axes]\n"impact.speed" = {values=["1 m/s", "2 m/s"]}'
    )
    assert task_size(read(str(tmp_path / "map.toml"))) == 4096


def test_columns_and_widths_are_what_the_study_keeps():
    head = 'base = "published"\nkeep = ["restitution"]\nkeep_impacts = 3\nmotions = true'
    found = study('"numerics.max_impacts" = {values = [7, 30, 20]}', head)
    names = [column.name for column in found.columns]
    assert names == ["outcome", "impacts", "energy_balance_error", "reason", "restitution",
                     "turning_separation", "turning_time"]  # fmt: skip
    assert [found.width(along) for along in ("impact", "turn", "byte")] == [3, 60, REASON_SIZE]
    assert study(GRID).width("turn") == 2 * builtin("published").numerics.max_impacts
    assert study(GRID).keep == DEFAULT_KEEP


def test_corners_have_each_axis_at_both_ends_with_the_others_low_and_high():
    axes = {
        "impact.speed": '["0.1 m/s", "1 m/s", "2 m/s"]',
        "adhesion.work": '["20 mJ/m^2", "30 mJ/m^2"]',
        "adhesion.equilibrium_spacing": '["0.2 nm"]',
        "body.radius": '["40 um", "50 um"]',
        "numerics.max_impacts": "[3, 4]",
        "numerics.rest_height_ratio": "[1e-3, 1e-4]",
    }
    found = study("\n".join(f'"{key}" = {{values = {values}}}' for key, values in axes.items()))
    places = np.array(np.unravel_index(found.corners, found.shape)).T
    last = np.array(found.shape) - 1
    assert len(found.corners) == len(set(found.corners)) == 12
    assert np.isin(places / np.maximum(last, 1), (0, 1)).all()
    high = places[:, last > 0].astype(bool).sum(axis=1)
    assert sorted(high) == [0, 1, 1, 1, 1, 1, 4, 4, 4, 4, 4, 5]
    two = study('"adhesion.work" = {values = ["20 mJ/m^2", "30 mJ/m^2"]}')
    assert two.corners == [0, 1]

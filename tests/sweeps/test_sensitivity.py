"""Sobol's indices of functions whose indices are known."""

import json
import math
import sys
import threading
import types
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest

from asperity.cli.attributing import sensitivity as command
from asperity.errors import ENDS, InputError, Outcome, SimulationError
from asperity.plots.study import bars
from asperity.sweeps.analysis.sensitivity import Sensitivity, sensitivity
from asperity.sweeps.study.study import Study, parse

REST, FAILED = ENDS.index(Outcome.REST), ENDS.index(Outcome.FAILED)
AXES = {
    "impact.speed": '{from = "0.1 m/s", to = "0.3 m/s"}',
    "capillary.humidity": "{from = 0.1, to = 0.5}",
    "roughness.rms_height": '{from = "5 nm", to = "20 nm", scale = "log"}',
}


def study(
    size: int = 4096, seed: int = 3, axes: Mapping[str, str] = AXES, sample: str = ""
) -> Study:
    rows = "\n".join(f'"{key}" = {text}' for key, text in axes.items())
    drawn = sample or f'[sample]\nmethod = "sobol"\nsize = {size}\nseed = {seed}\n'
    return parse(f'schema = 1\nbase = "published"\nkeep = ["restitution"]\n[axes]\n{rows}\n{drawn}')


def shares(one: Study, values: Mapping[str, np.ndarray]) -> list[np.ndarray]:
    """Where each value lies in its range, 0 to 1, evenly distributed."""
    found = []
    for axis in one.axes:
        low, high, value = axis.low, axis.high, values[axis.key]
        if axis.scale == "log":
            found.append(np.log(value / low) / math.log(high / low))
        else:
            found.append((value - low) / (high - low))
    return found


def by(one: Study, law: Callable[..., np.ndarray], measure: str = "restitution") -> Sensitivity:
    """Indices of a function of the shares."""

    def evaluate(values: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        found = law(*shares(one, values))
        along = found[:, None] if measure == "restitution" else found
        return {"outcome": np.full(found.size, REST, dtype="int8"), measure: along}

    return sensitivity(one, measure, evaluate)


def ishigami(*parts: np.ndarray) -> np.ndarray:
    x, y, z = (math.pi * (2.0 * part - 1.0) for part in parts)
    return np.sin(x) + 7.0 * np.sin(y) ** 2 + 0.1 * z**4 * np.sin(x)


@pytest.mark.parametrize("seed", [0, 1, 7])
def test_indices_of_ishigamis_function_lie_within_their_confidence(seed: int):
    # Ishigami and Homma (1990); the variances by integrating a = 7, b = 0.1 by hand.
    a, b, fourth, eighth = 7.0, 0.1, math.pi**4, math.pi**8
    alone = [0.5 * (1.0 + b * fourth / 5.0) ** 2, a**2 / 8.0, 0.0]
    together = b**2 * eighth * (1.0 / 18.0 - 1.0 / 50.0)
    variance = sum(alone) + together
    found = by(study(seed=seed), ishigami)
    totals = [alone[0] + together, alone[1], together]
    for index, known in ((found.first, alone), (found.total, totals)):
        share = np.array(known) / variance
        assert np.all(index.low <= index.value)
        assert np.all(index.value <= index.high)
        assert np.all((index.low <= share) & (share <= index.high))
        assert np.all(index.high - index.low < 0.15)
        np.testing.assert_allclose(index.value, share, atol=0.02)


@pytest.mark.parametrize(
    ("law", "measure", "first", "total"),
    [
        (lambda x, y, z: 3.0 * x + 2.0 * y + z, "restitution", *2 * (np.array([9, 4, 1]) / 14.0,)),
        # x y on [0, 1]^2: V = 1/9 - 1/16, V_x = V_y = (1/4) / 12.
        (lambda x, y, z: x * y, "restitution", [3.0 / 7.0, 3.0 / 7.0, 0.0], [4 / 7, 4 / 7, 0.0]),
        (lambda x, y, z: (x > 0.5).astype("int8"), "captured", *2 * ([1.0, 0.0, 0.0],)),
    ],
    ids=["a sum", "a product", "whether a body sticks"],
)
def test_indices_are_those_of_closed_forms(law, measure: str, first, total):
    found = by(study(), law, measure)
    np.testing.assert_allclose(found.first.value, first, atol=0.01)
    np.testing.assert_allclose(found.total.value, total, atol=0.01)
    assert not found.total.value[np.array(total) == 0.0].any()


def test_an_axis_on_a_log_scale_is_drawn_evenly_over_its_logarithm():
    seen = []
    by(study(), lambda x, y, z: seen.append(z) or x + z)
    drawn = np.sort(np.concatenate(seen))
    np.testing.assert_allclose(drawn, np.linspace(0.0, 1.0, drawn.size), atol=2e-3)


def test_cases_are_size_times_axes_and_two_and_the_same_each_time():
    counted = []
    one = study(size=64)
    first = by(one, lambda x, y, z: counted.append(x.size) or x + y * z)
    again = by(one, lambda x, y, z: x + y * z)
    assert sum(counted) == first.cases == 64 * 5
    assert first.json_object() == again.json_object()
    other = by(study(size=64, seed=9), lambda x, y, z: x + y * z)
    assert other.json_object() != first.json_object()


def failing(values: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    size = values["impact.speed"].size
    lost = np.arange(size) < 3
    return {
        "outcome": np.where(lost, FAILED, REST),
        "restitution": np.where(lost, np.nan, values["impact.speed"])[:, None],
        "captured": np.where(lost, -1, 0),
    }


@pytest.mark.parametrize("measure", ["restitution", "captured"])
def test_failed_cases_refuse_indices_with_their_number(measure: str):
    with pytest.raises(
        SimulationError, match=rf"{measure} .* of 64 cases 3 have none \(3 failed\)"
    ):
        sensitivity(study(size=64), measure, failing)


@pytest.mark.parametrize("value", [0.0, 0.3])
def test_a_measure_that_never_varies_has_no_indices(value: float):
    with pytest.raises(SimulationError, match="restitution must vary"):
        by(study(size=64), lambda x, y, z: np.full(x.size, value))


REFUSED = {
    "a list of values": (
        study(axes={**AXES, "capillary.humidity": "{values = [0.1, 0.2]}"}),
        "list of values",
    ),
    "a size that is no power of two": (study(size=100), "power of two .* such as 128; got 100"),
    "a size of one": (study(size=1), "power of two"),
    "one axis": (study(axes={"capillary.humidity": AXES["capillary.humidity"]}), "two axes"),
    "text": (
        study(axes={**AXES, "adhesion.model": '{values = ["dmt", "none"]}'}),
        "adhesion.model",
    ),
    "a grid": (
        study(axes={"capillary.humidity": "{values = [0.1, 0.5]}"}, sample="\n"),
        r"\[sample\] table must be given",
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_studies_without_meaning_for_indices_are_refused(what: str):
    one, rule = REFUSED[what]
    with pytest.raises(InputError, match=rule):
        sensitivity(one, "restitution", lambda values: pytest.fail("nothing may be computed"))
    with pytest.raises(InputError, match="did you mean 'restitution'"):
        sensitivity(study(), "restitition", dict)


def test_bars_stand_at_the_indices_and_the_same_twice():
    found = by(study(size=256), ishigami)
    drawn = bars.figure(found)
    heights = [patch.get_height() for patch in drawn.axes[0].patches]
    np.testing.assert_allclose(heights, [*found.first.value, *found.total.value])
    pictures = bars.pictures(found)
    assert pictures == bars.pictures(found)
    assert set(pictures) == {"sensitivity.png", "sensitivity.svg"}


def law_of_sum(
    one: Study,
    values: Mapping[str, np.ndarray],
    progress: Callable[[int], None],
    stop: threading.Event,
) -> dict[str, np.ndarray]:
    assert one.keep == ("restitution",)
    assert not stop.is_set()
    x, y, z = shares(one, values)
    progress(x.size)
    return {"outcome": np.full(x.size, REST), "restitution": (3.0 * x + 2.0 * y + z)[:, None]}


@pytest.fixture
def study_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A study file in the current folder, and a law in place of the physics."""
    batch = types.ModuleType("batch")
    batch.evaluate = law_of_sum  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "asperity.sweeps.compute.batch", batch)
    monkeypatch.chdir(tmp_path)
    rows = "\n".join(f'"{key}" = {text}' for key, text in AXES.items())
    file = tmp_path / "sum.toml"
    file.write_text(
        'schema = 1\nbase = "published"\nkeep = ["captured", "time_to_rest"]\nmotions = true\n'
        f'[axes]\n{rows}\n[sample]\nmethod = "latin"\nsize = 256\nseed = 1\n'
    )
    return file


def test_the_command_prints_a_table_and_writes_bars_and_numbers(
    study_file: Path, capsys: pytest.CaptureFixture[str]
):
    command(study_file.name, "restitution")
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "restitution: share of its variance that each axis makes, 1280 cases"
    assert [line.split()[0] for line in lines[3:6]] == list(AXES)
    folder = study_file.parent / "sum-sensitivity"
    names = {"sensitivity.png", "sensitivity.svg", "sensitivity.json"}
    assert {path.name for path in folder.iterdir()} == names
    with pytest.raises(InputError, match="--force"):
        command(study_file.name, "restitution")
    command(study_file.name, "restitution", as_json=True)
    printed = json.loads(capsys.readouterr().out)
    assert printed == json.loads((folder / "sensitivity.json").read_text())
    found = [printed["axes"][key]["first"]["index"] for key in AXES]
    np.testing.assert_allclose(found, np.array([9.0, 4.0, 1.0]) / 14.0, atol=0.05)


def test_the_command_names_the_file_of_a_study_without_sample(study_file: Path):
    text = study_file.read_text().partition("[sample]")[0].replace('"}', '", steps = 2}')
    study_file.write_text(text.replace("0.5}", "0.5, steps = 2}"))
    with pytest.raises(InputError, match="sample") as caught:
        command(study_file.name, "restitution", as_json=True, quiet=True)
    assert caught.value.file == "sum.toml"

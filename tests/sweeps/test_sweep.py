"""`asperity.sweep`: a grid of cases from Python, as one dataset, without a store."""

import signal
import threading
import time

import numpy as np
import pytest
import xarray

import asperity
from asperity import InputError, Outcome
from asperity.config import load
from asperity.errors import ENDS
from asperity.sweeps import sweep
from asperity.sweeps.compute import batch
from asperity.sweeps.study.study import parse
from jkr_spheres import SMOOTH

DMT = SMOOTH.replace('"jkr"', '"dmt"')
"""A smooth sphere; its pull-off force is 2 pi w R (Derjaguin, Muller and Toporov 1975)."""


@pytest.fixture(scope="module")
def swept():
    axes = {"body.radius": np.array([1e-6, 2e-6, 5e-6]), "adhesion.work": ["20 mJ/m^2", 0.05]}
    return asperity.sweep(load(DMT), axes, keep=["pull_off", "restitution", "impacts"])


def test_pull_off_over_a_grid_is_that_of_the_closed_form(swept):
    radius, work = swept["body.radius"], swept["adhesion.work"]
    xarray.testing.assert_allclose(
        swept["pull_off"].drop_attrs(), 2.0 * np.pi * radius * work, rtol=1e-9
    )
    assert swept["pull_off"].dims == ("body.radius", "adhesion.work")
    np.testing.assert_array_equal(radius, [1e-6, 2e-6, 5e-6])
    np.testing.assert_array_equal(work, [0.02, 0.05])


def test_a_sweep_has_units_names_and_no_case_that_failed(swept):
    for name, unit in {"body.radius": "m", "adhesion.work": "J/m^2", "pull_off": "N"}.items():
        assert swept[name].attrs["units"] == unit
    assert swept["pull_off"].attrs["long_name"] == "pull-off force"
    assert (swept.attrs["cases"], swept.attrs["computed"], swept.attrs["failed"]) == (6, 6, 0)
    assert set(swept["reason"].values.ravel()) == {""}
    assert isinstance(swept.attrs["warnings"], list)
    study = parse(swept["outcome"].attrs["study"])
    assert (study.base, study.size, study.keep) == (load(DMT), 6, ("pull_off", "restitution"))
    assert "impact" not in swept.dims


def test_each_case_of_a_sweep_is_that_of_a_run(swept):
    case = load(DMT).replace({"body.radius": 2e-6, "adhesion.work": 0.05})
    alone = asperity.solve(case, critical=False)
    one = swept.sel({"body.radius": 2e-6, "adhesion.work": 0.05})
    assert float(one["restitution"]) == pytest.approx(alone.measures["restitution"][0], rel=1e-6)
    assert int(one["impacts"]) == len(alone.measures["restitution"])


def test_a_sweep_leaves_no_file_and_tells_its_progress(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bead.toml").write_text(DMT)
    told = []
    found = asperity.sweep(
        "bead.toml", {"body.radius": [1e-6]}, keep="pull_off",
        progress=lambda done, text: told.append(done),
    )  # fmt: skip
    assert told == sorted(told)
    assert (told[0], told[-1]) == (0.0, 1.0)
    assert found.attrs["base"] == "bead"
    assert [path.name for path in tmp_path.iterdir()] == ["bead.toml"]


def test_cases_that_break_a_rule_between_keys_fail_alone_and_say_why(tmp_path):
    """That a material is known is a rule between [body] and the catalogue."""
    found = asperity.sweep(load(DMT), {"body.material": ["soft", "sofd"]}, keep="pull_off")
    assert found["outcome"].values[1] == ENDS.index(Outcome.FAILED)
    assert np.isnan(found["pull_off"].values[1])
    assert found["pull_off"].values[0] > 0.0
    assert "did you mean 'soft'?" in found["reason"].values[1]
    assert found.attrs["failed"] == 1
    found.to_netcdf(tmp_path / "sweep.nc")
    with xarray.open_dataset(tmp_path / "sweep.nc") as again:
        xarray.testing.assert_equal(again["pull_off"].load(), found["pull_off"])


def test_impacts_of_each_case_lie_along_a_dimension_where_they_are_asked_for():
    heavy = load(DMT).replace({"impact.gravity": 9.81, "numerics.max_impacts": 2})
    found = asperity.sweep(heavy, {"impact.speed": [0.5, 1.0]}, keep=["restitution"], impacts=3)
    assert found["restitution"].dims == ("impact.speed", "impact")
    np.testing.assert_allclose(found["restitution"].values[:, 0], 1.0, rtol=1e-9)
    assert np.isnan(found["restitution"].values[:, 2]).all()


@pytest.mark.parametrize(
    ("axes", "given", "words"),
    [
        ({}, {}, "`axes` must be values by their dotted key"),
        ([1], {}, "`axes` must be values by their dotted key"),
        ({"body.raduis": [1e-6]}, {}, "axes['body.raduis']: must go over a key of a case"),
        ({"body.radius": 1e-6}, {}, "must be a list, or an array of one dimension, of values"),
        ({"body.radius": "1 um"}, {}, "must be a list, or an array of one dimension, of values"),
        ({"body.radius": np.ones((2, 2))}, {}, "must be a list, or an array of one dimension"),
        ({"body.radius": []}, {}, "must be a list of 1 to 10000 values"),
        ({"body.radius": [-1e-6]}, {}, "axes['body.radius']: `radius` must be positive"),
        ({"body.radius": [np.nan]}, {}, "must be a finite number; got nan m"),
        ({"body.radius": [True]}, {}, "must be a number in m"),
        ({"body.radius": [1e-6]}, {"keep": ["restituton"]}, "did you mean 'restitution'?"),
        ({"body.radius": [1e-6]}, {"impacts": 0}, "`impacts` must be a whole number in [1, 100000"),
        ({"body.radius": [1e-6]}, {"impacts": True}, "`impacts` must be a whole number"),
    ],
)
def test_what_no_sweep_can_be_is_refused_before_anything_is_computed(axes, given, words):
    with pytest.raises(InputError) as refused:
        asperity.sweep(load(SMOOTH), axes, **given)
    assert words in str(refused.value)


def test_a_sweep_of_a_case_without_an_impact_is_refused():
    still = load(SMOOTH[: SMOOTH.index("[impact]")])
    with pytest.raises(InputError, match=r"an \[impact\] table must be given"):
        asperity.sweep(still, {"body.radius": [1e-6]})


def test_a_sweep_beyond_memory_is_refused(monkeypatch):
    monkeypatch.setattr(sweep, "MOST_CASES", 3)
    with pytest.raises(InputError, match=r"at most 3 cases in memory.*got 4"):
        asperity.sweep(load(SMOOTH), {"body.radius": [1e-6, 2e-6, 3e-6, 4e-6]})


def test_ctrl_c_ends_a_sweep_and_what_it_computes(monkeypatch):
    """What computes goes on until it is asked to stop, as a long task does.

    The signal comes in another thread: like one that comes just before the wait, it ends no wait.
    """
    stopped, begun, pressed = threading.Event(), threading.Event(), []

    def long(study, task, stop):
        begun.set()
        assert stop.wait(20.0)
        stopped.set()
        raise InterruptedError

    def press():
        begun.wait(120.0)  # what comes before may have to compile
        pressed.append(time.monotonic())
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(batch, "compute", long)
    threading.Thread(target=press).start()
    with pytest.raises(KeyboardInterrupt):
        asperity.sweep(load(SMOOTH), {"body.radius": [1e-6]})
    assert stopped.wait(5.0)
    assert time.monotonic() - pressed[0] < 10.0


def test_a_sweep_that_is_stopped_returns_what_it_has(monkeypatch):
    stop = threading.Event()
    stop.set()
    found = asperity.sweep(load(SMOOTH), {"body.radius": [1e-6]}, keep="pull_off", stop=stop)
    assert found.attrs["computed"] == 0
    assert found["outcome"].values.tolist() == [-1]
    assert np.isnan(found["pull_off"].values).all()

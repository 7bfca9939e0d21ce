"""Pictures: every kind of motion can be drawn, in one style, and nothing runs over the edge."""

from __future__ import annotations

import dataclasses
import struct
import sys
import time
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from asperity import plots
from asperity.errors import InputError, Outcome
from asperity.plots import impacts, restitution_plot, style
from asperity.results.colours import colour
from asperity.results.result import Result

sys.path.insert(0, str(Path(__file__).parents[1]))

from fake_result import ATTRACTION, GRAVITY, MASS, RELEASE, SURFACE, bounce, loading


def cut(result: Result, points: slice, **changes: Any) -> Result:
    """Some of the points of a result."""
    arrays = ("time", "separation", "central_separation", "speed")
    return dataclasses.replace(
        result,
        **{key: getattr(result, key)[points] for key in arrays},
        forces={key: values[points] for key, values in result.forces.items()},
        energies={key: values[points] for key, values in result.energies.items()},
        **changes,
    )


def shorten(result: Result, points: int) -> Result:
    """The start of a result, without the events that it did not reach."""
    last = result.time[points - 1] if points else -1.0
    events = {
        key: values[result.events[f"{key.rpartition('_')[0]}_time"] <= last]
        for key, values in result.events.items()
    }
    tops = events["apex_time"].size
    measures = {
        key: value[:tops] if isinstance(value, list) else value
        for key, value in result.measures.items()
    }
    return cut(result, slice(points), outcome=Outcome.TIME_LIMIT, events=events, measures=measures)


def without(result: Result, *names: str) -> Result:
    """The result of a case without some mechanisms."""
    return dataclasses.replace(
        result,
        forces={k: v for k, v in result.forces.items() if k not in names},
        energies={k: v for k, v in result.energies.items() if k.removeprefix("lost_") not in names},
    )


MOTIONS = {
    "few rebounds": bounce(0.3, 2),
    "many rebounds": bounce(0.98, 200),
    "one rebound": bounce(0.5, 1),
    "no loss": bounce(1.0, 5),
    "no impact yet": shorten(bounce(impacts=2), 10),
    "cut short within the contact": shorten(bounce(impacts=2), 36),
    "dry": without(bounce(impacts=4), "capillary"),
    "elastic": without(bounce(impacts=4), "capillary", "adhesion"),
}


def size_mm(png: bytes) -> tuple[float, float]:
    width, height = struct.unpack(">II", png[16:24])
    return width / style.RESOLUTION * 25.4, height / style.RESOLUTION * 25.4


def texts_outside(figure: Figure) -> list[str]:
    """Texts of a drawn figure that reach over its edge."""
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()  # type: ignore[attr-defined]
    page = figure.bbox
    outside = []
    for axes in figure.axes:
        labels = [axes.xaxis.label, axes.yaxis.label, axes._left_title]  # type: ignore[attr-defined]
        for axis in (axes.xaxis, axes.yaxis):
            labels += [tick.label1 for tick in axis._update_ticks()]  # type: ignore[attr-defined]
        legend = axes.get_legend()
        labels += legend.get_texts() if legend else []
        for text in labels:
            box = text.get_window_extent(renderer)
            inside = page.x0 <= box.x0 and box.x1 <= page.x1 and page.y0 <= box.y0
            if text.get_text() and not (inside and box.y1 <= page.y1):
                outside.append(text.get_text())
    return outside


def overlapping(figure: Figure) -> list[tuple[str, str]]:
    """Pairs of labels, titles and legend texts of a drawn figure that lie on each other."""
    renderer = figure.canvas.get_renderer()  # type: ignore[attr-defined]
    placed = []
    for axes in figure.axes:
        legend = axes.get_legend()
        texts = [axes.xaxis.label, axes.yaxis.label, axes._left_title]  # type: ignore[attr-defined]
        for text in [*texts, *(legend.get_texts() if legend else [])]:
            if text.get_text():
                placed.append((text.get_text(), text.get_window_extent(renderer)))
    return [
        (a, b)
        for number, (a, first) in enumerate(placed)
        for b, second in placed[number + 1 :]
        if first.overlaps(second)
    ]


def assert_legible(figure: Figure) -> None:
    assert texts_outside(figure) == []
    assert overlapping(figure) == []


@pytest.mark.parametrize("name", ["few rebounds", "no impact yet"])
def test_a_motion_is_drawn_page_wide(name: str):
    pictures = plots.pictures(MOTIONS[name])
    parts = ("motion", "forces", "energy")
    assert list(pictures) == [f"{part}.{kind}" for part in parts for kind in ("png", "svg")]
    for part in parts:
        assert b"<svg" in pictures[f"{part}.svg"][:1000]
        png = pictures[f"{part}.png"]
        assert png.startswith(b"\x89PNG")
        if size_mm(png)[0] != pytest.approx(style.PAGE, abs=0.2):
            assert size_mm(png)[0] == pytest.approx(style.COLUMN, abs=0.2)


@pytest.mark.parametrize("name", MOTIONS)
def test_every_motion_is_drawn_with_no_text_over_the_edge_or_over_another(name: str):
    assert_legible(MOTIONS[name].plot())


@pytest.mark.parametrize("stiff", [1.0, 1e4])
def test_a_curve_is_drawn_with_its_pull_off_enlarged_where_it_is_small(stiff: float):
    curve = loading()
    elastic = curve.components_loading["elastic"]
    curve = dataclasses.replace(
        curve,
        force_loading=curve.force_loading + stiff * elastic,
        force_unloading=curve.force_unloading + stiff * elastic,
    )
    figure = curve.plot()
    assert len(figure.axes) == (2 if stiff > 100 else 1)
    assert_legible(figure)
    assert list(plots.pictures(curve)) == ["curve.png", "curve.svg"]


def test_axes_carry_units():
    for result in (bounce(impacts=4), loading()):
        for axes in result.plot().axes:
            assert "[" in axes.get_ylabel()
            assert "[" in axes.get_xlabel() or axes.get_xlabel().startswith(("impact", "rebound"))


def test_a_unit_takes_the_prefix_of_the_largest_value():
    assert style.scale_of(np.array([1e-9, -4.6e-8, np.nan]), unit="m") == (1e-9, "nm")
    assert style.scale_of(np.array([2e-6]), unit="N") == (1e-6, "µN")
    assert style.scale_of(np.zeros(3), unit="s") == (1.0, "s")


def test_parts_can_be_drawn_alone_and_unknown_ones_are_refused():
    result = bounce(impacts=4)
    whole = plots.figure(result).get_figheight()
    assert plots.figure(result, "energy").get_figheight() == pytest.approx(whole / 3)
    with pytest.raises(InputError, match="must be of motion, forces, energy; got 'map'"):
        plots.figure(result, "map")


def test_a_result_without_motion_is_not_drawn():
    result = shorten(bounce(impacts=1), 0)
    assert plots.pictures(result) == {}
    with pytest.raises(InputError, match="must hold its motion"):
        result.plot()


def test_a_notebook_shows_a_figure_by_itself_and_the_users_own_style_is_left_alone():
    before = dict(mpl.rcParams)
    assert bounce(impacts=1).plot()._repr_png_().startswith(b"\x89PNG")
    assert dict(mpl.rcParams) == before


def test_the_first_contact_is_found():
    result = bounce(0.8, 10)
    points = impacts.first_contact(result) or slice(0, 1)
    start, end = result.time[points][[0, -1]] - result.events["closest_approach_time"][0]
    way_in = np.pi / 2 * np.sqrt(MASS / 2e4)
    assert start < -way_in
    assert way_in < end < 0.2 * result.events["apex_time"][0]


def test_largest_forces_belong_to_their_impacts():
    result = bounce(0.8, 10)
    push = impacts.largest(result, "elastic", 1.0)
    fast = np.sqrt(2 * GRAVITY * (RELEASE - SURFACE)) * 0.8 ** np.arange(10)
    np.testing.assert_allclose(push, fast * np.sqrt(2e4 * MASS), rtol=1e-9)
    np.testing.assert_allclose(impacts.largest(result, "capillary", -1.0), ATTRACTION)
    assert impacts.largest(result, "magnetic", 1.0).size == 0


def test_heights_count_from_static_equilibrium():
    assert impacts.reference(bounce(impacts=2)) == pytest.approx(SURFACE)
    assert impacts.reference(shorten(bounce(impacts=2), 10)) is None


@pytest.mark.parametrize(("point", "label"), [(0, "release"), (9, "release + v²/2g")])
def test_rebounds_of_a_launched_body_decay_from_the_height_of_its_energy(point: int, label: str):
    result = cut(bounce(0.8, 6), slice(point, None))
    axes = plots.figure(result, "motion").axes[1]
    heights = axes.lines[-1].get_ydata()
    np.testing.assert_allclose(heights[1:] / heights[:-1], 0.8**2, rtol=1e-9)
    assert heights[0] == pytest.approx((RELEASE - SURFACE) * 1e9, rel=1e-9)
    assert axes.get_xlabel() == f"rebound (0: {label})"
    assert_legible(plots.figure(result))


def test_a_launch_without_gravity_has_no_height_to_compare():
    result = cut(without(bounce(0.8, 6), "weight"), slice(9, None))
    axes = plots.figure(result, "motion").axes[1]
    assert axes.get_xlabel() == "rebound"
    assert np.isnan(axes.lines[-1].get_ydata()[0])


def test_losses_over_more_than_a_decade_fill_their_axis():
    axes = plots.figure(bounce(0.6, 6), "energy").axes[2]
    values = np.concatenate([line.get_ydata() for line in axes.lines])
    low, high = axes.get_ylim()
    assert axes.get_yscale() == "log"
    assert high / low < 3.0 * np.nanmax(values) / np.nanmin(values)


def test_energy_shows_what_each_mechanism_took_in_each_impact():
    result = bounce(0.8, 6)
    total = sum(values for name, values in result.energies.items() if name.startswith("lost_"))
    axes = plots.figure(result, "energy").axes[2]
    assert axes.get_xlabel() == "impact"
    assert axes.get_ylabel() == "energy lost [aJ]"
    taken = np.nansum([line.get_ydata() for line in axes.lines], axis=0) * 1e-18
    fall = MASS * GRAVITY * (RELEASE - SURFACE) * 0.64 ** np.arange(6)
    np.testing.assert_allclose(taken, fall * (1.0 - 0.64), rtol=1e-9)
    assert np.nansum(taken) == pytest.approx(total[-1] - total[0], rel=1e-9)


def test_a_mechanism_that_took_only_rounding_is_not_drawn_as_a_loss():
    result = bounce(0.8, 6)
    rounding = 1e-14 * result.energies["kinetic"].max() * np.linspace(0.0, 1.0, result.time.size)
    energies = {**result.energies, "lost_plastic": rounding}
    axes = plots.figure(dataclasses.replace(result, energies=energies), "energy").axes[2]
    tints = [line.get_color() for line in axes.lines]
    assert tints == [colour("lost_adhesion"), colour("lost_capillary")]


def test_one_pull_on_its_own_scale_is_named_on_the_axis_alone():
    dry = without(bounce(impacts=2), "capillary")
    figure = plots.figure(dry, "forces")
    assert figure.axes[1].get_ylabel() == "adhesion [pN]"
    assert figure.axes[1].get_legend() is None
    legends = [axes.get_legend() for axes in figure.axes if axes.get_legend()]
    named = [text.get_text() for legend in legends for text in legend.get_texts()]
    assert named.count("adhesion") == 1


def test_all_pictures_of_two_hundred_rebounds_take_a_moment_and_are_the_same_twice():
    first = plots.pictures(MOTIONS["many rebounds"])
    start = time.process_time()
    assert plots.pictures(MOTIONS["many rebounds"]) == first
    assert time.process_time() - start < 2.5


def test_slow_decay_is_drawn_from_its_beginning_and_fast_decay_whole():
    slow, shown = impacts.beginning(bounce(0.98, 200))
    assert shown == ", first 25 of 200 rebounds"
    assert bounce(0.98, 200).time[slow][-1] == bounce(0.98, 200).events["apex_time"][24]
    assert impacts.beginning(bounce(0.8, 100)) == (slice(None), "")
    assert impacts.beginning(bounce(0.98, 20)) == (slice(None), "")


def test_a_loss_without_a_pull_off_is_drawn_as_the_difference_of_the_branches():
    curve = loading()
    lifted = dataclasses.replace(
        curve,
        force_loading=curve.force_loading + 1e-6,
        force_unloading=curve.force_unloading + 1e-6,
        pull_off=0.0,
    )
    axes = lifted.plot().axes[1]
    bridge = curve.components_unloading["capillary"]
    np.testing.assert_allclose(axes.lines[-1].get_ydata(), bridge * 1e9, atol=1e-6)
    assert texts_outside(lifted.plot()) == []


CRITICAL = 12.3e-3
SPEEDS = np.geomspace(1e-4, 10.0, 61)


def of_jkr(speeds: np.ndarray) -> np.ndarray:
    """Restitution of a smooth JKR sphere, whose cycle loses the same at each speed."""
    return np.sqrt(np.clip(1.0 - (CRITICAL / speeds) ** 2, 0.0, None))


def upright(axes: Axes) -> list[float]:
    """Where vertical lines stand."""
    lines = [line for line in axes.lines if len(set(line.get_xdata())) == 1]
    return [float(line.get_xdata()[0]) for line in lines if len(line.get_xdata()) == 2]


def shaded(axes: Axes) -> list[tuple[float, float]]:
    return [(patch.get_x(), patch.get_x() + patch.get_width()) for patch in axes.patches]


def legend_of(figure: Figure) -> list[str]:
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def drawn(held: np.ndarray, speeds: np.ndarray = SPEEDS, **options: Any) -> Figure:
    return restitution_plot.figure(speeds, of_jkr(speeds), held, **options)


def test_restitution_is_drawn_over_decades_with_the_critical_velocity():
    held = SPEEDS < CRITICAL
    figure = drawn(held, edges=(CRITICAL,), critical=CRITICAL, own_speed=0.1, name="a")
    (axes,) = figure.axes
    assert (axes.get_xlabel(), axes.get_xscale()) == ("speed of approach [mm/s]", "log")
    assert (axes.get_ylabel(), axes.get_yscale()) == ("coefficient of restitution [-]", "linear")
    assert axes.get_ylim()[0] <= 0.0
    assert axes.get_ylim()[1] >= 1.0
    assert axes.get_xlim()[0] <= 0.1
    assert axes.get_xlim()[1] >= 1e4
    assert upright(axes) == pytest.approx([12.3, 100.0])
    rebounds, captures = (line for line in axes.lines if len(line.get_xdata()) > 2)
    np.testing.assert_allclose(rebounds.get_ydata()[~held], of_jkr(SPEEDS)[~held])
    assert np.all(np.isnan(rebounds.get_ydata()[held]))
    np.testing.assert_allclose(captures.get_xdata(), 1e3 * SPEEDS[held])
    assert not np.any(captures.get_ydata())
    ((low, high),) = shaded(axes)
    assert low <= 0.1
    assert high == pytest.approx(12.3)
    assert legend_of(figure) == [
        "critical velocity 12.3 mm/s", "speed of the case 100 mm/s", "captured at the first impact"
    ]  # fmt: skip


def test_every_interval_of_captured_speeds_is_shaded_between_its_edges():
    edges = (CRITICAL, 0.2, 0.9)
    held = (SPEEDS < CRITICAL) | ((SPEEDS > 0.2) & (SPEEDS < 0.9))
    figure = drawn(held, edges=edges, critical=CRITICAL)
    (axes,) = figure.axes
    assert sorted(upright(axes)) == pytest.approx([12.3, 200.0, 900.0])
    assert [high for _, high in shaded(axes)] == pytest.approx([12.3, 900.0])
    assert shaded(axes)[1][0] == pytest.approx(200.0)
    assert "other edges of capture 200 mm/s, 900 mm/s" in legend_of(figure)
    assert texts_outside(figure) == []


def test_an_interval_that_no_speed_lies_in_is_shaded_too():
    edges = (1e-3, 1.01e-3)  # no speed of the table lies between
    figure = drawn(SPEEDS < 0.0, edges=edges, critical=1e-3)
    assert np.allclose(shaded(figure.axes[0]), [(1.0, 1.01)])
    fast = SPEEDS[SPEEDS > 0.02]  # the critical velocity lies below all of them
    figure = drawn(fast < 0.0, fast, edges=(CRITICAL,), critical=CRITICAL)
    ((low, high),) = shaded(figure.axes[0])
    assert low < high == pytest.approx(12.3)


def test_speeds_that_all_rebound_have_no_critical_velocity():
    fast = SPEEDS[SPEEDS > 1.0]
    figure = drawn(fast < 0.0, fast)
    (axes,) = figure.axes
    assert upright(axes) == shaded(axes) == legend_of(figure) == []
    assert axes.get_xlabel() == "speed of approach [m/s]"


def test_speeds_that_gas_stops_are_left_out_and_counted():
    bounce = np.where(SPEEDS < 0.05, np.nan, of_jkr(SPEEDS))
    figure = restitution_plot.figure(SPEEDS, bounce, SPEEDS < 0.0)
    (line, none) = figure.axes[0].lines
    assert np.count_nonzero(np.isfinite(line.get_ydata())) == np.count_nonzero(SPEEDS >= 0.05)
    assert none.get_xdata().size == 0
    stopped = np.count_nonzero(SPEEDS < 0.05)
    assert legend_of(figure) == [f"no rebound, no capture at {stopped} of 61 speeds"]


def test_restitution_is_a_png_and_an_svg_of_one_column():
    files = restitution_plot.pictures(drawn(SPEEDS < CRITICAL))
    assert list(files) == ["restitution.png", "restitution.svg"]
    assert size_mm(files["restitution.png"])[0] == pytest.approx(style.COLUMN, abs=0.2)
    assert b"speed of approach" in files["restitution.svg"]

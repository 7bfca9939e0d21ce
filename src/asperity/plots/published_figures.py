"""The publication's figures, in this project's style, 85 mm wide."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from asperity.plots import adhesion_map, style
from asperity.plots.height_map import legible
from asperity.plots.style import Panel
from asperity.publication.figure_data import Drawing
from asperity.regimes import Frame
from asperity.results.colours import colour

_SHORT = 12
_ORDER = ("loading", "unloading", "capillary", "apex", "central")


def figures(drawings: dict[str, Drawing]) -> dict[str, Figure]:
    """A figure for each drawing, by its name."""
    with style.look():
        return {
            name: style.figure_of([[Panel(1.0, draw)] for draw in _panels(name, drawing)])
            for name, drawing in drawings.items()
        }


def files(drawings: dict[str, Drawing]) -> dict[str, bytes]:
    """Each figure as PNG and as SVG, and its data as CSV, by file name."""
    out: dict[str, bytes] = {}
    for name, figure in figures(drawings).items():
        out |= style.images(name, figure) | {f"{name}.csv": drawings[name].csv()}
    return out


Draw = Callable[[Axes], None]


def _panels(name: str, drawing: Drawing) -> list[Draw]:
    """What draws the panels of a figure, from top to bottom."""
    panels: dict[str, list[Callable[..., None]]] = {
        "figure-1": [_bodies, _near_the_plane],
        "figure-2": [_heights],
        "figure-3": [_distribution],
        "figure-4": [_map],
        "figure-5": [_meniscus, _bands],
        "figure-6": [_gap, _displacement],
        "figure-7a": [_motions],
        "figure-7b": [_forces, _first_contact],
        "figure-8": [_motions],
        "figure-9": [_motions],
    }
    return [partial(draw, drawing=drawing) for draw in panels[name]]


def _scaled(
    axes: Axes, labels: Sequence[str], xs: Sequence[np.ndarray], ys: Sequence[np.ndarray]
) -> list[float]:
    """Label both axes, ``name [unit]`` with a prefix that suits; the factors."""
    factors = []
    for axis, label, values in zip((axes.xaxis, axes.yaxis), labels, (xs, ys), strict=True):
        name, unit = label.rstrip("]").rsplit(" [", 1)
        factors.append(style.scaled_axis(axis, name, *values, unit=unit))
    return factors


def _bodies(axes: Axes, drawing: Drawing) -> None:
    x, y = drawing.series["sphere"]
    _, metres = _scaled(axes, drawing.columns, [x], [y])
    axes.fill(x / metres, y / metres, color=colour("central"), alpha=0.5, lw=0.0)
    axes.plot(x / metres, y / metres, color=colour("motion"))
    axes.axhspan(-0.12 * y.max() / metres, 0.0, color=colour("quiet"), alpha=0.5, lw=0.0)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_ylim(-0.12 * y.max() / metres, 1.05 * y.max() / metres)
    axes.annotate("silica", (0.0, 0.5 * y.max() / metres), ha="center", va="center")
    axes.annotate("silicon carbide", (0.0, -0.06 * y.max() / metres), ha="center", va="center")


def _near_the_plane(axes: Axes, drawing: Drawing) -> None:
    x, y = drawing.series["sphere near the plane"]
    rms = drawing.about["rms height [m]"]
    wide, tall = _scaled(axes, drawing.columns, [x], [y])
    axes.plot(x / wide, y / tall, color=colour("motion"), label="sphere")
    axes.axhspan(-rms / tall, rms / tall, color=colour("quiet"), alpha=0.3, lw=0.0,
                 label="± rms height")  # fmt: skip
    axes.axhline(0.0, color=colour("quiet"), lw=0.6)
    axes.set_ylim(-1.5 * rms / tall, 1.15 * y.max() / tall)
    axes.margins(x=0.0)
    style.legend_above(axes)


def _heights(axes: Axes, drawing: Drawing) -> None:
    ((name, (x, y, z)),) = drawing.series.items()
    if name != "composite":
        axes.set_title(legible(name), parse_math=False)
    shape = int(drawing.about["rows"]), int(drawing.about["columns"])
    metres, _ = _scaled(axes, drawing.columns[:2], [x], [x])
    nano, unit = style.scale_of(z, unit="m")
    image = axes.imshow(
        np.ma.masked_invalid(z.reshape(shape) / nano), origin="lower", cmap="cividis",
        interpolation="nearest", aspect="equal",
        extent=(0.0, x.max() / metres, 0.0, y.max() / metres),
    )  # fmt: skip
    figure = axes.figure
    assert isinstance(figure, Figure)
    place = axes.get_position()
    axes.set_position((place.x0, place.y0, 0.8 * place.width, place.height))
    column = (place.x0 + 0.83 * place.width, place.y0, 0.03 * place.width, place.height)
    style.colour_bar(figure, image, column, style.label("height", unit))


def _distribution(axes: Axes, drawing: Drawing) -> None:
    columns = [list(side) for side in zip(*drawing.series.values(), strict=True)]
    wide, _ = _scaled(axes, drawing.columns, *columns)
    # A density over the heights' unit, whatever the prefix that its own size would suggest.
    _, unit = style.scale_of(*columns[0], unit="m")
    axes.set_ylabel(style.label("probability density", f"1/{unit}"))
    axes.yaxis.set_major_locator(MaxNLocator(5))
    names = [name for name in drawing.series if name != "Gaussian"]
    for name, mark, tint in zip(names, "o^", ("loading", "unloading"), strict=False):
        x, y = drawing.series[name]
        axes.plot(x / wide, y * wide, mark, ms=2.5, mew=0.0, color=colour(tint),
                  label=legible(name, 30))  # fmt: skip
    x, y = drawing.series["Gaussian"]
    axes.plot(x / wide, y * wide, color=colour("contact"), lw=0.8, label="Gaussian")
    axes.set_ylim(bottom=0.0)
    axes.margins(x=0.0)
    style.legend_above(axes, 1 if len(names[0]) <= _SHORT else 2)


def _map(axes: Axes, drawing: Drawing) -> None:
    lines = {name: columns for name, columns in drawing.series.items() if "|" in name}
    frame = Frame.around([])
    adhesion_map.draw_lines(axes, lines, frame)
    adhesion_map.name_regions(axes, frame, [])
    marks = (("closest approach", "o", "motion"), ("at rest, exact model", "^", "unloading"))
    for name, mark, tint in marks:
        x, y = drawing.series[name]
        axes.plot(x, y, mark, ms=4.0, mew=0.0, color=colour(tint), label=name)
    style.legend_above(axes)


def _meniscus(axes: Axes, drawing: Drawing) -> None:
    shown = ("asperity", "meniscus, right", "meniscus, left")
    series = {name: drawing.series[name] for name in shown}
    wide = 1e-9  # both axes alike, so that the shape is true
    axes.set(xlabel="position [nm]", ylabel="height [nm]")
    right, left = series["meniscus, right"], series["meniscus, left"]
    x, y = series["asperity"]
    outline_x = np.concatenate([left[0], right[0][::-1]]) / wide
    outline_y = np.concatenate([left[1], right[1][::-1]]) / wide
    axes.fill(outline_x, outline_y, color=colour("central"), alpha=0.6, lw=0.0, label="liquid")
    top = y.max() / wide
    axes.fill_between(x / wide, y / wide, top, color="#DDDDDD", lw=0.0)
    axes.plot(x / wide, y / wide, color=colour("contact"), label="asperity")
    axes.axhline(0.0, color=colour("quiet"), lw=2.0, label="flat")
    axes.set_ylim(-0.08 * top, top)
    axes.set_aspect("equal", adjustable="datalim")
    style.legend_above(axes)


def _bands(axes: Axes, drawing: Drawing) -> None:
    x, profile = drawing.series["rough surface"]
    tops, heights = drawing.series["summits"]
    wet, below = drawing.series["summits with a meniscus"]
    flat, bands = drawing.about["edge [m]"], int(drawing.about["bands drawn"])
    wide = 1e-9
    axes.set(xlabel="position [nm]", ylabel="height [nm]")
    for number, (place, height) in enumerate(zip(wet, below, strict=True)):
        axes.fill_between((place / wide - 0.7, place / wide + 0.7), height / wide, flat / wide,
                          color=colour("central"), alpha=0.5, lw=0.0,
                          label="menisci" if number == 0 else None)  # fmt: skip
    low = -0.9 * flat / wide
    axes.fill_between(x / wide, np.maximum(profile / wide, low), low, color="#DDDDDD", lw=0.0)
    axes.plot(x / wide, profile / wide, color=colour("contact"), lw=0.8)
    axes.plot(tops / wide, heights / wide, "o", ms=2.5, mew=0.0, color=colour("unloading"),
              label="summits")  # fmt: skip
    reduced = flat / drawing.about["rms height [m]"]
    axes.axhline(flat / wide, color=colour("quiet"), lw=2.0, label=f"flat, λ' = {reduced:.3g}")
    for number in range(1, bands + 1):
        axes.axhline(flat * (1.0 - number / bands) / wide, color=colour("quiet"), lw=0.5, ls=":",
                     label="bands Δh" if number == 1 else None)  # fmt: skip
    axes.set_ylim(low, 1.1 * flat / wide)
    axes.margins(x=0.0)
    style.legend_above(axes)


def _gap(axes: Axes, drawing: Drawing) -> None:
    r, h, _, _ = drawing.series["closest approach"]
    edge, rms = drawing.about["edge [m]"], drawing.about["rms height [m]"]
    near = r < 2.0 * r[h < edge].max()
    wide, tall = _scaled(axes, drawing.columns[:2], [r[near]], [h[near]])
    axes.plot(r[near] / wide, h[near] / tall, color=colour("motion"), label="d + S(r)")
    name = f"edge, λ' = {edge / rms:.3g}"
    axes.axhline(edge / tall, color=colour("unloading"), lw=0.8, ls="--", label=name)
    axes.fill_between(r[near] / wide, h[near] / tall, edge / tall, where=h[near] < edge,
                      color=colour("lost"), lw=0.0, label="conjunction")  # fmt: skip
    axes.set_xlim(0.0, r[near].max() / wide)
    style.legend_above(axes)


def _displacement(axes: Axes, drawing: Drawing) -> None:
    r, h, u, _ = drawing.series["closest approach"]
    near = r < 2.0 * r[h < drawing.about["edge [m]"]].max()
    wide, tall = _scaled(axes, drawing.columns[::2], [r[near]], [u[near]])
    axes.plot(r[near] / wide, u[near] / tall, color=colour("central"))
    axes.set_xlim(0.0, r[near].max() / wide)
    axes.set_ylim(bottom=0.0)
    axes.set_title("what the pressure of contact would displace")


def _motions(axes: Axes, drawing: Drawing) -> None:
    columns = [list(side) for side in zip(*drawing.series.values(), strict=True)]
    wide, tall = _scaled(axes, drawing.columns, *columns)
    for number, (name, (x, y)) in enumerate(drawing.series.items()):
        axes.plot(x / wide, y / tall, color=colour(_ORDER[number % len(_ORDER)]), label=name)
    if "edge [m]" in drawing.about:
        axes.axhline(drawing.about["edge [m]"] / tall, color=colour("quiet"), lw=0.6,
                     ls=(0, (4, 3)), label="edge of the conjunction")  # fmt: skip
    axes.set_xlim(left=0.0, right=max(x.max() for x in columns[0]) / wide)
    style.legend_above(axes)


def _forces(axes: Axes, drawing: Drawing) -> None:
    time, *forces = drawing.series["wet"]
    _force_lines(axes, drawing, drawing.columns[0], time, forces)
    style.legend_above(axes, 2)


def _force_lines(
    axes: Axes, drawing: Drawing, label: str, time: np.ndarray, forces: Sequence[np.ndarray]
) -> None:
    """Each force against a time that is labelled."""
    wide, tall = _scaled(axes, (label, "force [N]"), [time], forces)
    for column, force in zip(drawing.columns[1:], forces, strict=True):
        name = column.rsplit(" [", 1)[0]
        axes.plot(time / wide, force / tall, color=colour(name), lw=0.8, label=name)
    axes.margins(x=0.0)


def _first_contact(axes: Axes, drawing: Drawing) -> None:
    time, *forces = drawing.series["wet"]
    middle = drawing.about["first closest approach [s]"]
    since = time - middle
    acts = np.abs(forces[0]) > 0.0
    # The stretch around the closest approach in which contact acts; to the end if it stays.
    index = int(np.argmin(np.abs(since)))
    before, after = np.flatnonzero(~acts[:index]), np.flatnonzero(~acts[index:])
    begin = int(before[-1]) if before.size else 0
    near = slice(begin, index + int(after[0]) + 1 if after.size else None)
    shown = [force[near] for force in forces]
    _force_lines(axes, drawing, "time from closest approach [s]", since[near], shown)
    axes.set_title("first contact")

"""Arguments and options of the commands, as typer shows them."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from asperity.cli import shell_completion
from asperity.errors import InputError


def _one_manner(ctx: typer.Context, value: bool) -> bool:
    """Refuse to be quiet and verbose at once; the later of the two options finds the other."""
    both = value and (ctx.params.get("quiet") or ctx.params.get("verbose"))
    if both and not ctx.resilient_parsing:
        raise InputError("`--quiet` must be given without `--verbose`; got both")
    return value


CaseName = Annotated[
    str,
    typer.Argument(
        help="Name of a built-in case (glass-bead), a FILE.toml, or a record.nc to repeat.",
        show_default=False,
        autocompletion=shell_completion.case,
    ),
]
Cases = Annotated[
    list[str],
    typer.Argument(
        metavar="CASE...",
        help="As for run.",
        show_default=False,
        autocompletion=shell_completion.case,
    ),
]
Materials = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="[NAME]...",
        help="Only these.",
        show_default=False,
        autocompletion=shell_completion.material,
    ),
]
Folder = Annotated[
    str | None,
    typer.Option("-o", "--output", metavar="DIR", help="Folder for the files.", show_default=False),
]
Force = Annotated[
    bool,
    typer.Option("--force", help="Replace results in DIR, of whatever case; other files stay."),
]
Published = Annotated[
    bool,
    typer.Option(
        "--publication", help="Show the publication's measures too: decrement and power losses."
    ),
]
Load = Annotated[
    str | None,
    typer.Option(
        "--load", metavar="FORCE", help='Load at which unloading begins, such as "1 uN".',
        show_default=False,
    ),
]  # fmt: skip
Depth = Annotated[
    str | None,
    typer.Option(
        "--depth",
        metavar="LENGTH",
        help='Depth at which unloading begins, below a rigid separation of 0, such as "5 nm".',
        show_default=False,
    ),
]
Speeds = Annotated[
    str | None,
    typer.Option(
        "--speeds",
        metavar="FROM,TO",
        help='First and last speed of launch, such as "1 mm/s, 10 m/s"; by default chosen about '
        "the critical velocity.",
        show_default=False,
    ),
]
SpeedPoints = Annotated[
    int | None,
    typer.Option(
        "--points",
        min=2,
        max=1001,
        help="How many speeds; 61 unless given, 31 with single bodies.",
        show_default=False,
    ),
]
Json = Annotated[
    bool,
    typer.Option(
        "--json", help="Print one JSON object, in SI units; write files only if -o is given."
    ),
]
OnlyJson = Annotated[bool, typer.Option("--json", help="Print one JSON object, in SI units.")]
Quiet = Annotated[
    bool,
    typer.Option("-q", "--quiet", callback=_one_manner, help="Print nothing but errors and JSON."),
]
Verbose = Annotated[
    bool,
    typer.Option(
        "-v", "--verbose", callback=_one_manner, help="Say each step and how long it took."
    ),
]
Version = Annotated[
    bool, typer.Option("--version", help="Print the version, and those of the stack.")
]
VersionJson = Annotated[bool, typer.Option("--json", help="With --version: one JSON object.")]


def optional(
    name: str, metavar: str, words: str, note: str | None = None, *, values: Any = None
) -> Any:
    """An option that takes a text and has no default of its own; a shell completes ``values``."""
    shown = f"{words}{f'  [default: {note}]' if note else ''}"
    return typer.Option(
        f"--{name}", metavar=metavar, help=shown, show_default=False, autocompletion=values
    )


def choice(name: str, metavar: str, words: str, note: str, *values: str) -> Any:
    """An option that takes one of some words."""
    return optional(name, metavar, words, note, values=shell_completion.one_of(*values))


Size = Annotated[
    str | None, optional("size", "'X x Y'", "Size of the map where the file does not state it.")
]
Unit = Annotated[
    str | None,
    optional(
        "unit",
        "UNIT",
        "Unit of the heights (of points: of x and y too) where the file does not state it.",
    ),
]
Missing = Annotated[
    str | None,
    choice(
        "missing", "refuse|keep|fill", "Missing pixels.", "refuse",
        "refuse", "keep", "fill",
    ),
]  # fmt: skip

SurfaceFiles = Annotated[
    list[str],
    typer.Argument(
        metavar="FILE [FILE2]",
        help="A measured surface, or two that face each other: .npy .csv .xyz .nc, or an "
        "instrument's.",
        show_default=False,
    ),
]
Channel = Annotated[str | None, optional("channel", "NAME|N", "Channel of an instrument's file.")]
FormRemoval = Annotated[
    str | None,
    choice(
        "form-removal", "FORM", "none|mean|tilt|curvature|sphere", "tilt",
        "none", "mean", "tilt", "curvature", "sphere",
    ),
]  # fmt: skip
LineLevelling = Annotated[
    str | None,
    choice(
        "line-levelling", "HOW", "Scan lines: none|median|median-difference|polynomial", "none",
        "none", "median", "median-difference", "polynomial",
    ),
]  # fmt: skip
Direction = Annotated[
    str | None,
    choice(
        "direction", "rows|columns", "What a scan line is.", "rows",
        "rows", "columns",
    ),
]  # fmt: skip
Degree = Annotated[int | None, optional("degree", "N", "Degree of a scan line's polynomial.", "1")]
SFilter = Annotated[
    str | None, optional("s-filter", "LENGTH", "Cut wavelengths below this, such as '50 nm'.")
]
LFilter = Annotated[
    str | None, optional("l-filter", "LENGTH", "Cut wavelengths above this, such as '5 um'.")
]
MadeFile = Annotated[
    str,
    typer.Argument(
        metavar="FILE", help="File to write: .npy .csv .xyz .nc, each also .gz.", show_default=False
    ),
]
MadeSize = Annotated[
    str | None, optional("size", "'X x Y'", "Size of the map, such as '10 um x 10 um'.")
]
Points = Annotated[str, typer.Option("--points", metavar="N|NxM", help="Pixels along x and y.")]
Hurst = Annotated[float, typer.Option("--hurst", metavar="H", help="Hurst exponent.")]
RollOff = Annotated[
    str | None,
    optional("roll-off", "LENGTH", "Wavelength above which the spectrum is flat.", "none"),
]
CutOff = Annotated[str | None, optional("cut-off", "LENGTH", "Shortest wavelength.", "two pixels")]
RmsHeight = Annotated[
    str | None, optional("rms-height", "LENGTH", "Rms height; this or --rms-slope.")
]
RmsSlope = Annotated[float | None, optional("rms-slope", "NUMBER", "Rms of the gradient.")]
Seed = Annotated[int, typer.Option("--seed", metavar="N", help="Of the random numbers.")]
Skewness = Annotated[float | None, optional("skewness", "S", "Skewness of the heights.", "0")]
Kurtosis = Annotated[
    float | None, optional("kurtosis", "K", "Kurtosis of the heights.", "3, a Gaussian's")
]
Heights = Annotated[
    str | None,
    optional(
        "heights",
        "FILE",
        "Take the distribution of these heights: an .npy of numbers, or "
        "a surface, whose tilt is removed.",
    ),
]
ForceFile = Annotated[bool, typer.Option("--force", help="Replace FILE.")]
Refit = Annotated[
    bool, typer.Option("--refit", help="Find the unknown inputs again from the tables.")
]
Tables = Annotated[
    str | None,
    typer.Option(
        "--tables",
        metavar="FILE.csv",
        help="Tables to compare with, in place of the publication's.",
        show_default=False,
    ),
]
TwoSurfaces = Annotated[
    tuple[str, str] | None,
    typer.Option(
        "--surfaces",
        metavar="FILE FILE",
        help="Two measured surfaces for Figures 2 and 3; their tilt is removed.",
        show_default=False,
    ),
]

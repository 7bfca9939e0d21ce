"""Arguments and options of the commands, as typer shows them, and those that most have."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from importlib import import_module
from typing import Annotated, Any

import typer

from asperity.cli import shell_completion
from asperity.cli.reporter import Reporter
from asperity.errors import InputError

Command = Callable[..., None]


def _one_manner(ctx: typer.Context, value: bool) -> bool:
    """Refuse to be quiet and verbose at once; the later of the two options finds the other."""
    both = value and (ctx.params.get("quiet") or ctx.params.get("verbose"))
    if both and not ctx.resilient_parsing:
        raise InputError("`--quiet` must be given without `--verbose`; got both")
    return value


def argument(words: str, metavar: str | None = None, *, values: Any = None) -> Any:
    """An argument that has no default of its own; a shell completes ``values``."""
    return typer.Argument(metavar=metavar, help=words, show_default=False, autocompletion=values)


def optional(
    name: str, metavar: str, words: str, note: str | None = None, *, values: Any = None
) -> Any:
    """An option that has no default of its own; a shell completes ``values``."""
    shown = f"{words}{f'  [default: {note}]' if note else ''}"
    return typer.Option(
        f"--{name}", metavar=metavar, help=shown, show_default=False, autocompletion=values
    )


def choice(name: str, metavar: str, words: str, note: str, *values: str) -> Any:
    """An option that takes one of some words."""
    return optional(name, metavar, words, note, values=shell_completion.one_of(*values))


CaseName = Annotated[
    str,
    argument(
        "Name of a built-in case (glass-bead), a FILE.toml, or a record.nc to repeat.",
        values=shell_completion.case,
    ),
]
Cases = Annotated[list[str], argument("As for run.", "CASE...", values=shell_completion.case)]
Materials = Annotated[
    list[str] | None, argument("Only these.", "[NAME]...", values=shell_completion.material)
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
    str | None, optional("load", "FORCE", 'Load at which unloading begins, such as "1 uN".')
]
Depth = Annotated[
    str | None,
    optional(
        "depth",
        "LENGTH",
        'Depth at which unloading begins, below a rigid separation of 0, such as "5 nm".',
    ),
]
Speeds = Annotated[
    str | None,
    optional(
        "speeds",
        "FROM,TO",
        'First and last speed of launch, such as "1 mm/s, 10 m/s"; by default chosen about '
        "the critical velocity.",
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


def reports(task: str = "", *, json: Any = OnlyJson) -> Callable[[Command], Command]:
    """Give a command ``--json``, ``--quiet`` and ``--verbose``.

    What carries it out is called with the `Reporter` that these three make, and then with the
    command's own arguments.

    Parameters
    ----------
    task : str
        What carries it out, as ``module.function`` of this package; imported once the command is
        called, whose own body is then empty. Without it the command carries itself out.
    json : type
        `Json` where the command writes files of its own accord.
    """

    def reporting(described: Command) -> Command:
        @functools.wraps(described)
        def command(
            *given: Any, as_json: bool = False, quiet: bool = False, verbose: bool = False,
            **options: Any,
        ) -> None:  # fmt: skip
            home, _, name = task.partition(".")
            carry_out = getattr(import_module(f"asperity.cli.{home}"), name) if task else described
            reporter = Reporter(as_json=as_json, quiet=quiet, verbose=verbose)
            carry_out(reporter, *given, **options)

        signature = inspect.signature(described, eval_str=True)
        own = [one for name, one in signature.parameters.items() if name != "reporter"]
        shared = {"as_json": json, "quiet": Quiet, "verbose": Verbose}
        options = [
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=False, annotation=kind)
            for name, kind in shared.items()
        ]
        shown = signature.replace(parameters=[*own, *options])
        command.__signature__ = shown  # type: ignore[attr-defined]
        return command

    return reporting


Version = Annotated[
    bool, typer.Option("--version", help="Print the version, and those of the stack.")
]
VersionJson = Annotated[bool, typer.Option("--json", help="With --version: one JSON object.")]
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
StudyFile = Annotated[str, argument("The study.", "STUDY.toml", values=shell_completion.study)]
StoreName = Annotated[
    str | None,
    typer.Option(
        "-o", "--output", metavar="NAME.zarr", help="The store.  [default: ./STUDY.zarr]",
        show_default=False,
    ),
]  # fmt: skip
Replace = Annotated[bool, typer.Option("--force", help="Replace what is there.")]
At = Annotated[
    list[str] | None,
    optional("at", "KEY=VALUE", "Take an axis' nearest value; may be repeated."),
]
Refit = Annotated[
    bool, typer.Option("--refit", help="Find the unknown inputs again from the tables.")
]
Tables = Annotated[
    str | None,
    optional("tables", "FILE.csv", "Tables to compare with, in place of the publication's."),
]
TwoSurfaces = Annotated[
    tuple[str, str] | None,
    optional(
        "surfaces", "FILE FILE",
        "Two measured surfaces for Figures 2 and 3; their tilt is removed.",
    ),
]  # fmt: skip

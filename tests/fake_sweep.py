"""The program with studies of numbers that cost nothing; for tests of stores, kills and commands.

``python fake_sweep.py ARGUMENTS...`` is ``asperity ARGUMENTS...`` with such studies: their file
holds the fields of a `fake_study.FakeStudy`.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

sys.path.insert(0, str(Path(__file__).parent))

import typer

import fake_study
from asperity.cli.terminal import Commands, leave, prepare

app = typer.Typer(cls=Commands, rich_markup_mode=None, pretty_exceptions_enable=False)

Output = Annotated[str | None, typer.Option("-o", "--output")]
Switch = Annotated[bool, typer.Option()]
Json = Annotated[bool, typer.Option("--json")]
Quiet = Annotated[bool, typer.Option("-q", "--quiet")]


@app.command()
def sweep(
    study: str,
    output: Output = None,
    resume: Switch = False,
    repair: Switch = False,
    shard: str | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    yes: Switch = False,
    force: Switch = False,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    from asperity.cli import sweeping

    sweeping.sweep(
        study, output=output, resume=resume, repair=repair, shard=shard, workers=workers,
        scheduler=scheduler, yes=yes, force=force, as_json=as_json, quiet=quiet,
    )  # fmt: skip


@app.command()
def merge(
    stores: list[str],
    output: Output = None,
    force: Switch = False,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    from asperity.cli import sweeping

    sweeping.merge(stores, output=output, force=force, as_json=as_json, quiet=quiet)


if __name__ == "__main__":
    sys.modules["asperity.studies.sweep.study"] = fake_study
    sys.modules["asperity.studies.sweep.batch"] = fake_study
    from typer.main import get_command

    prepare()
    leave(get_command(app))

"""The case that a study varies: a built-in one, a file, or tables in the study itself."""

from __future__ import annotations

from pathlib import Path

from asperity.config import BUILTINS, Case, Output, builtin, load_file
from asperity.config.case_file import beside
from asperity.config.problems import among, check
from asperity.errors import InputError
from asperity.sweeps.study.study_file import StudyTable
from asperity.units import shown


def base_of(table: StudyTable, folder: Path) -> tuple[Case, str]:
    """Base case of a study, and its name.

    Parameters
    ----------
    table : StudyTable
        The study's keys.
    folder : Path
        Where files that it names are looked for.

    Raises
    ------
    InputError
        Where there is no such case, or it cannot be used.
    """
    case, name = _found(table.base, folder)
    # Where a run would write its files is nothing of a study's, whose fingerprint it would change.
    return case.model_copy(update={"output": Output()}), table.name or name


def _found(base: object, folder: Path) -> tuple[Case, str]:
    if isinstance(base, dict):
        try:
            return beside(check(Case, base), folder), "base"
        except InputError as error:
            key = f"base.{error.key}" if error.key else "base"
            raise InputError(f"base.{error}", key=key) from None
    if not isinstance(base, str) or not base.strip():
        raise InputError(
            "`base` must be a built-in case or a case file beside the study, as text; got "
            f"{shown(base)}",
            key="base",
        )
    path = Path(base)
    if not path.suffix and path.name == base:
        return _builtin(base), base
    try:
        name = path.stem.encode(errors="replace").decode()
        return load_file(folder / path), name
    except InputError as error:
        raise InputError(f"base: {error}", key="base") from None


def _builtin(name: str) -> Case:
    rule = (
        f"`base` must be a built-in case ({', '.join(BUILTINS)}) or a case file beside the study, "
        "such as 'drop.toml'"
    )
    among(name, BUILTINS, rule, key="base")
    return builtin(name)

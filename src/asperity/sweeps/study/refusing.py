"""What no study can be: unknown columns, cases beyond counting, a text that no store holds."""

from __future__ import annotations

from asperity.config.case_file import refuse_size
from asperity.config.problems import place
from asperity.errors import InputError
from asperity.sweeps.study.columns import OF_BODIES
from asperity.sweeps.study.definition import StudyDefinition

CASES_LIMIT = 1 << 53
"""Most cases that a study can count: each has a number that a float can hold."""


def refuse_unusable(study: StudyDefinition, text: str) -> None:
    """Refuse unknown columns, cases without a motion or beyond counting, a text too long to store.

    Parameters
    ----------
    study : StudyDefinition
        The study.
    text : str
        Its canonical text, which a store holds.

    Raises
    ------
    InputError
        With the rule, and the key at fault.
    """
    kept = [column.name for column in study.columns if column in OF_BODIES]
    rough = study.base.roughness
    placed = rough is not None and rough.single_bodies
    placed = placed or any(axis.key == "roughness.placement" for axis in study.axes)
    if placed and not kept:
        raise InputError(
            f"`keep` must name a measure of single bodies, such as '{OF_BODIES[0].name}', where "
            f"`placement` launches them; got {', '.join(study.keep)}",
            key="keep",
        )
    if kept and not placed:
        raise InputError(
            f"`keep` must not name '{kept[0]}' without single bodies, which `placement` = 'random' "
            "in [roughness] launches",
            key="keep",
        )
    if study.base.impact is None and not any(place(a.key)[0] == "impact" for a in study.axes):
        raise InputError("`base` must have an [impact] table, for motions; got none", key="base")
    if study.size > CASES_LIMIT:
        got = f"at least 10^{len(str(study.size)) - 1}"
        raise InputError(f"[axes] must give at most 2^53 cases; got {got}", key="axes")
    if study.sample is not None:
        study.sample.refuse_axes(len(study.axes))
    _refuse_unstorable(text)


def _refuse_unstorable(text: str) -> None:
    """Refuse a canonical text that no store could hold."""
    try:
        text.encode()
    except UnicodeEncodeError:
        raise InputError(
            "`base` must name its files in UTF-8, for the store to hold; got other bytes",
            key="base",
        ) from None
    refuse_size(text, None, "a study")

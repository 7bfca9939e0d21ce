"""What no study can be: unknown columns, cases beyond counting, a text that no store holds."""

from __future__ import annotations

from asperity.config.case_file import refuse_size
from asperity.errors import InputError
from asperity.sweeps.study.definition import StudyDefinition
from asperity.sweeps.study.keys import place

CASES_LIMIT = 1 << 53
"""Most cases that a study can count: each has a number that a float can hold."""


_OF_BODIES = ("roughness.placement", "roughness.realisations", "roughness.seed")


def refuse_unusable(study: StudyDefinition) -> None:
    """Refuse columns that there are not, cases without a motion, and cases beyond counting.

    Raises
    ------
    InputError
        With the rule, and the key at fault.
    """
    _ = study.columns
    rough = study.base.roughness
    if any(axis.key in _OF_BODIES for axis in study.axes) or (
        rough is not None and rough.single_bodies
    ):
        raise InputError(
            "`placement` must be 'mean' in a study, which keeps the mean over all bodies: single "
            "ones are for `asperity run` and `asperity restitution`",
            key="roughness.placement",
        )
    if study.base.impact is None and not any(place(a.key)[0] == "impact" for a in study.axes):
        raise InputError("`base` must have an [impact] table, for motions; got none", key="base")
    if study.size > CASES_LIMIT:
        got = f"at least 10^{len(str(study.size)) - 1}"
        raise InputError(f"[axes] must give at most 2^53 cases; got {got}", key="axes")
    if study.sample is not None:
        study.sample.refuse_axes(len(study.axes))


def refuse_unstorable(text: str) -> None:
    """Refuse a study whose canonical text no store could hold.

    Raises
    ------
    InputError
        With the rule, and the key at fault.
    """
    try:
        text.encode()
    except UnicodeEncodeError:
        raise InputError(
            "`base` must name its files in UTF-8, for the store to hold; got other bytes",
            key="base",
        ) from None
    refuse_size(text, None, "a study")

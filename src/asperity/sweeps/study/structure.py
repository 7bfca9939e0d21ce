"""What kinds of case a study holds, and how many of them a task has."""

from __future__ import annotations

from typing import Any

from pydantic.fields import FieldInfo

from asperity.config.problems import place, tables_of
from asperity.config.tables import CaseTables
from asperity.sweeps.study.definition import StudyDefinition

QUICK = 4096
"""Cases of a task where the force is a closed form or a sum over heights."""

SLOW = 512
"""Cases of a task where the motion is integrated in time, or the law iterates."""

ELASTIC = 64
"""Cases of a task where a rough half-space is solved for each force."""


def task_size(study: StudyDefinition) -> int:
    """Cases of a task at most: by the slowest kind of case that the study can hold."""
    rough = _has(study, "roughness")
    bulk = "half-space" in _values(study, "counterface", "deformation")
    if rough and bulk and study.base.publication is None:
        return ELASTIC
    return QUICK if _quick(study) else SLOW


def largest_max_impacts(study: StudyDefinition) -> int:
    """Largest number of impacts that a case of the study can have."""
    return int(max(_values(study, "numerics", "max_impacts")))


def _quick(study: StudyDefinition) -> bool:
    """Whether no case has a rare mechanism, single summits or bodies, or adhesion beyond DMT's."""
    return not (
        any(_acts(study, name, field) for name, field in _mechanisms())
        or _values(study, "adhesion", "model") - {"dmt", "none"}
        or any(_values(study, "capillary", "formation_time"))
        or "summits" in _values(study, "roughness", "source")
        or _values(study, "roughness", "placement") & {"random", "measured"}
    )


def _has(study: StudyDefinition, table: str) -> bool:
    """Whether a case of the study can have a table."""
    varied = any(place(axis.key)[0] == table for axis in study.axes)
    return varied or getattr(study.base, table) is not None


def _mechanisms() -> list[tuple[str, FieldInfo]]:
    """The tables of mechanisms that few cases have."""
    rare = [
        (name, field)
        for name, field in CaseTables.model_fields.items()
        if isinstance(field.json_schema_extra, dict) and field.json_schema_extra.get("rare")
    ]
    return [(name, field) for name, field in rare if name != "publication"]


def _acts(study: StudyDefinition, table: str, field: FieldInfo) -> bool:
    """Whether the mechanism of a table can act in a case of the study."""
    if not _has(study, table):
        return False
    models = any("model" in kind.model_fields for kind in tables_of(field.annotation))
    return not models or bool(_values(study, table, "model") - {"none"})


def _values(study: StudyDefinition, table: str, key: str) -> set[Any]:
    """All values of a key within the study; {"none"} for a model whose table is absent."""
    for axis in study.axes:
        if axis.key == f"{table}.{key}":
            return set(axis.listed) or {axis.low, axis.high}
    found = getattr(study.base, table)
    absent = "none" if key == "model" else None
    return {absent if found is None else getattr(found, key)}

"""A study as text that needs no other file, the same for the same study."""

from __future__ import annotations

from asperity.config.case_text import literal
from asperity.sweeps.study.axes import Axis
from asperity.sweeps.study.definition import StudyDefinition


def text(study: StudyDefinition) -> str:
    """The study as TOML: SI values that read back exactly, its base case as tables."""
    lines = [
        "schema = 1",
        f"name = {literal(study.base_name)}",
        f"keep = {literal(list(study.keep))}",
        f"keep_impacts = {study.keep_impacts}",
        f"motions = {literal(study.motions)}",
        "",
        "[axes]",
        *(line for axis in study.axes for line in _axis(axis)),
    ]
    if study.sample is not None:
        sample = study.sample
        lines += ["", "[sample]", f"method = {literal(sample.method)}"]
        lines += [f"size = {sample.size}", f"seed = {sample.seed}"]
    return "\n".join([*lines, "", *_base(study), ""])


def _axis(axis: Axis) -> list[str]:
    if axis.listed:
        values = [f"  {literal(axis.written(value))}," for value in axis.listed]
        return [f"{literal(axis.key)} = {{values = [", *values, "]}"]
    ends = (int(end) if axis.whole else end for end in (axis.low, axis.high))
    low, high = (literal(axis.written(end)) for end in ends)
    steps = f", steps = {axis.steps}" if axis.steps else ""
    scale = literal(axis.scale)
    return [f"{literal(axis.key)} = {{from = {low}, to = {high}{steps}, scale = {scale}}}"]


def _base(study: StudyDefinition) -> list[str]:
    """The base case's own text, its tables put within [base]."""
    # A case's text has one value a line, so that a bracket in front opens a table.
    own = study.base.toml().rstrip("\n").split("\n")
    return ["[base]", *(f"[base.{line[1:]}" if line.startswith("[") else line for line in own)]

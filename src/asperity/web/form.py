"""The case schema as a form: what the page needs to draw a field for every key."""

from __future__ import annotations

import inspect
from typing import Any, Literal, get_args, get_origin

from pydantic.fields import FieldInfo

from asperity.config import Case
from asperity.config.case_text import ordered, unit_of
from asperity.config.fields import Number, Quantity
from asperity.config.key_labels import label
from asperity.config.problems import parts_of, tables_of

_LEFT_OUT = ("schema", "output")
"""What a page has no use for."""

_SPANS = {
    "rad": {"scale": "linear", "low": 0.0, "high": 89.0, "unit": "deg"},
    "K": {"scale": "linear", "low": 0.0, "high": 100.0, "unit": "degC"},
}
"""Spans of sliders by the SI unit, where a factor about the value is no way to move it."""

_DECADES = 1e3
"""Ratio of an interval's ends from which a plain number moves by factors."""


def form() -> list[dict[str, Any]]:
    """Every table of a case with its keys, in the order of a case file.

    Returns
    -------
    A list of tables ``{name, label, help, needed, named, keys}``, of which any number of ``named``
    ones may stand under their table's name, as [materials.NAME]; a key is ``{key, label, kind,
    unit, span, help, example, needed, shown, default, choices, among, slider, beside}``. Its kind
    is "quantity", "number", "whole", "choice", "switch", "list", "name or number" or "text";
    ``span`` says between what a plain number lies; ``slider`` is None where a slider cannot move
    it; ``beside`` is the key without which it must be absent.
    """
    found = []
    for name, field in ordered(Case).items():
        tables = tables_of(field.annotation)
        if not tables or (field.alias or name) in _LEFT_OUT:
            continue
        found.append(
            {
                "name": name,
                "label": label(name),
                "help": inspect.getdoc(tables[0]) or "",
                "needed": field.is_required() or name == "impact",  # the page shows motions
                "named": get_origin(field.annotation) is dict,
                "keys": [
                    {
                        **_key(name, key, inner),
                        "beside": "files" if key in getattr(tables[0], "of_files", ()) else "",
                    }
                    for key, inner in ordered(tables[0]).items()
                ],
            }
        )
    return found


def _key(table: str, name: str, field: FieldInfo) -> dict[str, Any]:
    extra = field.json_schema_extra if isinstance(field.json_schema_extra, dict) else {}
    limits = _limits(field)
    kind, choices = _kind(field.annotation, limits)
    return {
        "key": name,
        "label": label(f"{table}.{name}"),
        "kind": kind,
        "unit": unit_of(field),
        "span": "{:g} to {:g}".format(*limits.bounds) if isinstance(limits, Number) else "",
        "help": field.description or "",
        "example": (field.examples or [None])[0],
        "needed": field.is_required(),
        "shown": bool(extra.get("shown")) or field.is_required(),
        "default": None if field.is_required() else field.get_default(),
        "choices": choices,
        "among": extra.get("among") or [],
        "slider": _slider(limits),
    }


def _limits(field: FieldInfo) -> Quantity | Number | None:
    """What bounds a field's value."""
    for each in (*field.metadata, *parts_of(field.annotation)):
        if isinstance(each, Quantity | Number):
            return each
    return None


def _kind(annotation: Any, limits: Quantity | Number | None) -> tuple[str, list[str]]:
    if isinstance(limits, Quantity):
        return "quantity", []
    if isinstance(limits, Number):
        return ("whole" if limits.whole else "number"), []
    choices = [
        str(value)
        for part in parts_of(annotation)
        if get_origin(part) is Literal
        for value in get_args(part)
    ]
    if choices:
        return "choice", choices
    parts = [annotation, *get_args(annotation)]
    if any(part is bool for part in parts):
        return "switch", []
    if any(get_origin(part) is list for part in parts_of(annotation)):
        return "list", []
    if any(part is int for part in parts):
        return "name or number", []
    return "text", []


def _slider(limits: Quantity | Number | None) -> dict[str, Any] | None:
    """How far a slider goes: between the ends of an interval, or by factors about the value."""
    if isinstance(limits, Quantity):
        return _SPANS.get(limits.unit, {"scale": "factor"})
    if isinstance(limits, Number):
        low, high = limits.bounds
        if low > 0.0 and high / low >= _DECADES:
            return {"scale": "factor", "low": low, "high": high}
        return {"scale": "linear", "low": low, "high": high, "unit": ""}
    return None

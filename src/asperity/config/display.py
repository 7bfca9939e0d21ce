"""A case as Python shows it: one line, and a table for notebooks."""

from __future__ import annotations

from pydantic import BaseModel

from asperity.amounts import amount
from asperity.config.case_text import ordered, unit_of
from asperity.config.html_table import card
from asperity.config.tables import CaseTables


def sentence(case: CaseTables) -> str:
    """Body, counterface and what acts between them, in a few words."""
    body, plane = (part.material or "a solid by numbers" for part in (case.body, case.counterface))
    parts = [
        f"{case.body.shape} of {body}, radius {amount(case.body.radius, 'm')}, on {plane}",
        "smooth" if case.roughness is None else "rough",
    ]
    if case.adhesion.model != "none":
        parts.append(f"adhesion {case.adhesion.model}")
    if case.capillary.model != "none":
        humidity = case.capillary.humidity
        wet = "menisci" if humidity is None else f"relative humidity {100.0 * humidity:.3g} %"
        parts.append(wet)
    if case.gas is not None:
        parts.append(f"in {case.gas.name or 'gas'}")
    if case.impact is not None and case.impact.speed is not None:
        parts.append(amount(case.impact.speed, "m/s"))
    return ", ".join(parts)


def html(case: CaseTables) -> str:
    """The tables of a case that differ from their defaults, a row a key, with units."""
    sections = []
    for name in ordered(type(case)):
        value = getattr(case, name)
        if name == "materials":
            sections += [(f"materials.{own}", _rows(table)) for own, table in value.items()]
        elif isinstance(value, BaseModel) and getattr(value, "model", "") != "none":
            sections.append((name, _rows(value)))
    return card(case.name, f"Case: {sentence(case)}.", sections)


def _rows(table: BaseModel) -> list[tuple[str, str]]:
    """Keys of a table and their values; a table that only has its defaults has none."""
    fields = ordered(type(table))
    whole = any(field.is_required() for field in fields.values())
    given = {
        name: getattr(table, name)
        for name, field in fields.items()
        if whole or getattr(table, name) != field.get_default(call_default_factory=True)
    }
    return [
        (name, value_text(value, unit_of(fields[name])))
        for name, value in given.items()
        if value is not None
    ]


def value_text(value: object, unit: str) -> str:
    """A value with its unit, as a person would write it."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list):
        return ", ".join(map(str, value))
    return amount(value, unit, 5) if isinstance(value, float) else str(value)

"""What every table of a case file has in common."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ConfigDict

from asperity.errors import InputError, refuse_all


class Table(BaseModel):
    """A table of a case file: frozen, no unknown keys, defaults checked like any value."""

    model_config = ConfigDict(frozen=True, extra="forbid", validate_default=True, strict=True)


def need(table: Any, keys: tuple[str, ...]) -> Any:
    """The table itself; raises `InputError` where its model needs keys that it has not."""
    refuse_all(
        InputError(f"`{key}` must be given with model = '{table.model}'; got nothing", key=key)
        for key in keys
        if getattr(table, key) is None
    )
    return table

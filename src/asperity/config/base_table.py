"""What every table of a case file has in common."""

from __future__ import annotations

from typing import Any, ClassVar

from pydantic import BaseModel, ConfigDict

from asperity.errors import InputError, refuse_all


class Table(BaseModel):
    """A table of a case file: frozen, no unknown keys, defaults checked like any value."""

    model_config = ConfigDict(frozen=True, extra="forbid", validate_default=True, strict=True)

    loss: ClassVar[str | None] = None
    """Name of what is lost by what the table describes, in the ledger; None where nothing is."""

    def check_beside(self, case: Any) -> None:
        """Refuse what the table cannot stand beside in a ``CaseTables``; by default nothing.

        The materials of the case are known.

        Raises
        ------
        InputError
            With the key at fault and its rule.
        """


def acts(table: Any) -> bool:
    """Whether a table with a model is there, and its model is not 'none'."""
    return table is not None and table.model != "none"


def need(table: Any, keys: tuple[str, ...]) -> Any:
    """The table itself; raises `InputError` where its model needs keys that it has not."""
    refuse_all(
        InputError(f"`{key}` must be given with model = '{table.model}'; got nothing", key=key)
        for key in keys
        if getattr(table, key) is None
    )
    return table

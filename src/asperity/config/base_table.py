"""What every table of a case file has in common."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar

from pydantic import BaseModel, ConfigDict

from asperity.config.case_text import written
from asperity.errors import InputError, refuse_all
from asperity.units import shown


class Table(BaseModel):
    """A table of a case file: frozen, no unknown keys, defaults checked like any value."""

    model_config = ConfigDict(frozen=True, extra="forbid", validate_default=True, strict=True)

    loss: ClassVar[str | None] = None
    """Name of what is lost by what the table describes, in the ledger; None where nothing is."""

    excludes: ClassVar[Mapping[str, str]] = {}
    """Tables, and dotted keys, that must be absent beside this one where it acts: why, of each."""

    def check_beside(self, case: Any) -> None:
        """Refuse what the table cannot stand beside in a ``CaseTables``: by default, `excludes`.

        The materials of the case are known.

        Raises
        ------
        InputError
            With the key at fault and its rule.
        """
        if acts(self):
            refuse_all(self._excluded(case, f"[{type(self).__name__.lower()}]"))

    def _excluded(self, case: Any, beside: str) -> Iterator[InputError]:
        """What the case has of `excludes`, refused beside what is named so."""
        for key, why in self.excludes.items():
            name, _, inner = key.partition(".")
            table = getattr(case, name)
            if not acts(table) or (inner and not getattr(table, inner)):
                continue
            what = f"`{inner}`" if inner else f"[{name}]"
            last = inner or ("model" if "model" in type(table).model_fields else "")
            got = f"; got {shown(written(table)[last])}" if last else ""
            yield InputError(
                f"{what} must be absent with {beside}: {why}{got}",
                key=f"{name}.{last}" if last else name,
            )


def acts(table: Any) -> bool:
    """Whether a table is there, and has no model that is 'none'."""
    return table is not None and getattr(table, "model", "") != "none"


def need(table: Any, keys: tuple[str, ...]) -> Any:
    """The table itself; raises `InputError` where its model needs keys that it has not."""
    refuse_all(
        InputError(f"`{key}` must be given with model = '{table.model}'; got nothing", key=key)
        for key in keys
        if getattr(table, key) is None
    )
    return table

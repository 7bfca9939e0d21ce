"""A case: the tables together, and the rules between them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Self

from pydantic import model_validator

from asperity.config import case_text, display, replacing
from asperity.config.rules import check_rules
from asperity.config.tables import CaseTables


class Case(CaseTables):
    """A case: bodies, surfaces and how they meet. All values are SI floats."""

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        check_rules(self)
        return self

    def toml(self) -> str:
        """The case as TOML with SI units, defaults filled in; `load` reads back an equal case."""
        return case_text.toml(self)

    def replace(self, changes: Mapping[str, object]) -> Case:
        """The case with other values, checked anew; it keeps its name.

        Parameters
        ----------
        changes : mapping of str to object
            Values by their dotted key: text as in a file, or numbers in SI, e.g.
            ``{"body.radius": "20 um"}`` or ``{"body.radius": 2e-5}``; None takes a key or a table
            away.

        Raises
        ------
        InputError
            Where a key is unknown or a value breaks a rule.
        """
        return replacing.replaced(self, changes)

    def __repr__(self) -> str:
        return f"<Case {self.name}: {display.sentence(self)}>"

    __str__ = __repr__

    def _repr_html_(self) -> str:
        return display.html(self)

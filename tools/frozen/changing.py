"""A case with every continuous input changed by rounding's size, for the response of its values."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

import asperity
from asperity.config.bodies import solids_of

CHANGE = 1e-14
"""Relative change of an input: 45 units in the last place."""

_LEFT = ("numerics", "output", "materials")
_AMOUNT = re.compile(r"([-+]?[\d.]+(?:[eE][-+]?\d+)?)(\s+\S.*)?$")
_SOLID = ("youngs_modulus", "poisson", "density", "hardness", "yield_strength")


class Change:
    """Changes of a random sign each.

    Parameters
    ----------
    seed
        Of the signs; None changes nothing.
    folder
        Where changed surfaces are written.
    """

    def __init__(self, seed: int | None, folder: Path) -> None:
        self._draws = None if seed is None else np.random.default_rng(seed)
        self._folder = folder

    def number(self, value: float) -> float:
        """A number with its change."""
        if self._draws is None:
            return value
        return value * (1.0 + CHANGE * float(self._draws.choice((-1.0, 1.0))))

    def text(self, text: str) -> str:
        """A number with a unit as text, with its change; other text as it is."""
        found = _AMOUNT.match(text)
        if found is None:
            return text
        return f"{self.number(float(found[1]))!r}{found[2] or ''}"

    def case(self, case: asperity.Case) -> asperity.Case:
        """A case with changes of its numbers, of its solids' and of its measured heights."""
        if self._draws is None:
            return case
        changes: dict[str, Any] = dict(self._numbers(tomllib.loads(case.toml())))
        for part, solid in zip(("body", "counterface"), solids_of(case), strict=True):
            if getattr(case, part).material is not None:
                known = {key: getattr(solid, key) for key in _SOLID}
                changes[f"materials.{part}-of-frozen"] = {
                    key: self.number(value) for key, value in known.items() if value is not None
                }
                changes[f"{part}.material"] = f"{part}-of-frozen"
        if case.roughness is not None and case.roughness.files:
            changes["roughness.files"] = [self.surface(Path(f)) for f in case.roughness.files]
        return case.replace(changes)

    def surface(self, path: Path) -> str:
        """Path of a surface whose heights all have the same change, which keeps ties."""
        factor = self.number(1.0)
        lines = path.read_text().splitlines()
        made = [
            line
            if line.startswith("#")
            else ",".join(repr(float(height) * factor) for height in line.split(","))
            for line in lines
        ]
        changed = self._folder / f"changed-{factor > 1.0}-{path.name}"
        changed.write_text("\n".join(made) + "\n")
        return str(changed)

    def table(self, rows: list[dict[str, Any]]) -> str:
        """Path of published tables made of a reproduction's rows, each surface with its change."""
        unit = {"log_decrement": 1.0, "time_to_rest": 1e-6, "power_loss": 1e-13}
        names = ("time_to_rest", "power_loss", "log_decrement")
        found: dict[tuple[Any, ...], dict[str, float]] = {}
        for row in rows:
            key = row["table"], row["asperity_radius"] * 1e9, row["rms_height"] * 1e9
            found.setdefault(key, {})[row["quantity"]] = row["published"] / unit[row["quantity"]]
        surfaces: dict[float, float] = {}
        text = ["table,asperity_radius_nm,rms_height_nm,time_to_rest_us,power_loss_1e-4_nW"]
        text[0] += ",log_decrement"
        for (table, *surface), values in found.items():
            for value in surface:
                surfaces.setdefault(value, self.number(value))
            numbers = [*(surfaces[value] for value in surface), *(values[name] for name in names)]
            text.append(",".join(map(repr, (table, *numbers))))
        path = self._folder / "tables.csv"
        path.write_text("\n".join(text) + "\n")
        return str(path)

    def _numbers(self, tables: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
        for name, table in tables.items():
            if name in _LEFT or not isinstance(table, Mapping):
                continue
            for key, value in table.items():
                if isinstance(value, float):
                    changed = self.number(value)  # of shares, such as a humidity, at most 1
                    yield f"{name}.{key}", min(changed, 1.0) if value <= 1.0 else changed
                elif isinstance(value, str) and _AMOUNT.match(value):
                    yield f"{name}.{key}", self.text(value)

"""``asperity init`` and ``asperity materials``."""

from __future__ import annotations

import dataclasses
import json
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from asperity.cli.terminal import tell
from asperity.errors import InputError, OutputError
from asperity.gases import ATMOSPHERE, GASES
from asperity.materials import LIQUIDS, ROOM_TEMPERATURE, SOLIDS
from asperity.records.layout import plain
from asperity.summary import WIDTH, amount

_SOLID = (9, 7, 15, 12, 11)
_FLUID = (18, 18, 18)
_HIDDEN = ("tension_law", "density_law", "temperatures")


def write_template(file: str) -> None:
    """Write a commented case file where there is none yet.

    Raises
    ------
    InputError
        Where the file is there already.
    OutputError
        Where it cannot be written.
    """
    from asperity.case import template

    path = Path(file)
    try:
        with path.open("x", encoding="utf-8") as stream:
            try:
                stream.write(template())
                stream.flush()
            except BaseException:
                path.unlink(missing_ok=True)
                raise
    except FileExistsError:
        raise InputError(f"{file}: is there already and stays as it is", file=file) from None
    except OSError as error:
        reason = error.strerror or error
        raise OutputError(f"{file}: cannot be written: {reason}", path=file) from None
    tell(f"written to {file}; then: asperity run {file}")


def list_materials(*, as_json: bool) -> None:
    """Print the catalogue."""
    if as_json:
        found = {
            "solids": _rows(SOLIDS.values()),
            "liquids": _rows(LIQUIDS.values()),
            "gases": _rows(GASES.values()),
        }
        tell(json.dumps(found, allow_nan=False))
        return
    lines = ["Solids: Young's modulus, Poisson's ratio, density, hardness, yield strength", ""]
    for solid in SOLIDS.values():
        numbers = [
            amount(solid.youngs_modulus, "Pa"),
            f"{solid.poisson:.4g}",
            _density(solid.density),
            amount(solid.hardness, "Pa"),
            amount(solid.yield_strength, "Pa"),
        ]
        lines += _entry(solid.name, numbers, _SOLID, solid.source)
    lines += ["Liquids: surface tension, molar volume, density", ""]
    for liquid in LIQUIDS.values():
        numbers = [
            amount(liquid.tension, "N/m"),
            f"{liquid.molar_volume * 1e6:.4g} cm^3/mol",
            _density(liquid.density),
        ]
        lines += _entry(liquid.name, numbers, _FLUID, liquid.source)
    lines += ["Gases: viscosity, mean free path and slip length at 20 degC and 101.325 kPa", ""]
    for gas in GASES.values():
        numbers = [
            amount(gas.viscosity(ROOM_TEMPERATURE), "Pa s"),
            amount(gas.free_path(ATMOSPHERE, ROOM_TEMPERATURE), "m"),
            amount(gas.slip_length(ATMOSPHERE, ROOM_TEMPERATURE), "m"),
        ]
        lines += _entry(gas.name, numbers, _FLUID, gas.source)
    tell("\n".join(lines).rstrip())


def _rows(entries: Any) -> dict[str, Any]:
    """The catalogue's entries by name, as plain values in SI."""
    return {
        entry.name: {
            field.name: plain(getattr(entry, field.name))
            for field in dataclasses.fields(entry)
            if field.name not in (*_HIDDEN, "name")
        }
        for entry in entries
    }


def _entry(name: str, numbers: Sequence[str], widths: Sequence[int], source: str) -> list[str]:
    columns = zip(numbers, widths, strict=True)
    row = f"{name:<25}" + "".join(f"{number:>{width}}" for number, width in columns)
    about = textwrap.wrap(source, WIDTH, initial_indent="    ", subsequent_indent="    ")
    return [row, *about, ""]


def _density(value: float | None) -> str:
    if value is None:
        return "-"
    return f"{value:.0f} kg/m^3" if value >= 1e4 else f"{value:.4g} kg/m^3"

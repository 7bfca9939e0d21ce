"""``asperity init`` and ``asperity materials``."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from asperity.case.problems import did_you_mean
from asperity.cli.terminal import tell
from asperity.errors import InputError, OutputError
from asperity.gases import ATMOSPHERE, GASES, Gas
from asperity.materials import LIQUIDS, ROOM_TEMPERATURE, SOLIDS, Liquid, Solid
from asperity.records.layout import plain
from asperity.summary import WIDTH, amount
from asperity.units import shown

_SOLID = (9, 7, 15, 12, 11)
_FLUID = (18, 18, 18)
_HIDDEN = ("tension_law", "density_law", "temperatures")


def write_template(file: str, *, as_json: bool = False) -> None:
    """Write a commented case file where there is none yet.

    Parameters
    ----------
    file : str
        The file.
    as_json : bool
        Whether to print one JSON object.

    Raises
    ------
    InputError
        Where the file is there already.
    OutputError
        Where it cannot be written.
    """
    from asperity.case import template

    path, text = Path(file), template()
    try:
        with path.open("x", encoding="utf-8") as stream:
            try:
                stream.write(text)
                stream.flush()
            except BaseException:
                path.unlink(missing_ok=True)
                raise
    except FileExistsError:
        raise InputError(f"{file}: is there already and stays as it is", file=file) from None
    except OSError as error:
        reason = error.strerror or error
        raise OutputError(f"{file}: cannot be written: {reason}", path=file) from None
    if as_json:
        content = text.encode()
        digest = hashlib.sha256(content).hexdigest()
        tell(json.dumps({"file": file, "bytes": len(content), "sha256": digest}))
    else:
        tell(f"written to {file}; then: asperity run {file}")


def list_materials(names: Sequence[str] = (), *, as_json: bool) -> None:
    """Print the catalogue.

    Parameters
    ----------
    names : sequence of str
        Entries wanted; all where there is none.
    as_json : bool
        Whether to print one JSON object.

    Raises
    ------
    InputError
        Where a name is in no part of the catalogue.
    """
    known = {**SOLIDS, **LIQUIDS, **GASES}
    for name in names:
        if name not in known:
            raise InputError(
                f"a material must be one of the catalogue, which `asperity materials` lists; "
                f"got {shown(name)}{did_you_mean(name, known)}"
            )
    solids = [entry for entry in SOLIDS.values() if not names or entry.name in names]
    liquids = [entry for entry in LIQUIDS.values() if not names or entry.name in names]
    gases = [entry for entry in GASES.values() if not names or entry.name in names]
    if as_json:
        found = {"solids": _rows(solids), "liquids": _rows(liquids), "gases": _rows(gases)}
        tell(json.dumps(found, allow_nan=False))
        return
    lines = [*_solid_lines(solids), *_liquid_lines(liquids), *_gas_lines(gases)]
    tell("\n".join(lines).rstrip())


def _solid_lines(solids: Sequence[Solid]) -> list[str]:
    lines = ["Solids: Young's modulus, Poisson's ratio, density, hardness, yield strength", ""]
    for solid in solids:
        numbers = [
            amount(solid.youngs_modulus, "Pa"),
            f"{solid.poisson:.4g}",
            _density(solid.density),
            amount(solid.hardness, "Pa"),
            amount(solid.yield_strength, "Pa"),
        ]
        lines += _entry(solid.name, numbers, _SOLID, solid.source)
    return lines if solids else []


def _liquid_lines(liquids: Sequence[Liquid]) -> list[str]:
    lines = ["Liquids: surface tension, molar volume, density", ""]
    for liquid in liquids:
        numbers = [
            amount(liquid.tension, "N/m"),
            f"{liquid.molar_volume * 1e6:.4g} cm^3/mol",
            _density(liquid.density),
        ]
        lines += _entry(liquid.name, numbers, _FLUID, liquid.source)
    return lines if liquids else []


def _gas_lines(gases: Sequence[Gas]) -> list[str]:
    lines = ["Gases: viscosity, mean free path and slip length at 20 degC and 101.325 kPa", ""]
    for gas in gases:
        numbers = [
            amount(gas.viscosity(ROOM_TEMPERATURE), "Pa s"),
            amount(gas.free_path(ATMOSPHERE, ROOM_TEMPERATURE), "m"),
            amount(gas.slip_length(ATMOSPHERE, ROOM_TEMPERATURE), "m"),
        ]
        lines += _entry(gas.name, numbers, _FLUID, gas.source)
    return lines if gases else []


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

"""``asperity init`` and ``asperity materials``."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from asperity.cli.terminal import tell
from asperity.config.problems import among
from asperity.errors import InputError
from asperity.materials.gases import ATMOSPHERE, GASES, Gas
from asperity.materials.liquids import LIQUIDS, ROOM_TEMPERATURE, Liquid
from asperity.materials.solids import ADHESION, SOLIDS, Adhesion, Solid
from asperity.results.record_layout import plain
from asperity.results.summary import WIDTH, amount
from asperity.writing import aside, told

_SOLID = (9, 7, 15, 12, 11)
_FLUID = (18, 18, 18)
_MORE = ["Where the numbers of an entry come from: asperity materials NAME"]
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
    from asperity.config import template

    path, text = Path(file), template()
    with told(file):
        if path.exists():
            raise InputError(f"{file}: is there already and stays as it is", file=file)
        with aside(path, force=False) as place:
            place.write_text(text, encoding="utf-8")
    if as_json:
        content = text.encode()
        digest = hashlib.sha256(content).hexdigest()
        tell(json.dumps({"file": file, "bytes": len(content), "sha256": digest}))
    else:
        path_shown = file if path.suffix or path.name != file else f"./{file}"
        tell(f"written to {file}; then: asperity run {path_shown}")


def list_materials(names: Sequence[str] = (), *, as_json: bool) -> None:
    """Print the catalogue: a line for each entry, and of those that are named their sources.

    Works of adhesion have their sources always, and belong to either solid of the pair.

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
    paired = dict.fromkeys(name for entry in ADHESION for name in entry.pair)
    known = {**SOLIDS, **LIQUIDS, **GASES, **paired}
    for name in names:
        among(
            name,
            known,
            "a material must be one of the catalogue, which `asperity materials` lists",
        )
    solids = [entry for entry in SOLIDS.values() if not names or entry.name in names]
    liquids = [entry for entry in LIQUIDS.values() if not names or entry.name in names]
    gases = [entry for entry in GASES.values() if not names or entry.name in names]
    works = [entry for entry in ADHESION if not names or set(entry.pair) & set(names)]
    if as_json:
        found = {"solids": _rows(solids), "liquids": _rows(liquids), "gases": _rows(gases)}
        adhesion = [dataclasses.asdict(entry) for entry in works]
        tell(json.dumps({**found, "adhesion": adhesion}, allow_nan=False))
        return
    whole = bool(names)
    tables = (_solid_lines(solids), _liquid_lines(liquids), _gas_lines(gases))
    lines = [line for table in tables for line in _table(*table, whole=whole)]
    tell("\n".join([*lines, *_adhesion_lines(works), *([] if whole else _MORE)]).rstrip())


def _table(title: str, entries: Sequence[tuple[str, str]], *, whole: bool) -> list[str]:
    """A table's lines, with what is said about each entry where it is wanted whole."""
    if not entries:
        return []
    rows = [[row, *_wrapped(about), ""] if whole else [row] for row, about in entries]
    return [title, "", *(line for row in rows for line in row), *([] if whole else [""])]


def _solid_lines(solids: Sequence[Solid]) -> tuple[str, list[tuple[str, str]]]:
    rows = []
    for solid in solids:
        numbers = [
            amount(solid.youngs_modulus, "Pa"),
            f"{solid.poisson:.4g}",
            _density(solid.density),
            "never" if solid.never_yields else amount(solid.hardness, "Pa"),
            "yields" if solid.never_yields else amount(solid.yield_strength, "Pa"),
        ]
        about = solid.source
        if solid.never_yields:
            about = f"{about}; never yields: {solid.never_yields}"
        rows.append((_row(solid.name, numbers, _SOLID), about))
    return "Solids: Young's modulus, Poisson's ratio, density, hardness, yield strength", rows


def _liquid_lines(liquids: Sequence[Liquid]) -> tuple[str, list[tuple[str, str]]]:
    rows = []
    for liquid in liquids:
        numbers = [
            amount(liquid.tension, "N/m"),
            f"{liquid.molar_volume * 1e6:.4g} cm^3/mol",
            _density(liquid.density),
        ]
        rows.append((_row(liquid.name, numbers, _FLUID), liquid.source))
    return "Liquids: surface tension, molar volume, density", rows


def _gas_lines(gases: Sequence[Gas]) -> tuple[str, list[tuple[str, str]]]:
    rows = []
    for gas in gases:
        numbers = [
            amount(gas.viscosity(ROOM_TEMPERATURE), "Pa s"),
            amount(gas.free_path(ATMOSPHERE, ROOM_TEMPERATURE), "m"),
            amount(gas.slip_length(ATMOSPHERE, ROOM_TEMPERATURE), "m"),
        ]
        rows.append((_row(gas.name, numbers, _FLUID), gas.source))
    return "Gases: viscosity, mean free path and slip length at 20 degC and 101.325 kPa", rows


def _adhesion_lines(works: Sequence[Adhesion]) -> list[str]:
    lines = [
        "Works of adhesion as measured, least and largest; environment, method, source.",
        "No case assumes one: choose by your surfaces, and give `work` in [adhesion].",
        "",
    ]
    for entry in works:
        spread = " to ".join(amount(bound, "J/m^2") for bound in entry.bounds or ())
        row = f"{' / '.join(entry.pair):<31}{amount(entry.work, 'J/m^2'):>14}  {spread}".rstrip()
        about = f"{entry.environment}; {entry.method}; {entry.source}"
        lines += [row, *_wrapped(about), ""]
    return lines if works else []


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


def _row(name: str, numbers: Sequence[str], widths: Sequence[int]) -> str:
    columns = zip(numbers, widths, strict=True)
    return f"{name:<25}" + "".join(f"{number:>{width}}" for number, width in columns)


def _wrapped(about: str) -> list[str]:
    return textwrap.wrap(about, WIDTH, initial_indent="    ", subsequent_indent="    ")


def _density(value: float | None) -> str:
    if value is None:
        return "-"
    return f"{value:.0f} kg/m^3" if value >= 1e4 else f"{value:.4g} kg/m^3"

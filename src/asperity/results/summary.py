"""Results in words and tables, for a terminal and for ``summary.txt``; 80 columns."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from asperity.amounts import amount as amount
from asperity.amounts import scaled as scaled
from asperity.regimes import LAW_NAMES
from asperity.results.bodies_text import bodies_rows
from asperity.results.impact_table import cell_text, impact_table
from asperity.results.shares import share_texts
from asperity.results.verdict import sentence

if TYPE_CHECKING:
    from asperity.results.result_data import CurveData, ResultData

WIDTH = 80
_ROUNDING = 1e-15  # m: a separation below it is 0
FEW = 5
"""How many impacts a terminal shows of many."""


def of_result(
    result: ResultData, made: Mapping[str, object], *, published: bool | None = None
) -> str:
    """All of a result: outcome, measures, regime, energy, every impact, warnings, provenance.

    Parameters
    ----------
    result: ResultData
        The result.
    made : mapping of str to object
        Its record's attributes, for the versions and the hash of the input.
    published : bool, optional
        Whether the publication's measures are shown too: decrement and power losses; by default
        for a case with a [publication] table.
    """
    return "\n".join(
        [
            *underlined(result.name),
            "",
            *_wrapped(_ended(result)),
            *_section("Motion", _motion(result.measures)),
            *_section("Energy", _energy(result.ledger)),
            *_section("Single bodies", bodies_rows(result)),
            *_section("Surface", _surface(result.surface)),
            *_section("Regime", _regime(result.regime)),
            *_chosen(result.regime),
            *impact_table(result, None, published),
            *warning_lines(result.warnings),
            *_provenance(made),
            "",
        ]
    )


def of_curve(curve: CurveData, made: Mapping[str, object]) -> str:
    """The numbers of a curve, and where they come from; ``made`` as for `of_result`."""
    heading = [*underlined(curve.name), "", "Force against separation, in and out."]
    rows = _section("Curve", _curve(curve))
    return "\n".join([*heading, *rows, *warning_lines(curve.warnings), *_provenance(made), ""])


def brief(result: ResultData, *, published: bool | None = None) -> str:
    """What a terminal shows of a result; ``published`` as for `of_result`."""
    rows = [*_motion(result.measures), *_energy(result.ledger)]
    return "\n".join(
        [
            f"{result.name}: {result.outcome.value}",
            *_wrapped(_ended(result)),
            *_section("", rows),
            *_section("Single bodies", bodies_rows(result)),
            *_chosen(result.regime),
            *impact_table(result, FEW, published),
            *warning_lines(result.warnings),
        ]
    )


def shown_of(result: ResultData) -> tuple[str, list[tuple[str, list[tuple[str, str]]]]]:
    """Outcome in a sentence, and the measures that there are under their headings."""
    parts = {
        "Motion": _motion(result.measures),
        "Energy": _energy(result.ledger),
        "Single bodies": bodies_rows(result),
        "Surface": _surface(result.surface),
    }
    return _ended(result), [(title, _known(rows)) for title, rows in parts.items()]


def shown_of_curve(curve: CurveData) -> list[tuple[str, str]]:
    """The numbers of a curve that there are, by what they are called."""
    return _known(_curve(curve))


def _known(rows: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
    return [row for row in rows if row[1] != "-"]


def _ended(result: ResultData) -> str:
    """The answer in a sentence where there is one, and how the motion ended."""
    if not result.outcome.ok:
        return result.outcome.message
    whose = "" if result.realisations is None else "Mean field: "
    return f"{sentence(result)}. {whose}{result.outcome.message}"


def brief_curve(curve: CurveData) -> str:
    """What a terminal shows of a curve."""
    title = f"{curve.name}: force against separation"
    return "\n".join([title, *_section("", _curve(curve)), *warning_lines(curve.warnings)])


def _motion(measures: dict[str, Any]) -> list[tuple[str, str]]:
    captured = {True: "yes", False: "no", None: "-"}[measures.get("captured")]
    restitution = measures.get("restitution") or []
    first = restitution[0] if restitution else None
    critical = measures.get("critical_velocity_note")
    if measures.get("critical_velocity") is not None:
        note = f"  ({critical})" if critical else ""
        critical = amount(measures["critical_velocity"], "m/s") + note
    return [
        ("impact speed", amount(measures.get("impact_speed"), "m/s")),
        ("restitution", cell_text(first, 1.0, "")),
        ("captured at first impact", captured),
        ("critical velocity", critical or "-"),
        ("contact time", amount(measures.get("contact_time"), "s")),
        ("largest force", amount(measures.get("maximum_force"), "N")),
        *_pull(measures),
        ("impacts", str(len(restitution))),
        ("time to capture", amount(measures.get("capture_time"), "s")),
        ("time to rest", amount(measures.get("time_to_rest"), "s")),
    ]


def _pull(found: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Pull-off and work of separation, with the load that they belong to."""
    after = ""
    if found.get("preload") is not None:
        after = f"  (after {amount(found['preload'], 'N')})"
    where = ""
    if found.get("pull_off_separation") is not None:
        place = found["pull_off_separation"]
        where = f" at {amount(place if abs(place) > _ROUNDING else 0.0, 'm')}"
    return [
        ("pull-off force", amount(found.get("pull_off"), "N") + where + after),
        ("work of separation", amount(found.get("work_of_separation"), "J") + after),
    ]


def _energy(ledger: dict[str, Any]) -> list[tuple[str, str]]:
    initial = ledger.get("initial")
    rows = [("energy at release", amount(initial, "J"))]
    lost = ledger.get("lost") or {}
    total = sum(lost.values())
    if total > 0.0 and initial and initial > 0.0:
        share = f"{amount(100.0 * total / initial)} % of that at release"
        about = share if total <= initial else "with what attraction adds"
        rows.append(("energy lost", f"{amount(total, 'J')}  ({about})"))
    for (mechanism, energy), share in zip(lost.items(), share_texts(lost.values()), strict=True):
        about = f"  ({share} of the energy lost)" if energy > 0.0 else ""
        rows.append((f"lost to {mechanism}", amount(energy, "J") + about))
    error = ledger.get("energy_balance_error")
    closed = "-" if error is None else f"{error:.1e} of the impact energy or of that lost"
    return [*rows, ("balance closes to", closed)]


def _regime(regime: dict[str, Any]) -> list[tuple[str, str]]:
    rows = []
    for name, value in regime.items():
        if name.endswith("_reason"):
            continue
        if isinstance(value, str):
            text = LAW_NAMES.get(value.lower(), value)
        elif isinstance(value, bool):
            text = "yes" if value else "no"
        else:
            text = amount(value)
        rows.append((name.replace("_", " ").replace("tabor", "Tabor"), text))
    return rows


def _surface(found: dict[str, Any] | None) -> list[tuple[str, str]]:
    """What the files of a case were found to be."""
    if found is None:
        return []
    rows = [("file", Path(each["file"]).name) for each in found["files"]]
    rows += [("prepared", step) for each in found["files"] for step in each["prepared"]]
    rows += [("maps", found["added"])] if found.get("added") else []
    return [
        *rows,
        ("summits", f"{found['summits']} (source = '{found['source']}')"),
        ("density", amount(found["asperity_density"], "1/m^2")),
        ("tip radius", amount(found["asperity_radius"], "m")),
        ("rms height of summits", amount(found["rms_height"], "m")),
        ("their mean height", amount(found["mean_height"], "m")),
        ("rms height of surface", amount(found["surface_rms_height"], "m")),
    ]


def _chosen(regime: dict[str, Any]) -> list[str]:
    """Which law the program chose, and the state of the liquid, each with its reason.

    Nothing where the case names the law, and where it is dry.
    """
    lines: list[str] = []
    reason, liquid = regime.get("adhesion_reason"), regime.get("liquid_regime")
    if reason is not None:
        law = LAW_NAMES[regime["adhesion_law"]]
        lines += ["", *_wrapped(f"Adhesion law chosen: {law}. {reason}.")]
    if liquid not in (None, "dry"):
        name = "pendular (isolated menisci)" if liquid == "pendular" else liquid
        why = regime["liquid_regime_reason"]
        lines += ["", *_wrapped(f"Liquid regime: {name}, since {why}.")]
    return lines


def _curve(curve: CurveData) -> list[tuple[str, str]]:
    return [
        ("closest rigid separation", amount(curve.minimum_separation, "m")),
        *_pull(vars(curve)),
        ("lost over in and out", amount(curve.loss, "J")),
        *_jumps(curve.jumps),
    ]


def _jumps(found: dict[str, Any] | None) -> list[tuple[str, str]]:
    """Where a body on a spring jumps in and out, and what each jump loses."""
    if found is None:
        return []
    rows = []
    for way in ("in", "out"):
        if (jump := found[way]) is not None:
            rows += [
                (f"jump-{way} at", _place(jump["separation"], jump["force"])),
                ("  lands at", _place(jump["landing_separation"], jump["landing_force"])),
                ("  and loses", amount(jump["energy"], "J")),
            ]
    return [*rows, ("note", found["note"])] if found["note"] else rows


def _place(separation: float, force: float) -> str:
    return f"{amount(separation, 'm')}, {amount(force, 'N')}"


def underlined(name: str) -> list[str]:
    """A name as the title of a text."""
    return [name, "=" * min(len(name), WIDTH)]


def _section(title: str, rows: Sequence[tuple[str, str]]) -> list[str]:
    if not rows:
        return []
    head = ["", title] if title else [""]
    return [*head, *(f"  {label:<26}{text}" for label, text in rows)]


def warning_lines(warnings: Sequence[str]) -> list[str]:
    """Warnings as a list under a heading; no lines where there are none."""
    return listed("Warnings", warnings) if warnings else []


def listed(title: str, sentences: Sequence[str]) -> list[str]:
    """Sentences as a list under a heading."""
    lines = ["", title]
    for each in sentences:
        lines += textwrap.wrap(each, WIDTH, initial_indent="  - ", subsequent_indent="    ")
    return lines


def _provenance(made: Mapping[str, object]) -> list[str]:
    names = ("asperity", "jax", "numpy", "python")
    versions = ", ".join(f"{name} {made[f'{name}_version']}" for name in names)
    return ["", "Made by", *_wrapped(versions, "  "), f"  input {made['input_sha256']}"]


def _wrapped(text: str, indent: str = "") -> list[str]:
    return textwrap.wrap(text, WIDTH, initial_indent=indent, subsequent_indent=indent)

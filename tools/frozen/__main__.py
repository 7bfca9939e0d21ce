"""The two commands: ``python -m tools.frozen write`` and ``python -m tools.frozen compare``."""

from __future__ import annotations

import argparse
import fnmatch
import json
import os
import sys
import time
from pathlib import Path
from typing import Any

from . import rules, work

VALUES = Path(__file__).with_name("values.json")


def main() -> int:
    """Write the set or compare with it; 1 where something differs."""
    parser = argparse.ArgumentParser(prog="python -m tools.frozen", description=__doc__)
    parser.add_argument("command", choices=("write", "compare"))
    help_only = "structures, as 'smooth-*'; may be given again"
    parser.add_argument("--only", metavar="PATTERN", action="append", help=help_only)
    parser.add_argument("--missing", action="store_true", help="write what is not there yet")
    parser.add_argument("--values", type=Path, default=VALUES, help="file of the values")
    parser.add_argument("--processes", type=int, default=2)
    asked = parser.parse_args()
    stored = json.loads(asked.values.read_text()) if asked.values.exists() else {}
    start = time.monotonic()
    known = work.names()
    names = [n for n in known if any(fnmatch.fnmatch(n, each) for each in asked.only or "*")]
    if not names:
        parser.error(f"no structure is named {', '.join(asked.only)}")
    if asked.command == "compare":
        code = _compare(stored, names, asked)
    else:
        code = _write(stored, names, asked)
    print(f"{time.monotonic() - start:.0f} s")
    return code


def _write(stored: dict[str, Any], names: list[str], asked: argparse.Namespace) -> int:
    """Compute structures, with the response of each value, and store them."""
    out = {name: part for name, part in stored.items() if name in work.names()}
    names = [name for name in names if not asked.missing or name not in out]
    for name, part, took in work.of_all(work.frozen, [(name,) for name in names], asked.processes):
        out[name] = part
        print(f"{took:6.1f} s  {name}: {_told(part)}", flush=True)
        asked.values.write_text(_text(out))  # each time: what was cut short keeps what it has
    size = asked.values.stat().st_size
    print(f"{len(out)} structures, {_told(*out.values())}; {size} bytes")
    return 0


def _compare(stored: dict[str, Any], names: list[str], asked: argparse.Namespace) -> int:
    """Compute structures again, and print what differs."""
    missing = [name for name in names if name not in stored]
    known = [name for name in names if name in stored]
    if asked.only is None:
        missing += [name for name in stored if name not in names]
    jobs = [(name, stored[name]["inputs"]) for name in known]
    count = len(missing)
    for name in missing:
        print(f"{name}: stands on one side alone")
    for name, cases, took in work.of_all(work.again, jobs, asked.processes):
        found = list(_differences(name, stored[name]["cases"], cases))
        count += len(found)
        print("\n".join(found), end="\n" * bool(found))
        print(f"{took:6.1f} s  {name}: {len(found)} differences", file=sys.stderr, flush=True)
    total = _told(*(stored[name] for name in known))
    print(f"{len(known)} structures, {total}: {count} differences")
    return 1 if count else 0


def _differences(name: str, stored: dict[str, Any], found: dict[str, Any]) -> list[str]:
    """A line for each difference of a structure's cases."""
    out = []
    for case in sorted(stored.keys() | found.keys()):
        if case not in stored or case not in found:
            out.append(f"{name}/{case}: stands on one side alone")
            continue
        for each in rules.differences(stored[case], found[case]):
            what = "must be the same" if each.allowed is None else f"allowed {each.allowed:.3g}"
            line = f"{name}/{case}/{each.quantity}: stored {each.stored!r}, found {each.found!r}"
            if isinstance(each.stored, float) and isinstance(each.found, float):
                line += f", difference {each.found - each.stored:.3g}"
            out.append(f"{line}, {what}")
    return out


def _told(*parts: dict[str, Any]) -> str:
    """How much structures hold."""
    cases = [case for part in parts for case in part["cases"].values()]
    values = [each for case in cases for each in case["values"].values()]
    numbers = [n for value, _ in values for n in _flat(value)]
    responses = [n for _, response in values for n in _flat(response)]
    loose = sum(response == float("inf") for response in responses)
    errors = sum("error" in case["exact"] for case in cases)
    other = sum(len(case[kind]) for case in cases for kind in ("bounds", "exact", "sentences"))
    return (
        f"{len(cases)} cases ({errors} errors), {len(numbers)} numbers ({loose} unbounded), "
        f"{other} other quantities"
    )


def _flat(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [value]


def _text(value: Any, depth: int = 0) -> str:
    """JSON with sorted keys, one quantity a line."""
    if not isinstance(value, dict) or not value:
        return json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    inner = ",\n".join(
        f"{' ' * (depth + 1)}{json.dumps(key)}: {_text(value[key], depth + 1)}"
        for key in sorted(value)
    )
    return f"{{\n{inner}\n{' ' * depth}}}" + "\n" * (depth == 0)


if __name__ == "__main__":
    os.environ.setdefault("XLA_FLAGS", "--xla_cpu_multi_thread_eigen=false")
    sys.exit(main())

"""Single bodies: first impacts on a rigid bulk and a half-space, in air, with slow menisci.

``python -m benchmarks.single_bodies`` prints these rows alone.
"""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np

import asperity
from asperity.config.resolve import resolve
from asperity.dynamics.summit_path import Launch
from asperity.model import build
from asperity.single_bodies import SingleBodies

EXAMPLE = Path(__file__).parents[1] / "examples" / "single-bodies.toml"
SPEED = "3 mm/s"
SPEEDS = (3e-3, 12e-3)  # m/s
BODIES = {
    "rigid": 100_000, "in air": 1000, "menisci take 100 ns": 1000, "half-space": 1000,
    "half-space in air": 1000,
}  # fmt: skip
AIR = '[gas]\nname = "air"\npressure = "1 bar"\ntemperature = "20 degC"\n'
TURNS = 3
_IMPACT = f'[impact]\nspeed = "{SPEED}"'
Row = tuple[str, str, str]


def _case(kind: str) -> str:
    """The example, with DMT's adhesion, launched with a speed."""
    kept = [row for row in EXAMPLE.read_text().splitlines() if "release_separation" not in row]
    text = "\n".join(kept).replace('"maugis"', '"dmt"').replace("[impact]", _IMPACT)
    if "in air" in kind:
        text = text.replace("[impact]", f'{AIR}[impact]\nrelease_separation = "60 nm"')
    if "menisci" in kind:
        text = text.replace("[capillary]", '[capillary]\nformation_time = "100 ns"')
    return text.replace('"rigid"', '"half-space"') if "half-space" in kind else text


def rows() -> list[Row]:
    """What was measured, the figure, and its goal."""
    out = []
    for speed in SPEEDS:
        some = {kind: _Bodies(kind, speed) for kind in BODIES}
        turns = [{kind: bodies.seconds() for kind, bodies in some.items()} for _ in range(TURNS)]
        taken = {kind: min(turn[kind] for turn in turns) for kind in BODIES}
        for kind, count in BODIES.items():
            what = f"{count} first impacts, {kind}, {some[kind].contacting:.1f} summits touch"
            out.append((what, f"{taken[kind]:.1f} s", "10 s"))
        free, *others = (taken[kind] / count for kind, count in BODIES.items())
        for kind, each in zip([*BODIES][1:], others, strict=True):
            out.append((f"  a body {kind} over one that is rigid", f"{each / free:.0f}", ""))
    return out


class _Bodies:
    """Bodies of one case that come with a speed [m/s]; compiled once they are there."""

    def __init__(self, kind: str, speed: float) -> None:
        problem = build(resolve(asperity.config.load(_case(kind))))
        count = BODIES[kind]
        kinetic = np.full(count, 0.5 * float(problem.body.mass) * speed**2)
        self._launches = Launch(kinetic, np.full(count, np.inf))
        self._bodies = SingleBodies(problem, 0.0)
        found = self._bodies.impacts(self._launches, with_pull_off=False)
        self.contacting = float(np.mean(found.contacting))

    def seconds(self) -> float:
        """Time that their first impacts take [s]."""
        begun = time.perf_counter()
        self._bodies.impacts(self._launches, with_pull_off=False)
        return time.perf_counter() - begun


if __name__ == "__main__":
    for what, figure, goal in rows():
        print(f"{what:<62}{figure:>16}" + (f"   goal {goal}" if goal else ""), flush=True)

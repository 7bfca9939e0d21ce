"""How much a command says: its answer, notes beside it, and each step with its time."""

from __future__ import annotations

import contextlib
import json
import re
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from asperity.cli.terminal import say, tell, wrapped
from asperity.cli.working import Progress, progress_bar

if TYPE_CHECKING:
    from asperity.cli.compiling import Compilation

_WIDE = 40
_DETAIL = re.compile(r"impact \d+|[\d,]+ of [\d,]*\d")  # of a step that goes on


class Reporter:
    """What a command says of itself.

    Parameters
    ----------
    as_json : bool
        Whether the answer is one JSON object.
    quiet : bool
        Whether errors and JSON are all that is said.
    verbose : bool
        Whether each step is said with its time, on standard error.
    """

    def __init__(
        self, *, as_json: bool = False, quiet: bool = False, verbose: bool = False
    ) -> None:
        self.as_json, self.quiet, self.verbose = as_json, quiet, verbose

    def answer(self, text: Callable[[], str], found: Callable[[], Mapping[str, Any]]) -> None:
        """Say what came out: one JSON object, words, or nothing.

        Parameters
        ----------
        text, found : callable
            The words and the object; only what is said is made.
        """
        if self.as_json:
            tell(json.dumps(found(), allow_nan=False))
        elif not self.quiet:
            tell("\n".join(line for given in text().split("\n") for line in wrapped(given)))

    def note(self, text: str) -> None:
        """Say what a user should know besides, on standard error."""
        if not self.quiet:
            say(text)

    def written(self, paths: Sequence[Path], *, earlier: bool = False) -> None:
        """Say what was written; below the answer unless that is JSON.

        Parameters
        ----------
        paths : sequence of Path
            Files of one folder; none says nothing.
        earlier : bool
            Whether an earlier answer for the same case was replaced.
        """
        if paths:
            self.below(written_to(paths, earlier=earlier))

    def below(self, text: str) -> None:
        """Say a text below the answer, beside it where that is JSON."""
        if self.as_json:
            self.note(text)
        elif not self.quiet:
            tell("\n" + text)

    @contextlib.contextmanager
    def watch(self, *, compiles: bool = True) -> Iterator[Progress | None]:
        """What a computation reports to: steps where they are wanted, else a bar on a terminal.

        Parameters
        ----------
        compiles : bool
            Whether it uses JAX, whose compiling is told at the end.
        """
        if not self.verbose:
            with progress_bar(not (self.quiet or self.as_json)) as progress:
                yield progress
            return
        steps = _Steps()
        steps.follow(0.0, "loading")
        before = _compilation() if compiles else None
        try:
            yield steps.follow
        finally:
            steps.end()
            if before is not None:
                for line in (_compilation() - before).lines():
                    self.detail(line)

    @contextlib.contextmanager
    def step(self, name: str) -> Iterator[None]:
        """A step outside of what reports its own."""
        steps = _Steps()
        if self.verbose:
            steps.follow(0.0, name)
        try:
            yield
        finally:
            steps.end()

    def detail(self, text: str) -> None:
        """Say a line that only a verbose command says."""
        if self.verbose:
            say(f"asperity: {text}")


def _compilation() -> Compilation:
    """What was compiled until now; imports JAX."""
    from asperity.cli.compiling import compilation

    return compilation()


class _Steps:
    """Steps that follow each other, each said once it is over."""

    def __init__(self) -> None:
        self._name: str | None = None
        self._detail = ""
        self._begun = 0.0

    def follow(self, fraction: float, text: str) -> None:
        """Hear of progress: a step begins, or goes on."""
        detail = _DETAIL.match(text)
        if detail and self._name is not None:
            self._detail = f", {detail[0]}"
        elif text != self._name:
            self.end()
            if fraction < 1.0:
                self._name, self._begun = text, time.perf_counter()

    def end(self) -> None:
        """Say the step under way, if any."""
        if self._name is not None:
            took = time.perf_counter() - self._begun
            say(f"asperity: {self._name + self._detail:<{_WIDE}} {seconds(took)}")
        self._name, self._detail = None, ""


def seconds(duration: float) -> str:
    """A time for a human, in milliseconds below a tenth of a second."""
    return f"{1e3 * duration:.1f} ms" if duration < 0.1 else f"{duration:.2f} s"


def written_to(paths: Sequence[Path], *, earlier: bool = False) -> str:
    """What was written, and where, in words; and whether in place of an earlier answer."""
    instead = ", in place of the earlier results" if earlier else ""
    return "\n".join(
        [
            f"written to {paths[0].parent}{instead}:",
            *wrapped(" ".join(path.name for path in paths), "  "),
        ]
    )


def files_of(paths: Sequence[Path]) -> dict[str, Any]:
    """What was written, and where, as plain values."""
    return {"folder": str(paths[0].parent), "files": [path.name for path in paths]}

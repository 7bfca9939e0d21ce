"""The names of options in messages that know only the names of values."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterator

from asperity.errors import InputError

_OTHERWISE = {"rolloff": "roll-off", "cutoff": "cut-off"}

# What follows the word `key` is the name in a case file.
_NAME = re.compile(r"(?<!key )`([a-z_]+)`")


@contextlib.contextmanager
def in_options(*names: str, **otherwise: str) -> Iterator[None]:
    """Name options in the refusals raised within, for example ``--rms-height``.

    Parameters
    ----------
    *names : str
        The values that are options; all where none is named.
    **otherwise : str
        Options that have other names than their values.
    """
    called = _OTHERWISE | otherwise

    def option(match: re.Match[str]) -> str:
        name = match[1]
        if names and name not in names:
            return match[0]
        return f"`--{called.get(name, name).replace('_', '-')}`"

    try:
        yield
    except InputError as error:
        raise InputError(_NAME.sub(option, str(error)), file=error.file) from error

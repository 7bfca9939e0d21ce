"""The one line with which bad input is refused."""

from collections.abc import Callable

import pytest

from asperity.errors import InputError


def refusal(action: Callable, *given: object, **named: object) -> InputError:
    """The error with which an action refuses what it is given: always of one line."""
    with pytest.raises(InputError) as caught:
        action(*given, **named)
    assert len(str(caught.value).splitlines()) == 1
    return caught.value

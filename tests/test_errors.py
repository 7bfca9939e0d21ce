"""Errors are one line, and every way to end has its sentence."""

import dataclasses
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from asperity import errors
from asperity.errors import InputError, Outcome, OutputError, SimulationError, Tolerance


@given(st.text())
def test_an_input_errors_message_is_one_printable_line(text):
    message = str(InputError(text))
    assert len(message.splitlines()) <= 1
    assert all(character.isprintable() for character in message)


def test_an_input_error_knows_file_and_key():
    error = InputError("`radius` must be positive", file="drop.toml", key="body.radius")
    assert (error.file, error.key) == ("drop.toml", "body.radius")
    assert isinstance(error, ValueError)


def test_a_simulation_error_keeps_what_was_computed():
    assert SimulationError("no convergence", {"time": 1.0}).partial == {"time": 1.0}
    assert SimulationError("no convergence").partial is None


def test_an_output_error_is_an_os_error_of_one_line():
    error = OutputError("disk\nfull", path="out")
    assert isinstance(error, OSError)
    assert (str(error), error.path) == ("disk full", "out")


@pytest.mark.parametrize("outcome", Outcome)
def test_every_outcome_has_a_sentence(outcome):
    assert outcome.message.endswith(".")
    assert outcome.ok == (outcome.value not in ("interrupted", "failed"))


def test_exit_codes_differ():
    codes = [errors.EXIT_INPUT, errors.EXIT_NUMERICS, errors.EXIT_OUTPUT, errors.EXIT_INTERRUPTED]
    assert codes == [2, 3, 4, 130]


def test_tolerance_is_frozen_and_has_no_time_limit_by_default():
    tolerance = Tolerance()
    assert tolerance.time_limit == math.inf
    with pytest.raises(dataclasses.FrozenInstanceError):
        tolerance.relative = 1.0

"""Programs that are traced once and kept on disk: found again, never trusted when damaged."""

from __future__ import annotations

import re
import threading
from typing import NamedTuple

import equinox as eqx
import jax
import pytest

from asperity._jax import jnp
from asperity.integration.clock import Clock
from asperity.laws import Hertz
from asperity.numerics import compilation
from asperity.numerics.compilation import Program, kept


@kept
class Pair(NamedTuple):
    """What the programs of this file answer."""

    once: jax.Array
    twice: jax.Array


traced = []


def double(law: eqx.Module, x: jax.Array, factor: int) -> Pair:
    traced.append(factor)
    return Pair(x, factor * x + 0.0 * law.force(x))


double.__module__ = "asperity.tests"  # only programs of the package are kept


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty folder for kept programs, and no trace so far."""
    monkeypatch.setattr(compilation, "_folder", lambda: tmp_path / "programs")
    traced.clear()
    return tmp_path / "programs"


LAW, X = Hertz(1.0, 1.0), jnp.arange(3.0)


def answer(factor=2, law=LAW):
    """By a program that has compiled nothing yet, as in a new process."""
    return Program(double)(law, X, factor)


def test_a_kept_program_is_not_traced_again_and_answers_the_same(folder):
    first, second = answer(), answer()
    assert traced == [2]
    assert isinstance(second, Pair)
    assert second.twice.tolist() == first.twice.tolist() == [0.0, 2.0, 4.0]
    assert [file.suffix for file in folder.iterdir()] == [".jax"]


def test_static_arguments_and_shapes_have_programs_of_their_own(folder):
    answer()
    assert answer(3).twice.tolist() == [0.0, 3.0, 6.0]
    assert Program(double)(LAW, jnp.ones(2), 2).twice.tolist() == [2.0, 2.0]
    assert len(list(folder.iterdir())) == 3


def test_a_damaged_file_is_made_anew(folder):
    answer()
    (file,) = folder.iterdir()
    good = file.read_bytes()
    flipped = bytes([*good[:-9], good[-9] ^ 1, *good[-8:]])
    damaged = (b"", b"\0" * 100, good[: len(good) // 2], flipped)
    for content in damaged:
        file.write_bytes(content)
        assert answer().twice.tolist() == [0.0, 2.0, 4.0]
    answer()
    assert len(traced) == 1 + len(damaged)


def test_other_sources_have_other_names(folder, monkeypatch):
    answer()
    monkeypatch.setattr(compilation, "_ground", lambda: "other sources")
    answer()
    assert traced == [2, 2]
    assert len(list(folder.iterdir())) == 2


class Own(Hertz):
    """A user's own law: its code may change without this package's."""


def test_a_law_from_outside_is_not_kept(folder):
    assert answer(law=Own(1.0, 1.0)).twice.tolist() == [0.0, 2.0, 4.0]
    assert not folder.exists()


def test_a_function_from_outside_is_not_kept(folder):
    def triple(x):
        return Pair(x, 3.0 * x)

    assert Program(triple)(X).twice.tolist() == [0.0, 3.0, 6.0]
    assert not folder.exists()


def test_within_another_function_it_is_a_part_of_that(folder):
    program = Program(double)
    slope = jax.grad(lambda x: jnp.sum(program(LAW, x, 3).twice))(X)
    assert slope.tolist() == [3.0, 3.0, 3.0]
    assert jax.jit(lambda x: program(LAW, x, 4).twice)(X).tolist() == [0.0, 4.0, 8.0]
    assert not folder.exists()


def test_arguments_may_be_named(folder):
    assert Program(double)(LAW, X, factor=5).twice.tolist() == [0.0, 5.0, 10.0]


def test_a_folder_that_cannot_be_written_costs_time_alone(tmp_path, monkeypatch):
    file = tmp_path / "file"
    file.touch()
    monkeypatch.setattr(compilation, "_folder", lambda: file / "programs")
    assert answer().twice.tolist() == [0.0, 2.0, 4.0]


def test_ahead_gives_the_shapes_and_the_call_the_values(folder):
    ours = Program(double)
    shapes = ours.ahead(LAW, jax.ShapeDtypeStruct((3,), X.dtype), 2)
    assert shapes.twice.shape == (3,)
    assert ours(LAW, X, 2).twice.tolist() == [0.0, 2.0, 4.0]
    assert traced == [2]


def test_an_error_of_the_function_reaches_the_caller(folder):
    with pytest.raises(TypeError):
        Program(double)(LAW, X, "two")


def test_options_that_the_environment_names_are_left_to_it(folder, monkeypatch):
    options = {"xla_no_such_option": True}
    monkeypatch.setenv("XLA_FLAGS", "--xla_no_such_option_either=1")
    with pytest.raises(RuntimeError, match="xla_no_such_option"):
        Program(double, options)(LAW, X, 2)
    monkeypatch.setenv("XLA_FLAGS", "--xla_other --xla_no_such_option=true")
    assert Program(double, options)(LAW, X, 2).twice.tolist() == [0.0, 2.0, 4.0]


def test_a_long_session_keeps_only_the_kinds_used_last_in_memory(folder, monkeypatch):
    """Linux gives a process 65530 memory maps, and each compiled kind takes hundreds."""
    monkeypatch.setattr(compilation, "HELD", 2)
    long_lived = Program(double)
    for factor in (2, 3, 2, 4, 2, 3):
        assert long_lived(LAW, X, factor).twice.tolist() == [0.0, factor, 2.0 * factor]
        assert len(long_lived._held) <= 2
    assert traced == [2, 3, 4]  # what was dropped was found on disk


def held_back(monkeypatch):
    """The compiler is not through until what is returned is set."""
    through, made = threading.Event(), compilation._Held.make

    def make(self, lowered):
        through.wait()
        made(self, lowered)

    monkeypatch.setattr(compilation._Held, "make", make)
    return through


def test_who_waits_for_the_compiler_is_told_of_what_and_how_long(folder, monkeypatch):
    through, reports = held_back(monkeypatch), []
    monkeypatch.setattr(compilation, "COMPILES", 1e6)  # of a program that is traced at once

    def report(fraction, text):
        reports.append(text)
        through.set()

    program = Program(double)
    assert program.time_left(LAW, X, 2) > 100.0
    call = Clock(report=report).ready(0.1, "the impacts", program, LAW, X, 2)
    assert re.fullmatch(r"compilation of the impacts, some \d+ s", reports[0])
    assert call().twice.tolist() == [0.0, 2.0, 4.0]
    assert program.time_left(LAW, X, 2) == 0.0
    Clock(report=report).ready(0.1, "the impacts", program, LAW, X, 2)
    assert reports[1] == "compilation"


def test_a_program_that_was_kept_is_not_waited_for_long(folder, monkeypatch):
    answer()
    monkeypatch.setattr(compilation, "COMPILES", 1e6)
    through = held_back(monkeypatch)
    program = Program(double)
    assert program.time_left(LAW, X, 2) == 0.0
    through.set()
    assert program(LAW, X, 2).twice.tolist() == [0.0, 2.0, 4.0]

"""Panels are cut where the error of their polynomials is."""

import numpy as np
import pytest

from asperity._jax import jnp
from asperity.contact import SmoothContact
from asperity.dynamics.curve_table import tabulate
from asperity.integration.panel_cuts import CutPanels, Inaccurate, Unsolved, curve_failure
from asperity.laws import Hertz

NODES = 16
GOAL = 1e-9
FIRST = np.linspace(-1.0, 1.0, 7)


def errors_of(function, ends):
    """Largest of the last two Chebyshev coefficients on each panel."""
    points = np.polynomial.chebyshev.chebpts1(NODES)
    fitted = np.linalg.inv(np.polynomial.chebyshev.chebvander(points, NODES - 1))
    middle, half = 0.5 * (ends[1:] + ends[:-1]), 0.5 * np.diff(ends)
    values = function(middle[:, None] + half[:, None] * points)
    return np.max(np.abs(values @ fitted.T)[:, -2:], axis=1)


def cut_until_fine(function, most, first=FIRST, reach=np.inf):
    """The panels once they are fine, or not cut any more; how often curves were made."""
    panels, tries = CutPanels(), 0
    while True:
        ends = np.sort(np.concatenate([first, panels.cuts]))
        errors, tries = errors_of(function, ends), tries + 1
        after = panels.finer(ends, errors, reach, GOAL, most)
        if np.max(errors) <= GOAL or after.stuck() or after.cuts.size == panels.cuts.size:
            return panels, errors, tries
        panels = after


@pytest.mark.parametrize("width", [1e-2, 1e-3, 1e-4])
def test_a_steep_place_is_found_and_resolved_by_a_few_panels(width):
    """Evenly, 2 / width panels would be needed."""
    panels, errors, tries = cut_until_fine(lambda x: np.tanh((x - 0.31) / width), 100)
    assert np.max(errors) <= GOAL
    assert panels.cuts.size < 12 * np.log2(2.0 / width)
    assert tries < 12
    assert np.median(np.abs(panels.cuts - 0.31)) < 30.0 * width


def test_what_is_smooth_is_not_cut():
    panels, errors, _ = cut_until_fine(lambda x: np.sin(x) + 50.0 * np.tanh(1e3 * (x - 0.31)), 200)
    assert np.max(errors) <= GOAL
    assert np.all((panels.cuts > 0.0) & (panels.cuts < 2.0 / 3.0))


def test_a_jump_is_given_up_with_an_error_that_does_not_fall():
    panels, errors, tries = cut_until_fine(lambda x: np.where(x > 0.1234, 1.0, 0.0), 200)
    assert panels.cuts.size < 200
    assert np.max(errors) > 0.01
    assert tries <= 8


def test_no_more_cuts_than_there_may_be_the_worst_panels_first():
    panels, errors, _ = cut_until_fine(lambda x: np.abs(x - 0.2) + 1e-3 * np.abs(x + 0.7), 5)
    assert panels.cuts.size == 5
    assert np.all(np.abs(panels.cuts[:3] - 0.2) < 0.34)
    np.testing.assert_array_equal(panels.padded(7)[5:], -np.inf)
    assert np.max(errors) > GOAL


def test_a_panel_across_the_end_of_forces_is_cut_there_and_before():
    first = np.array([-1.0, 0.0, 1.0])
    panels = CutPanels().finer(first, np.array([0.0, 1.0]), 0.25, GOAL, 50)
    assert np.max(panels.cuts) == pytest.approx(0.25, rel=1e-15)
    assert np.min(panels.cuts) < 0.05


@pytest.mark.parametrize("first", [[0.0, 1.0], [0.0, 0.25, 1.0], [0.0, 0.25 - 1e-16, 1.0]])
def test_the_tail_beyond_the_end_of_forces_is_cut_where_it_counts(first):
    """A light body turns in it."""
    tail = lambda x: np.exp(-80.0 * x**2)  # noqa: E731
    panels, errors, _ = cut_until_fine(tail, 50, np.array(first), reach=0.25)
    assert np.max(errors) <= GOAL
    assert np.any(panels.cuts > 0.26)


@pytest.mark.parametrize(
    ("error", "residual", "kind", "words"),
    [
        (1e-5, 0.0, Inaccurate, r"relative error of 1\.0e-05, not `numerics.tolerance` = 1\.0e-08"),
        (1e-5, 2e-3, Unsolved, r"do not agree: relative force error 2\.0e-03"),
        (0.0, np.nan, Unsolved, "do not agree: no number solves them"),
        (np.nan, np.nan, Unsolved, "do not agree: no number solves them"),
        (np.nan, 0.0, Inaccurate, "no numbers somewhere"),
    ],
)
def test_a_failure_names_what_does_not_hold(error, residual, kind, words):
    with pytest.raises(kind, match=words):
        raise curve_failure(error, 1e-8, residual)


def test_curves_that_are_no_numbers_have_no_error_that_is_small():
    """It was 0, as where nothing acts."""

    def errors(modulus):
        contact = SmoothContact(Hertz(1e-6, modulus))
        return np.asarray(tabulate(contact, jnp.asarray(-1e-8), jnp.asarray(1e-8)).errors)

    assert np.max(errors(1e9)) < 1e-6
    assert np.isnan(np.max(errors(np.nan)))

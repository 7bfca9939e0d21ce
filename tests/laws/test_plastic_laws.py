"""Laws of yielding side by side, as the gallery draws them: against theory, and what it says."""

import re
from math import exp, pi, sqrt
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

PAGE = Path(__file__).parents[2] / "docs" / "gallery.md"
POISSON, INDENTATION = 0.3, 2.8  # of steel; hardness over yield strength
HARDNESS = INDENTATION * 295e6 * (1.0 - POISSON**2) / 207e9  # over the contact modulus


@pytest.fixture(scope="module")
def gallery():
    """What the page's script leaves behind."""
    cells = re.findall(r"^```\{code-cell\} python\n(.*?)^```$", PAGE.read_text(), re.M | re.S)
    (script,) = (cell for cell in cells if "PlasticInterface" in cell)
    names: dict = {}
    exec(script, names)
    return names


@pytest.fixture(scope="module")
def curves(gallery):
    """Index, and load and share of both laws."""
    both = (gallery["curves"][name] for name in ("Kogut-Etsion", "Jackson-Green"))
    return np.asarray(gallery["index"]), *(np.asarray(pair) for pair in both)


class KogutEtsion:
    """Force over that at the critical overlap, of overlaps over it; the published constants."""

    middle = np.log(1.40 * 6.0**1.263) / np.log(6.0)  # meets 1 at 1, and the branch above at 6
    yields, kinks = 1.0, (1.0, 6.0, 110.0)

    def __init__(self, hardness=HARDNESS):
        self.hardness = hardness
        self.critical = (0.5 * pi * (0.454 + 0.41 * POISSON) * hardness) ** 2  # over the radius

    def force(self, x):
        if x <= 1.0:
            return x**1.5
        if x <= 6.0:
            return x**self.middle
        return 1.40 * min(x, 110.0) ** 1.263 * max(x / 110.0, 1.0)


class JacksonGreen:
    """The same of the other law, elastic up to where its fit meets Hertz's."""

    ratio = 1.295 * exp(0.736 * POISSON)

    def __init__(self, hardness=HARDNESS):
        self.hardness = hardness
        self.strength = hardness / INDENTATION
        self.critical = (0.5 * pi * self.ratio * self.strength) ** 2
        self.yields = brentq(lambda x: self.fit(x) - x**1.5, 1.1, 4.0, xtol=1e-13)
        self.kinks = (self.yields,)

    def fit(self, x):
        wide = sqrt(self.critical * x * (x / 1.9) ** (0.14 * exp(23.0 * self.strength)))
        pressure = 2.84 * (1.0 - exp(-0.82 * wide**-0.7))
        plastic = 4.0 * pressure / self.ratio * (1.0 - exp(-(x ** (5 / 9)) / 25.0)) * x
        return exp(-(x ** (5 / 12)) / 4.0) * x**1.5 + plastic

    def force(self, x):
        return x**1.5 if x <= self.yields else self.fit(x)


def returned(law, x):
    """Energy of unloading over critical force and overlap: Etsion, Kligerman and Kadin (2005)."""
    over = max(x / law.yields, 1.0)
    residual = x * (1.0 - over**-0.28) * (1.0 - over**-0.69)
    return law.force(x) * (x - residual) / (1.5 * over**-0.0331 + 1.0)


def pressed(law, psi):
    """Load over Hertz's and share of the work kept, by adaptive quadrature over the heights."""
    critical = law.critical / (psi * law.hardness) ** 2  # in rms

    def mean(quantity):
        kinks = [kink for kink in law.kinks if kink * critical < 8.0]
        return quad(
            lambda x: quantity(x) * exp(-0.5 * (1.0 + critical * x) ** 2), 0.0, 8.0 / critical,
            points=kinks, limit=400, epsrel=1e-9,
        )[0]  # fmt: skip

    def work(x):
        below = [kink for kink in law.kinks if kink < x] or None
        return quad(law.force, 0.0, x, points=below, epsrel=1e-10, limit=200)[0]

    done = mean(work)
    return mean(law.force) / mean(lambda x: x**1.5), 1.0 - mean(lambda x: returned(law, x)) / done


@pytest.mark.parametrize("at", [40, 60, 75, 100, 120])
@pytest.mark.parametrize(("row", "law"), [(1, KogutEtsion), (2, JacksonGreen)])
def test_load_and_kept_work_are_the_means_of_the_published_laws(curves, row, law, at):
    index = curves[0][at]
    load, kept = pressed(law(), index)
    assert curves[row][0, at] == pytest.approx(load, rel=1e-7)
    assert curves[row][1, at] == pytest.approx(kept, rel=1e-6, abs=1e-8)


def test_hard_asperities_are_elastic_by_both_laws(curves):
    index, *laws = curves
    for load, kept in laws:
        assert np.abs(load[index <= 0.3] - 1.0).max() < 1e-3
        assert kept[index <= 0.3].max() < 1e-3
        assert np.all(np.diff(load) < 1e-9)
        assert np.all(np.diff(kept) > -1e-9)


def test_the_laws_differ_by_what_the_page_says(curves):
    index, (load, kept), (other_load, other_kept) = curves
    fitted, more = index <= 13.0, other_load / load - 1.0
    assert index[np.argmin(more[fitted])] == pytest.approx(2.1, abs=0.05)
    assert more[fitted].min() == pytest.approx(-0.003, abs=5e-4)
    assert more[fitted].max() == pytest.approx(0.06, abs=5e-3)
    assert index[np.argmax(more)] == pytest.approx(36.0, abs=1.0)
    assert more.max() == pytest.approx(0.22, abs=5e-3)
    most = np.argmax(kept - other_kept)
    assert index[most] == pytest.approx(2.6, abs=0.05)
    assert (kept[most], other_kept[most]) == pytest.approx((0.39, 0.26), abs=5e-3)


def test_the_fits_end_where_the_page_says(gallery):
    """Where the mean overlap of contacting asperities is 110 times that of yield."""
    law = gallery["laws"]["Kogut-Etsion"]
    rms = gallery["tip"] * (13.0 * gallery["hardness"] / gallery["modulus"]) ** 2
    heights = gallery["Gaussian"](rms)
    mean = float(heights.tail(2, rms) / heights.tail(1, rms))
    assert mean / float(law.yield_overlap) == pytest.approx(110.0, rel=0.02)


@pytest.mark.parametrize(("hardness", "more"), [(0.001, 0.06), (0.02, -0.07)])
def test_of_other_solids_jackson_and_green_carry_what_the_page_says(hardness, more):
    loads = [pressed(law(hardness), 12.6)[0] for law in (KogutEtsion, JacksonGreen)]
    assert loads[1] / loads[0] - 1.0 == pytest.approx(more, abs=5e-3)

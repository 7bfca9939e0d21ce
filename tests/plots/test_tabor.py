"""The picture of pull-off and hysteresis over the Tabor number."""

import numpy as np

from asperity.plots import style, tabor


def test_each_law_has_a_line_in_both_panels_between_the_limits():
    numbers = np.geomspace(0.01, 5.0, 5)
    curves = {
        "Lennard-Jones": (numbers, np.linspace(2.0, 1.53, 5), np.linspace(0.0, 0.5, 5)),
        "Maugis-Dugdale": (20.0 * numbers, np.linspace(2.0, 1.5, 5), np.linspace(0.0, 1.0, 5)),
    }
    figure = tabor.figure(curves)
    pull, lost = figure.axes
    names = [text.get_text() for text in pull.get_legend().get_texts()]
    assert names == list(curves)
    assert {text.get_text() for text in pull.texts} == {"Bradley, DMT", "JKR"}
    assert all("[-]" in axes.get_xlabel() and "[-]" in axes.get_ylabel() for axes in figure.axes)
    assert lost.get_xlim() == (0.01, 100.0)
    np.testing.assert_array_equal(lost.get_lines()[1].get_ydata(), curves["Maugis-Dugdale"][2])
    assert style.png(figure).startswith(b"\x89PNG")

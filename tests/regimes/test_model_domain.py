"""Where the models end: cases that are refused, and sizes and speeds that are warned of."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

import asperity
from asperity import solver
from asperity.config import load
from asperity.config.bodies import solids_of
from asperity.config.resolve import resolve
from asperity.errors import InputError
from asperity.inputs import Asperities
from asperity.materials.solids import contact_modulus
from asperity.regimes.model_domain import _yields, first_yield_speed, mean_overlap
from asperity.results.verdict import verdict

SMOOTH = """
[body]
radius = "5 um"
youngs_modulus = "70 GPa"
poisson = 0.2
density = "2500 kg/m^3"
[counterface]
material = "sapphire"
[impact]
speed = "1 m/s"
"""
ROUGH = (
    SMOOTH.replace('"sapphire"', '"sapphire"\ndeformation = "rigid"')
    + """
[roughness]
asperity_density = "1e13 1/m^2"
asperity_radius = "100 nm"
rms_height = "5 nm"
[numerics]
max_impacts = 3
"""
)
BAR = math.sqrt(70e9 / 2500.0)  # speed of waves in a bar of the body, softer than sapphire [m/s]


def changed(text: str, **changes: Any) -> asperity.Case:
    return load(text).replace({key.replace("__", "."): value for key, value in changes.items()})


@pytest.mark.parametrize(
    ("key", "value", "inside", "words"),
    [
        ("roughness.asperity_radius", "5.1 um", "4.99 um", "larger than the body is not a bump"),
        ("roughness.rms_height", "2.5 um", "2.49 um", "smaller than 0.5 of the body's radius"),
        ("body.radius", "0.99 nm", "1.01 um", "is no continuum"),
        ("impact.speed", f"{1.001 * BAR} m/s", f"{0.999 * BAR} m/s", "taken to be quasi-static"),
    ],
)
def test_what_no_model_describes_is_refused_and_what_lies_just_inside_is_not(
    key, value, inside, words
):
    with pytest.raises(InputError, match=words) as refused:
        changed(ROUGH, **{key: value})
    assert refused.value.key == key
    changed(ROUGH, **{key: inside})


TIPS = {"roughness.asperity_radius": "100 nm", "roughness.asperity_density": "1e16 1/m^2"}
ONE = (1.0 / (math.pi * 1e16)) ** 1.5 * 2.0 / (3.0 * math.pi * 1e-14)
"""Work of adhesion over contact modulus at which DMT's contacts of these tips fill the area."""


@pytest.mark.parametrize(
    ("model", "spacing", "cube"),
    [
        ("jkr", 0.3, 3.0),
        ("dmt", 0.3, 1.0),
        ("maugis", 0.3, 1.0),
        ("maugis", 0.01, 3.0),
        ("bradley", 0.3, 1.0),
        ("auto", 0.3, 1.0),
    ],
)
def test_asperities_that_adhesion_makes_one_contact_are_refused_on_a_half_space(
    model, spacing, cube
):
    """Contacts are 3^(1/3) times as large in JKR, and so with a Tabor number of 11."""
    case = load(ROUGH)
    body, counterface = solids_of(case)
    limit = ONE / cube * contact_modulus(body, counterface)

    def with_work(share, deformation="half-space"):
        changes = {"adhesion.model": model, "adhesion.work": f"{share * limit} J/m^2", **TIPS}
        if model != "jkr":
            changes["adhesion.equilibrium_spacing"] = f"{spacing} nm"
        return case.replace({**changes, "counterface.deformation": deformation})

    with_work(0.999)
    with_work(1.001, "rigid")
    with pytest.raises(InputError, match=r"1 times the whole area \(the limit is 1\)") as refused:
        with_work(1.001)
    assert refused.value.key == "adhesion.work"


def test_the_speed_of_a_fall_counts_as_well():
    fall = {"impact__speed": None, "body__youngs_modulus": "1 kPa"}
    height = 1e3 / 2500.0 / (2.0 * 9.81)
    changed(SMOOTH, **fall, impact__release_separation=f"{0.999 * height} m")
    with pytest.raises(InputError, match="quasi-static") as refused:
        changed(SMOOTH, **fall, impact__release_separation=f"{1.001 * height} m")
    assert refused.value.key == "impact.release_separation"


def test_a_measured_surface_rougher_than_the_body_is_refused(tmp_path):
    heights = 1e-6 * np.random.default_rng(1).normal(size=(64, 64))
    np.save(tmp_path / "map.npy", heights)
    case = changed(
        SMOOTH,
        body__radius="50 nm",
        roughness={"files": [str(tmp_path / "map.npy")], "size": "10 um x 10 um", "unit": "m"},
    )
    with pytest.raises(InputError, match="body's radius") as refused:
        solver.assess(case)
    assert refused.value.key == "roughness.files"


def warned(case: asperity.Case, words: str) -> list[str]:
    return [line for line in solver.assess(case).warnings if words in line]


@pytest.mark.parametrize(
    ("changes", "words", "number"),
    [
        ({"roughness__asperity_radius": "1 um"}, "the asperities' radius is", "0.2 of the body's"),
        ({"roughness__rms_height": "400 nm"}, "the rms height is", "0.08 of the body's radius"),
    ],
)
def test_large_or_high_asperities_are_warned_of(changes, words, number):
    (line,) = warned(changed(ROUGH, **changes), words)
    assert number in line
    assert not warned(changed(ROUGH), words)


def test_the_mean_overlap_is_that_of_the_tail_of_the_heights():
    rough = Asperities(1e13, 1e-7, 5e-9)
    for reduced in (-2.0, 0.0, 3.0, 30.0):
        far = 40.0 / max(reduced, 3.0)
        tail = [
            quad(lambda t, n=n, h=reduced: t**n * math.exp(-h * t - 0.5 * t**2), 0.0, far)[0]
            for n in (0, 1)
        ]
        expected = 5e-9 * tail[1] / tail[0]
        assert mean_overlap(rough, reduced * 5e-9) == pytest.approx(expected, rel=1e-8)


def test_asperities_pressed_deeper_than_a_tenth_of_their_tips_are_warned_of():
    sharp, blunt = (changed(ROUGH, roughness__asperity_radius=tip) for tip in ("2 nm", "1000 nm"))
    (line,) = warned(sharp, "the mean overlap of contacting asperities")
    share, width = (float(line.split(word)[1].split(" ")[0]) for word in (
        "contacting asperities is ", "their contact radius "))  # fmt: skip
    assert share > 0.1
    assert width == pytest.approx(math.sqrt(share), rel=0.02)
    assert not warned(blunt, "the mean overlap of contacting asperities")


def test_a_wide_contact_is_warned_of_with_its_depth():
    """Hertz: depth (15 E/(8 E* sqrt(R)))^0.4, contact radius sqrt(R depth)."""
    for speed, wide in ((10.0, False), (400.0, True)):
        case = changed(SMOOTH, impact__speed=f"{speed} m/s")
        radius, modulus = 5e-6, resolve(case).modulus
        energy = 0.5 * 2500.0 * 4.0 / 3.0 * math.pi * radius**3 * speed**2
        depth = (15.0 / 8.0 * energy / (modulus * math.sqrt(radius))) ** 0.4
        assert (depth > 0.02 * radius) is wide
        lines = warned(case, "small indentations")
        assert len(lines) == wide
        if wide:
            assert f"sinks in by {100.0 * depth / radius:.0f} %" in lines[0]
            assert f"contact radius is {math.sqrt(depth / radius):.2g}" in lines[0]


def test_fast_impacts_say_what_share_goes_into_waves():
    """Hunter: 1.04 (V/c)^(3/5)."""
    (line,) = warned(changed(SMOOTH, impact__speed=f"{0.1 * BAR} m/s"), "waves in a bar")
    assert f"0.1 of the speed of waves in a bar of the body ({BAR:.3g} m/s)" in line
    assert f"about {100.0 * 1.04 * 0.1**0.6:.0f} % of its energy" in line
    assert not warned(changed(SMOOTH, impact__speed=f"{0.0199 * BAR} m/s"), "waves in a bar")


def test_a_body_torn_in_by_adhesion_faster_than_waves_is_warned_of():
    """1 nm of radius and 200 J/m^2: released slowly, it comes in faster than any wave."""
    case = changed(
        SMOOTH, body__radius="1 nm", impact__speed="1 mm/s", impact__gravity="0 m/s^2",
        adhesion={"model": "dmt", "work": "200 J/m^2", "equilibrium_spacing": "0.3 nm"},
    )  # fmt: skip
    (line,) = warned(case, "waves in a bar")
    assert "not quasi-static" in line


def test_first_yield_of_a_smooth_sphere_is_johnsons():
    """V^2 = 26 (Y/E*)^4 Y/rho (1985, ch. 11), whose 26 is rounded, at a peak pressure of 1.6 Y."""
    strength, modulus, density = 1e9, 100e9, 7800.0
    expected = math.sqrt(26.0 * (strength / modulus) ** 4 * strength / density)
    assert first_yield_speed(1.6 * strength, modulus, density) == pytest.approx(expected, rel=0.02)


def test_a_smooth_body_faster_than_first_yield_is_warned_of_unless_it_yields():
    strong = changed(SMOOTH, body__yield_strength="1 GPa")
    modulus = resolve(strong).modulus
    first = first_yield_speed(1.61e9, modulus, 2500.0)
    fast, slow = (strong.replace({"impact.speed": f"{n * first} m/s"}) for n in (3.0, 0.9))
    (line,) = warned(fast, "a smooth body first yields")
    assert "3 times the speed" in line
    assert not warned(slow, "a smooth body first yields")
    yields = resolve(strong.replace({"plasticity.model": "thornton-ning"}))
    assert _yields(yields, 0.0, 3.0 * first) == []


def test_there_is_no_verdict_where_not_one_asperity_is_expected_to_touch():
    """A bead of 100 nm that falls gently on asperities of 60 nm."""
    case = changed(
        ROUGH, body__radius="100 nm", roughness__asperity_radius="60 nm",
        impact__speed="1 mm/s", roughness__asperity_density="1e12 1/m^2",
    )  # fmt: skip
    result = asperity.solve(case, critical=False)
    contacting = result.regime["contacting_asperities"]
    assert contacting < 0.1
    told = f"o verdict: {contacting:.2g} asperities are expected to touch"
    assert verdict(result).startswith(f"n{told}")
    assert "but a single body falls until a summit carries it" in verdict(result)
    summary = " ".join(result.summary().split())
    assert f"N{told}" in summary
    assert not any(word in summary for word in ("sticks", "bounces"))
    assert any("falls until a summit carries it" in line for line in result.warnings)


def test_a_smooth_body_has_a_verdict_and_no_number_of_contacting_asperities():
    result = asperity.solve(changed(SMOOTH, numerics__max_impacts=1), critical=False)
    assert result.regime["contacting_asperities"] is None
    assert "no verdict" not in verdict(result)

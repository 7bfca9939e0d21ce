"""Published measurements against ranges of ours: where they lie inside, and by how much not."""

import numpy as np
import pytest

import measured
import measured_bodies
import measured_impacts
from measured import Comparison, wet_work


def figures():
    return [measured_impacts.elastic_benchmark()]


def only(rows: list[Comparison], name: str) -> Comparison:
    (found,) = [row for row in rows if row.row == name]
    return found


def test_elastic_sticking_speed_of_the_published_benchmark():
    assert measured_impacts.elastic_benchmark().holds


def test_mean_pull_off_of_alumina_falls_far_more_than_measured():
    """By about rms^-2, 8^2 = 64, where 5 was measured: less than a tenth of a summit touches."""
    mean, wet, one = measured.alumina()
    assert 16.0 < mean.factor < 17.0
    assert 64.0 < mean.low < mean.high < 120.0
    inputs = measured.alumina_inputs()
    contacting = [measured.pull_off(1.5e-9, *given).contacting for given in inputs]
    assert max(contacting) * 10e-6 < 0.1
    assert wet.low > mean.low
    assert one.factor == 1.0


def test_pull_off_of_single_alumina_probes_hardly_falls_between_blunt_summits():
    """Of 1 um: less than that of sharp ones, which a long study holds."""
    assert measured_bodies.fall(1e-6, measured.SPACINGS[0]) < 1.5


@pytest.mark.long
def test_pull_off_of_single_alumina_probes_falls_as_measured():
    """About 5 times, between summits of 30 nm whose forces reach 0.2 and 0.4 nm."""
    row = measured_bodies.alumina()
    assert row.factor == 1.0
    near, far = measured_bodies.alumina_falls()[30e-9]
    assert near < row.published < far < 6.0
    assert max(measured_bodies.alumina_falls()[1e-6]) < 1.5


def test_pull_off_of_nominally_similar_spheres_scatters_as_measured():
    row = measured_bodies.pairs()
    assert row.factor == 1.0
    assert 1.9 < row.low < 2.1
    assert 7.0 < row.high < 8.0


def test_ruby_on_diamond_asks_for_rms_heights_of_nanometres():
    """The tenth of the adhesion at 4 nm and its thousandth at 40 nm: not a test."""
    for row in measured.ruby():
        assert row.factor == 1.0
    for given in measured.ruby_inputs():
        assert 3.5 < measured.ruby_rms(7.15, given) < 5.0
        assert 35.0 < measured.ruby_rms(0.08, given) < 45.0


def test_adhesion_of_diamond_like_tips_falls_by_more_than_ten_times():
    (row,) = measured.tips_in_microscope()
    assert row.factor == 1.0
    assert row.low > 10.0


def test_pull_off_of_sharp_tips_in_humid_air_is_that_of_a_meniscus():
    alone, with_dry, small = measured.humid_tips()
    assert 1.0 < alone.factor < 1.1
    assert with_dry.factor == small.factor == 1.0


def test_wet_adhesion_energy_tends_to_twice_the_tension():
    (row,) = measured.cantilevers()
    assert row.factor == 1.0
    assert row.high / row.low < 1.1


@pytest.mark.parametrize("rms", [1e-9, 3e-9, 10e-9])
def test_wet_adhesion_energy_of_rough_surfaces_rises_with_humidity_to_that_limit(rms):
    limit = 2e3 * measured.WATER.tension
    work = [wet_work(humidity, rms, 0.0) for humidity in (0.3, 0.6, 0.9, 0.99, 0.999, 0.9999)]
    assert np.all(np.diff(work) > 0.0)
    assert work[0] < 0.02 * limit
    assert work[-1] == pytest.approx(limit, rel=0.005)


def test_silver_needs_another_adhesion_at_each_size():
    """The speeds fall as the 1.6th power of the size; 5/6 for smooth elastic spheres."""
    rows = measured_impacts.silver()
    assert only(rows, "ARF1").factor == 1.0
    large, exponent = only(rows, "ARF2"), only(rows, "ARF3")
    assert large.published < large.low
    assert 3.3 < large.factor < 3.5
    assert exponent.low == pytest.approx(-5.0 / 6.0, rel=1e-12)
    assert 1.9 < exponent.factor < 1.95


def test_elastic_fluorescein_rebounds_sooner_than_a_sphere_that_yields():
    rows = measured_impacts.fluorescein()
    assert 2.7 < only(rows, "PAS1").factor < 2.9
    assert only(rows, "PAS1").published > only(rows, "PAS1").high
    assert 1.0 < only(rows, "WAL1").factor < 1.1


def test_dust_sticks_at_the_edge_of_the_range_and_ice_far_beyond():
    rows = measured_impacts.dust()
    assert 1.0 < only(rows, "HIL1").factor < 1.1
    assert 4.0 < only(rows, "GB1").factor < 5.0


def test_adhesion_is_too_little_to_matter_for_large_glass():
    rows = measured_impacts.glass()
    assert only(rows, "JUN1").factor == 1.0
    assert only(rows, "BOG1").low > 0.99999
    assert 1.1 < only(rows, "BOG1").factor < 1.12


def test_every_row_of_the_file_is_used():
    """Compared, or an input."""
    compared = [*measured.statics(), measured_bodies.pairs(), *measured_impacts.impacts()]
    inputs = {"THI3", "THI4", "GUN2", "GUN3", *(f"PB{k}" for k in (1, 2, 3, 4, 6, 7))}
    assert {row.row for row in compared} | inputs == set(measured.ROWS)

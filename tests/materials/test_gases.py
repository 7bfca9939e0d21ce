"""Viscosity and mean free path of gases."""

import pytest

from asperity import InputError
from asperity.materials.gases import ATMOSPHERE, GASES


@pytest.mark.parametrize(
    ("name", "temperature", "viscosity"),
    [("air", 293.15, 18.2e-6), ("air", 400.0, 23.1e-6), ("nitrogen", 300.0, 17.9e-6),
     ("argon", 300.0, 22.9e-6), ("carbon dioxide", 300.0, 15.0e-6)],
)  # fmt: skip
def test_viscosity_is_that_of_the_tables(name, temperature, viscosity):
    """CRC Handbook of Chemistry and Physics, section 6, to its 2-3 %."""
    assert GASES[name].viscosity(temperature) == pytest.approx(viscosity, rel=0.025)


def test_free_path_in_air_is_that_of_jennings_and_slip_inverse_to_the_pressure():
    """65.4 nm at 293 K and 101.325 kPa (Jennings 1988, dry air 65.0 to 65.5)."""
    air = GASES["air"]
    assert air.free_path(ATMOSPHERE, 293.15) == pytest.approx(65.4e-9, rel=5e-3)
    whole, thin = (air.slip_length(share * ATMOSPHERE, 293.15) for share in (1.0, 0.1))
    assert thin == pytest.approx(10.0 * whole)


def test_temperatures_beyond_the_law_are_refused():
    with pytest.raises(InputError, match="`temperature` must lie in"):
        GASES["air"].viscosity(50.0)

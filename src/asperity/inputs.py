"""Every physical quantity of one case, in SI units: all that the layers below a case file see.

`asperity.config.resolve` makes `Inputs` of a case. Nothing that computes reads a `Case`.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from .errors import Tolerance
from .materials.gases import SLIP_PER_FREE_PATH
from .materials.liquids import Liquid
from .materials.solids import Solid

if TYPE_CHECKING:
    from .surfaces.description.summits import Summits
    from .surfaces.topography import Topography

CLASSES = 6
"""Classes of tip radius of measured summits, where a law needs them and a case names no number."""


class Structure(NamedTuple):
    """Which models a case is made of.

    Attributes
    ----------
    adhesion
        Law of adhesion of one asperity, after "auto" has chosen: "none", "bradley", "dmt",
        "maugis", "jkr" or "lennard-jones".
    liquid
        Model of the menisci: "none" in dry air too, "equilibrium", "constant-volume",
        "kelvin-filling".
    formation
        When a meniscus forms: "on-contact", also without any, or "capillary-condensation".
    plasticity
        Law of a contact that yields: "none", "kogut-etsion", "jackson-green", "thornton-ning".
    deformation
        Of the bulk: "rigid" or "half-space".
    viscoelastic
        Whether the half-space relaxes.
    waves
        Whether the contact radiates into the counterface.
    gas
        Whether there is gas in the gap.
    suspension
        What holds the body: "none", a "spring", or "damped", a spring and a dashpot.
    heights
        Of the asperities: "smooth" without any, "gaussian", or "summits" as they were measured.
    published
        Whether the publication's assumptions replace the other models.
    """

    adhesion: str
    liquid: str
    formation: str
    plasticity: str
    deformation: str
    viscoelastic: bool
    waves: bool
    gas: bool
    suspension: str
    heights: str
    published: bool


class Yielding(NamedTuple):
    """What yields in a contact of two solids.

    Attributes
    ----------
    hardness
        Indentation hardness [Pa].
    yield_strength
        Yield strength in uniaxial tension [Pa].
    yield_pressure
        Peak pressure of the contact at which it starts to yield [Pa].
    poisson
        Poisson's ratio of the solid that yields [-].
    """

    hardness: float
    yield_strength: float
    yield_pressure: float
    poisson: float


@dataclass(frozen=True, eq=False)
class Asperities:
    """Asperities of the composite of both surfaces.

    Attributes
    ----------
    asperity_density
        Asperities per area [1/m^2].
    asperity_radius
        Radius of their tips [m]; measured, that of the mean curvature.
    rms_height
        Standard deviation of their heights [m].
    mean_height
        Their mean height above the mean plane of the surface [m]; 0 where only numbers are known.
    surface
        The map that they were found on; None where only numbers are known.
    summits
        The measured summits; likewise.
    facts
        Files, what was done to them and what was found, as plain numbers and text in SI units.
    warnings
        What to know before they are believed, a line each.
    """

    asperity_density: float
    asperity_radius: float
    rms_height: float
    mean_height: float = 0.0
    surface: Topography | None = None
    summits: Summits | None = None
    facts: dict[str, Any] | None = None
    warnings: tuple[str, ...] = ()

    @property
    def spacing(self) -> float:
        """Mean distance of neighbours [m]."""
        return self.asperity_density**-0.5


class Gas(NamedTuple):
    """The gas in the gap.

    Attributes
    ----------
    viscosity
        Viscosity [Pa s].
    slip_length
        Slip length on both surfaces [m].
    cutoff_separation
        Separation below which the film does not thin [m].
    pressure, temperature
        Of a gas that was given by name [Pa], [K]; else None.
    """

    viscosity: float
    slip_length: float
    cutoff_separation: float
    pressure: float | None
    temperature: float | None

    @property
    def free_path(self) -> float:
        """Mean free path [m] that belongs to the slip length."""
        return self.slip_length / SLIP_PER_FREE_PATH


class Suspension(NamedTuple):
    """The spring and the dashpot that hold the body.

    Attributes
    ----------
    stiffness
        Stiffness of the spring [N/m].
    damping
        Force of the dashpot over the speed [N s/m].
    rest_gap
        Separation of the mean planes at which the spring is relaxed [m].
    """

    stiffness: float
    damping: float
    rest_gap: float


class Release(NamedTuple):
    """How the body is let go.

    Attributes
    ----------
    separation
        Separation of the mean planes there [m]; None where the solver is to choose it.
    speed
        Speed towards the surface [m/s].
    gravity
        Acceleration towards the surface [m/s^2].
    """

    separation: float | None
    speed: float
    gravity: float


class Placement(NamedTuple):
    """Summits one by one.

    Attributes
    ----------
    measured
        Whether they stand where they were measured, or at random places.
    realisations
        Bodies, each on summits of its own.
    seed
        Of their places.
    required
        Whether a map too small for that is refused; else they stand at random places.
    """

    measured: bool
    realisations: int
    seed: int
    required: bool = True


class Assumptions(NamedTuple):
    """What the publication assumes.

    Attributes
    ----------
    attraction_during_retraction_only
        Whether adhesion and menisci pull only while the bodies part.
    conjunction_ends
        Separation over the rms height beyond which nothing acts [-].
    capillary_factor
        Factor on the force of the menisci [-].
    polynomials
        Height integrals: "exact", or the polynomials "printed" as eqs. 10 and 17.
    bands
        Number of the bands of menisci, eq. 13.
    """

    attraction_during_retraction_only: bool
    conjunction_ends: float
    capillary_factor: float
    polynomials: str
    bands: int


@dataclass(frozen=True, eq=False)
class Inputs:
    """Every physical quantity of a case.

    Attributes
    ----------
    structure
        Which models the case is made of.
    body, counterface
        The two solids.
    radius
        Radius of the body [m].
    mass
        Mass of the body, a full sphere [kg].
    modulus
        Contact modulus E* [Pa]: 1/E* is the sum of (1 - nu^2)/E over both solids. Johnson,
        Contact Mechanics (1985), eq. 4.22.
    tip_radius
        Radius of one asperity, or of the smooth body [m].
    yielding
        What yields; None where no strength is known.
    strength_given
        Whether that strength was given in place of a solid's own.
    plasticity_allowed
        Whether a case may have a law of yielding beside its other models.
    work_of_adhesion
        Work of adhesion [J/m^2]; 0 without adhesion.
    equilibrium_spacing
        Equilibrium spacing of the atoms [m]; 0 where it is not known.
    adhesion_reason
        Why this law of adhesion, where the program chose it; None where the case names it.
    border_warnings
        A sentence for each border between two laws of adhesion that is near.
    asperities
        The asperities; None for a smooth body.
    surface_rms_height
        Rms height of the surface itself, where it is known, or else of its asperities [m]; 0 for
        a smooth body.
    radius_classes
        Classes of tip radius of measured summits.
    liquid
        The liquid of the menisci; None without them.
    contact_angle
        Of the liquid [rad].
    kelvin_radius
        Kelvin radius [m]: tension times molar volume over R T ln(1/humidity), the publication's
        eq. 11. 0 without menisci, infinite at a humidity of 1.
    liquid_radius
        Radius of curvature of the liquid [m]: Kelvin's, or less where its film bounds it.
    liquid_span
        Largest gap that the liquid bridges [m], 2 cos(contact angle) times its radius.
    liquid_temperature
        Of liquid and vapour [K]; None without menisci.
    formation_time
        Time that menisci take to form [s]; 0 where they form at once.
    gas
        The gas in the gap; None in a vacuum.
    suspension
        What holds the body; None where it is free.
    relaxed_modulus_ratio, relaxation_time
        Of a half-space that relaxes [-], [s]; 1 and 0 of an elastic one.
    release
        How the body is let go; None where only curves can be asked for.
    placement
        Single bodies on summits of their own; None where the case does not ask for them.
    beside
        Those that stand beside a mean of few asperities; None where the case asks for the mean
        alone, or its models leave no room for them.
    published
        What the publication assumes; None in every other case.
    tolerance
        How closely to solve and when to stop.

    Notes
    -----
    A number may be an array of many cases that are alike in all else.
    """

    structure: Structure
    body: Solid
    counterface: Solid
    radius: float
    mass: float
    modulus: float
    tip_radius: float
    yielding: Yielding | None
    strength_given: bool
    plasticity_allowed: bool
    work_of_adhesion: float
    equilibrium_spacing: float
    adhesion_reason: str | None
    border_warnings: tuple[str, ...]
    asperities: Asperities | None
    surface_rms_height: float
    radius_classes: int
    liquid: Liquid | None
    contact_angle: float
    kelvin_radius: float
    liquid_radius: float
    liquid_span: float
    liquid_temperature: float | None
    formation_time: float
    gas: Gas | None
    suspension: Suspension | None
    relaxed_modulus_ratio: float
    relaxation_time: float
    release: Release | None
    placement: Placement | None
    beside: Placement | None
    published: Assumptions | None
    tolerance: Tolerance

    @property
    def yields(self) -> bool:
        """Whether the contact can yield."""
        return self.structure.plasticity != "none"

    @property
    def surface_facts(self) -> dict[str, Any] | None:
        """What the files of measured surfaces were found to be; None for a case of numbers."""
        return None if self.asperities is None else self.asperities.facts

    @property
    def chosen_release(self) -> bool:
        """Whether the body is let go from where the solver chooses."""
        return self.release is not None and self.release.separation is None

    def with_bodies(self) -> Inputs:
        """The same with single bodies: those that the case asks for, or those beside a mean."""
        return dataclasses.replace(self, placement=self.placement or self.beside)

    def one_impact(self) -> Inputs:
        """The same with one impact alone, however long it takes."""
        ends = dataclasses.replace(self.tolerance, max_impacts=1, time_limit=math.inf)
        return dataclasses.replace(self, tolerance=ends)

    def elastic(self) -> Inputs:
        """The same with nothing that yields."""
        return dataclasses.replace(self, structure=self.structure._replace(plasticity="none"))

    def without_motion(self) -> Inputs:
        """The same without a release, and without gas and waves, which act in a motion alone."""
        structure = self.structure._replace(waves=False, gas=False)
        return dataclasses.replace(self, structure=structure, release=None, gas=None)

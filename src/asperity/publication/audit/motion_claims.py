"""Claims on the motion, its damping, the tables and the power losses, eqs. 21-24."""

from __future__ import annotations

from math import log

import numpy as np
from scipy.special import ndtr

from ...dynamics import Body
from ...dynamics.damped_summits import rebound
from ...dynamics.gas_film import SqueezeFilm
from ...laws.law import as_float64
from ...materials.gases import ATMOSPHERE, GASES
from ...materials.liquids import ROOM_TEMPERATURE
from ...results.summary import amount
from ..evidence import Evidence, first
from ..parameter_estimation import WITHIN
from ..published_tables import QUANTITIES
from .claim import AGREES, MISSING, OUTSIDE, REPRODUCED, UNEXPLAINED, WRONG, Claim, close


def claims(evidence: Evidence) -> list[Claim]:
    """From what damps the motion to what the exact model says of the case."""
    return [
        *_damping(evidence),
        *_tables(evidence),
        _wet_over_dry(evidence),
        _gas(evidence),
        *_power(evidence),
        *_exact(evidence),
    ]


def _damping(evidence: Evidence) -> list[Claim]:
    unknowns = evidence.unknowns
    wet = first(evidence.wet.measures["log_decrement"])
    restitution = first(evidence.both_ways.measures["restitution"])
    published = evidence.published.values["log_decrement"]
    left_out = 1.0 / (0.5 - ndtr(-unknowns.conjunction_ends))
    return [
        Claim("Adhesion and menisci damp the motion (eqs. 9, 15, 21)", f"decrement {published}",
              f"as forces of position alone they give a restitution of {restitution:.8f}. Pulling "
              f"only while the bodies part, which no equation says, they give {wet:.4f}",
              AGREES if restitution < 0.999 else UNEXPLAINED),
        Claim("Release gap, density, number of bands, grid", "-",
              f"{amount(unknowns.release_separation, 'm')} from rest, found from the tables; "
              f"{evidence.inputs.body.density:g} kg/m^3, assumed",
              MISSING),
        Claim("The force of the menisci (eq. 15)", "1",
              f"times {unknowns.capillary_factor:.4g}, found from the tables. The asperities that "
              f"the sum leaves out would be {left_out:.3g} of that; an end of the conjunction "
              "farther out needs less (see --refit)",
              AGREES if close(unknowns.capillary_factor, 1.0, 0.1) else UNEXPLAINED),
    ]  # fmt: skip


def _tables(evidence: Evidence) -> list[Claim]:
    out = []
    for quantity, limit in WITHIN.items():
        known = {
            (row["asperity_radius"], row["rms_height"]): row["relative_difference"]
            for row in evidence.rows
            if row["quantity"] == quantity and row["published"] is not None
        }
        if not known:
            continue
        none = sum(off is None for off in known.values())
        worst = max((abs(off) for off in known.values() if off is not None), default=np.inf)
        found = f"the worst is off by {100.0 * worst:.1f} %, with one set of inputs"
        out.append(
            Claim(
                f"The {QUANTITIES[quantity].words}s of the tables",
                f"{len(known)} of them",
                f"{none} of them have none by the model" if none else found,
                REPRODUCED if not none and worst <= limit else WRONG,
            )
        )
    return out


def _wet_over_dry(evidence: Evidence) -> Claim:
    wet, dry = (first(m.measures["log_decrement"]) for m in (evidence.wet, evidence.dry))
    return Claim(
        "The decrement is 200 times larger wet than dry (section 5)",
        "200",
        f"{wet / dry:.0f} times ({wet:.4f} and {dry:.2e}) with the inputs found",
        REPRODUCED if close(wet / dry, 200.0, 0.1) else UNEXPLAINED,
    )


def _gas(evidence: Evidence) -> Claim:
    unknowns = evidence.unknowns
    edge = float(evidence.contact.pressure.end)
    air = GASES["air"]
    slip = air.slip_length(ATMOSPHERE, ROOM_TEMPERATURE)
    path = air.free_path(ATMOSPHERE, ROOM_TEMPERATURE)
    film = SqueezeFilm(evidence.inputs.radius, air.viscosity(ROOM_TEMPERATURE), slip)
    release = unknowns.release_separation
    body = Body(evidence.inputs.mass, evidence.gravity, release, drags=(film,))
    _, apex = rebound(body, as_float64(edge))
    gas = log((release - edge) / (float(apex) - edge))
    return Claim(
        "Surface forces and gravity are all that acts on the sphere (section 3.5)",
        "-",
        f"the gas film is left out: alone it gives a decrement of {gas:.2g} in air, by first-order "
        f"slip ({amount(slip, 'm')}), whose range ends at a Knudsen number of 0.1; here it is "
        f"{path / edge:.2g}",
        OUTSIDE,
    )


def _power(evidence: Evidence) -> list[Claim]:
    def spread(name: str) -> str:
        known = [value for row in evidence.power if (value := row[name]) is not None]
        return f"{min(known):.2f} to {max(known):.2f}" if known else "-"

    means = [row["over_mean_of_impacts"] for row in evidence.power]
    fits = all(value is not None and abs(value - 1.0) < 0.2 for value in means)
    may_be = ". The mean may be meant" if fits else ""
    exact = evidence.exact.measures
    ratio = first(exact["power_loss_published"]) / first(exact["power_loss"])
    published = evidence.published.values["power_loss"]
    return [
        Claim("The power loss is the work of the pulls over the impact time (eq. 23)",
              f"{published:.4g} W",
              f"published over that of the first impact: {spread('over_first_impact')}; over the "
              "energy of the whole drop by the time to rest: "
              f"{spread('over_whole_drop')}; over the mean of eq. 23 over all impacts until a "
              f"rebound of 1e-3 of the first: {spread('over_mean_of_impacts')}, until 1e-2: "
              f"{spread('over_mean_of_large_impacts')}" + may_be,
              UNEXPLAINED),
        Claim("The work of the pulls on the way out is lost (eq. 23)", "all of it",
              f"by the exact model, at 60 % from 60 nm, eq. 23 says {ratio:.0f} times what is "
              "lost: most comes back on the way in",
              AGREES if close(ratio, 1.0, 0.1) else WRONG),
        Claim("The heading of the power loss in Table 3", "1e-8 nW",
              "1e-4 nW: the row that both tables hold differs by 10 000 otherwise", WRONG),
    ]  # fmt: skip


def _exact(evidence: Evidence) -> list[Claim]:
    rest, sigma = evidence.exact_rest, evidence.rough.rms_height
    edge, release, _ = evidence.unknowns
    push = float(evidence.exact_state(release).force) / evidence.weight
    capillary = evidence.exact.case.capillary
    gap = evidence.exact.case.launch.release_separation
    assert capillary.humidity is not None
    assert gap is not None
    found, damp = (
        first(motion.measures["log_decrement"]) for motion in (evidence.exact, evidence.exact_damp)
    )
    humidity = evidence.exact_damp.case.capillary.humidity
    assert humidity is not None
    published = evidence.published.values["log_decrement"]
    assert published is not None
    return [
        Claim("The release and the place of rest that the tables ask for", "-",
              f"{release * 1e9:.4g} nm and lambda' = {edge:.4g}; by the exact model it rests at "
              f"lambda' = {rest / sigma:.2f} ({rest * 1e9:.1f} nm), and at {release * 1e9:.4g} nm "
              f"contact pushes with {push:.2g} times the weight",
              AGREES if release > rest else WRONG),
        Claim("The decrement by the exact model, where that has one: menisci that end, and a "
              "release outside contact",
              f"{published}",
              f"{found:.2g} at {100.0 * capillary.humidity:g} % and {amount(gap, 'm')}, {damp:.2g} "
              f"at {100.0 * humidity:.3g} %, above which menisci coalesce. Rest never comes: a "
              "swing within the reach of the menisci loses nothing",
              REPRODUCED if close(found, published, 0.1) else OUTSIDE),
    ]  # fmt: skip

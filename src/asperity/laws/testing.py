"""Proof that a law of one asperity keeps the rules on which everything above it relies."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..errors import InputError
from .law import Law, terms

DIMENSIONS: dict[str, tuple[float, float]] = {
    "contact_angle": (0.0, 0.0),
    "kelvin_radius": (1.0, 0.0),
    "modulus": (-2.0, 1.0),
    "radius": (1.0, 0.0),
    "spacing": (1.0, 0.0),
    "tension": (-1.0, 1.0),
    "work_of_adhesion": (-1.0, 1.0),
}
"""Powers of (length, force) of the values that the laws of the package have."""

_SLOPE = 1e-7  # relative difference of the force and the slope of the energy
_WORK = 1e-4  # of the work between two gaps: a root's kink is integrated no closer
_FAR = 1e6  # times the largest length of a law
_OTHER_UNITS = 7.0, 3.0  # by which the numbers of a length and of a force grow in other units
_NODES, _WEIGHTS = (np.asarray(a) for a in np.polynomial.legendre.leggauss(16))

Curve = Callable[[jax.Array], jax.Array]


class _Branch(NamedTuple):
    """A branch between the gaps where it exists, for messages and loops."""

    title: str
    force: Curve
    energy: Curve
    gaps: np.ndarray


def check_law(
    law: Law,
    *,
    dimensions: Mapping[str, tuple[float, float]] | None = None,
) -> None:
    """Prove that a law is one: energies, branches, units, and that it can be traced.

    Parameters
    ----------
    law
        The law, or a sum, whose laws are checked one by one.
    dimensions
        Powers of (length, force) of each of the law's values, such as
        ``{"stiffness": (-1, 1)}``; (0, 0) for a pure number. Names in :data:`DIMENSIONS`
        need none.

    Raises
    ------
    AssertionError
        If a rule is broken; the message names law, branch, gap and numbers.
    InputError
        If a value's dimensions are not known.

    Notes
    -----
    The rules: force = -d(energy)/d(gap) on each branch where it exists, also across its
    kinks; the free energy tends to 0 and the force is negligible beyond
    ``interaction_range``; a bond breaks at no smaller gap than it forms at, and neither step
    gains energy; everything is finite float64 of the gap's shape, also at kinks, and the same
    under ``jit`` and ``vmap``, with finite gradients; ``powers`` and ``response`` add up to
    the force; in other units the law is the same.
    """
    known = {**DIMENSIONS, **(dimensions or {})}
    for part in terms(law):
        places = _gaps(part)
        _check_order(part)
        for branch in _branches(part, places):
            _check_traceable(part, branch)
            _check_slope(part, branch)
            _check_work(part, branch)
        _check_far(part)
        _check_losses(part, places)
        _check_response(part, places)
        _check_powers(part, places)
        _check_units(part, places, known)


def _name(law: Law) -> str:
    return type(law).__name__


def _lengths(law: Law) -> np.ndarray:
    """The law's own lengths [m], ascending; 1 nm where it has none."""
    own = [law.length, law.interaction_range, law.forming_gap, law.breaking_gap, *law.kinks]
    values = np.abs(np.array([float(value) for value in own]))
    values = np.sort(values[np.isfinite(values) & (values > 0.0)])
    return values if len(values) else np.array([1e-9])


def _kinks(law: Law) -> np.ndarray:
    return np.array([float(k) for k in law.kinks])


def _gaps(law: Law) -> np.ndarray:
    """Gaps [m] to look at: overlap and apart, close together around 0, with all kinks."""
    lengths = _lengths(law)
    apart = np.geomspace(1e-3 * lengths[0], 3.0 * lengths[-1], 48)
    overlap = -np.geomspace(1e-3 * lengths[0], 10.0 * lengths[0], 32)
    ends = [float(law.forming_gap), float(law.breaking_gap)]
    return np.unique(np.concatenate([overlap, [0.0], apart, _kinks(law), ends]))


def _branches(law: Law, gaps: np.ndarray) -> list[_Branch]:
    """The free branch, above the forming gap where bonds form, and the bonded one."""
    if not law.hysteretic:
        return [_Branch("free", law.force, law.energy, gaps)]
    free = gaps[gaps >= float(law.forming_gap)]
    bonded = gaps[gaps <= float(law.breaking_gap)]
    return [
        _Branch("free", law.force, law.energy, free),
        _Branch("bonded", law.bonded_force, law.bonded_energy, bonded),
    ]


def _check_order(law: Law) -> None:
    forming, breaking = float(law.forming_gap), float(law.breaking_gap)
    assert np.isfinite(forming + breaking), (
        f"{_name(law)}: `forming_gap` and `breaking_gap` must be finite; "
        f"got {forming:.6g} m and {breaking:.6g} m"
    )
    assert breaking >= forming, (
        f"{_name(law)}: a bond must break at no smaller gap than it forms at; "
        f"it forms at {forming:.6g} m and breaks at {breaking:.6g} m"
    )


def _check_traceable(law: Law, branch: _Branch) -> None:
    """Finite float64 of the gap's shape, alike under jit and vmap, with finite gradients."""
    gaps = jnp.asarray(branch.gaps)
    for what, curve in (("force", branch.force), ("energy", branch.energy)):
        where = f"{_name(law)}, {branch.title} branch: the {what}"
        try:
            plain, traced = curve(gaps), jax.jit(jax.vmap(curve))(gaps)
            slope = jax.jit(jax.vmap(jax.grad(curve)))(gaps)
        except TypeError as error:
            raise AssertionError(
                f"{where} does not work under jit, vmap and grad "
                f"(choose with `jax.numpy.where`): {str(error).splitlines()[0]}"
            ) from error
        assert plain.dtype == jnp.float64, f"{where} must be float64; got {plain.dtype}"
        assert plain.shape == gaps.shape, (
            f"{where} must have the gap's shape {gaps.shape}; got {plain.shape}"
        )
        _all_finite(where, plain, branch.gaps)
        _all_finite(f"{where}'s slope", slope, branch.gaps)
        size = float(jnp.max(jnp.abs(plain)))
        _compare(f"{where} under jit and vmap", traced, plain, branch.gaps, 1e-12 * size, 1e-9)
    for name, gradient in _parameter_gradients(law, branch).items():
        _all_finite(f"{_name(law)}, {branch.title} branch: d(force)/d({name})", gradient, gaps)


def _parameter_gradients(law: Law, branch: _Branch) -> dict[str, jax.Array]:
    values = _values(law)
    bonded = branch.title == "bonded"

    def force(own: dict[str, jax.Array], gap: jax.Array) -> jax.Array:
        other = dataclasses.replace(law, **own)
        return other.bonded_force(gap) if bonded else other.force(gap)

    every_gap = jax.jit(jax.vmap(jax.grad(force), in_axes=(None, 0)))
    rows: dict[str, jax.Array] = every_gap(values, jnp.asarray(branch.gaps))
    return rows


def _values(law: Law) -> dict[str, jax.Array]:
    """The physical values of a law by the name of their field."""
    own = {field.name: getattr(law, field.name) for field in dataclasses.fields(law)}
    return {
        name: value
        for name, value in own.items()
        if isinstance(value, jax.Array) and jnp.issubdtype(value.dtype, jnp.floating)
    }


def _all_finite(what: str, values: Any, gaps: Any) -> None:
    bad = np.flatnonzero(~np.isfinite(np.asarray(values)))
    if len(bad):
        place = float(np.asarray(gaps)[bad[0]])
        value = float(np.asarray(values)[bad[0]])
        raise AssertionError(f"{what} must be finite; at the gap {place:.6g} m it is {value}")


def _compare(
    what: str, got: Any, expected: Any, gaps: np.ndarray, absolute: float, relative: float
) -> None:
    got, expected = np.asarray(got), np.asarray(expected)
    limit = absolute + relative * np.maximum(np.abs(got), np.abs(expected))
    bad = np.flatnonzero(~(np.abs(got - expected) <= limit))
    if len(bad):
        k = bad[0]
        raise AssertionError(
            f"{what}: at the gap {gaps[k]:.6g} m it is {got[k]:.9g}, not {expected[k]:.9g}"
        )


def _check_slope(law: Law, branch: _Branch) -> None:
    """Force = -d(energy)/d(gap) away from the kinks."""
    away = _away(branch.gaps, _kinks(law), 1e-6 * _lengths(law)[0])
    gaps = branch.gaps[away]
    force = np.asarray(branch.force(jnp.asarray(gaps)))
    slope = -np.asarray(jax.jit(jax.vmap(jax.grad(branch.energy)))(jnp.asarray(gaps)))
    tiny = 1e-12 * float(np.max(np.abs(force), initial=0.0))
    what = f"{_name(law)}, {branch.title} branch: the force must be -d(energy)/d(gap) [N]"
    _compare(what, force, slope, gaps, tiny, _SLOPE)


def _away(gaps: np.ndarray, kinks: np.ndarray, least: float) -> np.ndarray:
    away: np.ndarray = np.all(np.abs(gaps[:, None] - kinks[None, :]) > least, axis=1)
    return away


def _check_work(law: Law, branch: _Branch) -> None:
    """Energy differences are the force's work: an energy that jumps has the right slope too."""
    inner = _kinks(law)
    inner = inner[(inner > branch.gaps[0]) & (inner < branch.gaps[-1])]
    ends = np.unique(np.concatenate([branch.gaps, inner]))
    half = 0.5 * np.diff(ends)
    places = 0.5 * (ends[:-1] + ends[1:])[:, None] + half[:, None] * _NODES
    force = np.asarray(branch.force(jnp.asarray(places)))
    work = half * (force @ _WEIGHTS)
    drop = -np.diff(np.asarray(branch.energy(jnp.asarray(ends))))
    size = half * (np.abs(force) @ _WEIGHTS)
    energy = np.abs(np.asarray(branch.energy(jnp.asarray(ends))))
    limit = _WORK * size + 1e-12 * np.maximum(energy[:-1], energy[1:]) + 1e-9 * np.max(size)
    bad = np.flatnonzero(~(np.abs(drop - work) <= limit))
    if len(bad):
        k = bad[0]
        raise AssertionError(
            f"{_name(law)}, {branch.title} branch: the energy must fall by the force's work; "
            f"between the gaps {ends[k]:.6g} m and {ends[k + 1]:.6g} m it falls by "
            f"{drop[k]:.9g} J and the work is {work[k]:.9g} J (a jump, or a kink that "
            "`kinks` does not name)"
        )


def _check_far(law: Law) -> None:
    """Free energy 0 at infinity, force negligible beyond the interaction range."""
    far = _FAR * _lengths(law)[-1]
    at = jnp.asarray([far, 100.0 * far])
    energy = np.abs(np.asarray(law.energy(at)))
    near = [branch.gaps for branch in _branches(law, _gaps(law))]
    largest = max(float(np.max(np.abs(_either(law, gaps)))) for gaps in near)
    vanishes = energy[0] <= 1e-4 * largest
    falls = energy[1] <= energy[0]
    assert all((vanishes, falls)), (
        f"{_name(law)}, free branch: the energy must tend to 0 far away; at the gap "
        f"{far:.6g} m it is {energy[0]:.6g} J, beside {largest:.6g} J at most"
    )
    interaction_range = float(law.interaction_range)
    beyond = interaction_range + _lengths(law)[-1] * np.array([1e-6, 1e-2, 1.0, 1e2])
    force = np.abs(np.asarray(law.force(jnp.asarray(beyond))))
    pull = max(float(np.max(-np.asarray(b.force(jnp.asarray(b.gaps))), initial=0.0))
               for b in _branches(law, _gaps(law)))  # fmt: skip
    bad = np.flatnonzero(force > 1.01e-6 * pull)
    if len(bad):
        raise AssertionError(
            f"{_name(law)}, free branch: beyond `interaction_range` = {interaction_range:.6g} m "
            f"the force must be below 1e-6 of the largest pull, {pull:.6g} N; at the gap "
            f"{beyond[bad[0]]:.6g} m it is {force[bad[0]]:.6g} N"
        )


def _either(law: Law, gaps: np.ndarray) -> np.ndarray:
    at = jnp.asarray(gaps)
    return np.maximum(np.abs(law.energy(at)), np.abs(law.bonded_energy(at)))


def _check_losses(law: Law, gaps: np.ndarray) -> None:
    if not law.hysteretic:
        return
    size = float(np.max(_either(law, gaps[gaps <= float(law.breaking_gap)]), initial=0.0))
    for step, loss, gap in (
        ("forms", float(law.formation_loss), float(law.forming_gap)),
        ("breaks", float(law.rupture_loss), float(law.breaking_gap)),
    ):
        assert loss >= -1e-12 * size, (
            f"{_name(law)}: energy must not be gained where a bond {step}; at the gap "
            f"{gap:.6g} m the loss is {loss:.6g} J"
        )


def _check_response(law: Law, gaps: np.ndarray) -> None:
    """The forces by mechanism are those that it counts, and add up."""
    names = set(law.response(jnp.zeros(()), jnp.asarray(False)))
    expected = {"energy", *(law.counts or {law.mechanism})}
    assert names == expected, (
        f'{_name(law)}: `response` must name "energy" and the forces of `counts` (or else '
        f"`mechanism`), {sorted(expected)}; it names {sorted(names)}"
    )
    for branch in _branches(law, gaps):
        at = jnp.asarray(branch.gaps)
        parts = law.response(at, jnp.full(at.shape, branch.title == "bonded"))
        energy = parts.pop("energy")
        total = np.sum(np.stack([np.asarray(part) for part in parts.values()]), axis=0)
        size = max(float(np.max(np.abs(part))) for part in parts.values())
        of = f"{_name(law)}, {branch.title} branch: the"
        what = f"{of} forces of `response` must add up to the force [N]"
        _compare(what, total, branch.force(at), branch.gaps, 1e-12 * size, 1e-9)
        what = f"{of} energy of `response` must be that of the branch [J]"
        deep = 1e-12 * float(np.max(np.abs(energy)))
        _compare(what, energy, branch.energy(at), branch.gaps, deep, 1e-9)


def _check_powers(law: Law, gaps: np.ndarray) -> None:
    """Truncated powers, where given, are the force and the energy with every bond gap."""
    forming, breaking = float(law.forming_gap), float(law.breaking_gap)
    for bond_gap in np.linspace(forming, breaking, 5) if law.hysteretic else [-np.inf]:
        powers = law.powers(jnp.asarray(bond_gap))
        if powers is None:
            return
        away = _away(gaps, np.append(_kinks(law), bond_gap), 1e-9 * _lengths(law)[0])
        at, bonded = jnp.asarray(gaps[away]), gaps[away] < bond_gap
        pairs = (
            ("force", powers[0], law.force, law.bonded_force),
            ("energy", powers[1], law.energy, law.bonded_energy),
        )
        for what, rows, free, held in pairs:
            got = sum((term(at) for term in rows), jnp.zeros_like(at))
            expected = np.where(bonded, held(at), free(at))
            text = f"{_name(law)}: `powers({bond_gap:.6g})` must be the {what}"
            tiny = 1e-11 * float(np.max(np.abs(expected), initial=0.0))
            _compare(text, got, expected, gaps[away], tiny, 1e-9)


def _check_units(
    law: Law,
    gaps: np.ndarray,
    dimensions: Mapping[str, tuple[float, float]],
) -> None:
    """The law in other units of length and force is the same law."""
    per_length, per_force = _OTHER_UNITS
    changed = {}
    for name, value in _values(law).items():
        if name not in dimensions:
            raise InputError(
                f"`dimensions` must give the powers of (length, force) of `{name}` of {_name(law)}"
            )
        length, force = dimensions[name]
        changed[name] = value * per_length**length * per_force**force
    other = dataclasses.replace(law, **changed)
    for name in ("forming_gap", "breaking_gap", "interaction_range", "length"):
        before, after = float(getattr(law, name)), float(getattr(other, name))
        assert after == before or np.isclose(after, per_length * before, rtol=1e-9, atol=0.0), (
            f"{_name(law)}: `{name}` must scale like a length; with lengths times "
            f"{per_length:g} and forces times {per_force:g} it went from {before:.6g} "
            f"to {after:.6g}"
        )
    away = _away(gaps, _kinks(law), 1e-6 * _lengths(law)[0])
    pairs = zip(_branches(law, gaps[away]), _branches(other, per_length * gaps[away]), strict=True)
    for old, new in pairs:
        for what, old_curve, new_curve, factor in (
            ("force", old.force, new.force, per_force),
            ("energy", old.energy, new.energy, per_force * per_length),
        ):
            expected = factor * np.asarray(old_curve(jnp.asarray(old.gaps)))
            got = np.asarray(new_curve(jnp.asarray(old.gaps * per_length)))
            tiny = 1e-11 * float(np.max(np.abs(expected), initial=0.0))
            text = (
                f"{_name(law)}, {old.title} branch: with lengths times {per_length:g} and forces "
                f"times {per_force:g} the {what} must scale by {factor:g}"
            )
            _compare(text, got, expected, old.gaps, tiny, 1e-8)

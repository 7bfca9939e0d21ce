"""A smooth sphere on a viscoelastic half-space, in SI units."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

import numpy as np

from ...contact.smooth import SmoothContact
from ...contact.viscoelastic import Relaxation
from ...halfspace.viscoelastic_paraboloid import Solid
from ...laws import Hertz
from ..curve_table import CENTRAL, CONTACTING, FORCE, STORED, quantities
from ..stepped_phase import Samples, SteppedPhase
from ..stepped_record import Ledger
from .sphere_motion import Bounce, Track


class SmoothBounce:
    """A smooth sphere that falls on a viscoelastic half-space.

    Parameters
    ----------
    relaxation
        The half-space, under a contact by Hertz's law.
    ledger
        What moves on what, and where it ends.

    Notes
    -----
    Units of speed, length, time and energy are those of the elastic impact.
    """

    def __init__(self, relaxation: Relaxation, ledger: Ledger) -> None:
        assert isinstance(relaxation.contact, SmoothContact)
        law, body = relaxation.contact.law, ledger.body
        assert isinstance(law, Hertz)
        gravity, release = float(body.gravity), float(body.release)
        self._speed = sqrt(float(body.speed) ** 2 + 2.0 * gravity * release)
        self._energy = float(body.mass) * self._speed**2
        stiffness = float(law.modulus) * sqrt(float(law.radius))
        self._length = (15.0 * self._energy / (16.0 * stiffness)) ** 0.4
        self._time = self._length / self._speed
        self._columns = quantities(ledger.contact).components.stop
        solid = Solid(
            float(relaxation.ratio),
            float(relaxation.time) / self._time,
            gravity * self._time / self._speed,
        )
        still, near, top = ledger.ends
        goal = -still / self._length, near / self._length
        self._bounce = Bounce(
            solid, -release / self._length, float(body.speed) / self._speed, goal,
            -top / self._length,
        )  # fmt: skip

    @property
    def threshold(self) -> float:
        """No meniscus is on its way."""
        return 0.0

    def start(self) -> Samples:
        """The sample of the release."""
        depth, speed = self._bounce.state[:2]
        first = (0.0, depth, speed, 0.0, 0.0, 0.0, 0.0)
        return self._samples([Track(*(np.array([x]) for x in first))])

    def phase(self, inwards: bool) -> SteppedPhase:
        """The phase until the body turns."""
        fate, tracks = self._bounce.follow(inwards)
        return SteppedPhase(fate, self._samples(tracks))

    def _samples(self, tracks: Sequence[Track]) -> Samples:
        """Tracks in SI units, one row a sample."""
        track = Track(*(np.concatenate(c) for c in zip(*tracks, strict=True)))
        rows = np.zeros((track.time.size, self._columns))
        force = track.force * self._energy / self._length
        contacting = (force > 0.0).astype(float)
        stored = (track.stored + track.dented) * self._energy
        spent = track.spent * self._energy
        separation = -track.depth * self._length
        columns = [FORCE, STORED, CENTRAL, CONTACTING, -1]
        rows[:, columns] = np.stack([force, stored, separation, contacting, force], axis=1)
        return Samples(
            track.time * self._time, separation, -track.speed * self._speed, rows, spent[:, None]
        )

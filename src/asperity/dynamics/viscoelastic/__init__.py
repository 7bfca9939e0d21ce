"""Motions on a bulk that creeps: stepped in time, with the usual records."""

from .viscoelastic_motion import fly_creeping

__all__ = ["fly_creeping"]

"""Motions on a bulk that creeps: stepped in time, with the usual records."""

from .viscoelastic_motion import integrate_viscoelastic

__all__ = ["integrate_viscoelastic"]

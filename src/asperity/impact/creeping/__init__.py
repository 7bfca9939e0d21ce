"""Motions on a bulk that creeps: stepped in time, with the usual records."""

from .flight import fly_creeping

__all__ = ["fly_creeping"]

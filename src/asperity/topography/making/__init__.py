"""Surfaces that are made."""

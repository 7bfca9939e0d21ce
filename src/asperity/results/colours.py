"""One colour for each quantity, in every picture and on the page."""

from __future__ import annotations

COLOURS = {
    "motion": "#0072B2",
    "central": "#56B4E9",
    "apex": "#E69F00",
    "closest_approach": "#D55E00",
    "quiet": "#888888",
    "contact": "#000000",
    "total": "#000000",
    "weight": "#888888",
    "elastic": "#0072B2",
    "adhesion": "#D55E00",
    "capillary": "#009E73",
    "gas": "#CC79A7",
    "waves": "#8C6D31",
    "kinetic": "#0072B2",
    "potential": "#C8C8C8",
    "stored": "#F0E442",
    "lost_adhesion": "#D55E00",
    "lost_capillary": "#009E73",
    "lost_gas": "#CC79A7",
    "lost_waves": "#8C6D31",
    "lost_plastic": "#E69F00",
    "lost_viscous": "#7F3C8D",
    "lost_instability": "#56B4E9",
    "loading": "#0072B2",
    "unloading": "#D55E00",
    "lost": "#F5D0B5",
}
"""Okabe and Ito's, which the colour-blind can tell apart."""

_SPARE = ("#661100", "#A05195", "#5B8C5A")  # of mechanisms of one's own


def colour(name: str) -> str:
    """The colour of a quantity; of an unknown one a spare colour, which its loss has too."""
    return COLOURS.get(name) or _SPARE[sum(map(ord, name.removeprefix("lost_"))) % len(_SPARE)]

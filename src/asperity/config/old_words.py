"""Public words of earlier versions, and what they are called now: for messages alone."""

from __future__ import annotations

RENAMED = {
    "range": "equilibrium_spacing",
    "film_thickness": "adsorbed_film_thickness",
    "closest_gap": "cutoff_separation",
    "release_gap": "release_separation",
    "rest": "rest_height_ratio",
    "pull_while_parting_only": "attraction_during_retraction_only",
    "closure": "energy_balance_error",
    "impact_time": "rebound_period",
    "stiction_time": "time_to_rest",
    "end_time": "last_apex_time",
    "deepest": "minimum_separation",
    "short": "s_filter",
    "long": "l_filter",
    "remove": "form_removal",
    "align": "line_levelling",
}
"""Keys of cases, columns of studies and options of commands, by their old names."""


def new_name(word: str) -> str:
    """The name that took the place of an old key or column, with the tables before it.

    Parameters
    ----------
    word
        A key, dotted or not, or a column. A word that was never renamed comes back as it is.
    """
    above, dot, last = word.rpartition(".")
    return f"{above}{dot}{RENAMED.get(last, last)}"

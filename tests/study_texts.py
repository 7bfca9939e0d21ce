"""Studies from a few lines of text."""

from asperity.sweeps.study.study import Study, parse

RMS = "roughness.rms_height"
HUMIDITY = "capillary.humidity"


def study(axes: str, head: str = 'base = "published"', tail: str = "") -> Study:
    """The study of some lines of [axes]."""
    return parse(f"{head}\n[axes]\n{axes}\n{tail}")


def sample(size: int, method: str = "sobol", seed: int = 1) -> Study:
    """A sampled study over four kinds of value."""
    four = f"""
        "{RMS}" = {{from = "8 nm", to = "12 nm", scale = "log"}}
        "{HUMIDITY}" = {{from = 0.2, to = 0.9}}
        "numerics.max_impacts" = {{from = 3, to = 7}}
        "adhesion.model" = {{values = ["dmt", "none"]}}
    """
    tail = f'[sample]\nmethod = "{method}"\nsize = {size}\nseed = {seed}'
    return study(four, tail=tail)


GRID = f"""
    "{RMS}" = {{from = "8 nm", to = "12 nm", steps = 5, scale = "log"}}
    "{HUMIDITY}" = {{values = [0.2, 0.4, 0.3]}}
    "adhesion.model" = {{values = ["dmt", "none"]}}
    "publication.attraction_during_retraction_only" = {{values = [true, false]}}
"""

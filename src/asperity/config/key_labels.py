"""What people call the tables and the keys of a case: one name for pages, pictures and texts."""

from __future__ import annotations

LABELS = {
    "schema": "version of the schema",
    "counterface.deformation": "deformation of the bulk",
    "roughness.asperity_density": "asperities per area",
    "roughness.asperity_radius": "tip radius",
    "roughness.files": "measured surfaces",
    "roughness.source": "asperities taken from the maps",
    "roughness.size": "size of the maps",
    "roughness.unit": "unit of the heights",
    "roughness.channel": "channel of the file",
    "roughness.missing": "missing pixels",
    "roughness.form_removal": "form that is removed",
    "roughness.line_levelling": "levelling of scan lines",
    "roughness.direction": "direction of scan lines",
    "roughness.degree": "degree of a scan line's polynomial",
    "roughness.s_filter": "shortest wavelength kept",
    "roughness.l_filter": "longest wavelength kept",
    "roughness.placement": "placement of the summits",
    "roughness.realisations": "single bodies",
    "roughness.seed": "seed of their places",
    "roughness.radius_classes": "classes of tip radius",
    "adhesion": "dry adhesion",
    "adhesion.model": "adhesion law",
    "adhesion.work": "work of adhesion",
    "adhesion.equilibrium_spacing": "equilibrium spacing of the adhesion",
    "capillary": "menisci",
    "capillary.model": "meniscus model",
    "capillary.formation": "formation of menisci",
    "capillary.humidity": "relative humidity",
    "capillary.temperature": "temperature of the vapour",
    "capillary.tension": "surface tension",
    "capillary.molar_volume": "molar volume of the liquid",
    "capillary.adsorbed_film_thickness": "thickness of the adsorbed film",
    "capillary.surface_rms_height": "rms height of the surface",
    "capillary.formation_time": "formation time of menisci",
    "plasticity": "yielding",
    "plasticity.model": "law of yielding",
    "plasticity.hardness": "hardness of what yields",
    "plasticity.yield_strength": "yield strength of what yields",
    "plasticity.yield_pressure": "pressure at which a contact yields",
    "gas": "gas in the gap",
    "gas.name": "gas",
    "gas.pressure": "gas pressure",
    "gas.temperature": "gas temperature",
    "gas.viscosity": "gas viscosity",
    "gas.cutoff_separation": "thinnest gas film",
    "waves": "elastic waves",
    "waves.model": "wave model",
    "viscoelasticity": "creep of the bulk",
    "viscoelasticity.model": "creep model",
    "viscoelasticity.relaxed_modulus_ratio": "relaxed over sudden modulus",
    "impact": "release and fall",
    "impact.release_separation": "gap at release",
    "impact.speed": "speed at release",
    "publication": "assumptions of the publication",
    "publication.attraction_during_retraction_only": "attraction during retraction alone",
    "publication.conjunction_ends": "end of the conjunction over rms height",
    "publication.capillary_factor": "factor on the force of menisci",
    "publication.polynomials": "height integrals",
    "publication.bands": "bands of menisci",
    "numerics.tolerance": "error allowed to force curves",
    "numerics.rest_height_ratio": "at rest below this share of the first rebound",
    "numerics.time_limit": "longest simulated time",
    "numerics.max_impacts": "largest number of impacts",
    "numerics.rings": "rings of the conjunction",
    "output.directory": "folder of the files",
    "output.motion": "keep the motion",
    "output.pictures": "draw pictures",
    "materials": "materials of your own",
    "materials.youngs_modulus": "Young's modulus",
    "materials.poisson": "Poisson's ratio",
}
"""Names in words of tables and keys of a case, by their dotted key, that the key itself does not
say."""


PERCENT = frozenset({"capillary.humidity"})
"""Keys of shares that people give in per cent."""


def label(key: str) -> str:
    """The name in words of a key or a table.

    Parameters
    ----------
    key : str
        Dotted key, e.g. ``capillary.humidity``, or a table, e.g. ``capillary``; a key of a
        material of one's own with its name, e.g. ``materials.my glass.density``.

    Returns
    -------
    str
        E.g. ``relative humidity``, ``menisci``, ``density of my glass``; without a capital but for
        names of persons. Of any other key its last part, with blanks.
    """
    found = LABELS.get(key)
    if found is not None:
        return found
    table, _, rest = key.partition(".")
    if table in ("body", "counterface") and rest:
        return f"{label(f'materials.{rest}')} of the {table}"
    material, _, last = rest.rpartition(".")
    if table == "materials" and material:
        return f"{label(f'materials.{last}')} of {material}"
    return key.rpartition(".")[2].replace("_", " ")

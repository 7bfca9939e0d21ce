"""Results as netCDF, as datasets, as JSON, and as folders of files."""

from asperity.results.netcdf_record import dataset, encode
from asperity.results.record_layout import attributes, json_object, plain
from asperity.results.results_folder import (
    CURVE_FILES,
    REPRODUCTION_FILES,
    RESTITUTION_FILES,
    RUN_FILES,
    SINGLE_BODY_FILES,
    SURFACE_FILES,
    check_folder,
    holds_only_results,
    write_folder,
)

__all__ = [
    "CURVE_FILES",
    "REPRODUCTION_FILES",
    "RESTITUTION_FILES",
    "RUN_FILES",
    "SINGLE_BODY_FILES",
    "SURFACE_FILES",
    "attributes",
    "check_folder",
    "dataset",
    "encode",
    "holds_only_results",
    "json_object",
    "plain",
    "write_folder",
]

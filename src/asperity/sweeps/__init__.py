"""Many cases at once: a study, its batches, a store that survives interruption.

`study`: a study file to axes and cases. `compute`: groups of one structure, integrated as batches
by threads or dask workers. `store`: one zarr array a column, one chunk a task; `store.manifest`
marks a chunk complete. `analysis`: tables, Pareto fronts, Sobol indices.
`sweep`: a grid from Python; `restitution_curve`: restitution of the first impact against speed.

The bytes of a store do not depend on who computes what.
"""

"""Bodies on a bulk that relaxes, from one turning point to the next.

`rough_phase`: a rough body, by rings (`ring_system`, `ring_step`, `ring_menisci`), whose mesh is
`fitted_mesh`'s.
`smooth_sphere`: a smooth one, exactly (`sphere_motion`).
`sample_times`: when a free flight is sampled.
"""

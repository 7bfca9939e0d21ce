"""Made surfaces: self-affine, with Gaussian or given heights."""

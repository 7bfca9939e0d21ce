"""Many cases at once: a study file, batches of one structure, and a store that survives."""

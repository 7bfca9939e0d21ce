"""The store of a study: arrays, chunks, manifest, merge, repair, and the dataset it opens as."""

"""Cases of a study computed: groups of one structure, batches, runners."""

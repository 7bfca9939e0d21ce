"""Studies of more than one case: :mod:`.reproduce` computes the seed publication again."""

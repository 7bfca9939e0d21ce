"""The frozen set: what the program answered before its walls were moved, and whether it still does.

Of its modules `structures` says which cases, from `kinds` and `forces`; `asking` computes them, by
the public names of `asperity` alone; `changing` changes their inputs by rounding's size; `work`
spreads them over processes; `rules` compares. What was answered stands in ``values.json``.
"""

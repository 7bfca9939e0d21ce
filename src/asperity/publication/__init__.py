"""The seed publication computed again: `reproduce`, `parameter_estimation`, `audit`, figures.

`published_tables`: its printed numbers. `evidence`: the runs that the audit stands on.
`comparison`: printed beside computed. `audit`: its claims, one by one. `figures`,
`surface_figures`, `figure_data`: the data of its figures. `report`: all this in words.

Nothing else imports this room but pictures and commands.
"""

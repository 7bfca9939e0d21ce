"""Mean pressure and energy between two rough planes, with the memory of every bond.

`rough_planes`: what a contact asks of all that follow.
`named_means`: which means laws ask for, and how they are put together.
`interface`: one law over one distribution of heights; its memory is a play operator.
`height_quadrature`: means over heights of laws without a closed form.
`panel_table`, `branch_pressure`: means over the separation, read from polynomials on panels.
`radius_classes`, `major_branches`, `measured_summits`: summits of several radii.
`plastic_interface`, `virgin_loading`, `residual_profile`: asperities that yield.
`layers`: interfaces side by side, such as asperities and liquid on the surface.

An interface knows a separation and a memory, and no body. What acts on one asperity alone is a
matter of `laws`; what integrates over a body's profile is a matter of `contact`.
"""

"""Numerical tools that know nothing of contact.

`height_integrals`: truncated moments F_n of the Gaussian (Greenwood and Tripp 1970).
`polynomials`: Chebyshev sums and their integrals; `splines`: cubic B-splines on even nodes.
`roots`: Newton's method between two places, and fixed points. `krylov`: linear systems, by
biconjugate gradients until little is left, or by factors. `trees`: choices between trees of arrays.
`compilation`: the one place that compiles with JAX, and that keeps compiled code on disk.

Everything takes arrays and returns arrays. A new special function or solver belongs here if it
would be as useful in a program about something else; whatever needs a law, a height or a
separation belongs in a room above. `compilation` may be changed without touching any physics.
"""

"""Liquid between one asperity and a plane: one model a file.

`meniscus`: a bridge in equilibrium with the vapour; `constant_volume`: a bridge that keeps its
volume while it is stretched, with the force and rupture of `bridge`; `kelvin_filling`: liquid in
every gap below twice the Kelvin radius times the cosine of the contact angle.
"""

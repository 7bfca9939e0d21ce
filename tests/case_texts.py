"""Texts of cases, and of tables to put beside them."""

SMALL = """
[body]
radius = "10 um"
material = "silica"
[counterface]
material = "silicon"
[impact]
speed = "0.1 m/s"
"""
"""A smooth sphere, elastic and dry."""

ROUGH = """
[roughness]
asperity_density = "10 1/um^2"
asperity_radius = "100 nm"
rms_height = "5 nm"
"""

WATER = """
[capillary]
model = "equilibrium"
liquid = "water"
humidity = 0.5
temperature = "20 degC"
contact_angle = "60 deg"
"""

LATE = 'formation_time = "1 us"\n'
"""Put after water: its menisci take time."""

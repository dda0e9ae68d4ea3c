"""Problems that several tests state: by numbers, and as the text of a case file."""

SPHERE = {
    "indenter": "sphere",
    "tabor": 3.24,
    "modulus_ratio": 0.1,
    "exponent": 0.8,
    "preload": 73.0,
    "rate": 316.23,
}
PUNCH = {
    "indenter": "punch",
    "size": 64.85,
    "thickness": 3.24,
    "cohesion": 0.05,
    "modulus_ratio": 0.1,
    "preload": 1.0,
    "rate": 10.0,
}
ELASTIC = 'model = "elastic"'
STANDARD = 'model = "sls"\nglassy_modulus = "10 MPa"\ntau0 = "1 ms"'
PRESSED = 'preload_depth = "1 um"\nspeed = "10 um/s"'


def case_text(material=ELASTIC, *, radius="1 mm", protocol=PRESSED):
    """Return the text of a case file; its last table is that of the protocol."""
    return f"""
[material]
{material}
rubbery_modulus = "1 MPa"
poisson_ratio = 0.5
[interface]
law = "lennard-jones"
work_of_adhesion = "50 mJ/m^2"
equilibrium_gap = "1 um"
[sphere]
radius = "{radius}"
[protocol]
{protocol}
"""

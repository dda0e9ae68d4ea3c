"""Problems that several tests state: by numbers, and as the text of a case file."""

from dataclasses import asdict

import viscotack as vt
from solids import creep_power_law

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
PRESSED = 'preload_depth = "1 um"\nspeed = "10 um/s"'


RUBBER = 'rubbery_modulus = "1 MPa"\npoisson_ratio = 0.5'
LAW = 'law = "lennard-jones"\nwork_of_adhesion = "50 mJ/m^2"\nequilibrium_gap = "1 um"'
# the lens of the thesis, Eq. 4.27 and section 4.6
LENS = """
[material]
model = "power-law"
rubbery_modulus = "1.458 MPa"
glassy_modulus = "3089 MPa"
exponent = 0.2207
tau0 = "18.76 ms"
poisson_ratio = 0.5

[interface]
law = "lennard-jones"
work_of_adhesion = "0.1523 J/m^2"
equilibrium_gap = "1.55 um"

[sphere]
radius = "5.19 mm"

[protocol]
preload_force = "1.5 mN"
speed = "100 um/s"
"""


def lens(speed=100e-6, **changes):
    """Return the same lens as a problem, with changes."""
    parts = {
        "material": creep_power_law(1.458e6, 3.089e9, 0.2207, 0.01876, 0.5),
        "traction": vt.LennardJones(work_of_adhesion=0.1523, equilibrium_gap=1.55e-6),
        "geometry": vt.Sphere(radius=5.19e-3),
        "protocol": vt.Retraction(start=vt.AtForce(force=1.5e-3), speed=speed),
    }
    return vt.Problem(**parts | changes)


# a pad of 2 mm on a bonded layer
PAD = """
[material]
model = "sls"
rubbery_modulus = "1.5 MPa"
glassy_modulus = "15 MPa"
tau0 = "100 ms"
poisson_ratio = 0.4
[interface]
law = "lennard-jones"
work_of_adhesion = "0.15 J/m^2"
equilibrium_gap = "1.5 um"
[punch]
half_width = "1 mm"
[layer]
thickness = "50 um"
base = "bonded"
[protocol]
preload_stress = "2 kPa"
speed = "100 um/s"
"""


def case_text(material=ELASTIC, *, radius="1 mm", protocol=PRESSED, shape=None, law=LAW):
    """Return the text of a case file; its last table is that of the protocol."""
    solid = material if "passport" in material else f"{material}\n{RUBBER}"
    shape = shape or f'[sphere]\nradius = "{radius}"'
    return f"\n[material]\n{solid}\n[interface]\n{law}\n{shape}\n[protocol]\n{protocol}\n"


def numbers(thing):
    """Return all the numbers of a problem, in order."""
    if isinstance(thing, dict | list | tuple):
        values = thing.values() if isinstance(thing, dict) else thing
        return [number for value in values for number in numbers(value)]
    if thing is None or isinstance(thing, str):
        return []
    return numbers(asdict(thing)) if hasattr(thing, "__dataclass_fields__") else [thing]

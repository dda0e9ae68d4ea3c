"""Example cases for new users, also used to warm up worker processes."""

from typing import Any

_PDMS = {
    "model": "power-law",
    "rubbery_modulus": "1.458 MPa",
    "glassy_modulus": "3089 MPa",
    "exponent": 0.2207,
    "tau0": "18.76 ms",
    "poisson_ratio": 0.5,
}
_FORCES = {
    "law": "lennard-jones",
    "work_of_adhesion": "0.1523 J/m^2",
    "equilibrium_gap": "1.55 um",
}
_RUBBER = {
    "model": "sls",
    "rubbery_modulus": "1.5 MPa",
    "glassy_modulus": "15 MPa",
    "tau0": "100 ms",
    "poisson_ratio": 0.5,
}

# Title -> tables of a case file.
EXAMPLES: dict[str, dict[str, dict[str, Any]]] = {
    "A glass lens on silicone rubber": {
        "material": _PDMS,
        "interface": _FORCES,
        "sphere": {"radius": "5.19 mm"},
        "protocol": {"preload_force": "1.5 mN", "speed": "100 um/s"},
    },
    "Pressed, held, pulled through a spring": {
        "material": _RUBBER,
        "interface": {
            "law": "lennard-jones",
            "work_of_adhesion": "50 mJ/m^2",
            "equilibrium_gap": "1 um",
        },
        "sphere": {"radius": "2 mm"},
        "protocol": {
            "start": "apart 10 um",
            "moves": ["approach 20 um/s to force 0.5 mN", "dwell 1 s"],
            "speed": "50 um/s",
            "stiffness": "500 N/m",
        },
    },
    "A shallow cone on silicone rubber": {
        "material": _PDMS,
        "interface": _FORCES,
        "cone": {"slope": 0.05},
        "protocol": {"preload_force": "1.5 mN", "speed": "100 um/s"},
    },
    "A flat punch on a soft layer": {
        "material": _RUBBER,
        "interface": {
            "law": "lennard-jones",
            "work_of_adhesion": "0.15 J/m^2",
            "equilibrium_gap": "1.5 um",
        },
        "punch": {"half_width": "1 mm"},
        "layer": {"thickness": "50 um", "base": "frictionless"},
        "protocol": {"preload_stress": "2 kPa", "speed": "100 um/s"},
    },
}
FIRST = next(iter(EXAMPLES.values()))

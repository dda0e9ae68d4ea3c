"""An invented melt: a plateau between terminal flow and the glass, with a shift that is known.

WLF in frequency, rubber elasticity and thermal expansion in the moduli; noise, and a chamber whose
temperature is not quite the one that the file states.
"""

import numpy as np

from viscotack.lab import CreepTest, FrequencySweeps, RelaxationTest
from viscotack.model.materials.shift import WLF

REFERENCE, ROOM = 243.15, 293.15
LAW = WLF(reference_temperature=REFERENCE, c1=10.0, c2=90.0)
EXPANSION = 6.5e-4  # 1/K
CHAMBER = np.array([233.15, 243.15, 253.15, 263.15, 273.15, 293.15, 313.15])
_TERMINAL = 500.0  # s


def modes():
    """Return moduli [Pa] and relaxation times [s] at the reference: reptation, then the glass."""
    p = np.arange(1.0, 40.0, 2.0)
    times = np.geomspace(1e-9, 1e-3, 25)
    moduli = np.concatenate((8 / np.pi**2 * 4e5 / p**2, 1.5e5 * (times / 1e-3) ** -0.6))
    return moduli, np.concatenate((_TERMINAL / p**2, times))


def vertical(temperature):
    """Return the factor on every modulus: rho T over that of the reference."""
    above = temperature - REFERENCE
    return temperature * np.exp(-EXPANSION * above) / REFERENCE


def melt(seed=0, *, noise=0.01, thermometer=0.2, temperatures=CHAMBER, points=20):
    """Return sweeps as a rheometer would, in shear."""
    rng = np.random.default_rng(seed)
    temperatures, hertz = np.asarray(temperatures), np.geomspace(0.01, 30, points)
    true = np.repeat(
        temperatures + thermometer * rng.standard_normal(temperatures.size), hertz.size
    )
    stated, omega = (
        grid.ravel() for grid in np.meshgrid(temperatures, 2 * np.pi * hertz, indexing="ij")
    )
    moduli, times = modes()
    phase = 1j * (omega * 10 ** LAW.log10_shift(true))[:, None] * times
    G = phase / (1 + phase) @ moduli * vertical(true)
    scatter = np.exp(noise * rng.standard_normal((2, omega.size)))
    return FrequencySweeps(
        stated,
        omega,
        G.real * scatter[0],
        G.imag * scatter[1],
        "G",
        np.repeat(np.arange(temperatures.size), hertz.size),
    )


def relaxations(seed=0, *, noise=0.01, temperatures=CHAMBER[:5]):
    """Return relaxation tests of the same melt, one for each temperature."""
    rng = np.random.default_rng(seed)
    time = np.geomspace(0.1, 30, 25)
    moduli, times = modes()
    found = []
    for T in temperatures:
        reduced = time / 10 ** LAW.log10_shift(T)
        G = np.exp(-reduced[:, None] / times) @ moduli * vertical(T)
        scatter = np.exp(noise * rng.standard_normal(time.size))
        found.append(RelaxationTest(time, G * scatter, "G", temperature=float(T)))
    return found


def creeps(seed=0, *, noise=0.01, temperatures=CHAMBER):
    """Return creep tests of a solid of a few retardation times, one for each temperature."""
    rng = np.random.default_rng(seed)
    time = np.geomspace(0.1, 300, 25)
    times = np.geomspace(1e-6, 1e4, 21)
    compliances = 1e-9 * (times / 1e-6) ** 0.3
    found = []
    for T in temperatures:
        reduced = time / 10 ** LAW.log10_shift(T)
        J = 1e-9 + -np.expm1(-reduced[:, None] / times) @ compliances
        scatter = np.exp(noise * rng.standard_normal(time.size))
        found.append(CreepTest(time, J / vertical(T) * scatter, "G", temperature=float(T)))
    return found


def swept(solid, law, temperatures, hertz, *, noise=0.0, seed=0, up=0.0):
    """Return sweeps of a solid under a law of shift; `up` is a vertical shift per kelvin."""
    hertz = np.asarray(hertz)
    T, omega = (x.ravel() for x in np.meshgrid(temperatures, 2 * np.pi * hertz, indexing="ij"))
    modulus = solid.complex_modulus(omega * 10 ** law.log10_shift(T))
    rng = np.random.default_rng(seed)
    scatter = np.exp(noise * rng.standard_normal((2, T.size))) * 10 ** (-up * (T - ROOM))
    storage, loss = modulus.real * scatter[0], modulus.imag * scatter[1]
    return FrequencySweeps(T, omega, storage, loss, "E", np.arange(T.size) // hertz.size)

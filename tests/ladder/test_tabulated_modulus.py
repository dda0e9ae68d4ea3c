"""The ladder of the crack theories from a tabulated complex modulus, and of its file."""

import numpy as np
import pytest

from solids import creep_power_law
from viscotack.model.materials import StandardSolid
from viscotack.theory import greenwood, persson_brener, tabulated_modulus
from viscotack.theory.crack.tabulated_modulus import TabulatedModulus

RUBBER = creep_power_law(1e6, 1e7, 0.6, 1e-3, 0.5)
SOLID = StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=1e-3, poisson_ratio=0.5)
GOOD = dict(
    rubbery_modulus=1e6,
    frequencies=(0.1, 1.0, 10.0, 100.0),
    storage=(1.01e6, 1.1e6, 2e6, 4e6),
    loss=(3e4, 2e5, 9e5, 3e6),
)


def sampled(material, decades, per_decade):
    """A material's own complex modulus at angular frequencies, as a table."""
    omega = np.logspace(*decades, per_decade * (decades[1] - decades[0]) + 1)
    E = material.complex_modulus(omega)
    return TabulatedModulus(
        rubbery_modulus=material.rubbery_modulus,
        frequencies=tuple(omega),
        storage=tuple(E.real),
        loss=tuple(E.imag),
    )


def inside(ends, count=9):
    """Speeds over the range of a table."""
    return np.geomspace(1.0001 * ends[0], 0.9999 * ends[1], count)


def test_a_loss_compliance_that_rises_with_the_frequency_gives_the_closed_form():
    """C'' = c omega to the end: 1/Gamma = 1 - E0 C''(omega_c)/2, the lower bound to round-off."""
    omega, stored = np.geomspace(1e-3, 1e3, 13), 1.1e6
    lossy = 4e-7 * omega / omega[-1]
    # the E'' of this E' and C''
    loss = 2 * lossy * stored**2 / (1 + np.sqrt(1 - 4 * (lossy * stored) ** 2))
    table = TabulatedModulus(1e6, tuple(omega), (stored,) * omega.size, tuple(loss))
    cutoff = np.array([0.7, 30.0, 900.0])
    gamma = 1 / (1 - 1e6 * 4e-7 * cutoff / omega[-1] / 2)
    found = tabulated_modulus.amplification(cutoff * gamma / (2 * np.pi), modulus=table)
    assert found.low == pytest.approx(gamma, rel=1e-11, abs=0)
    assert np.all(found.high > gamma)


PERSSON_BRENER = persson_brener, tabulated_modulus.amplification
GREENWOOD = greenwood, tabulated_modulus.greenwood_amplification


@pytest.mark.parametrize("material", [RUBBER, SOLID])
@pytest.mark.parametrize(
    ("theory", "last", "close", "within"),
    [(PERSSON_BRENER, 6, 1e-9, 0.1), (GREENWOOD, 9, 2e-4, 0.2)],
)
def test_a_finer_table_tends_to_the_theory_at_second_order(theory, last, close, within, material):
    """Slow, transitional and glassy cracks of a table that begins at the rubbery plateau."""
    closed, of_table = theory
    v = np.array([1e-1, 1e2, 1e4])
    exact = closed.amplification(v * material.tau0, material=material)
    error = []
    for per_decade in (8, 16, 32):
        low, high = of_table(v, modulus=sampled(material, (-4, last), per_decade))
        assert high == pytest.approx(low, rel=close, abs=0)
        error.append(np.max(np.abs((low + high) / 2 / exact - 1)))
    assert error[2] < 1e-3
    assert -np.diff(np.log2(error)) == pytest.approx(2, abs=within)


@pytest.mark.parametrize(
    ("theory", "speeds", "ends"),
    [
        *((PERSSON_BRENER, tabulated_modulus.speed_range, (first, 6)) for first in (1, 2, 3)),
        *(
            (GREENWOOD, tabulated_modulus.greenwood_speed_range, ends)
            for ends in ((1, 6), (-2, 3), (0, 5), (2, 9))
        ),
    ],
)
def test_bounds_contain_the_exact_value_where_the_table_begins_late_or_ends_early(
    theory, speeds, ends
):
    closed, of_table = theory
    table = sampled(RUBBER, ends, 64)
    v = inside(speeds(modulus=table), 50)
    low, high = of_table(v, modulus=table)
    exact = closed.amplification(v * RUBBER.tau0, material=RUBBER)
    # the error between the rows, at 64 a decade
    assert np.all(low < exact * (1 + 2e-4)) and np.all(high > exact * (1 - 2e-4))
    assert np.all(high > low)
    if theory is GREENWOOD:
        # no use at the fast end, where all of the glass is missing; two decades below it they are
        assert np.all(low >= 1) and np.all((high / low)[v < v[-1] / 100] < 1.15)


def test_a_speed_whose_cut_off_leaves_the_table_is_refused():
    table = TabulatedModulus(**GOOD)
    low, high = tabulated_modulus.speed_range(modulus=table)
    tabulated_modulus.amplification([low, high], modulus=table)
    for v in (0.99 * low, 1.01 * high):
        with pytest.raises(ValueError, match="measure a wider range"):
            tabulated_modulus.amplification(v, modulus=table)
    with pytest.raises(ValueError, match="speed must be positive"):
        tabulated_modulus.amplification(-1.0, modulus=table)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (dict(frequencies=(100.0, 10.0, 1.0, 0.1)), "must ascend"),
        (dict(frequencies=(0.1, 1.0, 100.0, 1000.0)), "gap of 2 decades"),
        (dict(loss=(3e4, 0.0, 9e5, 3e6)), "loss must be positive"),
        (dict(rubbery_modulus=2e6), "must not exceed the first storage modulus"),
        (dict(storage=(1.01e6,) * 4, loss=(9e5,) * 4), "impossible for a linear solid"),
    ],
)
def test_an_impossible_table_is_refused(change, message):
    TabulatedModulus(**GOOD)
    with pytest.raises(ValueError, match=message):
        TabulatedModulus(**(GOOD | change))

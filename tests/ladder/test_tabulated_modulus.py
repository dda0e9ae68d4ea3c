"""The ladder of Persson-Brener from a tabulated complex modulus."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from viscotack.materials import RetardationPowerLaw, StandardSolid
from viscotack.theory import persson_brener, tabulated_modulus
from viscotack.theory.tabulated_modulus import TabulatedModulus

RUBBER = RetardationPowerLaw(
    rubbery_modulus=1e6, glassy_modulus=1e7, exponent=0.6, tau0=1e-3, poisson_ratio=0.5
)
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


def inside(table, count=9):
    """Speeds over the range of a table."""
    low, high = tabulated_modulus.speed_range(modulus=table)
    return np.geomspace(1.0001 * low, 0.9999 * high, count)


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


@pytest.mark.parametrize("material", [RUBBER, SOLID])
def test_a_finer_table_tends_to_persson_brener_at_second_order(material):
    """Slow, transitional and glassy cracks of a table that begins at the rubbery plateau."""
    v = np.array([1e-1, 1e2, 1e4])
    exact = persson_brener.amplification(v * material.tau0, material=material)
    error = []
    for per_decade in (8, 16, 32):
        table = sampled(material, (-4, 6), per_decade)
        low, high = tabulated_modulus.amplification(v, modulus=table)
        assert high == pytest.approx(low, rel=1e-9, abs=0)
        error.append(np.max(np.abs(low / exact - 1)))
    assert error[2] < 1e-3
    for coarse, fine in zip(error[:-1], error[1:], strict=True):
        assert np.log2(coarse / fine) == pytest.approx(2, abs=0.1)


@pytest.mark.parametrize("first", [1, 2, 3])
def test_the_bounds_hold_the_truth_where_the_table_begins_late(first):
    table = sampled(RUBBER, (first, 6), 64)
    v = inside(table)
    low, high = tabulated_modulus.amplification(v, modulus=table)
    exact = persson_brener.amplification(v * RUBBER.tau0, material=RUBBER)
    # the error between the rows, at 64 a decade
    assert np.all(low < exact * (1 + 2e-4)) and np.all(high > exact * (1 - 2e-4))
    assert np.all(high > low)


def test_the_bounds_below_the_table_hold_for_every_relaxation_time():
    x = np.geomspace(1e-6, 1e6, 10001)
    lossy, stored = x / (1 + x**2), x**2 / (1 + x**2)
    assert np.all(lossy <= np.arctan(x) * (1 + 1e-15))
    assert np.all(np.arctan(x) <= (lossy + np.pi / 2 * stored) * (1 + 1e-15))


@given(st.floats(-6, 6), st.floats(-6, 6), st.floats(0.02, 30.0))
def test_the_amplification_does_not_depend_on_the_units(time, load, speed):
    T, M = 10**time, 10**load
    old = tabulated_modulus.amplification(speed, modulus=TabulatedModulus(**GOOD))
    scaled = dict(
        rubbery_modulus=M * 1e6,
        frequencies=tuple(T * w for w in GOOD["frequencies"]),
        storage=tuple(M * e for e in GOOD["storage"]),
        loss=tuple(M * e for e in GOOD["loss"]),
    )
    new = tabulated_modulus.amplification(T * speed, modulus=TabulatedModulus(**scaled))
    assert new == pytest.approx(old, rel=1e-9, abs=0)


def test_many_speeds_are_those_asked_one_by_one_and_rise():
    table = sampled(RUBBER, (0, 6), 8)
    v = inside(table, 3000).reshape(2, -1)
    low, high = tabulated_modulus.amplification(v, modulus=table)
    assert low.shape == v.shape
    assert np.size(tabulated_modulus.amplification([], modulus=table).low) == 0
    assert np.all(np.diff(np.ravel(low)) > 0) and np.all(np.diff(np.ravel(high)) > 0)
    for i in (0, 700, 1499):
        one = tabulated_modulus.amplification(v[1, i], modulus=table)
        assert one == pytest.approx((low[1, i], high[1, i]), rel=1e-11, abs=0)


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
        (dict(frequencies=(0.1, 1.0, 1.0, 10.0)), "must ascend"),
        (dict(frequencies=(0.1, 1.0, 100.0, 1000.0)), "gap of 2 decades"),
        (dict(loss=(3e4, 0.0, 9e5, 3e6)), "loss must be positive"),
        (dict(storage=(1.01e6, float("nan"), 2e6, 4e6)), "storage must be positive"),
        (dict(loss=(3e4, 2e5, 9e5)), "4 or more rows"),
        (dict(rubbery_modulus=2e6), "above the first storage modulus"),
        (dict(rubbery_modulus=-1.0), "rubbery_modulus must be positive"),
        (dict(storage=(1.01e6,) * 4, loss=(9e5,) * 4), "no linear solid"),
    ],
)
def test_an_impossible_table_is_refused(change, message):
    TabulatedModulus(**GOOD)
    with pytest.raises(ValueError, match=message):
        TabulatedModulus(**(GOOD | change))

import numpy as np
import pytest

import viscotack as vt
from command_line import rows_of
from synthetic import SI, energies, jkr_crack_speed, jkr_detachment, jkr_result
from viscotack.result import ShallowStart, receding_speed


def full(**changes):
    """Return a result with every part that a result may have."""
    m, n = 200 + 1, 7
    parts = dict(
        energy=energies(drive=np.linspace(0, 3, m), mode_heat=np.array([1.0, 2.0])),
        energy_residual=3e-4,
        error_estimate={"force": 1e-3, "work": 5e-3},
        versions={"viscotack": "0.0.9", "numpy": "1.26.0", "scipy": "1.12.0"},
        shallow_start=ShallowStart(1e6, 85.0, force=1e-4, work=5e-4, shift=0.01),
        events=(vt.Event("jump out of contact", 1.0, -2.0, -0.8, 0.1),),
        fields={
            "time": np.linspace(0, 1, 3),
            "radius": np.ones((3, n)),
            "pressure": np.full((3, n), -0.5),
            "gap": np.full((3, n), np.nan),
        },
    )
    return jkr_result(**(parts | changes))


@pytest.mark.parametrize(
    "result",
    [full(), full(problem=SI), jkr_result(), jkr_detachment()],
    ids=["full", "SI", "bare", "jump"],
)
def test_a_saved_result_comes_back_whole(result, tmp_path):
    vt.save(result, tmp_path / "run.npz")
    back = vt.load(tmp_path / "run.npz")
    for name in ("time", "depth", "force", "contact_radius", "edge_speed"):
        np.testing.assert_array_equal(getattr(back, name), getattr(result, name))
    for name in ("energy", "fields"):
        old, new = getattr(result, name), getattr(back, name)
        assert (old is None) == (new is None)
        old, new = (vars(x) if name == "energy" and x is not None else x for x in (old, new))
        for key in old or {}:
            np.testing.assert_array_equal(new[key], old[key])
    kept = "problem status events statistics error_estimate energy_residual shallow_start versions"
    for name in kept.split():
        assert getattr(back, name) == getattr(result, name)


def flip(path):
    data = bytearray(path.read_bytes())
    data[len(data) // 3] ^= 0xFF
    path.write_bytes(bytes(data))


def other_npz(path):
    np.savez(path, force=np.ones(3))


@pytest.mark.parametrize("damage", [flip, other_npz])
def test_a_damaged_or_foreign_file_is_named_as_such(damage, tmp_path):
    path = tmp_path / "run.npz"
    vt.save(full(), path)
    damage(path)
    with pytest.raises(ValueError, match=r"run\.npz is not a readable result of viscotack"):
        vt.load(path)


def test_a_csv_has_si_columns_with_units_for_a_problem_in_si(tmp_path):
    result = jkr_result(problem=SI)
    vt.write_csv(result, tmp_path / "run.csv")
    rows = rows_of(tmp_path / "run.csv")
    assert list(rows[0]) == [
        *("time", "depth", "force", "contact_radius", "edge_speed"),
        *("time_s", "depth_m", "force_N", "contact_radius_m", "edge_speed_m_per_s"),
    ]
    unit = SI.scales()
    factors = {
        "time_s": ("time", unit.time),
        "depth_m": ("depth", unit.length),
        "force_N": ("force", unit.force),
        "contact_radius_m": ("contact_radius", unit.radius),
        "edge_speed_m_per_s": ("edge_speed", unit.edge_speed),
    }
    for name, (plain, factor) in factors.items():
        got = np.array([float(row[name]) for row in rows])
        np.testing.assert_allclose(got, getattr(result, plain) * factor, rtol=1e-15)


def test_a_csv_of_groups_is_dimensionless_and_exact(tmp_path):
    result = jkr_detachment()
    vt.write_csv(result, tmp_path / "run.csv")
    data = np.genfromtxt(tmp_path / "run.csv", delimiter=",", names=True)
    assert data.dtype.names == ("time", "depth", "force", "contact_radius", "edge_speed")
    np.testing.assert_array_equal(data["force"], result.force)
    np.testing.assert_array_equal(data["contact_radius"], result.contact_radius)
    assert list(vt.columns(result)) == list(data.dtype.names)


def test_receding_speed_is_second_order():
    errors = []
    for steps in (100, 200, 400):
        # Away from the instability, where the speed is infinite.
        r = jkr_result(end=1.0, steps=steps)
        v = receding_speed(r.time, np.pi ** (1 / 3) * r.contact_radius)
        errors.append(np.max(np.abs(v / jkr_crack_speed(r.contact_radius) - 1)))
    slopes = -np.diff(np.log2(errors))
    assert slopes[-1] == pytest.approx(2, abs=0.15), errors
    assert errors[-1] < 1e-3


def test_receding_speed_is_not_taken_across_a_jump():
    time = np.array([0.0, 1.0, 2.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    radius = np.array([5.0, 4.0, 3.0, 1.0, 0.5, np.nan, np.nan, 0.2])
    speed = receding_speed(time, radius)
    np.testing.assert_allclose(speed[:5], [1, 1, 1, 0.5, 0.5], rtol=1e-12)
    assert np.all(np.isnan(speed[5:]))

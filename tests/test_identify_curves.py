"""Tests of fits to every curve of a folder: values, standard errors, means, refusals."""

import json

import numpy as np
import pytest
from scipy.stats import t

import tack_files
from command_line import exit_status, rows_of
from viscotack.errors import InputError
from viscotack.identify import fit_curves, group_curves, identify_slow, slow_test
from viscotack.lab import tack

SPHERE = tack_files.SPHERE
WORKS = 0.152 * np.array([0.9, 0.97, 1.0, 1.05, 1.12])


def cycle(folder, name, noise=2e-5, seed=0, camera=False, **changed):
    """Return the cycle of a curve written to a file."""
    write = tack_files.with_camera if camera else tack_files.plain
    made = tack_files.made(noise, sphere=SPHERE | changed, seed=seed)
    (folder / name).write_bytes(write(made))
    return tack.evaluate(tack.read(folder / name)[0]).cycles[0]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Write five curves of different works, and a file that is none."""
    path = tmp_path_factory.mktemp("curves")
    for number, work in enumerate(WORKS):
        cycle(path, f"{number}.csv", seed=number, work_of_adhesion=work)
    (path / "notes.txt").write_text("cleaned with ethanol\n")
    return path


def test_errors_are_those_of_the_noise(tmp_path):
    curves = [cycle(tmp_path, "a.csv", seed=seed) for seed in range(20)]
    fits, refused = fit_curves(curves, SPHERE["radius"])
    assert not refused
    for name, true in (("work_of_adhesion", 0.152), ("contact_modulus", 1e6)):
        found = [getattr(fit, name) for fit in fits]
        values = np.array([one.value for one in found])
        errors = np.array([one.uncertainty for one in found])
        assert values.mean() == pytest.approx(true, rel=0.003)
        # the scatter of 20 is known to 16 %; the corrected zero of the force adds a part
        assert 0.6 < values.std(ddof=1) / errors.mean() < 1.6
        assert np.ptp(errors) < 0.4 * errors.mean()
    noise = [fit.scatter for fit in fits]
    assert np.mean(noise) == pytest.approx(2e-5, rel=0.1)


@pytest.mark.parametrize("camera", [False, True])
def test_a_single_curve_is_as_one_slow_test_says(tmp_path, camera):
    one = cycle(tmp_path, "a.csv", camera=camera)
    ((fit,), _) = fit_curves([one], SPHERE["radius"])
    slow = identify_slow(slow_test(one, SPHERE["radius"]), models=["jkr"], level=0.6827).best
    assert fit.work_of_adhesion.value == pytest.approx(slow.work_of_adhesion, rel=1e-4)
    ends = slow.intervals["work_of_adhesion"]
    assert 2 * fit.work_of_adhesion.uncertainty == pytest.approx(ends.high - ends.low, rel=0.1)
    (group,) = group_curves([fit])
    assert group.work_of_adhesion.deviation is None and group.work_of_adhesion.low is None


def test_dmt_reads_less_work_from_the_same_pull(tmp_path):
    one = cycle(tmp_path, "a.csv")
    ((fit,), _) = fit_curves([one], SPHERE["radius"], model="dmt")
    # 2 pi R w and not 1.5 pi R w
    assert fit.work_of_adhesion.value == pytest.approx(0.75 * 0.152, rel=0.05)


def test_a_known_modulus_is_kept(tmp_path):
    one = cycle(tmp_path, "a.csv")
    ((fit,), _) = fit_curves([one], SPHERE["radius"], contact_modulus=(1.2e6, 1.2))
    assert fit.contact_modulus.value == pytest.approx(1.2e6, rel=1e-3)


def test_the_command_gives_each_curve_and_the_means(folder, tmp_path, capsys):
    table, means, picture = (tmp_path / name for name in ("a.csv", "b.csv", "c.png"))
    words = ["identify", "curves", folder, "--radius", "5 mm", "--json", "--level", "0.8"]
    words += ["--csv", table, "--repeats", means, "--plot", picture]
    assert exit_status(words) == 0
    record = json.loads(capsys.readouterr().out)
    found = [row["work_of_adhesion_J_m2"] for row in record["curves"]]
    np.testing.assert_allclose(found, WORKS, rtol=0.01)
    (row,) = record["repeats"]
    assert row["curves"] == 5 and row["work_of_adhesion_J_m2_mean"] == pytest.approx(np.mean(found))
    half = t.ppf(0.9, 4) * np.std(found, ddof=1) / np.sqrt(5)
    assert row["work_of_adhesion_high_J_m2"] == pytest.approx(np.mean(found) + half)
    assert row["work_of_adhesion_low_J_m2"] == pytest.approx(np.mean(found) - half)
    assert [float(x["work_of_adhesion_J_m2"]) for x in rows_of(table)] == found
    assert "work_of_adhesion_J_m2_mean" in means.read_text()
    assert picture.stat().st_size > 10_000


def test_speeds_have_a_mean_each(folder, tmp_path):
    slow = tack.survey([folder]).cycles
    made = tack_files.made(2e-5)
    fast = tack_files.Test(made.time / 2, made.force, made.drive, made.contact_radius, made.parts)
    (tmp_path / "f.csv").write_bytes(tack_files.plain(fast))
    both = (*tack.survey([tmp_path]).cycles, *slow)
    first, second = group_curves(fit_curves(both, SPHERE["radius"])[0])
    assert (len(first.curves), len(second.curves)) == (5, 1)
    assert second.speed == pytest.approx(2 * first.speed, rel=1e-3)


def test_what_cannot_be_fitted_is_refused(folder, tmp_path):
    cycles = tack.survey([folder]).cycles
    with pytest.raises(InputError, match="model"):
        fit_curves(cycles, 5e-3, model="maugis")
    with pytest.raises(InputError, match="level"):
        group_curves(fit_curves(cycles[:1], 5e-3)[0], level=1.0)
    fits, refused = fit_curves(cycles[:1], -5e-3)
    assert not fits and "radius" in refused[0]
    assert exit_status(["identify", "curves", folder, "--radius", "5 mm", "--model", "x"]) == 2

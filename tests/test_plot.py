import pytest
from matplotlib.figure import Figure

from picture_units import in_si
from solids import standard_solid
from synthetic import SI, jkr_result
from viscotack.plot.simulation import draw_force
from viscotack.plot.style import label_in_si, save_figure


def curve(axes):
    """Return the simulated curve of a picture."""
    (line,) = [line for line in axes.lines if line.get_label() == "simulation"]
    return line


def mark(axes):
    (line,) = [line for line in axes.lines if line.get_label().startswith("pull-off")]
    return line


def test_a_problem_in_si_is_drawn_with_readable_units():
    result = jkr_result(problem=SI)
    (axes,) = draw_force(result).axes
    unit = SI.scales()
    assert axes.get_xlabel() == "depth [µm]"
    assert axes.get_ylabel() == "force [mN]"
    assert in_si(axes.xaxis, curve(axes).get_xdata()) == pytest.approx(result.depth * unit.length)
    assert in_si(axes.yaxis, curve(axes).get_ydata()) == pytest.approx(result.force * unit.force)
    assert mark(axes).get_label() == "pull-off, 3.72 mN"
    assert in_si(axes.yaxis, mark(axes).get_ydata()) == pytest.approx(-3.7248e-3, rel=1e-4)


@pytest.mark.parametrize("speeds", [[1e-9, 1e-7], [1e-6, 1e-3], [1e-6, 1.0], [4e-3, 5e-3]])
def test_a_tick_times_the_unit_of_its_axis_is_the_data(speeds):
    forces = [5e-6, 2e-2]
    axes = Figure().subplots()
    axes.semilogx(speeds, forces, label="simulation")
    label_in_si(axes.xaxis, "speed", "m/s")
    label_in_si(axes.yaxis, "force", "N")
    assert in_si(axes.xaxis, curve(axes).get_xdata()) == pytest.approx(speeds)
    assert in_si(axes.yaxis, curve(axes).get_ydata()) == pytest.approx(forces)


def test_axes_of_a_regime_map_have_units_of_their_size():
    from viscotack.plot.design import draw_regimes
    from viscotack.theory.punch import Frictionless, Pad
    from viscotack.theory.punch.unloading import regime_map

    solid = standard_solid(0.75e6, 7.5e6, 1e-3, 0.5)
    held = {"contact_modulus": 1e6, "work_of_adhesion": 0.05, "strength": 5e4}
    pad = Pad(half_width=1e-3, **held, base=Frictionless())
    law = pad.crack_law("greenwood", material=solid)
    axes = draw_regimes(regime_map([1e-3, 2e-1], [1e-3, 1.0], pad, law)).axes[0]
    assert in_si(axes.xaxis, axes.get_xlim()) == pytest.approx([1e-3, 1.0])
    assert in_si(axes.yaxis, axes.get_ylim()) == pytest.approx([1e-3, 2e-1])


@pytest.mark.parametrize("ending", ["png", "svg"])
def test_figures_are_written_in_every_format(ending, tmp_path):
    path = tmp_path / f"run.{ending}"
    save_figure(draw_force(jkr_result()), path)
    start = {"png": b"\x89PNG", "svg": b"<?xml"}[ending]
    assert path.read_bytes().startswith(start)


def test_energy_picture_shows_where_the_work_went():
    from viscotack import AtDepth, Groups, StandardSolid, draw_energy, solve

    solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    groups = Groups(tabor=1.0, material=solid, start=AtDepth(1.0), rate=10.0)
    result = solve(groups, accuracy=8e-3, estimate_error=False)
    left, right = draw_energy(result).axes
    labels = [text.get_text() for text in left.get_legend().get_texts()]
    assert labels[:4] == ["drive work", "interface", "elastic energy", "heat in the solid"]
    curves = {line.get_label(): line.get_ydata()[-1] for line in left.get_lines()}
    work = curves.pop("drive work")
    assert sum(curves.values()) == pytest.approx(work, abs=5e-3 * abs(curves["interface"]))
    assert "retardation time" in right.get_xlabel()
    with pytest.raises(ValueError, match="contains no energies"):
        draw_energy(jkr_result())

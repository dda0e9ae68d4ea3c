"""A sphere on a film: simulated pull-off against thickness and speed, and when a film is thick.

    python benchmarks/films.py [--plot FILE.png] [--map FILE.png]

Prints, for films of a standard solid, the simulated pull-off force and how far the theory of a
crack that recedes on the film is from it (`theory.crack.contact.recede`, short range), and of the
forward model of `identify rates` (the same with a correction for the range), beside the errors that
`advise` and `identify rates` state. `--plot` draws both; `--map` draws JKR on films, without
simulation.
"""

import argparse
from dataclasses import replace
from typing import Any

import numpy as np

import viscotack as vt
from viscotack.identify.forward import Forward
from viscotack.theory import SteadyCrack, film
from viscotack.theory.crack.contact import profile_on, recede

TABOR, START = 8.0, 4.0  # radius of the start in beta
SOLID = vt.StandardSolid(rubbery_modulus=1.0, glassy_modulus=10.0, tau0=1.0, poisson_ratio=0.0)
LAW = vt.LennardJones(1.0, 1.0)
BALL = vt.Sphere(1.0)
UNITS: Any = {"contact_modulus": 1.0, "work_of_adhesion": 1.0}
_THEORY = 0.03  # of identify rates on a layer
ROOT, LOAD = np.pi ** (1 / 3), 1.5 * np.pi
GLUED, SLIDING = vt.Bonded(poisson_ratio=0.49), vt.Frictionless()
SQUEEZED, MIDDLE = vt.Bonded(poisson_ratio=0.5), vt.Bonded(poisson_ratio=0.3)
THICKNESSES = (0.1, 0.3, 1.0, 3.0, np.inf)
RATES = (0.01, 0.1, 1.0, 10.0, 100.0)  # in mu h0 per time unit of the material


def body_of(thickness: float, base: vt.Bonded | vt.Frictionless) -> vt.HalfSpace | vt.Layer:
    """Return the film of a thickness [beta], for infinity the half-space."""
    return vt.HalfSpace() if np.isinf(thickness) else vt.Layer(thickness, base)


def case(
    body: Any, rate: float, tabor: float = TABOR, ratio: float = 0.1, start: float = START
) -> vt.Groups:
    """Return a retraction from a relaxed contact, the rate in mu h0 per time unit."""
    solid = replace(SOLID, glassy_modulus=1 / ratio)
    return vt.Groups(tabor, solid, vt.AtRadius(start / ROOT), rate * tabor, body=body)


def simulated(groups: vt.Groups) -> float:
    """Return the simulated pull-off force [1.5 pi R dg]."""
    result = vt.solve(groups, until="pull-off", accuracy=5e-3, estimate_error=False)
    return result.pull_off_force


def by_crack(body: Any, rates: Any) -> Any:
    """Return the pull-off force of a receding crack of short range [1.5 pi R dg]."""
    given = np.broadcast_arrays(START, np.asarray(rates, dtype=float), TABOR)
    names = ("radius", "rate", "tabor")
    crack, profile = SteadyCrack(SOLID, LAW), profile_on(BALL, body)
    found = recede(crack, profile, **dict(zip(names, given, strict=True)))
    return -found.force.min(axis=0) / LOAD


def by_forward(groups: vt.Groups) -> tuple[float, float | None]:
    """Return the force of the forward model of `identify rates`, and its error if it applies."""
    solid: Any = groups.material
    body: Any = groups.body
    forward = Forward(solid, 1.0, body=body)
    assert groups.rate is not None and isinstance(groups.start, vt.AtRadius)
    load = profile_on(BALL, body).relaxed_force(groups.start.contact_radius * ROOT)
    case = 1.0, 1 / groups.tabor, np.array([groups.rate / groups.tabor]), np.array([load])
    found = forward.changed(case[0], case[1], case[2], case[3])
    error = None if found.refused else _THEORY + float(forward.layer_error(*case)[0])
    return float(forward.pulled(*case).force[0]) / LOAD, error


def grid() -> dict[float, list[float]]:
    """Return simulated forces of bonded films by thickness, one for each rate."""
    return {b: [simulated(case(body_of(b, GLUED), rate)) for rate in RATES] for b in THICKNESSES}


def judge(forces: dict[float, list[float]]) -> None:
    """Print the error of the receding crack beside the one that advise states."""
    found = [
        (case(body_of(b, GLUED), rate), force)
        for b, row in forces.items()
        if np.isfinite(b)
        for rate, force in zip(RATES, row, strict=True)
    ]
    others = [(SLIDING, b, TABOR, 0.1, rate) for b in (0.1, 0.3, 1.0) for rate in RATES]
    others += [(GLUED, 0.3, 16.0, 0.1, rate) for rate in RATES[1:4]]
    others += [(SQUEEZED, b, 16.0, 0.1, rate) for b in (0.3, 1.0) for rate in RATES[1:4]]
    others += [(SQUEEZED, 2.0, 16.0, 0.03, rate) for rate in RATES[1:4]]
    others += [(MIDDLE, b, 16.0, 0.1, rate) for b in (0.3, 1.0) for rate in RATES[1:4]]
    others += [(GLUED, 3.0, 5.0, 0.1, rate) for rate in RATES[1:4]]
    cases = [case(body_of(b, base), rate, mu, k) for base, b, mu, k, rate in others]
    found += [(each, simulated(each)) for each in cases]
    held, identified = [], []
    for groups, force in found:
        row = next(e for e in vt.advise(groups).estimates if e.tier == "receding crack")
        assert groups.rate is not None
        off = (row.pull_off_force or np.nan) / force - 1
        error = f"stated {row.error:.1%}" if row.error is not None else "does not apply"
        held += [abs(off) <= row.error] if row.error is not None else []
        other, stated = by_forward(groups)
        if stated is not None:
            identified.append(abs(other / force - 1) <= stated)
        print(
            f"{groups.body}, mu {groups.tabor:g}, k {groups.modulus_ratio:.2g}, rate "
            f"{groups.rate / groups.tabor:g} mu: {force:.3f}, theory {off:+.1%}, {error}; "
            f"of identify {other / force - 1:+.1%}, "
            + ("does not apply" if stated is None else f"stated {stated:.1%}"),
            flush=True,
        )
    for name, inside in (("advise", held), ("identify", identified)):
        print(f"{name}: of {len(found)} applies to {len(inside)}, {sum(inside)} within its error")


def judge_small_starts() -> None:
    """Print the error of the forward model for starts little larger than the pull-off.

    The edge travels 12 to 29 zones.
    """
    rows = [(1.0, 3.0, 30.0, 0.1, 2.73), (3.0, 0.3, 30.0, 0.1, 2.4)]
    rows += [(2.0, 0.3, 40.0, 0.03, 2.73), (2.0, 1.0, 30.0, 0.03, 2.73)]
    for b, *other in rows:
        groups = case(body_of(b, GLUED), *other)
        (found, error), force = by_forward(groups), simulated(groups)
        stated = "does not apply" if error is None else f"stated {error:.1%}"
        print(f"{b:g} beta, start {other[-1]:g} beta: {found / force - 1:+.1%}, {stated}")


def draw(forces: dict[float, list[float]], path: str) -> None:
    """Draw simulated forces and those of the theory against speed, and against thickness."""
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.0), layout="constrained")
    rates = np.geomspace(1e-3, 1e3, 61)
    colours = plt.get_cmap("viridis")(np.linspace(0.0, 0.9, len(forces)))
    for colour, (thickness, force) in zip(colours, forces.items(), strict=True):
        name = "half-space" if np.isinf(thickness) else rf"$b = {thickness:g}\,\beta$"
        left.loglog(RATES, force, "o", color=colour)
        left.loglog(rates, by_crack(body_of(thickness, GLUED), rates), color=colour, label=name)
    left.set(xlabel=r"speed [$\beta^2/(R\,\tau_0)$]")
    left.set_ylabel(r"pull-off force [$1.5\,\pi R\,\Delta\gamma_0$]")
    title = "circles: simulated, Tabor number 8; lines: theory, forces of short range"
    figure.suptitle(title, fontsize=10)
    left.legend(frameon=False)
    thick = np.geomspace(0.05, 20.0, 25)
    rows = np.array([by_crack(body_of(b, GLUED), RATES) for b in thick])
    whole = by_crack(vt.HalfSpace(), RATES)
    finite = [b for b in forces if np.isfinite(b)]
    for i, rate in enumerate(RATES):
        (line,) = right.semilogx(thick, rows[:, i] / whole[i], label=f"{rate:g}")
        ratios = [forces[b][i] / forces[np.inf][i] for b in finite]
        right.semilogx(finite, ratios, "o", color=line.get_color())
    right.axhline(1.0, color="0.8", lw=0.8, zorder=0)
    right.set(xlabel=r"thickness [$\beta$]", ylabel="pull-off force, film over half-space")
    right.legend(frameon=False, title=r"speed [$\beta^2/(R\,\tau_0)$]")
    figure.savefig(path, dpi=130)


def draw_map(path: str) -> None:
    """Draw the pull-off force of JKR over the half-space's, and where it differs by little."""
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.0), layout="constrained")
    thick = np.geomspace(1e-3, 20.0, 60)
    ratios = (0.0, 0.3, 0.45, 0.49, 0.5)
    bases: list[Any] = [SLIDING, *(vt.Bonded(poisson_ratio=nu) for nu in ratios)]
    names = ["sliding", *(rf"bonded, $\nu = {nu:g}$" for nu in ratios)]
    colours = plt.get_cmap("viridis")(np.linspace(0.0, 0.9, len(bases)))
    whole = film.pull_off(shape=BALL, body=vt.HalfSpace(), **UNITS)
    for base, name, colour in zip(bases, names, colours, strict=True):
        ends = [film.pull_off(shape=BALL, body=vt.Layer(b, base), **UNITS) for b in thick]
        force = np.array([float(end.force / whole.force) for end in ends])
        radius = np.array([float(end.contact_radius) for end in ends])
        style = "--" if base is SLIDING else "-"
        left.semilogx(thick, force, style, color=colour, label=name)
        right.loglog(radius / thick, np.abs(force - 1), style, color=colour, label=name)
    left.set(xlabel=r"thickness $b/\beta$", ylabel="pull-off force, film over half-space")
    for limit, words in ((4 / 3, r"$2\pi R\Delta\gamma$"), (2.0, r"$3\pi R\Delta\gamma$")):
        left.axhline(limit, color="0.8", lw=0.8, zorder=0)
        left.text(20.0, limit - 0.01, words, ha="right", va="top", fontsize=9, color="0.4")
    left.legend(frameon=False, fontsize=8, loc="center right", bbox_to_anchor=(1.0, 0.72))
    right.set(
        xlabel="contact radius at pull-off over thickness",
        ylabel="difference from the half-space",
        xlim=(0.05, 20.0),
        ylim=(1e-3, 1.2),
    )
    right.set_title("below a line: a half-space to this tolerance", fontsize=10)
    for part in (0.01, 0.05, 0.1):
        right.axhline(part, color="0.8", lw=0.8, zorder=0)
        right.text(19.0, part * 1.04, f"{part:.0%}", ha="right", fontsize=9, color="0.4")
    figure.savefig(path, dpi=130)


def main() -> None:
    """Print the comparison, and draw what is asked for."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--plot", default="")
    options.add_argument("--map", default="")
    asked = options.parse_args()
    if asked.map:
        draw_map(asked.map)
        return
    forces = grid()
    if asked.plot:
        draw(forces, asked.plot)
    judge(forces)
    judge_small_starts()


if __name__ == "__main__":
    main()

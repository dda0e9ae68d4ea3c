"""The command of a contact whose edge is a steady crack: any Tabor number above a few, at once."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer
from typer import Option

from viscotack.files.whole import write_whole
from viscotack.methods.by_crack import CrackContact, crack_contact
from viscotack.methods.by_crack import summary as summary_of
from viscotack.operations.declare.questions import SPHERE
from viscotack.problem import Groups, Problem

from .asking import asking
from .commands import AsJson, CaseFile, PlotFile, With, stated_problem, wrong_input
from .theory import theory
from .writing import Writing, check_files

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@theory.command("crack-contact", cls=asking(SPHERE.questions))
def _crack_contact(
    context: typer.Context,
    case: CaseFile = None,
    own: With = None,
    curve: Annotated[
        Path | None,
        Option("--curve", metavar="FILE", help="Write the history as CSV, dimensionless."),
    ] = None,
    plot_file: PlotFile = None,
    as_json: AsJson = False,
) -> None:
    """Follow a contact whose edge is the steady crack of its solid and law.

    The problem is stated as for simulate sphere, by flags or by a file in SI. No fitted constant;
    any Tabor number above a few, in a tenth of a second where a simulation takes minutes.

    Example: viscotack theory crack-contact --tabor 10000 --material sls --modulus-ratio 0.1
    --preload 200000 --rate 10000
    """
    with wrong_input():
        check_files({"--plot": plot_file, "--curve": curve})
        problem = stated_problem(case, context, SPHERE, own)
        assert isinstance(problem, Problem | Groups)
        found = crack_contact(problem)
    answer = summary_of(found)
    write = Writing()
    if curve is not None:
        write_whole(curve, _table(found).encode())
    write.picture(plot_file, lambda: _drawn(found))
    write.answer(json.dumps(answer, indent=2, allow_nan=False) if as_json else _words(answer))
    write.end()


def _table(found: CrackContact) -> str:
    names = ("time", "depth", "force", "contact_radius", "edge_speed", "amplification", "move")
    rows = zip(*(getattr(found, name).tolist() for name in names), strict=True)
    lines = [",".join(map(repr, row)) for row in rows]
    return "\n".join([",".join(names), *lines]) + "\n"


def _drawn(found: CrackContact) -> "Figure":
    from matplotlib.figure import Figure

    figure = Figure(layout="constrained")
    axes = figure.subplots()
    axes.plot(found.depth, found.force)
    if found.pull_off_depth is not None and found.pull_off_force is not None:
        band = found.band * found.pull_off_force
        axes.errorbar(found.pull_off_depth, -found.pull_off_force, yerr=band, fmt="o", capsize=3)
    axes.set_xlabel("depth / h0")
    axes.set_ylabel("force / (1.5 pi R dg0)")
    axes.axhline(0.0, color="0.7", linewidth=0.8)
    return figure


def _words(answer: dict[str, Any]) -> str:
    lines = []
    for name, value in answer.items():
        if isinstance(value, float | np.floating):
            lines.append(f"  {name:<36}{value:>14.6g}")
        elif value is None:
            lines.append(f"  {name:<36}{'-':>14}")
        elif isinstance(value, list):
            lines.append(f"  {name:<36}{value[0]:>14.6g} to {value[1]:.6g}")
        else:
            lines.append(f"  {name:<36}{value}")
    return "\n".join(lines)

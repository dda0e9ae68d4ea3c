"""The command ``viscotack edge-energy``: what the edge of a simulated contact takes, by speed."""

import json
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from typer import Argument

from viscotack.errors import InputError
from viscotack.problem.nouns import own_nouns

from .commands import AsJson, PlotFile, With, application, wrong_input
from .writing import Writing, check_files

# Rows of the table that a person reads.
_ROWS = 8


@application.command("edge-energy")
def edge_energy_command(
    file: Annotated[Path, Argument(metavar="FILE.npz", help="A result that --save wrote.")],
    plot_file: PlotFile = None,
    own: With = None,
    as_json: AsJson = False,
) -> None:
    """Read the energy at the edge off a simulated pull-off, against the speed that the edge had.

    Of a sphere that is pulled off a relaxed contact. Fits Gent and Schultz's relation to the
    energies, says which part of them the bulk takes and which the interface, and how steep the
    surface is at the edge.

    Example: viscotack simulate sphere lens.toml --save lens.npz, then viscotack edge-energy
    lens.npz --plot edge.png
    """
    with wrong_input():
        check_files({"--plot": plot_file}, as_json=as_json, reads=(file,))
        if file.is_dir():
            raise InputError(f"{file} is a folder; give the name of a file")
        from viscotack.pictures.edge_energy import draw_edge_energy
        from viscotack.result import load
        from viscotack.result.edge_energy import edge_energy

        result = load(file, also=own_nouns(own or ()))
        found = edge_energy(result)
        unit = "m/s" if result.scales is not None else "(R^2 dg/E0*)^(1/3) per time unit"
        answer: dict[str, Any] = {
            "speed": found.speed.tolist(),
            "amplification": found.amplification.tolist(),
            "bulk": found.bulk.tolist(),
            "interface": found.interface.tolist(),
            "unit_of_speed": unit,
            "reference_speed": found.reference_speed,
            "exponent": found.exponent,
            "strain": found.strain,
            "words": list(found.words),
        }
    write = Writing()
    write.picture(plot_file, lambda: draw_edge_energy(found, unit))
    write.answer(json.dumps(answer, indent=2, allow_nan=False) if as_json else _words(answer))
    write.end()


def _words(answer: dict[str, Any]) -> str:
    """Return the answer as lines a person reads: some rows, evenly over the logarithm of speed."""
    speed = np.array(answer["speed"])
    wanted = np.geomspace(speed.min(), speed.max(), _ROWS)
    near = {int(np.argmin(np.abs(np.log(speed / v)))) for v in wanted}
    rows = sorted(near, key=lambda i: speed[i])
    columns = ("speed", "amplification", "bulk", "interface")
    lines = [f"speed of the edge in {answer['unit_of_speed']}, energies in works of adhesion"]
    lines += ["  ".join(f"{name:>13}" for name in columns)]
    lines += ["  ".join(f"{answer[name][i]:>13.4g}" for name in columns) for i in rows]
    v0, n = answer["reference_speed"], answer["exponent"]
    lines.append(f"Gent and Schultz: 1 + (v/v0)^n with v0 {v0:.4g} and n {n:.3f}")
    return "\n".join([*lines, *answer["words"]])

"""Predict, or compare with, the pull-offs of a microsphere: ``README.md`` has the question.

``python -m research.measured_series REPOSITORY --predict`` opens only the single tests at 20 nm/s
in the git directory of github.com/Tour712/Nanoindentation_Analysis and writes `predictions.csv`.
Three minutes.
Without `--predict` it reads the tests at the other speeds too, and writes `comparison.csv` and
`comparison.png`, from the predictions that are kept. `--cycles` simulates nine cycles of partial
unloading beside a single test.
"""

import argparse
import csv
from dataclasses import asdict
from pathlib import Path

from .comparison import draw, table
from .cycles import grown
from .prediction import SINGLE, exact_sphere_over_parabola, layer_over_half_space, measured, rows

HERE = Path(__file__).parent
THICKNESSES = (10e-6, 20e-6, 50e-6, 100e-6)  # m


def predict(repository: Path) -> None:
    predicted: list[dict[str, str | float]] = []
    for solid in SINGLE:
        test = measured(repository, solid)
        print(
            f"{solid}: E0* {test.contact_modulus / 1e6:.3f} MPa,"
            f" work {test.work_of_adhesion * 1e3:.1f} mJ/m2 (JKR),"
            f" jump-in {test.jump_in_force * 1e9:.0f} nN,"
            f" pull-off {test.pull_off_force * 1e9:.0f} nN"
        )
        force, radius = exact_sphere_over_parabola(test)
        print(f"  exact sphere: {force:.3f} of the pull-off force, at a/R {radius:.2f}")
        for thickness in THICKNESSES:
            ratio = layer_over_half_space(test, thickness)
            print(f"  bonded layer of {thickness * 1e6:.0f} um: {ratio:.3f} of the pull-off force")
        predicted += [asdict(row) for row in rows(solid, test)]
    write(predicted, HERE / "predictions.csv")


def write(rows: list[dict[str, str | float]], path: Path) -> None:
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow({k: f"{v:.4g}" if isinstance(v, float) else v for k, v in row.items()})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("repository", type=Path, help="git directory of the raw curves")
    parser.add_argument("--predict", action="store_true", help="predict, and open no other speed")
    parser.add_argument("--cycles", action="store_true", help="simulate cycles on PDMS")
    chosen = parser.parse_args()
    if chosen.cycles:
        for name, force, time in grown(measured(chosen.repository, "PDMS")):
            print(f"{name}: {force:.4f} of the force after {time:.2f} times as long in contact")
        return
    if chosen.predict:
        predict(chosen.repository)
        return
    found = table(chosen.repository, HERE / "predictions.csv")
    write(found, HERE / "comparison.csv")
    draw(found, HERE / "comparison.png")


if __name__ == "__main__":
    main()

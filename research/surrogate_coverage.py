"""What `viscotack.predict` holds on fresh cases: coverage, abstentions and the worst errors.

`python -m research.surrogate_coverage --seed 41 --labels FOLDER [--counts ...]`: the cases of
`training/fresh_cases.py` beside the surrogates alone (a budget of milliseconds). A curve is
compared at every simulated step between zero force (or a start in tension) and the pull-off.
"""

import argparse
from dataclasses import dataclass
from typing import Any

import numpy as np

from research.training.fresh_cases import Case, add_draw, counts_of, drawn, labelled
from research.training.scores import curve_error
from viscotack import OutOfRange, predict
from viscotack.arrays import Array
from viscotack.prediction.prediction import Prediction
from viscotack.prediction.tiers import AT_ONCE

# Quantities whose intervals are judged, and an error that must not be silent.
OF, SILENT = ("force", "work", "curve"), 0.1


@dataclass(frozen=True)
class Judged:
    """One prediction beside its simulation.

    `ratio` has the errors of `OF` over the half widths of their intervals on that side, nan where
    not predicted; `off` the relative errors of force and work; `joint` is 1 if force, work and
    curve lie in the joint intervals, otherwise 0, nan without them.
    """

    case: Case
    ratio: Array
    off: Array
    joint: float


def judged(case: Case, label: dict[str, Any]) -> Judged:
    """Compare the prediction of a case with its label, which may be empty if there is none."""
    try:
        said, joint = (predict(case.problem, budget=AT_ONCE, joint=x) for x in (False, True))
    except OutOfRange:
        none = np.full(len(OF), np.nan)
        return Judged(case, none, none[:2], np.nan)
    together = np.max(ratios(joint, label)) <= 1 if joint.joint else np.nan
    off = np.full(2, np.nan)
    off[0] = abs(said.pull_off_force / label["force"] - 1)
    if said.work_to_pull_off is not None:
        off[1] = abs(said.work_to_pull_off / label["work"] - 1)
    return Judged(case, ratios(said, label), off, float(together))


def ratios(said: Prediction, label: dict[str, Any]) -> Array:
    """Return errors of `OF` over the half widths of their intervals; nan where not predicted."""
    found = np.full(len(OF), np.nan)
    found[0] = _over(label["force"], said.pull_off_force, said.interval)
    if said.work_to_pull_off is not None and said.work_interval is not None:
        found[1] = _over(label["work"], said.work_to_pull_off, said.work_interval)
    if said.curve is not None and said.curve_band is not None:
        found[2] = curve_error(said.curve, label) / said.curve_band
    return found


def _over(true: float, value: float, ends: tuple[float, float]) -> float:
    """Return an error over the half width on its side, which may be none at a proven limit."""
    end = ends[1] if true > value else ends[0]
    return abs(true / value - 1) / max(abs(end / value - 1), 1e-12)


def report(some: list[Judged]) -> str:
    """Return one line of figures for some cases."""
    ratio = np.array([one.ratio for one in some])
    off = np.array([one.off for one in some])
    answered = np.isfinite(ratio[:, 0])
    known, with_work = ratio[answered], np.isfinite(ratio[answered, 1])
    if not len(known):
        return f"{len(some)} | 0 % | | | | | | | |"
    held = [np.mean(x[np.isfinite(x)] <= 1) if np.isfinite(x).any() else np.nan for x in known.T]
    joints = np.array([one.joint for one in some])
    joint = np.nanmean(joints) if np.isfinite(joints).any() else np.nan
    worst = np.nanmax(known, axis=0) if with_work.any() else known.max(axis=0)
    silent = np.nansum((off[answered] > SILENT) & (known[:, :2] > 1), axis=0)
    most = np.nanmax(off[answered], axis=0) if with_work.any() else off[answered].max(axis=0)
    shares = " | ".join(f"{100 * x:.1f} %" if x == x else "" for x in (*held, joint))
    return (
        f"{len(some)} | {100 * answered.mean():.1f} % | {100 * with_work.mean():.1f} % | {shares} "
        f"| {', '.join(f'{x:.1f}' for x in worst)} | {', '.join(f'{x:.1%}' for x in most)} | "
        f"{silent[0]}, {silent[1]} |"
    )


def table(found: list[Judged]) -> str:
    """Return a table of figures, a row for each design."""
    lines = [
        "| design | cases | answered | of these with work | held: force | work | curve | "
        "all, joint | worst, half widths | worst, force and work | "
        "silently off by more than 10 % |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---|---|---|",
    ]
    for design in dict.fromkeys(one.case.design for one in found):
        some = [one for one in found if one.case.design == design]
        lines.append(f"| {design} | {report(some)}")
    return "\n".join([*lines, f"| all | {report(found)}"])


def main() -> None:
    """Judge and print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    add_draw(parser)
    given = parser.parse_args()
    cases = drawn(given.seed, counts_of(given.counts))
    known = labelled(cases, given.labels, given.accuracy)
    found = [judged(case, label) for case, label in known if "failed" not in label]
    print(table(found))


if __name__ == "__main__":
    main()

"""The command ``viscotack predict``: one contact, or a table of thousands, answered at once."""

import json
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from typer import Argument, Option

from viscotack.app.questions import PUNCH, SPHERE, SPHERE_OR_PUNCH, given_of
from viscotack.errors import InputError
from viscotack.forecast import predict
from viscotack.forecast.prediction import Prediction, prediction_summary
from viscotack.forecast.tiers import SOON
from viscotack.problem import Case
from viscotack.problem.outputs import Kind
from viscotack.result import Outcome, Result
from viscotack.result.observables import summary

from .asking import answers, asking
from .commands import (
    AsJson,
    CaseFile,
    With,
    application,
    deviation_of_shift,
    stated_problem,
    wrong_input,
)
from .writing import Writing, check_files

# What is predicted of numbers alone.
_DOORS = {door.word: door for door in (SPHERE, PUNCH)}
# What a simulation would only repeat.
_SAID_ONCE = (
    "problem",
    "run_id",
    "tabor",
    "size",
    "thickness",
    "cohesion",
    "modulus_ratio",
    "rate",
)


@application.command("predict", cls=asking(SPHERE_OR_PUNCH))
def _predict(
    context: typer.Context,
    what: Annotated[
        str,
        Argument(
            metavar="sphere|punch|CASE.toml|CASES.csv",
            help="The word sphere or punch, and flags as for simulate sphere or simulate punch, in "
            "their units (forces of a punch are stresses in sigma0); or a problem in SI; or a "
            "table with a case in each row: tabor, modulus_ratio, exponent, rate and one of "
            "preload, preload_force, preload_radius; or size, thickness, cohesion, modulus_ratio, "
            "rate and preload or preload_force.",
            show_default=False,
        ),
    ],
    confidence: Annotated[
        float,
        Option(
            "--confidence",
            metavar="PART",
            help="Part of the cases that the intervals are to hold: 0.5, 0.6, 0.7, 0.8, 0.9, "
            "0.95 or 0.98.",
        ),
    ] = 0.9,
    budget: Annotated[
        float,
        Option(
            "--budget",
            metavar="SECONDS",
            help="Time that the answer may take: surrogates up to 0.01, closed forms from 0.02, "
            "the steady-crack contact from 0.5, the simulation from 3.",
        ),
    ] = SOON,
    exact: Annotated[bool, Option("--exact", help="Simulate, whatever it takes.")] = False,
    compare: Annotated[
        bool, Option("--compare", help="Simulate as well, and say how far off the prediction is.")
    ] = False,
    curve_file: Annotated[
        Path | None,
        Option(
            "--curve",
            metavar="FILE",
            help="Write the predicted unloading curve as a table; - is standard output.",
        ),
    ] = None,
    plot_file: Annotated[
        Path | None,
        Option("--plot", metavar="FILE", help="Draw that curve to a .png, .pdf or .svg file."),
    ] = None,
    csv_file: Annotated[
        Path | None,
        Option(
            "--csv",
            metavar="FILE",
            help="Where the rows of CASES.csv go, with their answers; - is standard output.",
        ),
    ] = None,
    case: CaseFile = None,
    own: With = None,
    as_json: AsJson = False,
) -> None:
    """Predict the pull-off force, with an interval.

    Surrogates trained on simulations answer in a millisecond, with force, work and curve. Outside
    of their range the theory with the narrowest band that was verified for such a problem gives the
    force. Otherwise the command states which input is out of range; --exact simulates the problem.

    One contact: viscotack predict sphere --tabor 3.24 --modulus-ratio 0.1 --exponent 0.8
    --preload 73 --rate 316.23

    A flat punch on a layer: viscotack predict punch --size 64.85 --thickness 3.24 --cohesion 0.05
    --modulus-ratio 0.1 --preload 1 --rate 10

    In SI, beside its simulation: viscotack predict lens.toml --compare --plot lens.png

    Thousands: viscotack predict cases.csv --csv answers.csv
    """
    is_table, write = Path(what).suffix.lower() == ".csv", Writing()
    files = {"--plot": plot_file, "--curve": curve_file, "--csv": csv_file}
    result = None
    with wrong_input():
        check_files(files, as_json=as_json, reads=() if is_table else (Path(what), case))
        if is_table:
            others = {
                "--compare": compare,
                "--exact": exact,
                "--budget": None if budget == SOON else budget,
                "--curve": curve_file,
                "--plot": plot_file,
                "the second file": case,
            }
            others |= {f"--{name}": value for name, value in given_of(answers(context)).items()}
            _refuse(others, f"{what} is a table of cases")
            from .predict_table import predict_file

            answer = predict_file(Path(what), csv_file, confidence, write)
            words = _counts(answer)
        else:
            _refuse({"--csv": csv_file}, "--csv is for a table CASES.csv; --curve writes the curve")
            problem = _problem(what, case, context, own)
            case = case if what in _DOORS else Path(what)
            deviation = deviation_of_shift(case, context, own)
            wish = {"confidence": confidence, "budget": budget, "exact": exact}
            found = _predicted(problem, deviation, curve_file or plot_file, wish)
            result = _simulated(problem) if compare else None
            answer = prediction_summary(found)
            if result is not None:
                answer |= _comparison(found, result)
            words = _words(found, answer)
            _write(found, result, curve_file, plot_file, write)
    write.answer(json.dumps(answer, indent=2, allow_nan=False) if as_json else words)
    write.end()
    if result is not None and result.outcome is Outcome.STOPPED:
        raise typer.Exit(1)


def _refuse(others: dict[str, Any], why: str) -> None:
    given = [name for name, value in others.items() if value is not None and value is not False]
    if given:
        raise InputError(f"{why}; leave out {', '.join(given)}")


def _problem(what: str, case: Path | None, context: typer.Context, own: list[Path] | None) -> Case:
    door = _DOORS.get(what)
    if door is None:
        if case is not None:
            raise InputError(f"give one file, got {what} and {case}")
        if not Path(what).suffix:
            raise InputError(
                "predictions are for 'sphere', 'punch', a file CASE.toml or a table CASES.csv, got "
                f"{what!r}"
            )
        case = Path(what)
    elif case is None:
        asked = {question.name for question in door.questions}
        others = [f"--{name}" for name in given_of(answers(context)) if name not in asked]
        if others:
            raise InputError(f"a {what} is not asked {', '.join(others)}; leave it out")
    return stated_problem(case, context, door if case is None else None, own)


def _predicted(
    problem: Case, deviation: float, curve_wanted: Path | None, wish: dict[str, Any]
) -> Prediction:
    found = predict(problem, shift_deviation=deviation, **wish)
    if found.curve is None and curve_wanted:
        raise InputError(
            f"{found.why}. The tier {found.method!r} gives no curve; leave out --curve and "
            "--plot, or simulate"
        )
    return found


def _simulated(problem: Case) -> Result:
    from viscotack.methods import solve

    return solve(problem, until="pull-off", throw=False)


def _compared(kind: Kind) -> dict[str, str]:
    """Return what of both answers is compared, with the name of its interval."""
    return {f"pull_off_{kind.name_of('force')}": "interval", "work_to_pull_off": "work_interval"}


def _comparison(found: Prediction, result: Result) -> dict[str, Any]:
    """Return the simulated numbers, how far off the predicted ones are, and what the interval did.

    `difference` is prediction over simulation, less 1.
    """
    simulated = summary(result)
    answer: dict[str, Any] = {
        "simulation": {name: x for name, x in simulated.items() if name not in _SAID_ONCE}
    }
    predicted = prediction_summary(found)
    compared = _compared(found.problem.groups().outputs)
    difference: dict[str, float | None] = dict.fromkeys(compared)
    held: dict[str, bool | None] = dict.fromkeys(compared)
    for name, interval in compared.items():
        true = simulated[name]
        if predicted[name] is not None and true is not None:
            difference[name] = predicted[name] / true - 1
            if predicted[interval] is not None:
                low, high = predicted[interval]
                held[name] = low <= true <= high
    return answer | {"difference": difference, "interval_held": held}


def _write(
    found: Prediction,
    result: Result | None,
    curve_file: Path | None,
    plot_file: Path | None,
    write: Writing,
) -> None:
    if curve_file is not None:
        from .predict_table import write_table

        table = _curve(found)
        write("wrote", curve_file, lambda file: write_table(table, file))
    if plot_file is not None:
        from viscotack.pictures.forecast import draw_prediction

        write.picture(plot_file, lambda: draw_prediction(found, result))


def _curve(found: Prediction) -> dict[str, Any]:
    """Return the columns of the curve, as `simulate --csv` names them."""
    assert found.curve is not None, "checked before anything is written"
    groups = found.problem.groups()
    kind = groups.outputs
    names = {kind.name_of(name): name for name in ("depth", "force", "contact_radius")}
    table = {
        name: np.asarray(getattr(found.curve, of)) * kind.series[name].factor(groups)
        for name, of in names.items()
    }
    if (scales := found.problem.scales()) is not None:
        units = {name: kind.series[name].unit for name in names}
        table |= {f"{n}_{u.tail}": table[n] * getattr(scales, u.scale) for n, u in units.items()}
    return table


def _words(found: Prediction, answer: dict[str, Any]) -> str:
    """Return a prediction as lines a person reads."""
    lines = [found.why if found.inside else f"outside of the surrogates: {found.why}"]
    held = (
        "not measured," if found.confidence is None else f"{100 * found.confidence:.4g} % between"
    )
    kind = found.problem.groups().outputs
    intervals = _compared(kind) | {"pull_off_depth": "depth_interval"}
    for name, observable in kind.observables.items():
        told = observable.words, observable.unit, intervals.get(name)
        lines += _number_words(name, *told, answer, held)
    force, depth = kind.name_of("force"), kind.observables["pull_off_depth"].unit
    told = f"depth at zero {force}", depth, f"zero_{force}_interval"
    lines += _number_words(f"zero_{force}_depth", *told, answer, held)
    if "simulation" in answer:
        lines += _comparison_words(answer, kind)
    return "\n".join(lines)


def _number_words(
    name: str, words: str, unit: Any, interval: str | None, answer: dict[str, Any], held: str
) -> list[str]:
    """Return a number and its interval as lines, none where the answer has it not."""
    if (value := answer.get(name)) is None:
        return []
    line = f"  {words:<21}{value:>12.5g}  {unit.text:<30}"
    if f"{name}_{unit.tail}" in answer:
        line += f"= {answer[f'{name}_{unit.tail}']:.4g} {unit.si}"
    if interval is None or answer[interval] is None:
        return [line.rstrip()]
    low, high = answer[interval]
    between = f"    {held:<19}{low:>12.5g}  and {high:<26.5g}"
    if f"{interval}_{unit.tail}" in answer:
        low, high = answer[f"{interval}_{unit.tail}"]
        between += f"= {low:.4g} to {high:.4g} {unit.si}"
    return [line.rstrip(), between.rstrip()]


def _comparison_words(answer: dict[str, Any], kind: Kind) -> list[str]:
    simulated = answer["simulation"]
    took = simulated["wall_time_s"]
    lines = ["simulated" + ("" if took is None else f" in {took:.2g} s")]
    for name in _compared(kind):
        words, true = kind.observables[name].words, simulated[name]
        if true is None:
            why = simulated.get(f"{name}_note") or simulated["status"]
            lines.append(f"  {words:<21}{'none':>12}  {why}")
            continue
        line = f"  {words:<21}{true:>12.5g}"
        if (off := answer["difference"][name]) is not None:
            way = "above" if off >= 0 else "below"
            line += f"  the prediction is {abs(off):.2%} {way}"
            if (held := answer["interval_held"][name]) is not None:
                line += f"; {'inside' if held else 'outside'} its interval"
        lines.append(line)
    return lines


def _counts(answer: dict[str, Any]) -> str:
    lines = [f"{answer['rows']} rows, {answer['inside']} inside what was learned from"]
    for method, count in answer["methods"].items():
        lines.append(f"  {method:<14}{count:>8}")
    if answer["unanswered"]:
        lines.append(f"  {'no answer':<14}{answer['unanswered']:>8}  the column why says it")
    return "\n".join(lines)

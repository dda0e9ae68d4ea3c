"""The operations ``predict`` and ``advise``: fast predictions and their reliability."""

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from viscotack.errors import InputError

from .options import binary_file, contact, csv_file, number, picture, quoted, rows, switch
from .parts.record_words import units_of
from .request import Answer, Caller, Request
from .simulate import HowLong

if TYPE_CHECKING:
    from viscotack.model.problem.outputs import Kind
    from viscotack.prediction.advice import Advice
    from viscotack.prediction.prediction import Prediction
    from viscotack.result import Result

# Meaning of the intervals of a prediction.
OF_METHOD = "Intervals are the error of the method; material and interface are taken as given."
# What a simulation would only repeat, and what the text leaves out.
_INPUTS = ("tabor", "size", "thickness", "cohesion", "modulus_ratio", "rate")
_SAID_ONCE = ("problem", "run_id", *_INPUTS)
_UNSAID = (*_INPUTS, "method", "inside", "confidence", "band", "curve_band", "why")


class Predict(Request):
    """Predict the pull-off force, with an interval.

    Surrogates trained on simulations answer in a millisecond, with force, work and curve. Outside
    of their range the theory with the narrowest band that was verified for such a problem gives the
    force. Otherwise the command states which input is out of range; --exact simulates the problem.

    In SI: viscotack predict sphere --radius "5 mm" --material pdms-10-1
    --work-of-adhesion "150 mJ/m^2" --equilibrium-gap "200 nm" --preload-force "1.5 mN"
    --speed "10 um/s"

    By a file, beside its simulation: viscotack predict lens.toml --compare --plot lens.png

    A table in SI, each row a change of one problem: viscotack predict lens.toml cases.xlsx
    --xlsx answers.xlsx

    Without dimensions: viscotack predict sphere --tabor 3.24 --modulus-ratio 0.1 --exponent 0.8
    --preload 73 --rate 316.23

    Thousands without dimensions: viscotack predict cases.csv --csv answers.csv
    """

    word: ClassVar = "predict"
    outputs: ClassVar = (
        csv_file("Write the predicted unloading curve as a table.", "curve"),
        picture("Draw that curve."),
        csv_file("Write the table of cases with its predictions."),
        binary_file("xlsx", "Write it as a workbook.", ".xlsx"),
    )
    takes_own: ClassVar = True

    problem: Any = contact(
        "The word sphere or punch, and flags as for simulate; or a problem in SI; or a table "
        "with a case in each row, whose columns are flags (docs/predict.md).",
        metavar="sphere|punch|CASE.toml|CASES.csv",
        indenters=("sphere", "punch"),
        spelling="word",
        table="cases",
    )
    cases: Path | tuple[Mapping[str, Any], ...] | None = rows(
        "A table, CSV or .xlsx. After a problem each row changes it: columns are keys of its "
        'file with units, "radius [mm]". Alone it has a case without dimensions in each row.',
        elsewhere=True,
    )
    confidence: float = number(
        "Level of the intervals: 0.5, 0.6, 0.7, 0.8, 0.9, 0.95 or 0.98.", default=0.9
    )
    budget: float | None = number(
        "From 0.01 s surrogates, from 0.02 s also closed forms, from 0.5 s the steady-crack "
        "contact model, from 1 s (default) the simulation where a surrogate is not certain, from "
        "3 s the simulation.",
        "s",
        above=0,
        bare=True,
    )
    exact: bool = switch("Simulate at the usual accuracy, however long it takes.")
    compare: bool = switch("Also simulate, and show the error of the prediction.")
    why: bool = switch("Also print why this method answers.")
    time_limit: HowLong = None

    def check(self) -> None:
        """Refuse options that exclude each other."""
        if self.problem is None and not isinstance(self.cases, Path):
            got = "none" if self.cases is None else "rows, which change a problem"
            raise InputError(f"give a problem or a table of cases, got {got}")

    def answer(self, caller: Caller) -> Answer:
        """Predict with the best tier within the time budget."""
        if self.cases is not None:
            return self._of_table(caller)
        from viscotack.clock import limited
        from viscotack.prediction.predict import predict
        from viscotack.prediction.prediction import prediction_summary
        from viscotack.result import Outcome

        stated = self.stated(caller)
        if table := sorted(caller.wants & {"csv", "xlsx"}):
            raise InputError(
                f"{table[0]} is for a table of cases; curve writes the curve; leave out {table[0]}"
            )
        with limited(self.time_limit):
            found = predict(
                stated.problem,
                shift_deviation=stated.deviation,
                passport=stated.passport,
                **self._how,
            )
            if found.curve is None and caller.wants & {"curve", "plot"}:
                raise InputError(
                    f"{found.why}. The tier {found.method!r} gives no curve; leave out curve and "
                    "plot, or simulate"
                )
            result = None
            if self.compare:
                from viscotack.simulate import solve

                result = solve(stated.problem, until="pull-off", throw=False)
        record = prediction_summary(found)
        if result is not None:
            record |= _comparison(found, record, result)

        def draw() -> Any:
            from viscotack.plot.prediction import draw_prediction

            return draw_prediction(found, result)

        return Answer(
            found,
            data=record,
            words=_shown(found, record, self.why),
            units=units_of(found.problem.groups().outputs),
            files={"curve": {} if found.curve is None else _curve(found)},
            pictures={"plot": draw},
            notes=stated.improbable,
            status=int(result is not None and result.outcome is Outcome.STOPPED),
        )

    @property
    def _how(self) -> dict[str, Any]:
        """Options of :func:`viscotack.predict`."""
        from viscotack.prediction.tiers import SOON

        budget = SOON if self.budget is None else self.budget
        return self.values("confidence", "exact") | {"budget": budget}

    def _of_table(self, caller: Caller) -> Answer:
        """Predict all rows of a table."""
        from .parts.predict_table import predict_changes, predict_file

        alone = self.problem is None
        values = self.values("compare", *(("exact", "budget", "time_limit") if alone else ()))
        given = [name for name, value in values.items() if value]
        given += sorted(caller.wants & {"curve", "plot"})
        if given:
            what = f"{self.cases} is a table of cases" if alone else "there is a table of cases"
            raise InputError(f"{what}; leave out {quoted(given)}")
        if not alone:
            rows, limit = caller.rows(self.cases), self.time_limit
            return predict_changes(
                self.stated(caller), rows, caller.tell, time_limit=limit, **self._how
            )
        assert isinstance(self.cases, Path), "checked before"
        if len(caller.wants & {"csv", "xlsx"}) != 1:
            raise InputError(f"choose one output for the answers to {self.cases}: csv or xlsx")
        return predict_file(caller.file(self.cases), self.confidence, caller.tell)


class Advise(Request):
    """Determine the regime of a contact and the reliability of each method.

    The problem is stated as for simulate sphere, by flags or by a file in SI with any indenter of
    revolution. For a film (--thickness) the answer states when it is a half-space, how much more it
    holds, and at which speed the gain saturates; for discs and profiles it has the two limits.

    Example: viscotack advise --tabor 3.24 --modulus-ratio 0.1 --exponent 0.8 --preload 73
    --rate 316.23
    """

    word: ClassVar = "advise"
    takes_own: ClassVar = True

    problem: Any = contact(
        "The contact, of revolution.", indenters=("sphere", "profile", "disc"), default=...
    )

    def answer(self, caller: Caller) -> Answer:
        """Evaluate every tier."""
        from viscotack.prediction.advice import advise
        from viscotack.prediction.cautions import cautions_on

        stated = self.stated(caller)
        problem = stated.problem
        if problem.groups().in_plane_strain:
            raise InputError(
                "advice is for shapes of revolution; this problem contains a punch, which "
                "viscotack predict answers"
            )
        advice = advise(problem)
        warned = cautions_on(problem, passport=stated.passport)
        # the sentences of the advice have one of the cautions already
        sentences = tuple(dict.fromkeys((*advice.statements, *warned))) + advice.tiers
        return Answer(
            advice,
            data=_advised(advice, sentences, warned),
            words={"sentences": sentences},
            notes=stated.notes,
        )


def _advised(
    advice: "Advice", sentences: tuple[str, ...], warned: tuple[str, ...]
) -> dict[str, Any]:
    """Return advice ready for JSON; the answer in newtons as well where the problem is in SI."""
    record: dict[str, Any] = asdict(advice)
    record |= {"sentences": sentences, "cautions": warned}
    length, speed = record.pop("length_scale"), record.pop("speed_scale")
    if (contact := record.pop("contact")) is not None:
        del contact["receding"], contact["start_radius"], contact["edge_speed"]
        record |= contact
        if length is not None and (thick := contact["half_space_thickness"]) is not None:
            record["half_space_thickness_m"] = [length * value for value in thick]
        for name in ("saturation_", "half_space_saturation_"):
            if speed is not None and (rate := contact[f"{name}rate"]) is not None:
                record[f"{name}speed_m_per_s"] = rate * speed
    if (unit := advice.force_scale) is not None:
        force, interval = advice.pull_off_force, advice.interval
        record["pull_off_force_N"] = None if force is None else force * unit
        record["interval_N"] = None if interval is None else [end * unit for end in interval]
    return record


def _compared(kind: "Kind") -> dict[str, str]:
    """Return the quantities to compare, with the names of their intervals."""
    return {f"pull_off_{kind.name_of('force')}": "interval", "work_to_pull_off": "work_interval"}


def _comparison(
    found: "Prediction", predicted: Mapping[str, Any], result: "Result"
) -> dict[str, Any]:
    """Return the simulated numbers, the errors of the prediction, and whether the interval holds.

    `difference` is prediction over simulation, less 1.
    """
    from viscotack.result.observables import summary

    simulated = summary(result)
    difference: dict[str, float | None] = {}
    held: dict[str, bool | None] = {}
    for name, interval in _compared(found.problem.groups().outputs).items():
        true, value, ends = simulated[name], predicted[name], predicted[interval]
        difference[name] = held[name] = None
        if value is not None and true is not None:
            difference[name] = value / true - 1
            held[name] = None if ends is None else ends[0] <= true <= ends[1]
    simulation = {name: x for name, x in simulated.items() if name not in _SAID_ONCE}
    return {"simulation": simulation, "difference": difference, "interval_held": held}


def _curve(found: "Prediction") -> dict[str, Any]:
    """Return the columns of the curve, as `simulate --csv` names them."""
    assert found.curve is not None, "asked of predictions with a curve"
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


def _shown(found: "Prediction", record: Mapping[str, Any], why: bool) -> dict[str, Any]:
    """Return what the text says of a record."""
    by = f"by {found.method}{'' if found.inside else ', outside of the surrogates'}"
    if found.confidence is not None:
        by += f"; {100 * found.confidence:.4g} % intervals"
    shown = {n: x for n, x in record.items() if n not in _UNSAID}
    if simulated := record.get("simulation"):
        said = (*_compared(found.problem.groups().outputs), "status", "wall_time")
        shown["simulation"] = {n: x for n, x in simulated.items() if n.startswith(said)}
        parts = {n: x for n, x in record["difference"].items() if x is not None}
        shown["difference"] = {n: f"{x:+.2%}" for n, x in parts.items()}
    words = [by, found.why] if why else [by]
    return {"words": words} | shown | {"cautions": [OF_METHOD, *record["cautions"]]}

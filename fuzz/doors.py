"""Relations between tiers, whose intervals overlap, and between doors, whose digits agree."""

from __future__ import annotations

import atexit
import contextlib
import io
import json
import math
import tempfile
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from rounded_cone import largest_contact_radius  # noqa: E402  (cases names its folder)

import viscotack as vt
from viscotack import (
    Apart,
    Approach,
    AtDepth,
    AtForce,
    AtRadius,
    Bonded,
    Cone,
    Dwell,
    Elastic,
    FlatPunch,
    Groups,
    InputError,
    Layer,
    LoadTo,
    MoveTo,
    PowerLawProfile,
    Prony,
    RetardationPowerLaw,
    Retract,
    Sphere,
    StandardSolid,
    Tabulated,
)
from viscotack.app.cli import main as command_line
from viscotack.campaign import CaseSettings, measure
from viscotack.cards import cards
from viscotack.traction import has_rest

from . import cases
from .answers import ACCURACY, Unjudged, by_simulation, solved
from .cases import OWN, Case, Luck
from .relations import Found, Relation, in_si

CONFIDENCES = (0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98)
# How much wider than stated an interval of 98 % may be before it is said to miss.
_WIDER = 1.5
# What differs between two runs of the same problem.
_OF_A_RUN = ("wall_time_s", "statistics", "versions")
_OWN_FILES = ("cole_cole.py", "morse.py", "rounded_cone.py")
_OWN_FOLDER = Path(__file__).parents[1] / "examples" / "own"


# --- tiers -----------------------------------------------------------------------------------


def learned_sphere(luck: Luck) -> Groups:
    """Return a sphere within or next to the range of the surrogate."""
    tabor = luck.decades(0.1, 60)
    k, exponent = luck.decades(1e-4, 0.9), luck.within(0.15, 1.6)
    solid: Any = {
        "rubbery_modulus": 1.0,
        "glassy_modulus": 1 / k,
        "tau0": 1.0,
        "poisson_ratio": 0.0,
    }
    kind = luck.one({RetardationPowerLaw: 0.7, StandardSolid: 0.15, vt.RelaxationPowerLaw: 0.15})
    if kind is not StandardSolid:
        solid["exponent"] = exponent
    start = luck.one(
        {
            AtDepth((1 + tabor) * luck.decades(0.1, 30)): 0.6,
            AtForce(luck.within(-0.6, 10.0)): 0.2,
            AtRadius(luck.within(1.3, 5.0)): 0.2,
        }
    )
    rate = (1 + tabor) * luck.decades(1e-2, 1e5)
    return Groups(tabor=tabor, material=kind(**solid), start=start, rate=rate)


def learned_punch(luck: Luck) -> Groups:
    """Return a punch within or next to the range of its surrogate."""
    return Groups(
        tabor=None,
        geometry=FlatPunch(luck.decades(3, 100)),
        body=Layer(luck.decades(1, 30)),
        cohesion=luck.decades(0.01, 0.1),
        material=StandardSolid(
            rubbery_modulus=1.0, glassy_modulus=luck.decades(1.1, 1e3), tau0=1.0, poisson_ratio=0.0
        ),
        start=AtDepth(luck.decades(0.1, 10)),
        rate=luck.decades(1e-2, 1e4),
    )


def _sizes(case: Case) -> dict[str, Any]:
    """Return the numbers of a dimensionless punch by the names of its flags and columns."""
    return {name: case.inputs[name] for name in ("size", "thickness", "cohesion")}


def _learned(luck: Luck) -> Case:
    return learned_punch(luck) if luck.happens(0.2) else learned_sphere(luck)


def _predicted(case: Any, confidence: float = 0.9) -> vt.Prediction:
    try:
        return vt.predict(case, confidence=confidence)
    except InputError as error:
        raise Unjudged(f"refused: {error}") from None


def nesting(case: Case, luck: Luck) -> Found:
    """Check that intervals of a higher confidence contain those of a lower one, and the value."""
    answers = [_predicted(case, confidence) for confidence in CONFIDENCES]
    words = []
    for name in ("interval", "work_interval", "zero_force_interval"):
        pairs = [getattr(answer, name) for answer in answers]
        if any(pair is None for pair in pairs):
            continue
        for (low, high), (least, most), c in zip(pairs, pairs[1:], CONFIDENCES, strict=False):
            tiny = 1e-9 * (abs(low) + abs(high))
            if least > low + tiny or most < high - tiny:
                words.append(
                    f"{name} of {c} is not within that of the next: {low, high}, {least, most}"
                )
    values = {answer.pull_off_force for answer in answers}
    if len(values) > 1:
        words.append(f"the value depends on the confidence: {sorted(values)}")
    for answer in answers:
        low, high = answer.interval
        if not low <= answer.pull_off_force <= high:
            words.append(f"value {answer.pull_off_force} not in its interval {low, high}")
    return words


def predict_simulate(case: Case, luck: Luck) -> Found:
    """Check that the interval of the prediction and that of the simulation overlap."""
    found = _predicted(case, 0.98)
    mu = getattr(case, "effective_tabor", 1.0)
    if mu > 25:
        raise Unjudged("refused: its simulation takes too long")
    answer = by_simulation(case, until="pull-off", estimate=True)
    name = "pull_off_stress" if case.in_plane_strain else "pull_off_force"
    words = _apart(
        f"force by {found.method}", found.pull_off_force, found.interval, answer, name, found.band
    )
    if found.work_interval is not None and found.work_to_pull_off is not None:
        words += _apart(
            f"work by {found.method}",
            found.work_to_pull_off,
            found.work_interval,
            answer,
            "work_to_pull_off",
            found.band,
        )
    return words


def _apart(what: str, value: float, interval: Any, answer: Any, name: str, band: str) -> Found:
    simulated = answer.numbers.get(name)
    if simulated is None:
        return []
    stated = (answer.result.error_estimate or {}).get(
        "work" if "work" in name else "force", ACCURACY
    )
    wider = _WIDER if band == "measured" else 2 * _WIDER
    low, high = (value + wider * (end - value) for end in interval)
    doubt = stated * abs(simulated)
    if low - doubt <= simulated <= high + doubt:
        return []
    return [
        f"{what} {value:.5g} in {interval[0]:.5g} to {interval[1]:.5g}, band {band}; "
        f"simulated {simulated:.5g} within {doubt:.2g}"
    ]


def crack_simulate(case: Groups, luck: Luck) -> Found:
    """Check that the band of the contact with a steady crack and that of the simulation overlap."""
    try:
        found = vt.crack_contact(case)
    except InputError as error:
        raise Unjudged(f"refused: {error}") from None
    if found.pull_off_force is None or found.interval is None:
        raise Unjudged("refused: there is no pull-off")
    answer = by_simulation(case, estimate=True, until="detached" if case.moves else "pull-off")
    band = "measured" if found.inside else "not measured"
    interval = found.interval
    return _apart("force", found.pull_off_force, interval, answer, "pull_off_force", band)


def _crackish(luck: Luck) -> Groups:
    while True:
        found = cases.contact(luck)
        if isinstance(found, Groups):
            return replace(found, tabor=luck.decades(5, 25))


def advise_predict(case: Groups, luck: Luck) -> Found:
    """Check that tiers that both claim a problem have intervals that overlap."""
    found = _predicted(case, 0.98)
    try:
        advice = vt.advise(case)
    except InputError as error:
        raise Unjudged(f"refused: {error}") from None
    claims = {f"predict by {found.method}": (*found.interval, found.band)}
    for e in advice.estimates:
        if e.applies and e.pull_off_force is not None and e.error is not None:
            wide = _WIDER * e.error * e.pull_off_force
            claims[e.tier] = (e.pull_off_force - wide, e.pull_off_force + wide, "measured")
    words, known = [], list(claims.items())
    for at, (one, (low, high, band)) in enumerate(known):
        for other, (least, most, also) in known[at + 1 :]:
            sure = band == also == "measured"
            if sure and (low > most or high < least):
                words.append(f"{one} {low:.4g} to {high:.4g}, {other} {least:.4g} to {most:.4g}")
    return words


# --- doors -----------------------------------------------------------------------------------


def same(one: Any, other: Any, where: str = "") -> Found:
    """Return where two answers as JSON differ; what belongs to a run is not compared."""
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        names = (one.keys() | other.keys()) - set(_OF_A_RUN)
        return [
            words
            for name in sorted(names)
            for words in same(one.get(name), other.get(name), f"{where}.{name}" if where else name)
        ]
    if isinstance(one, list | tuple) and isinstance(other, list | tuple) and len(one) == len(other):
        pairs = enumerate(zip(one, other, strict=True))
        return [words for i, (a, b) in pairs for words in same(a, b, f"{where}[{i}]")]
    both_nan = isinstance(one, float) and isinstance(other, float) and one != one and other != other
    return [] if one == other or both_nan else [f"{where}: {one!r} and {other!r}"]


def plain(values: Mapping[str, Any]) -> Any:
    """Return numbers and words as JSON has them."""
    return json.loads(json.dumps(values))


def command(arguments: list[str]) -> tuple[int, Any]:
    """Return the exit status of a command, and the object that it printed."""
    said, status = io.StringIO(), 0
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(io.StringIO()) as errors:
        try:
            command_line([*arguments, "--json"])
        except SystemExit as end:
            status = int(end.code or 0)
    text = said.getvalue()
    return status, json.loads(text) if text.strip().startswith("{") else errors.getvalue()


@contextlib.contextmanager
def folder() -> Iterator[Path]:
    """Give a folder for files."""
    with tempfile.TemporaryDirectory() as name:
        yield Path(name)


def in_words(problem: vt.Problem, where: Path) -> str:
    """Return a problem in SI as the text of a case file; tables of laws are written beside it."""
    law, material, shape, test = (
        problem.traction,
        problem.material,
        problem.geometry,
        problem.protocol,
    )
    lines = ["[material]", f'model = "{material.word}"', *_numbers(material)]
    if isinstance(material, Prony):
        arms = ", ".join(f'["{E!r} Pa", "{t!r} s"]' for E, t in material.branches)
        lines.append(f"branches = [{arms}]")
    lines += ["", "[interface]", f'law = "{law.word}"']
    if isinstance(law, Tabulated):
        rows = [
            (g * law.equilibrium_gap, t * law.work_of_adhesion / law.equilibrium_gap)
            for g, t in law.points
        ]
        text = "gap_m,traction_Pa\n" + "".join(f"{g!r},{t!r}\n" for g, t in rows)
        (where / "law.csv").write_text(text, encoding="utf-8")
        lines.append('file = "law.csv"')
    else:
        lines += _numbers(law)
        if has_rest(law):
            lines += [f'base = "{law.base.word}"']
            lines += [n for n in _numbers(law.base) if not n.startswith(("work_of", "equilibrium"))]
    if isinstance(shape, PowerLawProfile):
        lines += ["", "[profile]", f"exponent = {shape.exponent!r}"]
        lines += [f'height = "{shape.coefficient!r} m"', 'at_radius = "1 m"']
    elif isinstance(shape, Cone):
        lines += ["", "[profile]", f"slope = {shape.slope!r}"]
    else:
        table = "punch" if isinstance(shape, FlatPunch) else shape.word
        lines += ["", f"[{table}]", *_numbers(shape)]
    if isinstance(shape, FlatPunch):
        body: Any = problem.body
        lines += [
            "",
            "[layer]",
            f'thickness = "{body.thickness!r} m"',
            f'base = "{body.base.word}"',
        ]
    force = "Pa" if isinstance(shape, FlatPunch) else "N"
    lines += ["", "[protocol]"]
    match test.start:
        case Apart(gap=gap):
            lines.append(f'start = "apart {gap!r} m"')
        case AtDepth(depth=depth):
            lines.append(f'preload_depth = "{depth!r} m"')
        case AtForce(force=value):
            name = "preload_stress" if force == "Pa" else "preload_force"
            lines.append(f'{name} = "{value!r} {force}"')
        case AtRadius(contact_radius=value):
            lines.append(f'preload_radius = "{value!r} m"')
    if test.moves:
        units = {"depth": "m", "force": force, "speed": "m/s", "time": "s", "radius": "m"}
        words = ", ".join(f'"{move_words(move, units)}"' for move in test.moves)
        lines.append(f"moves = [{words}]")
    if test.speed is not None:
        lines.append(f'speed = "{test.speed!r} m/s"')
    if test.stiffness is not None:
        lines.append(f'stiffness = "{test.stiffness!r} {"Pa/m" if force == "Pa" else "N/m"}"')
    return "\n".join(lines) + "\n"


def _numbers(noun: Any) -> list[str]:
    """Return the numbers of a noun as lines of a table."""
    lines = []
    for name, one in cards(type(noun)).items():
        value, unit = getattr(noun, name), one.card.unit
        if isinstance(value, float | int):
            lines.append(f"{name} = {value!r}" if unit == "1" else f'{name} = "{value!r} {unit}"')
    return lines


def move_words(move: Any, units: Mapping[str, str]) -> str:
    """Return a move in the words of a case file; units "" for numbers without one."""

    def of(value: float, kind: str) -> str:
        return f"{value!r} {units[kind]}".strip()

    match move:
        case Approach(speed=speed, to=to) | Retract(speed=speed, to=to):
            (value,) = vars(to).values()
            kind = {AtDepth: "depth", AtForce: "force", AtRadius: "radius"}[type(to)]
            name = "approach" if isinstance(move, Approach) else "retract"
            return f"{name} {of(speed, 'speed')} to {kind} {of(value, kind)}"
        case MoveTo(depth=depth, duration=duration):
            return f"move to {of(depth, 'depth')} in {of(duration, 'time')}"
        case LoadTo(force=force, duration=duration):
            return f"load to {of(force, 'force')} in {of(duration, 'time')}"
        case Dwell(duration=duration, hold=hold):
            return f"hold {hold} {of(duration, 'time')}"
    raise AssertionError(move)


def flags(case: Case) -> list[str] | None:
    """Return the flags that state a dimensionless case; None where there are none for it."""
    solid, law = case.material, case.traction
    word = {Elastic: "elastic", StandardSolid: "sls", RetardationPowerLaw: "power-law"}.get(
        type(solid)
    )
    if isinstance(solid, vt.FractionalZener):
        word = f"fractional-zener:{solid.order!r}"
    law_word = _law_words(law)
    if word is None or law_word is None:
        return None
    if case.in_plane_strain:
        given: dict[str, Any] = dict(_sizes(case))
        if isinstance(case.body.base, Bonded):
            given["bonded"] = case.body.base.poisson_ratio
        door = "punch"
    else:
        given, door = {"tabor": case.tabor}, "sphere"
        if isinstance(case.geometry, PowerLawProfile):
            door = "profile"
            given["profile-exponent"] = case.geometry.exponent
        elif not isinstance(case.geometry, Sphere):
            return None
    given |= {"material": word, "law": law_word, "rate": case.rate, "stiffness": case.stiffness}
    if not isinstance(solid, Elastic):
        given["modulus-ratio"] = 1 / solid.glassy_modulus
    if isinstance(solid, RetardationPowerLaw):
        given["exponent"] = solid.exponent
    (value,) = vars(case.start).values()
    names = {
        AtDepth: "preload",
        AtForce: "preload-force",
        AtRadius: "preload-radius",
        Apart: "apart",
    }
    given[names[type(case.start)]] = value
    words = ["simulate", door]
    for name, value in given.items():
        if value is not None:
            words += [f"--{name}={value if isinstance(value, str) else repr(value)}"]
    bare = dict.fromkeys(("depth", "force", "speed", "time", "radius"), "")
    return words + [f"--move={move_words(move, bare)}" for move in case.moves]


def _law_words(law: Any) -> str | None:
    """Return a law as a flag has it; None where it is in a table, or a user's own."""
    if isinstance(law, Tabulated) or isinstance(law, OWN):
        return None
    base = f":{_law_words(law.base)}" if has_rest(law) else ""
    scales = ("work_of_adhesion", "equilibrium_gap", "base")
    values = [repr(v) for n, v in vars(law).items() if n not in scales]
    return law.word + (":" + ",".join(values) if values else "") + base


def case_file(case: Case, luck: Luck) -> Found:
    """Check that a problem in a file, in a record and in JSON is the problem."""
    problem = in_si(case, luck)
    words = []
    with folder() as where:
        path = where / "case.toml"
        path.write_text(in_words(problem, where), encoding="utf-8")
        read = vt.read_case(path, also=OWN)
    # tables of laws are scaled when they are read
    if not isinstance(problem.traction, Tabulated) and read != problem:
        words.append(f"file: {read!r} for {problem!r}")
    for one in (problem, case):
        record = json.loads(json.dumps(vt.to_dict(one)))
        back = vt.from_dict(record, OWN)
        if back != one or vt.run_id(back) != vt.run_id(one):
            words.append(f"record: {back!r} for {one!r}")
    return words


def command_simulates(case: Case, luck: Luck) -> Found:
    """Check that the command line prints what Python returns."""
    until, also = luck.one({"pull-off": 1, "detached": 1}), ()
    options = [f"--accuracy={ACCURACY}", f"--until={until}"]
    given = flags(case)
    if given is None or luck.happens(0.5):
        problem = in_si(case, luck)
        with folder() as where:
            path = where / "case.toml"
            path.write_text(in_words(problem, where), encoding="utf-8")
            problem = vt.read_case(path, also=OWN)
            result = solved(problem, until=until, estimate_error=True)
            also = (largest_contact_radius,)
            own = [f"--with={_OWN_FOLDER / name}" for name in _OWN_FILES]
            status, said = command(["simulate", "case", str(path), *options, *own])
    else:
        k = getattr(case.material, "glassy_modulus", 1.0)
        if not isinstance(case.material, Elastic):
            case = replace(case, material=replace(case.material, glassy_modulus=1 / (1 / k)))
        if isinstance(case, Groups) and isinstance(case.geometry, PowerLawProfile):
            q = case.geometry.exponent
            case = replace(case, geometry=PowerLawProfile(1 / q, q))
        result = solved(case, until=until, estimate_error=True)
        status, said = command([*given, *options])
    if status or not isinstance(said, dict):
        return [f"the command ends with {status}: {said}"]
    return same(plain(vt.summary(result, also)), said)


def saved(case: Case, luck: Luck) -> Found:
    """Check that a result that is saved and loaded is the result."""
    result = solved(in_si(case, luck) if luck.happens(0.5) else case, fields=luck.happens(0.3))
    with folder() as where:
        vt.save(result, where / "x.npz")
        back = vt.load(where / "x.npz", also=OWN)
    words = same(plain(vt.summary(result)), plain(vt.summary(back)))
    one, other = vt.columns(result), vt.columns(back)
    for name in one.keys() | other.keys():
        if not np.array_equal(one[name], other[name], equal_nan=True):
            words.append(f"column {name} differs")
    if result.energy is not None and back.energy is not None:
        for name, values in vars(result.energy).items():
            if not np.array_equal(values, vars(back.energy)[name]):
                words.append(f"energy {name} differs")
    return words


def campaign_row(case: Case, luck: Luck) -> Found:
    """Check that the row of a campaign has the numbers of the simulation."""
    until = luck.one({"pull-off": 1, "detached": 1})
    problem = in_si(case, luck) if luck.happens(0.5) else case
    result = solved(problem, until=until, whole=True, estimate_error=True)
    try:
        vt.pull_off(result)
    except InputError as error:
        raise Unjudged(f"refused: {error}") from None
    row = plain(measure(problem, CaseSettings(accuracy=ACCURACY, until=until)))
    said = plain(vt.summary(result))
    estimate = said.pop("error_estimate") or {}
    said |= {"error_estimate": estimate.get("force"), "error_estimate_work": estimate.get("work")}
    shared = (said.keys() & row.keys()) - {"versions"}
    return same({n: said[n] for n in shared}, {n: row[n] for n in shared})


def watched(case: Case, luck: Luck) -> Found:
    """Check that what a run tells while it goes on is its result; its progress rises to 1."""
    points: list[tuple[float, ...]] = []
    shares: list[float] = []
    result = solved(case, watch=lambda *p: points.append(p), progress=shares.append)
    if result.method != "simulation":
        return []
    words = []
    got = np.array(points).reshape(-1, 4).T
    for values, name in zip(got, ("time", "depth", "force", "contact_radius"), strict=True):
        series = getattr(result, name)
        if not np.array_equal(values, series[len(series) - len(values) :], equal_nan=True):
            words.append(f"watched {name} is not the series")
    if np.any(np.diff(shares) < 0) or not all(0 <= share <= 1 for share in shares):
        words.append(f"progress falls or leaves 0 to 1: {min(shares)} to {max(shares)}")
    return words


def predict_doors(case: Case, luck: Luck) -> Found:
    """Check that Python, command line, table and HTTP predict the same digits."""
    found = _predicted(case)
    said = plain(vt.prediction_summary(found))
    words = []
    given = flags(case)
    if given is not None:
        solid = case.material
        if 1 / (1 / solid.glassy_modulus) == solid.glassy_modulus:
            status, printed = command(["predict", *given[1:]])
            words += same(said, printed, "command") if status == 0 else [f"command: {printed}"]
    response = client().post("/api/predict", json={"problem": vt.to_dict(case)})
    words += same(said, response.json(), "http") if response.status_code == 200 else [response.text]
    return words + _by_table(case, found)


def _by_table(case: Case, found: vt.Prediction) -> Found:
    columns: dict[str, Any]
    if case.in_plane_strain:
        columns = {name: [value] for name, value in _sizes(case).items()}
    elif isinstance(case.material, RetardationPowerLaw):
        columns = {"tabor": [case.tabor], "exponent": [case.material.exponent]}
    else:
        return []
    names = {AtDepth: "preload", AtForce: "preload_force", AtRadius: "preload_radius"}
    (value,) = vars(case.start).values()
    columns |= {"modulus_ratio": [case.modulus_ratio], "rate": [case.rate]}
    row = vt.predict_table(columns | {names[type(case.start)]: [value]})
    name = "pull_off_stress" if case.in_plane_strain else "pull_off_force"
    expected = {"": found.pull_off_force, "_low": found.interval[0], "_high": found.interval[1]}
    # rows are evaluated together, in another order of additions
    return [
        f"table {name}{tail}: {row[name + tail][0]} and {value}"
        for tail, value in expected.items()
        if not math.isclose(row[name + tail][0], value, rel_tol=1e-9)
    ]


@cache
def client() -> Any:
    """Return a client of the application in this process."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        from fastapi.testclient import TestClient

        from viscotack.app.api import application
        from viscotack.app.engine.jobs import Engine, Limits

        asking = TestClient(application(Engine(Limits(workers=1))), base_url="http://localhost")
        asking.__enter__()
    atexit.register(asking.__exit__, None, None, None)
    return asking


DOORS: tuple[Relation, ...] = (
    Relation("nesting", _learned, nesting, 2.5),
    Relation("predict-simulate", _learned, predict_simulate, 1.5),
    Relation("crack-simulate", _crackish, crack_simulate, 0.5),
    Relation("advise-predict", learned_sphere, advise_predict, 0.7),
    Relation("case-file", cases.contact, case_file, 2.5),
    Relation("command", cases.contact, command_simulates, 1.0),
    Relation("saved", cases.contact, saved, 1.0),
    Relation("campaign", cases.contact, campaign_row, 1.0),
    Relation("watched", cases.contact, watched, 0.7),
    Relation("predict-doors", _learned, predict_doors, 1.0),
)

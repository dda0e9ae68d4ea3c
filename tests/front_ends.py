"""One question through every door: Python, command line, HTTP, the form of the page, a study.

A question is the word of an operation and its options as a user states them. Each door gives the
record of the answer, or the words by which the question was refused.
"""

import asyncio
import contextlib
import io
import json
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import httpx

from viscotack import InputError
from viscotack.app.api import application
from viscotack.app.cli import main
from viscotack.app.engine.crew import Refused
from viscotack.app.engine.jobs import Engine
from viscotack.app.engine.operating import run_operation
from viscotack.files.toml import toml_value
from viscotack.operations import ask, operation
from viscotack.operations.declare.cards import File, Known, Named, Spelled, Switch
from viscotack.operations.declare.options import options, spelled
from viscotack.operations.declare.statement import Stated
from viscotack.operations.parts.json_data import plain
from viscotack.problem.nouns import own_nouns

# What two runs of one question do not share.
OF_A_RUN = ("wall_time_s",)
# What the library of the command line says itself, of flags that it does not know or misses.
OF_THE_SHELL = (
    "No such option",
    "Missing",
    "is not a valid float",
    "Got unexpected",
    "requires an",
)


@dataclass
class Question:
    """What is asked."""

    word: str
    given: dict = field(default_factory=dict)
    # files with nouns of the user's own
    own: tuple = ()

    @property
    def kind(self):
        return operation(self.word)


@dataclass
class Told:
    """What a door answers: a record, or the words of a refusal."""

    record: object = None
    refused: str = ""


def by_python(question):
    try:
        also = own_nouns(question.own)
        return Told(without_times(plain(ask(question.word, also=also, **question.given).record())))
    except (InputError, OSError) as error:
        return Told(refused=words_of(error))


def words_of(error):
    missing = isinstance(error, FileNotFoundError)
    return f"there is no file {error.filename}" if missing else str(error)


def by_command(question):
    status, out, err = run(arguments(question))
    if status in (0, 1, 4):
        return Told(without_times(json.loads(out)))
    _, ours, words = f"\n{err}".rpartition("\nviscotack: ")
    return Told(refused=spelled(words.rstrip("\n") if ours else err, question.kind))


def run(arguments):
    out, err, status = io.StringIO(), io.StringIO(), 0
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            main([str(argument) for argument in arguments])
        except SystemExit as end:
            status = int(end.code or 0)
    return status, out.getvalue(), err.getvalue()


def arguments(question):
    """Return the command line of a question."""
    word, flags, places = question.word.split(), [], []
    for option in options(question.kind):
        if option.name not in question.given:
            continue
        value = question.given[option.name]
        if option.card.form == "rows":
            write_rows(value)
            value = "rows.csv"
        if isinstance(option.card, Stated):
            command, stated = problem_flags(option.card, value)
            word, flags = [*word, *command], [*flags, *stated]
        elif isinstance(option.card, Switch) and isinstance(value, bool):
            spelled_no = f"--no-{option.flag.removeprefix('--')}"
            flags += [option.flag] if value else [spelled_no] if option.default is True else []
        elif option.card.argument:
            places += value if isinstance(value, list) else [value]
        elif getattr(option.card, "elsewhere", False):
            word.append(value)
        elif isinstance(option.card, Known) and isinstance(value, list):
            flags += [option.flag, value[0], f"{option.flag}-uncertainty", value[1]]
        else:
            for each in value if isinstance(value, list) else [value]:
                flags += [option.flag, each]
    unknown = question.given.keys() - {option.name for option in options(question.kind)}
    for name in unknown:
        flags += [f"--{name.replace('_', '-')}", question.given[name]]
    flags += [part for path in question.own for part in ("--with", path)]
    return [*word, *flags, "--json", *(["--"] if places else []), *places]


def write_rows(rows):
    """Write rows as the table that the command line takes in their place."""
    lines = [",".join(rows[0]), *(",".join(map(repr, row.values())) for row in rows)]
    Path("rows.csv").write_text("\n".join(lines) + "\n")


def problem_flags(card, value):
    """Return what states a problem on the command line: words of the command, and flags."""
    if not isinstance(value, dict):
        return (["case"] if card.spelling == "commands" else []), [value]
    answers = {name: each for name, each in value.items() if name not in ("indenter", "case")}
    flags = [part for n, v in answers.items() for part in (f"--{n.replace('_', '-')}", v)]
    if "case" in value:
        flags = [value["case"], *flags]
        return (["case"] if card.spelling == "commands" else []), flags
    return ([] if card.spelling == "flags" else [value["indenter"]]), flags


class InProcess(Engine):
    """An engine that computes in this process: what it answers is what its processes answer."""

    own = ()

    async def begin(self):
        pass

    async def end(self):
        pass

    async def ask(self, task, asked, **more):
        assert task == "operation"
        try:
            return json.loads(
                json.dumps(run_operation(asked, lambda told: None, own_nouns(self.own)))
            )
        except InputError as error:
            raise Refused(str(error)) from None


class Http:
    """A client of the application in this process."""

    def __init__(self, own=()):
        self.loop = asyncio.new_event_loop()
        engine = InProcess()
        engine.own = own
        transport = httpx.ASGITransport(app=application(engine), raise_app_exceptions=False)
        self.client = httpx.AsyncClient(transport=transport, base_url="http://localhost")

    def __call__(self, path, **more):
        return self.loop.run_until_complete(self.client.post(path, timeout=600, **more))

    def get(self, path):
        return self.loop.run_until_complete(self.client.get(path))

    def close(self):
        self.loop.run_until_complete(self.client.aclose())
        self.loop.close()


def by_http(question, http):
    """Ask in JSON where no file is to be sent, else as a form."""
    path = f"/api/{question.word.replace(' ', '/')}"
    sent = files_of(question)
    if sent:
        return by_form(question, http)
    return told(http(path, json=question.given))


def by_form(question, http):
    """Ask as the page does: a form of texts and files."""
    path = f"/api/{question.word.replace(' ', '/')}"
    known = {option.name: option for option in options(question.kind)}
    data, files = {}, []
    for name, value in question.given.items():
        card = known[name].card if name in known else None
        if isinstance(card, File):
            for each in value if isinstance(value, list) else [value]:
                if Path(each).is_file():
                    files.append((name, (str(each), Path(each).read_bytes())))
                else:
                    data.setdefault(name, []).append(str(each))
        elif isinstance(card, Stated) or (card is not None and card.form == "rows"):
            data[name] = json.dumps(value)
        else:
            data[name] = [text(each) for each in (value if isinstance(value, list) else [value])]
    for name in list(data):
        if name in known and isinstance(known[name].card, Known) and len(data[name]) == 2:
            data[name], data[f"{name}_uncertainty"] = data[name][:1], data[name][1:]
    for each in files_of(question):
        if not any(each == named for _, (named, _) in files):
            files.append(("attached", (each, Path(each).read_bytes())))
    # a form without a file is a multipart form as well
    files = files or [("attached", ("nothing.txt", b""))]
    return told(http(path, data=data, files=files))


def text(value):
    return str(value).lower() if isinstance(value, bool) else str(value)


def told(response):
    answer = response.json()
    if response.status_code == 200:
        answer.pop("beside", None)
        return Told(without_times(answer))
    assert response.status_code == 422, response.text
    return Told(refused=answer["error"])


def files_of(question):
    """Return the files that the options of a question name and that are there."""
    known = {option.name: option for option in options(question.kind)}
    found = []
    for name, value in question.given.items():
        card = known[name].card if name in known else None
        named = value if isinstance(value, list) else [value]
        if isinstance(card, Stated):
            if isinstance(value, dict):
                named = [value.get("case"), *(str(v).rpartition(":")[2] for v in value.values())]
            found += [each for each in named if isinstance(each, str) and Path(each).is_file()]
        elif isinstance(card, File | Named | Spelled):
            found += [
                bare for each in named if Path(bare := str(each).rpartition(":")[2]).is_file()
            ]
    # a study names the files of its tests, which a request must contain too
    for study in [each for each in found if each.endswith(".toml")]:
        named = tomllib.loads(Path(study).read_text(encoding="utf-8")).get("files", [])
        found += [each for each in named if Path(each).is_file()]
    return list(dict.fromkeys(found))


def by_study(question):
    """Ask by a file."""
    lines = [f"operation = {toml_value(question.word)}"]
    lines += [f"{name} = {toml_value(value)}" for name, value in question.given.items()]
    study = Path("asked.toml")
    study.write_text("\n".join(lines) + "\n", encoding="utf-8")
    own = [part for path in question.own for part in ("--with", path)]
    status, out, err = run(["study", study, "--json", *own])
    if status in (0, 1, 4):
        return Told(without_times(json.loads(out)))
    _, _, words = f"\n{err}".rpartition("\nviscotack: ")
    return Told(refused=words.removeprefix(f"{study}: ").rstrip("\n"))


def without_times(value):
    """Return a record without what differs between two runs."""
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if k not in OF_A_RUN}
    return [without_times(each) for each in value] if isinstance(value, list | tuple) else value


def through_all(question, http):
    """Return what each door answers, those left out in which the operation is refused by design."""
    found = {
        "Python": by_python(question),
        "command line": by_command(question),
        "study": by_study(question),
    }
    if "http" not in question.kind.refused:
        found |= {"HTTP": by_http(question, http), "form": by_form(question, http)}
    return found

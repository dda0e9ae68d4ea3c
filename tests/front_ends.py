"""One question through every door: Python, command line, HTTP, a study.

A question is the word of an operation and its options as a user states them. Each door gives the
record of the answer, or the words by which the question was refused.
"""

import asyncio
import contextlib
import io
import json
import re
from dataclasses import dataclass, field
from pathlib import Path

import httpx

from viscotack import InputError
from viscotack.app.cli import main
from viscotack.app.operations import ask, operation
from viscotack.app.operations.options import Contact, Rows, flag_of, option_of
from viscotack.app.operations.request import plain
from viscotack.files.toml import toml_value

# What two runs of one question do not share.
OF_A_RUN = ("wall_time_s",)
# What the library of the command line says itself, of flags that it does not know or misses.
OF_THE_SHELL = ("No such option", "Missing", "Got unexpected", "requires an")


@dataclass
class Question:
    """What is asked."""

    word: str
    given: dict = field(default_factory=dict)

    @property
    def kind(self):
        return operation(self.word)


@dataclass
class Told:
    """What a door answers: a record, or the words of a refusal."""

    record: object = None
    refused: str = ""
    field: str = ""


def refused(words, field=""):
    """Return the words of a refusal with options as Python spells them."""
    words = re.sub(r"--([a-z][a-z0-9-]*)", lambda x: x[1].replace("-", "_"), words)
    return Told(refused=words.replace("`", ""), field=field)


def by_python(question):
    try:
        return Told(without_times(plain(ask(question.word, **question.given).record())))
    except FileNotFoundError as error:
        return refused(f"there is no file {error.filename}")
    except (InputError, OSError) as error:
        return refused(str(error), getattr(error, "field", ""))


def by_command(question):
    return by_arguments(arguments(question))


def by_study(question):
    lines = [f"operation = {toml_value(question.word)}"]
    lines += [f"{name} = {toml_value(value)}" for name, value in question.given.items()]
    study = Path("asked.toml")
    study.write_text("\n".join(lines) + "\n", encoding="utf-8")
    told = by_arguments(["study", study, "--json"])
    return Told(told.record, told.refused.removeprefix(f"{study}: "))


def by_arguments(words):
    status, out, err = run(words)
    if status in (0, 1, 4):
        return Told(without_times(json.loads(out)))
    _, ours, said = f"\n{err}".rpartition("\nviscotack: ")
    return refused(said.rstrip("\n") if ours else err)


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
    for name, value in question.given.items():
        info = question.kind.model_fields.get(name)
        if info is None:
            flags += [f"--{name.replace('_', '-')}", value]
            continue
        option = option_of(info)
        several = value if isinstance(value, list) else [value]
        if isinstance(option, Rows) and isinstance(value, list):
            write_rows(value)
            several = ["rows.csv"]
        if isinstance(option, Contact):
            command, stated = problem_flags(option, value)
            word, flags = [*word, *command], [*flags, *stated]
        elif isinstance(value, bool):
            flag = flag_of(name, option)
            spelled_no = f"--no-{flag.removeprefix('--')}"
            flags += [flag] if value else [spelled_no] if info.default is True else []
        elif option.argument or getattr(option, "elsewhere", False):
            places += several
        else:
            flags += [part for each in several for part in (flag_of(name, option), each)]
    return [*word, *flags, "--json", *(["--"] if places else []), *places]


def write_rows(rows):
    """Write rows as the table that the command line takes in their place."""
    lines = [",".join(rows[0]), *(",".join(map(repr, row.values())) for row in rows)]
    Path("rows.csv").write_text("\n".join(lines) + "\n")


def problem_flags(option, value):
    """Return what states a problem on the command line: words of the command, and flags."""
    if not isinstance(value, dict):
        return [], [value]
    answers = {name: each for name, each in value.items() if name not in ("indenter", "case")}
    flags = [part for n, v in answers.items() for part in (f"--{n.replace('_', '-')}", v)]
    if "case" in value:
        return [], [value["case"], *flags]
    return ([] if option.spelling == "flags" else [value["indenter"]]), flags


class Client:
    """Requests to an application in this process, one after the other."""

    def __init__(self, app):
        self.app, self.loop = app, asyncio.new_event_loop()
        transport = httpx.ASGITransport(app=app, raise_app_exceptions=False)
        self.client = httpx.AsyncClient(transport=transport, base_url="http://localhost")

    def wait(self, what):
        return self.loop.run_until_complete(what)

    def __call__(self, method, path, **more):
        return self.wait(self.client.request(method, path, timeout=600, **more))

    def send(self, names):
        """Send files; return the query of a request that names them."""
        files = [("files", (str(name), Path(name).read_bytes())) for name in names]
        return self("POST", "/api/files", files=files).json() if files else {}


@contextlib.contextmanager
def served(client):
    """Yield a client while its application runs, with the processes of its tasks."""
    alive = client.app.router.lifespan_context(client.app)
    client.wait(alive.__aenter__())
    yield client
    client.wait(client.client.aclose())
    client.wait(alive.__aexit__(None, None, None))
    client.loop.close()


def by_http(question, http):
    path = f"/api/{question.word.replace(' ', '/')}"
    return told(http("POST", path, json=question.given, params=http.send(files_of(question.given))))


def told(response):
    answer = response.json()
    if response.status_code == 200:
        answer.pop("beside", None)
        return Told(without_times(answer))
    assert response.status_code == 422, response.text
    return refused(answer["error"], answer["field"])


def files_of(value):
    """Return the files that a request names, and those that its studies name."""
    if isinstance(value, dict):
        return list(dict.fromkeys(file for each in value.values() for file in files_of(each)))
    if isinstance(value, list):
        return list(dict.fromkeys(file for each in value for file in files_of(each)))
    file = Path(str(value).rpartition(":")[2])
    if not file.is_file():
        return []
    named = re.findall(r'"([^"]+)"', file.read_text("utf-8")) if file.suffix == ".toml" else []
    return [file.name, *(each for each in named if Path(each).is_file() and each != file.name)]


def without_times(value):
    """Return a record without what differs between two runs."""
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if k not in OF_A_RUN}
    return [without_times(each) for each in value] if isinstance(value, list | tuple) else value


def through_all(question, http):
    """Return what each door answers, HTTP only where it has the operation."""
    found = {
        "Python": by_python(question),
        "command line": by_command(question),
        "study": by_study(question),
    }
    return found if question.kind.local else found | {"HTTP": by_http(question, http)}

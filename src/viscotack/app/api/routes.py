"""The questions of the API and of the page, and the files of the page."""

import asyncio
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from importlib.resources import files as files_of
from os.path import dirname
from typing import Annotated, Any

from fastapi import APIRouter, File, Form, Path, Query, Response, UploadFile

from viscotack.app.engine.crew import Refused
from viscotack.app.engine.jobs import Engine, Job

from .models import (
    Answer,
    Asked,
    AskedQuick,
    AskedState,
    AskedTheory,
    AskedToPredict,
    AskedToRun,
    AskedToSimulate,
    AskedVerdict,
    JobAnswer,
    Refusal,
    Words,
)

# Longest time that a question for a job waits for news [s], and most files of one request.
_LONGEST_WAIT, _MOST_FILES = 10.0, 60
_KINDS = {
    "html": "text/html; charset=utf-8",
    "css": "text/css; charset=utf-8",
    "js": "text/javascript; charset=utf-8",
    "svg": "image/svg+xml",
}
_REFUSED: dict[int | str, dict[str, Any]] = {
    status: {"model": Refusal, "description": words}
    for status, words in (
        (400, "The request cannot be read."),
        (401, "The token is missing or wrong."),
        (403, "The request comes from elsewhere."),
        (413, "The request is too long."),
        (422, "The question has no answer; the words say why."),
    )
}
_NO_JOB: dict[int | str, dict[str, Any]] = {404: {"model": Refusal, "description": "No such job."}}
_FULL: dict[int | str, dict[str, Any]] = {
    429: {"model": Refusal, "description": "There are as many jobs as there may be."}
}
Id = Annotated[str, Path(max_length=64)]
Files = Annotated[list[UploadFile], File(description="What the instrument wrote.")]


def routes(engine: Engine) -> APIRouter:
    """Return the routes of an engine."""
    router = APIRouter(responses=_REFUSED)
    _questions(router, engine)
    _jobs(router, engine)
    _laboratory(router, engine)
    _page(router, engine)
    return router


def _questions(router: APIRouter, engine: Engine) -> None:
    @router.post("/api/predict", tags=["answers"])
    async def predict(asked: AskedToPredict) -> Answer:
        """Predict the pull-off force with an interval, by the best tier within a budget."""
        return Answer(**await engine.ask("predict", asked.model_dump()))

    @router.post("/api/advise", tags=["answers"])
    async def advise(asked: Asked) -> Answer:
        """Say which regime a contact is in, and which answer may be trusted."""
        return Answer(**await engine.ask("advise", asked.model_dump()))

    @router.get("/api/materials", tags=["materials"])
    async def materials() -> Answer:
        """List the published materials, each as a table [material] of a case file."""
        return Answer(**await engine.ask("materials", {}))


def _jobs(router: APIRouter, engine: Engine) -> None:
    @router.post("/api/jobs/simulate", status_code=202, responses=_FULL, tags=["jobs"])
    async def simulate(asked: AskedToSimulate) -> JobAnswer:
        """Begin a simulation."""
        return _told(engine.start("simulate", asked.model_dump()))

    @router.post("/api/jobs/campaign", status_code=202, responses=_FULL, tags=["jobs"])
    async def campaign(asked: AskedToRun) -> JobAnswer:
        """Begin simulations of one problem with some of its numbers replaced."""
        if len(asked.cases) > engine.limits.cases:
            raise Refused(
                f"{len(asked.cases)} cases are more than the {engine.limits.cases} that a campaign "
                "may have here; viscotack campaign has no such limit"
            )
        return _told(engine.start("campaign", asked.model_dump()))

    @router.get("/api/jobs/{id}", responses=_NO_JOB, tags=["jobs"])
    async def job(
        id: Id,
        points_from: Annotated[int, Query(ge=0, le=10**9, description="First point.")] = 0,
        rows_from: Annotated[int, Query(ge=0, le=10**9, description="First row.")] = 0,
        wait: Annotated[
            float, Query(ge=0, le=_LONGEST_WAIT, description="Wait for news so long [s].")
        ] = 0.0,
    ) -> JobAnswer:
        """Ask how far a job is, and for its answer when it is done."""
        found = engine.job(id)
        known = len(found.points) > points_from or len(found.rows) > rows_from
        if wait and not found.over and not known:
            try:
                await asyncio.wait_for(found.news.wait(), wait)
            except TimeoutError:
                pass  # no news is an answer too
        return _told(found, points_from, rows_from)

    @router.delete("/api/jobs/{id}", responses=_NO_JOB, tags=["jobs"])
    async def cancel(id: Id) -> JobAnswer:
        """End a job, and forget it."""
        return _told(await engine.cancel(id))


def _told(job: Job, points_from: int = 0, rows_from: int = 0) -> JobAnswer:
    return JobAnswer.model_validate(
        {
            "id": job.id,
            "kind": job.kind,
            "state": job.state,
            "share": min(job.share, 1.0),
            "points": job.points[points_from:],
            "points_from": points_from,
            "rows": job.rows[rows_from:],
            "rows_from": rows_from,
            "error": job.error,
            "answer": job.answer,
        }
    )


def _laboratory(router: APIRouter, engine: Engine) -> None:
    async def ask(
        task: str, files: list[UploadFile], options: Mapping[str, Any], **more: Any
    ) -> Answer:
        given = {name: value for name, value in options.items() if value not in (None, "")}
        async with _received(engine, files) as paths:
            asked = {"files": paths, "options": given, **more}
            return Answer(**_bare(await engine.ask(task, asked), paths))

    @router.post("/api/materials/fit", tags=["materials"])
    async def fit(
        files: Files,
        poisson_ratio: Annotated[Words, Form()] = "0.5",
        reference_temperature: Annotated[Words | None, Form(examples=["20 degC"])] = None,
        glass_transition: Annotated[Words | None, Form(examples=["-115 degC"])] = None,
        wlf: Annotated[Words | None, Form(examples=["8.86,101.6 K"])] = None,
        model: Annotated[Words, Form(examples=["best", "power-law", "prony"])] = "best",
        format: Annotated[Words | None, Form()] = None,
        kind: Annotated[Words | None, Form(examples=["E", "G"])] = None,
        temperature: Annotated[Words | None, Form(examples=["20 degC"])] = None,
        frequency_unit: Annotated[Words | None, Form(examples=["Hz"])] = None,
        modulus_unit: Annotated[Words | None, Form(examples=["MPa"])] = None,
        time_unit: Annotated[Words | None, Form(examples=["s"])] = None,
        temperature_unit: Annotated[Words | None, Form(examples=["degC"])] = None,
        name: Annotated[Words | None, Form()] = None,
    ) -> Answer:
        """Fit a material to files of a DMA, relaxation or creep test."""
        options = {key: value for key, value in locals().items() if key not in ("files", "ask")}
        return await ask("fit", files, options)

    @router.post("/api/tests", tags=["laboratory"])
    async def tests(
        files: Files,
        format: Annotated[Words | None, Form()] = None,
        force_unit: Annotated[Words | None, Form(examples=["mN"])] = None,
        length_unit: Annotated[Words | None, Form(examples=["um"])] = None,
        time_unit: Annotated[Words | None, Form(examples=["s"])] = None,
        force_column: Annotated[Words | None, Form()] = None,
        nominal_speed: Annotated[Words | None, Form(examples=["10 um/s"])] = None,
        compliance: Annotated[Words | None, Form(examples=["2 um/N"])] = None,
        retraction_only: Annotated[bool, Form()] = False,
    ) -> Answer:
        """Read tack tests or force curves: pull-off, work, depth and true speed of every cycle."""
        options = {key: value for key, value in locals().items() if key not in ("files", "ask")}
        return await ask("tests", files, options)

    @router.post("/api/identify/slow", tags=["laboratory"])
    async def slow(
        files: Files,
        radius: Annotated[Words, Form(examples=["5.19 mm"])],
        cycle: Annotated[int, Form(ge=1, le=10**6)] = 1,
        contact_modulus: Annotated[Words | None, Form(examples=["1.94 MPa"])] = None,
        contact_modulus_uncertainty: Annotated[Words | None, Form(examples=["0.06 MPa"])] = None,
        format: Annotated[Words | None, Form()] = None,
        force_unit: Annotated[Words | None, Form(examples=["mN"])] = None,
        length_unit: Annotated[Words | None, Form(examples=["um"])] = None,
        nominal_speed: Annotated[Words | None, Form(examples=["10 um/s"])] = None,
        compliance: Annotated[Words | None, Form(examples=["2 um/N"])] = None,
    ) -> Answer:
        """Find work of adhesion and Tabor number from one slow retraction of a sphere."""
        options = {key: value for key, value in locals().items() if key not in ("files", "ask")}
        return await ask("slow", files, options)

    @router.post("/api/identify/rates", tags=["laboratory"])
    async def rates(
        files: Files,
        radius: Annotated[Words, Form(examples=["5.19 mm"])],
        material: Annotated[
            str,
            Form(
                max_length=200_000,
                description="The solid, as the TOML text of a table [material] or the name of a "
                "published material.",
                examples=["pdms-10-1"],
            ),
        ],
        preload: Annotated[Words | None, Form(examples=["1.5 mN"])] = None,
        work_of_adhesion: Annotated[Words | None, Form(examples=["152 mJ/m^2"])] = None,
        work_of_adhesion_uncertainty: Annotated[Words | None, Form(examples=["8 mJ/m^2"])] = None,
        format: Annotated[Words | None, Form()] = None,
        force_unit: Annotated[Words | None, Form(examples=["mN"])] = None,
        length_unit: Annotated[Words | None, Form(examples=["um"])] = None,
        nominal_speed: Annotated[Words | None, Form(examples=["10 um/s"])] = None,
        compliance: Annotated[Words | None, Form(examples=["2 um/N"])] = None,
    ) -> Answer:
        """Find work of adhesion and range of attraction from pull-offs at several speeds."""
        left_out = ("files", "ask", "material")
        options = {key: value for key, value in locals().items() if key not in left_out}
        return await ask("rates", files, options, material=material)


def _bare(value: Any, paths: list[str]) -> Any:
    """Return an answer in which files have their names, and not the place where they lay."""
    if isinstance(value, dict):
        return {key: _bare(entry, paths) for key, entry in value.items()}
    if isinstance(value, list):
        return [_bare(entry, paths) for entry in value]
    if isinstance(value, str) and paths:
        return value.replace(f"{dirname(paths[0])}/", "")
    return value


@asynccontextmanager
async def _received(engine: Engine, files: list[UploadFile]) -> AsyncIterator[list[str]]:
    """Hold the files of a request in a folder for the block."""
    if len(files) > _MOST_FILES:
        raise Refused(f"{len(files)} files are more than the {_MOST_FILES} of one request")
    contents = [(file.filename or "file", await file.read()) for file in files]
    async with engine.uploaded(contents) as paths:
        yield paths


def _page(router: APIRouter, engine: Engine) -> None:
    @router.get("/api/forms", tags=["page"])
    async def forms() -> Answer:
        """Say what can be asked, read from the cards: choices, fields, units, ranges, examples."""
        return Answer(**await engine.ask("forms", {}))

    @router.post("/api/state", tags=["page"])
    async def state(asked: AskedState) -> Answer:
        """Return a state as tables, file and link, from one of the three."""
        return Answer(**await engine.ask("state", asked.model_dump()))

    @router.post("/api/quick", tags=["page"])
    async def quick(asked: AskedQuick) -> Answer:
        """Return what is known of a state in milliseconds: curves, numbers with intervals."""
        return Answer(**await engine.ask("quick", asked.model_dump()))

    @router.post("/api/moduli", tags=["page"])
    async def moduli(asked: AskedQuick) -> Answer:
        """Return storage and loss modulus of a state's material over the frequency."""
        return Answer(**await engine.ask("moduli", asked.model_dump()))

    @router.post("/api/verdict", tags=["page"])
    async def verdict(asked: AskedVerdict) -> Answer:
        """Return the advisor's words on a state."""
        return Answer(**await engine.ask("verdict", asked.model_dump()))

    @router.post("/api/theory", tags=["page"])
    async def theory(asked: AskedTheory) -> Answer:
        """Return the curves of the theories that may take seconds."""
        return Answer(**await engine.ask("theory", asked.model_dump()))

    @router.get("/", include_in_schema=False)
    async def page() -> Response:
        return _file("index.html")

    @router.get("/api/docs", include_in_schema=False)
    async def docs() -> Response:
        return _file("docs.html")

    @router.get("/page/{name}", include_in_schema=False)
    async def part(name: str) -> Response:
        return _file(name)


# What the page is made of: the names that are asked for are looked up here, and not in a folder.
_PARTS = {
    part.name: part
    for part in files_of("viscotack.app.page").iterdir()
    if part.name.rpartition(".")[2] in _KINDS
}


def _file(name: str) -> Response:
    if name not in _PARTS:
        return Response("there is no such file", 404, media_type="text/plain")
    kind = _KINDS[name.rpartition(".")[2]]
    # always asked for anew: the page and the program it asks are of one version
    return Response(
        _PARTS[name].read_bytes(), media_type=kind, headers={"cache-control": "no-cache"}
    )

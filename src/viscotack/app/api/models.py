"""Schemas of requests and responses of the API, with the limits of single numbers."""

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from viscotack.model.problem.accuracy import DEFAULT_ACCURACY, LOOSEST_ACCURACY

Accuracy = Annotated[
    float,
    Field(ge=1e-6, le=LOOSEST_ACCURACY, description="Required relative error of the force."),
]
Until = Annotated[
    Literal["pull-off", "detached"],
    Field(description="Stop past the largest tension, or when the surfaces are apart."),
]
Confidence = Annotated[
    float, Field(description="0.5, 0.6, 0.7, 0.8, 0.9, 0.95 or 0.98: for these it was measured.")
]


class Strict(BaseModel):
    """Base class of requests; rejects unknown names."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


class AskedState(Strict):
    """A case file, as text."""

    toml: Annotated[str, Field(max_length=200_000)]


class AskedQuick(Strict):
    """A state of the page while its numbers are dragged."""

    tables: dict[str, Any]
    accuracy: Accuracy = DEFAULT_ACCURACY
    until: Until = "detached"
    confidence: Confidence = 0.9


class AskedVerdict(Strict):
    """A state of the page for which advice is requested."""

    tables: dict[str, Any]


class AskedTheory(AskedVerdict):
    """A state of the page, and which slow theories to evaluate."""

    crack: Annotated[bool, Field(description="The contact whose edge is a steady crack.")] = True
    speeds: Annotated[bool, Field(description="The best theory at other speeds.")] = False


class SentFiles(BaseModel):
    """Files that were sent, for the query of requests that name them."""

    files: str


class Refusal(BaseModel):
    """Error response: the problem, the value, and a remedy; `field` is the option, if it is one."""

    error: str
    field: str = ""


class Answer(BaseModel):
    """Response; its keys are those of the ``--json`` output of the command line."""

    model_config = ConfigDict(extra="allow")


class JobAnswer(BaseModel):
    """State of a job."""

    id: str
    kind: str
    state: Literal["queued", "running", "done", "refused", "failed", "cancelled"]
    share: Annotated[float, Field(ge=0, le=1, description="Done share of the work.")]
    points: Annotated[
        list[list[float | None]],
        Field(
            description="Of the growing curve, from `points_from` on: time, depth, force, contact "
            "radius; in SI where the problem is."
        ),
    ]
    points_from: int
    rows: Annotated[list[dict[str, Any]], Field(description="Of a sweep, from `rows_from` on.")]
    rows_from: int
    error: Annotated[str, Field(description="Why there is no answer; empty else.")]
    field: Annotated[str, Field(description="The option that the error names; empty else.")]
    answer: Annotated[
        dict[str, Any] | None,
        Field(description="The record of the operation, as its command prints it with --json."),
    ]

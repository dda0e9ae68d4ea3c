"""Schemas of the responses of the API."""

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field


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
    error: Annotated[str, Field(description="Why there is no answer; empty else.")]
    field: Annotated[str, Field(description="The option that the error names; empty else.")]
    answer: Annotated[
        dict[str, Any] | None,
        Field(description="The record of the operation, as its command prints it with --json."),
    ]

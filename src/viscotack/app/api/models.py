"""Schemas of the responses of the API."""

from pydantic import BaseModel, ConfigDict


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

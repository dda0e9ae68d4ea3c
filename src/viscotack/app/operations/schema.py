"""The operation ``schema``: the JSON schema of a problem."""

import json
from typing import ClassVar

from .options import switch
from .request import Answer, Caller, Request


class Schema(Request):
    """Print the JSON schema of a problem: every number with its unit, symbol and range.

    It describes the object `problem` of --json, which results and campaigns keep as well.

    Example: viscotack schema > problem.schema.json
    """

    word: ClassVar = "schema"
    takes_own: ClassVar = True

    words: bool = switch("Tables in Markdown for people, in place of the schema.")

    def answer(self, caller: Caller) -> Answer:
        """Read the cards of all nouns."""
        from viscotack.model.problem.record import schema, words

        found = schema(caller.also)
        return Answer(
            found,
            data=found,
            words=words(caller.also) if self.words else json.dumps(found, indent=2),
        )

"""What there is to replicate, a part each."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Part:
    """A publication's claims, and the command that puts them to the test.

    Attributes
    ----------
    room : str
        Module of the part: ``python -m ROOM`` runs it.
    options : str
        Of its whole run.
    claim : str
        What is put to the test.
    source : str
        Who published it, and where.
    time : str
        How long it takes.
    """

    room: str
    options: str
    claim: str
    source: str
    time: str

    @property
    def command(self) -> str:
        """The command of the whole run."""
        return f"python -m {self.room} {self.options}".rstrip()

    def words(self) -> str:
        """Return the part in four lines."""
        return f"{self.command}\n  {self.claim}\n  Source: {self.source}\n  Time: {self.time}"


CONTENTS = (
    Part(
        room="research.replication.published",
        options="--table rows.csv --workers 2 --write research/replication/published",
        claim="How good the published table of detachments is, row by row",
        source="the table of the thesis's authors, 9,005 rows",
        time="15 min of processor time; two with --count 1000",
    ),
    Part(
        room="research.replication.second_code",
        options="",
        claim="Steady cracks and pull-offs of this package, by other formulations",
        source="this package; the manuscript in the folder `paper`",
        time="two minutes of processor time",
    ),
)

"""Which machines of a cluster are given cases, and which are not; the cluster is played."""

from types import SimpleNamespace

import pytest

from viscotack.campaign import CaseSettings, cluster
from viscotack.campaign.case import Answer, Lost
from viscotack.campaign.cluster import DaskCrew
from viscotack.campaign.identity import identity

pytest.importorskip("distributed", reason="the cluster extra is not installed")
ANSWER = Answer({"pull_off_force": 1.0}, "", "", 0.1, 1e6)


class Future:
    """What a cluster owes."""

    def __init__(self, function, arguments, address):
        self.asked = eval(*arguments) if function is eval else None
        self.address = address
        self.status, self.told, self.error, self.is_cancelled = "pending", None, None, False

    def add_done_callback(self, call):
        self.call = call

    def end(self, told=None, error=None, status="finished"):
        self.told, self.error = told, error
        self.status = "error" if error else status
        self.call(self)

    def result(self, timeout):
        if isinstance(self.told, Exception):
            raise self.told
        return self.told

    def exception(self, timeout=None):
        return self.error

    def cancel(self):
        self.is_cancelled = True

    def cancelled(self):
        return self.is_cancelled


class Client:
    """A cluster that does what it is told to do here."""

    def __init__(self, **threads):
        self.threads, self.futures, self.status = threads, [], "running"
        self.scheduler = SimpleNamespace(address="tcp://here:8786")

    def nthreads(self):
        return dict(self.threads)

    def submit(self, function, *arguments, workers, **options):
        assert options.pop("allow_other_workers") is False
        self.futures.append(Future(function, arguments, workers[0]))
        return self.futures[-1]

    def last(self, address):
        return [future for future in self.futures if future.address == address][-1]


@pytest.fixture
def clock(monkeypatch):
    """Return a clock that goes when it is told to; lists of workers serve for no time at all."""
    now = [1000.0]
    monkeypatch.setattr(cluster, "monotonic", lambda: now[0])
    monkeypatch.setattr(cluster, "_LISTED", 0.0)
    return now


def crew_of(client):
    return DaskCrew(client, b"", CaseSettings())


def test_a_machine_is_given_nothing_before_it_has_said_what_it_runs(clock):
    client = Client(a=1, b=3)
    crew = crew_of(client)
    assert crew.room() == 0 and crew.workers() == 1
    assert [future.asked for future in client.futures] == [identity(), identity()]
    client.last("a").end(identity())
    assert crew.collect(0.0) == [] and (crew.room(), crew.workers()) == (2, 1)
    client.last("b").end(identity())
    # a thread has a case, and all of them one beside it
    assert crew.collect(0.0) == [] and (crew.room(), crew.workers()) == (2 + 4, 4)
    given = []
    for number in range(6):
        crew.hand(number, "{}")
        given.append(client.futures[-1].address)
    assert crew.room() == 0 and sorted(given) == ["a"] * 2 + ["b"] * 4
    assert given[:2] == ["b", "b"], "the one that has most room comes first"
    client.futures[-1].end(ANSWER)
    assert crew.collect(0.0) == [(5, ANSWER)] and crew.room() == 1


def ready(**threads):
    """Return a crew whose machines are fit, and its cluster."""
    client = Client(**threads)
    crew = crew_of(client)
    crew.room()
    for address in threads:
        client.last(address).end(identity())
    crew.collect(0.0)
    return crew, client


def test_what_a_machine_had_is_lost_when_it_leaves_and_nobody_is_blamed(clock):
    crew, client = ready(a=1, b=1)
    for number in range(4):
        crew.hand(number, "{}")
    late = [future for future in client.futures[2:] if future.address == "a"]
    del client.threads["a"]
    lost = crew.collect(0.0)
    assert [what for _, what in lost] == [Lost("its worker a has left", blame=False)] * 2
    assert len({number for number, _ in lost}) == 2 and all(f.cancelled() for f in late)
    # what it says after that is not heard
    late[0].end(ANSWER)
    assert crew.collect(0.0) == [] and crew.workers() == 1
    # one that comes back is asked again
    client.threads["a"] = 1
    assert crew.room() == 0 and client.last("a").asked == identity()
    client.last("a").end({"viscotack": "0.0"})
    crew.collect(0.0)
    assert crew.room() == 0 and crew.workers() == 1

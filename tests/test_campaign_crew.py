"""Which machines of a cluster are given cases, and which are not; the cluster is played."""

import json
from types import SimpleNamespace

import pytest

import synthetic
from viscotack import InputError, to_dict
from viscotack.campaign import CaseSettings, NoWorker, cluster, local
from viscotack.campaign.case import Answer, Lost
from viscotack.campaign.cluster import DaskCrew, Gone, do_case, security_of
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


@pytest.mark.parametrize(
    ("told", "error", "words"),
    [
        ({"viscotack": "0.0"}, None, "a: it is of another program: viscotack 0.0 and not"),
        (None, ImportError("no such"), "a: it cannot begin: ImportError: no such"),
    ],
)
def test_why_a_machine_is_given_nothing_is_said(clock, told, error, words):
    client = Client(a=1)
    crew = crew_of(client)
    crew.room()
    client.last("a").end(told, error)
    assert crew.collect(0.0) == [] and crew.room() == 0
    clock[0] += cluster._FIRST - 0.1
    assert crew.room() == 0
    clock[0] += 0.2
    with pytest.raises(NoWorker, match=f"no worker of tcp://here:8786 can run .*: {words}"):
        crew.room()


def test_three_machines_are_named_and_the_others_counted(clock):
    client = Client(a=1, b=1, c=1, d=1, e=1)
    crew = crew_of(client)
    crew.room()
    for address in "abcde":
        client.last(address).end({"viscotack": "0.0"})
    crew.collect(0.0)
    clock[0] += 100.0
    with pytest.raises(NoWorker, match="a: it is.*b: it is.*c: it is.* and 2 more; workers need"):
        crew.room()


def test_how_long_a_worker_is_awaited(clock):
    crew = crew_of(Client())
    clock[0] += cluster._FIRST + 0.1
    with pytest.raises(NoWorker, match="here:8786 answers, but it has no workers; start some"):
        crew.room()
    # one that is there and has not answered is given longer, for it imports much
    client = Client(a=1)
    crew = crew_of(client)
    crew.room()
    clock[0] += cluster._ANSWER - 0.1
    assert crew.room() == 0
    clock[0] += 0.2
    with pytest.raises(NoWorker, match="a: busy with others, or it does not answer"):
        crew.room()
    # and when all have left that were there, another one longest
    client = Client(a=1)
    crew = crew_of(client)
    crew.room()
    client.last("a").end(identity())
    crew.collect(0.0)
    client.threads.clear()
    clock[0] += cluster._AGAIN - 0.1
    assert crew.room() == 0
    clock[0] += 0.2
    with pytest.raises(NoWorker, match="answers, but all its workers have left"):
        crew.room()
    assert cluster._FIRST + 1 < 15 < cluster._ANSWER < cluster._AGAIN


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


@pytest.mark.parametrize(
    ("end", "words", "stays"),
    [
        ({"told": "source 1 and not 2"}, "its worker a is of another program: source 1", False),
        ({"error": TypeError("no")}, "its worker a cannot do it: no", False),
        ({"told": TimeoutError("gone")}, "its worker a left with its answer", True),
        ({"status": "cancelled"}, "its worker a left with its answer", True),
    ],
)
def test_a_case_that_does_not_come_back_is_lost_without_blame(clock, end, words, stays):
    crew, client = ready(a=1)
    crew.hand(7, "{}")
    client.futures[-1].end(**end)
    ((number, lost),) = crew.collect(0.0)
    assert number == 7 and lost.reason.startswith(words) and lost.blame is False
    assert (crew.room() > 0) is stays


def test_a_machine_whose_word_is_gone_is_asked_again(clock):
    client = Client(a=1)
    crew = crew_of(client)
    crew.room()
    first = client.last("a")
    first.end(TimeoutError("the data has gone with it"))
    assert crew.collect(0.0) == [] and crew.room() == 0
    assert client.last("a") is not first
    first.end(identity())  # of no use any more
    assert crew.collect(0.0) == [] and crew.room() == 0
    client.last("a").end(identity())
    assert crew.collect(0.0) == [] and crew.room() == 2


def test_a_scheduler_that_has_gone_is_said(clock, monkeypatch):
    crew, client = ready(a=1)
    crew.hand(0, "{}")
    client.status = "closed"
    client.futures[-1].end(status="lost")
    with pytest.raises(Gone, match="connection to the scheduler was lost; what is stored is safe"):
        crew.collect(0.0)
    crew, client = ready(a=1)

    def gone():
        raise OSError("no answer")

    client.nthreads = gone
    with pytest.raises(Gone):
        crew.room()


class Thread:
    """Stands for the supervisor of a thread's own process."""

    made = []

    def __init__(self, packed, settings, workers):
        assert workers == 1
        self.packed, self.left, self.waits = packed, False, 2
        self.made.append(self)

    def room(self):
        self.waits -= 1
        return self.waits < 0

    def hand(self, number, problem):
        self.problem = problem

    def collect(self, seconds):
        if self.waits >= 0:
            return []
        if self.problem == "none":
            raise NoWorker("no worker can start")
        return [(0, ANSWER)]

    def dismiss(self, *, at_once):
        self.left = at_once


def test_a_thread_of_a_cluster_keeps_a_process_of_its_own(monkeypatch):
    monkeypatch.setattr(local, "LocalCrew", Thread)
    monkeypatch.setattr(cluster, "_THREAD", SimpleNamespace())
    monkeypatch.setattr(Thread, "made", [])
    who, settings = identity(), CaseSettings()
    problem = json.dumps(to_dict(synthetic.GROUPS))
    assert do_case(b"work", settings, problem, who | {"viscotack": "0"}).startswith("viscotack ")
    assert not Thread.made
    for _ in range(3):
        assert do_case(b"work", settings, problem, who) == ANSWER
    assert len(Thread.made) == 1 and Thread.made[0].problem == problem
    # other work has another process
    assert do_case(b"other", settings, problem, who) == ANSWER
    assert [one.left for one in Thread.made] == [True, False]
    assert do_case(b"other", settings, "none", who) == "no worker can start"
    assert do_case(b"other", settings, problem, who) == ANSWER and len(Thread.made) == 3


@pytest.mark.parametrize("given", ["100", "010", "001", "110", "101", "011"])
def test_a_certificate_is_of_three_files(tmp_path, given):
    files = [tmp_path / str(i) if word == "1" else None for i, word in enumerate(given)]
    with pytest.raises(InputError, match="TLS needs three files"):
        security_of(*files)

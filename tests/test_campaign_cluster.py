"""A Dask cluster: certificates, machines that come and go, of other programs, or none at all."""

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import pytest

from campaign_work import (
    InlineCrew,
    employ,
    plan_of,
    slow,
    stand_in,
    told,
    trouble,
    unhurried,
)
from processes import until
from viscotack import InputError
from viscotack.campaign import NoWorker, Store, cluster, run
from viscotack.campaign.cluster import Security, security_of

pytest.importorskip("distributed", reason="the cluster extra is not installed")
HERE = Path(__file__).parent
DASK = [sys.executable, "-m", "dask"]


@pytest.fixture(autouse=True)
def findable(monkeypatch):
    monkeypatch.setattr(cluster, "_FIRST", 60.0)  # on a machine that is busy with others
    before = os.environ.get("PYTHONPATH")
    paths = [str(HERE), before] if before else [str(HERE)]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(paths))


class Cluster:
    """A scheduler and workers, each a process of its own, over TCP."""

    def __init__(self, folder, secured=None):
        self.folder, self.secured = folder, secured
        self.quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        self.workers = []
        file = folder / "scheduler.json"
        file.unlink(missing_ok=True)
        words = ["--port", "0", "--no-dashboard", "--scheduler-file", str(file), *self.flags()]
        self.scheduler = subprocess.Popen([*DASK, "scheduler", *words], **self.quiet)
        until(lambda: file.exists() and file.read_text().endswith("}"))  # not whole at once
        self.address = json.loads(file.read_text())["address"]

    def flags(self):
        if self.secured is None:
            return []
        files = zip(("ca-file", "cert", "key"), self.secured, strict=True)
        return [word for name, path in files for word in (f"--tls-{name}", str(path))]

    def hire(self, count=1, path=None):
        """Start workers; of the program at another path."""
        words = ["--nthreads", "1", "--no-nanny", "--no-dashboard", *self.flags()]
        words += ["--local-directory", str(self.folder)]
        env = os.environ | ({"PYTHONPATH": path} if path else {})
        command = [*DASK, "worker", self.address, *words]
        self.workers += [
            subprocess.Popen(command, env=env, cwd=self.folder, **self.quiet) for _ in range(count)
        ]

    def await_workers(self, count):
        """Wait until the scheduler knows so many."""
        from distributed import Client

        with Client(self.address, set_as_default=False) as client:
            until(lambda: len(client.nthreads()) == count)

    def end(self):
        for process in [*self.workers, self.scheduler]:
            process.kill()
            process.wait()


@contextmanager
def held(*arguments):
    found = Cluster(*arguments)
    try:
        yield found
    finally:
        found.end()


@pytest.fixture(scope="session")
def certificates(tmp_path_factory):
    """Return an authority, and a certificate and a key that it has signed, made here."""
    if shutil.which("openssl") is None:
        pytest.skip("openssl makes the certificates")
    folder = tmp_path_factory.mktemp("certificates")
    ca, ca_key, cert, key, wish = (
        str(folder / name) for name in ("ca.pem", "ca.key", "cert.pem", "key.pem", "wish.pem")
    )
    openssl = ["openssl"]
    curve = ["-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes"]
    for words in (
        ["req", "-x509", *curve, "-keyout", ca_key, "-out", ca, "-subj", "/CN=ca", "-days", "2"],
        ["req", *curve, "-keyout", key, "-out", wish, "-subj", "/CN=127.0.0.1"],
        ["x509", "-req", "-in", wish, "-CA", ca, "-CAkey", ca_key, "-out", cert, "-days", "2"],
    ):
        subprocess.run([*openssl, *words], check=True, capture_output=True)
    return Path(ca), Path(cert), Path(key)


def told_by_one_process(tmp_path, plan, monkeypatch, work=stand_in):
    with monkeypatch.context() as patch:
        employ(patch, InlineCrew())
        run(plan, tmp_path / "here", work=work)
    return told(tmp_path / "here")


# Clusters of processes take ten seconds and more; what a crew does with its scheduler is held by
# tests/test_campaign_crew.py.


@pytest.mark.slow
def test_a_cluster_with_certificates_gives_the_same_table_when_a_worker_is_killed(
    tmp_path, monkeypatch, certificates
):
    plan, killed = plan_of(tmp_path, cases=40), []
    with held(tmp_path, certificates) as dask:
        assert dask.address.startswith("tls://")
        dask.hire(2)

        def murder(now):
            if now.done > 10 and not killed:
                killed.append(dask.workers[0].pid)
                dask.workers[0].kill()

        options = {"security": security_of(*certificates), "store_every": 0.1}
        end = run(plan, tmp_path / "c", scheduler=dask.address, work=slow, report=murder, **options)
        assert (end.done, end.failed) == (40, 0) and killed
        # who has no certificate is not let in, and that is said
        monkeypatch.setattr(cluster, "_CONNECT", 2.0)
        with pytest.raises(ConnectionError, match="no scheduler answers at 'tls://"):
            run(plan, tmp_path / "d", scheduler=dask.address, work=slow)
    assert told(tmp_path / "c") == told_by_one_process(tmp_path, plan, monkeypatch)


def altered(folder):
    """Return a copy of this program with other physics in it."""
    import viscotack

    shutil.copytree(
        Path(viscotack.__file__).parent,
        folder / "viscotack",
        ignore=shutil.ignore_patterns("__pycache__"),
    )
    with (folder / "viscotack/bem/solver.py").open("a") as file:
        file.write("# other physics\n")
    return os.pathsep.join([str(HERE), str(folder)])


def broken_package(folder):
    """Return the path of a program that cannot begin."""
    (folder / "viscotack").mkdir(parents=True)
    (folder / "viscotack/__init__.py").write_text("raise ImportError('half an installation')\n")
    return str(folder)


@pytest.mark.slow
def test_no_worker_no_case(tmp_path, monkeypatch):
    monkeypatch.setattr(cluster, "_FIRST", 5.0)
    plan = plan_of(tmp_path, cases=4)
    with held(tmp_path) as dask:
        with pytest.raises(NoWorker, match="answers, but it has no workers; start some with"):
            run(plan, tmp_path / "a", scheduler=dask.address, work=stand_in)
        # one with altered physics, and one whose package cannot be imported
        dask.hire(1, altered(tmp_path / "altered"))
        dask.hire(1, broken_package(tmp_path / "broken"))
        dask.await_workers(2)
        with pytest.raises(NoWorker, match="of another program") as caught:
            run(plan, tmp_path / "b", scheduler=dask.address, work=stand_in)
        words = str(caught.value)
        assert "source " in words and "it cannot begin: ImportError: half an installation" in words
        assert Store(tmp_path / "b").failures().num_rows == 0
        # beside one that is fit it is given nothing
        dask.hire(1)
        dask.await_workers(3)
        assert run(plan, tmp_path / "b", scheduler=dask.address, work=stand_in).done == 4


def test_three_files_or_none_are_needed_for_certificates(tmp_path):
    assert security_of(None, None, None) is None
    with pytest.raises(InputError, match="TLS needs three files"):
        security_of(tmp_path, None, None)
    for name in "abc":
        (tmp_path / name).write_text("")
    files = [tmp_path / name for name in "abc"]
    assert security_of(*files) == Security(*files)
    with pytest.raises(FileNotFoundError):
        security_of(tmp_path / "d", *files[1:])


@pytest.mark.slow
def test_limits_bind_on_a_cluster_too(tmp_path, monkeypatch):
    # no case that ends by itself takes so long, beside any load
    plan = plan_of(tmp_path, cases=20, text="settings.time_limit = 3")
    with held(tmp_path) as dask:
        dask.hire(2)
        end = run(plan, tmp_path / "c", scheduler=dask.address, work=trouble)
    assert (end.done, end.failed) == (18, 2)
    failures = Store(tmp_path / "c").failures().to_pylist()
    assert {(row["rate"], row["failure"]) for row in failures} == {
        (7.0, "worker died"),
        (11.0, "time limit"),
    }


@pytest.mark.slow
def test_a_thousand_cases_over_tls_with_workers_replaced_every_5_s_are_the_local_table(
    tmp_path, monkeypatch, certificates
):
    plan, replaced = plan_of(tmp_path, cases=1000), [(time.monotonic(), 0)]
    with held(tmp_path, certificates) as dask:
        dask.hire(4)

        def replace(now):
            # on a machine that is busy a worker takes longer to begin, and another one is awaited
            due = time.monotonic() - replaced[-1][0] > 5.0 and now.done > replaced[-1][1]
            if due and len(replaced) < 40:
                oldest = dask.workers[len(replaced) - 1]
                oldest.send_signal(signal.SIGKILL if len(replaced) % 2 else signal.SIGTERM)
                dask.hire()
                replaced.append((time.monotonic(), now.done))

        options = {"security": security_of(*certificates), "store_every": 0.5}
        options |= {"scheduler": dask.address, "work": unhurried, "report": replace}
        end = run(plan, tmp_path / "c", **options)
    assert (end.done, end.failed) == (1000, 0) and len(replaced) > 5
    assert told(tmp_path / "c") == told_by_one_process(tmp_path, plan, monkeypatch)


@pytest.mark.slow
def test_twenty_workers_that_come_and_go_give_the_same_table(tmp_path, monkeypatch):
    plan, chance = plan_of(tmp_path, cases=400), random.Random(5)
    with held(tmp_path) as dask:
        dask.hire(3)

        def stir(now):
            if len(dask.workers) < 20 and chance.random() < 0.5:
                dask.hire()
                chance.choice(dask.workers[:-2]).send_signal(
                    chance.choice([signal.SIGKILL, signal.SIGTERM])
                )

        options = {"work": slow, "report": stir, "store_every": 0.3}
        end = run(plan, tmp_path / "c", scheduler=dask.address, **options)
    assert (end.done, end.failed) == (400, 0)
    assert told(tmp_path / "c") == told_by_one_process(tmp_path, plan, monkeypatch)


@pytest.mark.slow
def test_a_scheduler_that_is_killed_ends_the_run_and_the_next_one_goes_on(tmp_path, monkeypatch):
    plan = plan_of(tmp_path, cases=200)
    with held(tmp_path) as dask:
        dask.hire(2)

        def murder(now):
            if now.done > 20:
                dask.scheduler.kill()

        options = {"work": slow, "report": murder, "store_every": 0.2}
        with pytest.raises(ConnectionError, match="connection to the scheduler was lost"):
            run(plan, tmp_path / "c", scheduler=dask.address, **options)
    assert 20 < Store(tmp_path / "c").results().num_rows < 200
    assert run(plan, tmp_path / "c", workers=2, work=stand_in).done == 200
    assert told(tmp_path / "c") == told_by_one_process(tmp_path, plan, monkeypatch)

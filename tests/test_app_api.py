"""The API in its own process: answers, jobs, limits, files that are sent, and who may ask."""

from dataclasses import replace
from multiprocessing import active_children

import pytest
from fastapi import FastAPI

from front_ends import Client, served
from viscotack.app.api import application
from viscotack.app.api.routes import guard
from viscotack.app.engine.jobs import Engine, Limits
from viscotack.app.operations.parts.solid import FIRST

OVER = ("done", "refused", "failed", "cancelled")


class Asking(Client):
    """A client that begins jobs and waits for their ends."""

    def job(self, kind, outputs=(), **asked):
        params = {"outputs": list(outputs)}
        return self("POST", f"/api/jobs/{kind}", json={"problem": FIRST, **asked}, params=params)

    def answer(self, id):
        while True:
            found = self("GET", f"/api/jobs/{id}", params={"wait": 5}).json()
            if found["state"] in OVER:
                return found


@pytest.fixture(scope="module")
def engine():
    # one process for what takes long: the others are started where they are needed
    return Engine(Limits(jobs=101, workers=1, cases=3, body=200_000))


@pytest.fixture(scope="module")
def ask(engine):
    with served(Asking(application(engine))) as client:
        yield client
    assert active_children() == []


def test_a_simulation_is_a_job_whose_curve_grows_and_whose_digits_are_those_of_solve(ask):
    import viscotack as vt

    asked = {"accuracy": 0.01, "until": "pull-off", "profiles": True, "outputs": ["drawn"]}
    begun = ask.job("simulate", **asked)
    assert begun.status_code == 202
    found = ask.answer(begun.json()["id"])
    result = vt.solve(problem_of_first(), accuracy=0.01, until="pull-off")
    summary, drawn = found["answer"], found["answer"]["beside"]["drawn"]
    assert found["state"] == "done" and found["share"] == 1.0
    assert summary["pull_off_force_N"] == vt.summary(result)["pull_off_force_N"]
    # what was told while it ran is the curve of the answer
    assert [point[2] for point in found["points"]] == drawn["columns"]["force_N"][1:]
    assert drawn["profiles"][0].keys() == {"step", "radius", "gap", "pressure", "flank"}
    later = ask("GET", f"/api/jobs/{found['id']}", params={"points_from": 10}).json()
    assert later["points"] == found["points"][10:]
    told = ask("DELETE", f"/api/jobs/{found['id']}")
    # what was read is not sent again
    assert told.status_code == 200 and told.json()["state"] == "done"
    assert (told.json()["answer"], told.json()["points"]) == (None, [])
    assert ask("GET", f"/api/jobs/{found['id']}").status_code == 404


def problem_of_first():
    from viscotack.model.problem.case_file import case_of_tables

    return case_of_tables(FIRST)


def test_a_sweep_has_a_row_for_each_case_and_says_why_one_failed(ask):
    cases = [{"protocol.speed": 1e-5}, {"protocol.speed": -1.0}]
    begun = ask.job("sweep", cases=cases, accuracy=0.02)
    found = ask.answer(begun.json()["id"])
    good, bad = found["answer"]["rows"]
    assert good["outputs"]["pull_off_force_N"] == pytest.approx(4.07e-3, rel=0.01)
    assert bad["outputs"] is None and "speed must be positive" in bad["reason"]
    assert found["answer"]["failed"] == 1
    many = ask.job("sweep", cases=cases * 2)
    assert many.status_code == 422 and "exceed the limit of 3" in many.json()["error"]


@pytest.mark.parametrize("end", ["cancelled", "failed"])
def test_after_a_job_that_is_cancelled_or_whose_process_crashes_the_next_is_served(
    ask, engine, end, monkeypatch
):
    # which would take minutes
    id = ask.job("simulate", accuracy=1e-6).json()["id"]
    while ask("GET", f"/api/jobs/{id}").json()["state"] == "queued":
        pass
    # as many as may wait or run
    with monkeypatch.context() as patch:
        patch.setattr(engine, "limits", replace(engine.limits, jobs=1))
        assert ask.job("simulate").status_code == 429
    if end == "cancelled":
        assert ask("DELETE", f"/api/jobs/{id}").json()["state"] == end
    else:
        (pool,) = engine._lanes["work"]._all
        pool.kill()
        found = ask.answer(id)
        assert found["state"] == end and "its process ended" in found["error"]
    assert ask.answer(ask.job("simulate", accuracy=0.02).json()["id"])["state"] == "done"


@pytest.fixture
def behind():
    made = []

    def make(**rules):
        app = FastAPI()
        app.add_api_route("/{path:path}", lambda: {}, methods=["GET", "POST"])
        made.append(Client(guard(app, **rules)))
        return made[-1]

    yield make
    for one in made:
        one.loop.close()


def test_a_server_on_this_machine_answers_to_its_names_and_its_own_pages_only(behind):
    ask = behind(hosts=("127.0.0.1", "localhost"))
    assert ask("GET", "/").status_code == 200
    assert ask("GET", "/", headers={"host": "127.0.0.1:8642"}).status_code == 200
    assert ask("GET", "/", headers={"host": "evil.example"}).status_code == 400
    assert ask("POST", "/", headers={"origin": "http://evil.example"}).status_code == 403
    assert ask("POST", "/", headers={"origin": "http://localhost"}).status_code == 200
    assert ask("POST", "/", headers={"origin": "http://["}).status_code == 403
    assert "default-src 'self'" in ask("GET", "/").headers["content-security-policy"]


def test_beyond_this_machine_a_token_is_needed_and_a_browser_gets_it_by_the_link(behind):
    ask = behind(token="x" * 20)
    assert ask("GET", "/api/forms").status_code == 401
    assert ask("GET", "/api/forms", headers={"authorization": "Bearer wrong"}).status_code == 401
    assert (
        ask("GET", "/api/forms", headers={"authorization": f"Bearer {'x' * 20}"}).status_code == 200
    )
    entered = ask("GET", "/", params={"token": "x" * 20})
    assert entered.status_code == 303 and entered.headers["location"] == "/"
    assert "HttpOnly" in entered.headers["set-cookie"]
    assert "SameSite=strict" in entered.headers["set-cookie"]
    # the client keeps the cookie, as a browser does
    assert ask("GET", "/api/forms").status_code == 200


def test_a_request_that_is_too_long_is_refused_also_where_it_does_not_say_so(behind):
    ask = behind(body=1000, uploads=2000)

    async def pieces():
        for _ in range(30):
            yield b"x" * 100

    assert ask("POST", "/", content=b"x" * 900).status_code == 200
    assert ask("POST", "/", content=b"x" * 1100).status_code == 413
    assert ask("POST", "/", content=pieces()).status_code == 411
    upload = {"content-type": "multipart/form-data; boundary=x"}
    assert ask("POST", "/", content=b"x" * 1100, headers=upload).status_code == 200

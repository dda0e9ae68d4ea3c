"""Thousands of invented requests to the API: `make test MARK=outside`, figures in docs/api.md."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from app_server import running

CHECKS = (
    "not_a_server_error",
    "response_schema_conformance",
    "status_code_conformance",
    "content_type_conformance",
)


@pytest.mark.outside
def test_no_invented_request_is_a_failure_of_the_server(tmp_path):
    program = shutil.which("st", path=Path(sys.executable).parent)
    if program is None:
        pytest.fail("nothing to invent requests with: pip install viscotack[outside]")
    with running() as (link, _):
        command = [program, "run", f"{link}openapi.json", "--checks", ",".join(CHECKS)]
        command += ["--phases", "examples,coverage,fuzzing", "--max-examples", "40"]
        command += ["--seed", "1", "--no-color", "--generation-database", "none"]
        command += ["--continue-on-failure", "--max-time", "900", "--request-timeout", "120"]
        told = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True).stdout
    cases = re.search(r"(\d+) generated", told)
    print(told[-1500:])
    assert cases and int(cases[1]) >= 5000
    assert "Failures:" not in told, told

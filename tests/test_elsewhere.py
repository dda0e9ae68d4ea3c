"""The Octave of docs/elsewhere.md is run, beside a server and the command line."""

import os
import re
import shutil
import subprocess
import sys

import pytest

from app_server import running
from docs import sessions

PAGE = sessions.ROOT / "docs/elsewhere.md"


@pytest.mark.outside
def test_octave_prints_what_predict_answers(tmp_path):
    octave = shutil.which("octave-cli") or pytest.fail("install Debian's package octave")
    sessions.stage(tmp_path)
    program = tmp_path / "bin/viscotack"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m viscotack "$@"\n')
    program.chmod(0o755)
    path = {"PATH": f"{program.parent}{os.pathsep}{os.environ['PATH']}"}
    printed = []
    with running() as (link, _):
        for number, block in enumerate(re.findall(r"```octave\n(.*?)```", PAGE.read_text(), re.S)):
            script = tmp_path / f"block_{number}.m"
            script.write_text(block.replace("http://localhost:8642/", link))
            done = subprocess.run(
                [octave, "--no-gui", script],
                cwd=tmp_path,
                env=os.environ | path,
                capture_output=True,
                text=True,
            )
            assert done.stdout, done.stderr
            printed.append(done.stdout.split())
    numbers = [[float(x) for x in re.findall(r"\d+\.\d+", " ".join(each))] for each in printed]
    assert numbers[0] == [4.665, 4.66, 4.671]
    assert numbers[1] == [4.665, 4.072, 2.34]
    assert numbers[2] == [4.665]

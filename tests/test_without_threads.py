"""Answers and simulations where no thread and no process can start, as in Pyodide."""

import json
import subprocess
import sys

ANSWERS = """
import _thread, json, os, subprocess, sys, threading

def nothing(*arguments, **more):
    raise RuntimeError("no thread and no process here")

threading.Thread.start = _thread.start_new_thread = subprocess.Popen.__init__ = os.fork = nothing
for name in ("fcntl", "grp", "psutil", "pwd", "resource", "syslog", "termios"):
    sys.modules[name] = None

import numpy as np
import viscotack as vt
import viscotack.theory

material = vt.RetardationPowerLaw(
    rubbery_modulus=1.0, glassy_modulus=10.0, exponent=0.8, tau0=1.0, poisson_ratio=0.0
)
case = vt.Groups(tabor=3.24, material=material, start=vt.AtDepth(73.0), rate=316.23)
row = {"tabor": 3.24, "modulus_ratio": 0.1, "exponent": 0.8, "preload": 73.0, "rate": 316.23}
found = [
    vt.predict(case).pull_off_force,
    vt.predict_table({name: np.array([x]) for name, x in row.items()})["pull_off_force"][0],
    vt.theory.jkr.pull_off_force(radius=1.0, work_of_adhesion=1.0) / np.pi,
]
found.append(vt.solve(case, accuracy=0.02, until="pull-off", estimate_error=False).pull_off_force)
print(json.dumps(found))
"""


def test_answers_need_no_thread_and_no_process():
    done = subprocess.run([sys.executable, "-c", ANSWERS], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    surrogate, row, jkr, simulated = json.loads(done.stdout)
    assert abs(surrogate - 7.336373) < 1e-6 and abs(row - surrogate) < 1e-12 and jkr == 1.5
    assert abs(simulated / surrogate - 1) < 0.02

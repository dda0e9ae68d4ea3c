"""Servers of the page and of the API, and a browser that opens the page."""

import re
import shutil
import signal
import subprocess
import sys
import time
from contextlib import contextmanager

import pytest


@contextmanager
def running(*flags, environment=None):
    """Yield the link of a server at a free port; it is ended as by Ctrl-C."""
    server = subprocess.Popen(
        [sys.executable, "-m", "viscotack", "app", "--no-browser", "--port", "0", *flags],
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
    )
    try:
        link = re.search(r"http://\S+", server.stderr.readline())
        assert link, server.communicate()[1]
        yield link[0], server.pid
    finally:
        server.send_signal(signal.SIGINT)
        server.wait(20)
        server.stderr.close()


@contextmanager
def browsing():
    """Yield Chromium without a window; says what to install where it is missing."""
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        pytest.fail("no driver for a browser: pip install viscotack[outside]")
    program = shutil.which("chromium") or shutil.which("google-chrome")
    if program is None:
        pytest.fail("no browser: install Debian's package chromium")
    with sync_playwright() as driver:
        browser = driver.chromium.launch(
            executable_path=program, args=["--no-sandbox", "--disable-dev-shm-usage"]
        )
        yield browser
        browser.close()


def until(page, expression, seconds=60.0):
    """Wait for a truth; the page itself evaluates no text as a program."""
    end = time.perf_counter() + seconds
    while not page.evaluate(expression):
        assert time.perf_counter() < end, f"{expression} is not so after {seconds} s"
        page.wait_for_timeout(20)

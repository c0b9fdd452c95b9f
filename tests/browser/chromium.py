"""Headless Chromium, run once for one page."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

TIME = 5000  # [ms] of the page's own clock, after which it is looked at
LIMIT = 120  # [s] of ours


def find() -> str | None:
    """Return the program, or None where it is not installed."""
    return next(
        (
            found
            for name in ("chromium", "chromium-browser", "google-chrome")
            if (found := shutil.which(name))
        ),
        None,
    )


def required() -> str:
    """Return the program; without it fail where everything must be tested, else skip."""
    program = find()
    if program is None:
        if os.environ.get("CI") == "true":
            pytest.fail("Chromium is not installed")
        pytest.skip("Chromium is not installed (Debian: apt install chromium)")
    return program


def look(program: str, page: Path, profile: Path, *flags: str) -> tuple[str, list[str]]:
    """Open a page and return what is printed and the lines of its console."""
    done = subprocess.run(
        [
            program, "--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--no-first-run",
            "--disable-dev-shm-usage", "--hide-scrollbars", "--enable-logging=stderr", f"--user-data-dir={profile}",
            f"--virtual-time-budget={TIME}", *flags, page.as_uri(),
        ],
        capture_output=True, text=True, timeout=LIMIT, check=True,
    )  # fmt: skip
    return done.stdout, [line for line in done.stderr.splitlines() if "CONSOLE" in line]

"""Headless Chromium for the drivers of this folder, found as the tests find it."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import Browser, sync_playwright

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from browser.chromium import find

MISSING = "Chromium is not installed (Debian: apt install chromium)"


@contextmanager
def chromium() -> Iterator[Browser]:
    """Start a browser and close it.

    Raises:
        FileNotFoundError: it is not installed.
    """
    program = find()
    if program is None:
        raise FileNotFoundError(MISSING)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=program, args=["--no-sandbox", "--disable-dev-shm-usage"]
        )
        try:
            yield browser
        finally:
            browser.close()

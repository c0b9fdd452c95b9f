"""A study to show in a browser, and the browser."""

import pytest
from playwright.sync_api import sync_playwright

from browser.chromium import required
from browser.synthetic_trainer import STATIC
from small_study import shared_folder, shared_small_study


@pytest.fixture(scope="session")
def study(tmp_path_factory):
    return shared_small_study(shared_folder(tmp_path_factory.getbasetemp()))


@pytest.fixture(scope="module")
def browser():
    program = required()
    if not (STATIC / "index.html").is_file():
        pytest.fail("the client is not built: pip install --editable .")
    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(
            executable_path=program, args=["--no-sandbox", "--disable-dev-shm-usage"]
        )
        yield launched
        launched.close()

"""Fixtures that tests share."""

import os

import pytest

from sample_tissues import three_layers


@pytest.fixture(scope="session", autouse=True)
def own_records(tmp_path_factory):
    """Keep what tests do out of the user's records, in processes that they start too."""
    before = os.environ.get("TROCAR_DATA")
    os.environ["TROCAR_DATA"] = str(tmp_path_factory.mktemp("records"))
    yield
    if before is None:
        del os.environ["TROCAR_DATA"]
    else:
        os.environ["TROCAR_DATA"] = before


@pytest.fixture(scope="session")
def skin():
    return three_layers()


@pytest.fixture(scope="session")
def make_skin():
    return three_layers

"""Fixtures that tests share."""

import pytest

from sample_tissues import three_layers


@pytest.fixture(scope="session")
def skin():
    return three_layers()


@pytest.fixture(scope="session")
def make_skin():
    return three_layers

"""A study that tests of its report and its files share."""

import pytest

from small_study import shared_folder, shared_small_study


@pytest.fixture(scope="session")
def study(tmp_path_factory):
    return shared_small_study(shared_folder(tmp_path_factory.getbasetemp()))

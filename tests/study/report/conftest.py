"""The pictures of the shared study, drawn once."""

import pytest

from trocar.study.report.figures.animation import animation
from trocar.study.report.pictures import pictures


@pytest.fixture(scope="session")
def drawn(study):
    return pictures(study)


@pytest.fixture(scope="session")
def moving(study):
    return animation(study.film)

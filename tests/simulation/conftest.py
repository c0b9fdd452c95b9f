"""Scenes that tests share: made once, because a fit takes a second. Nothing in a scene changes."""

import pytest

import trocar
from trocar.contact.instrument import TipKind
from trocar.study.contact.scenes import BLOCK, setting, upright


@pytest.fixture(scope="session")
def usual():
    """The trainer's own pair on skin."""
    return setting(trocar.tissue("skin"))


@pytest.fixture(scope="session")
def straight(usual):
    """A grasper and a probe from right above, the probe over the middle."""
    return usual.with_instruments(upright())


@pytest.fixture(scope="session")
def graspers(usual):
    """Two graspers from right above, 8 mm apart, mirror images in the middle of the block."""
    places = ((0.026, 0.03), (0.034, 0.03))
    return usual.with_instruments(upright((TipKind.GRASPER, TipKind.GRASPER), places))


@pytest.fixture(scope="session")
def hard():
    """The same as `straight` on a block of 1 MPa."""
    return setting(BLOCK, instruments=upright())

"""Finite elements with the nodes of a middle plane let go."""

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press, Support
from trocar.reference import FEASolid, MeshSize
from trocar.reference.opening import OpenedBlock
from trocar.tissues import Layer, Tissue

SIZE = (0.03, 0.03)
COARSE = MeshSize(per_radius=1.0, growth=1.2, top=0.6, deepening=1.2)
LOAD = tuple(Press(x=x, y=0.015, radius=4e-3, force=0.05) for x in (0.009, 0.021))
PLACES = np.array([[0.009, 0.015], [0.015, 0.015]])


def pad() -> Tissue:
    layers = (
        Layer(name=name, thickness=5e-3, young_modulus=1e4, poisson_ratio=0.45, density=1e3)
        for name in ("upper", "lower")
    )
    return Tissue(layers=tuple(layers))


def opened(depth: float) -> OpenedBlock:
    return OpenedBlock(pad(), size=SIZE, support=Support.BASE, load=LOAD, depth=depth, mesh=COARSE)


def test_a_cut_of_no_depth_is_the_whole_block() -> None:
    whole = FEASolid(pad(), size=SIZE, support="base", around=LOAD, mesh=COARSE)
    expected = whole.displacement(whole.static(LOAD), PLACES)
    np.testing.assert_allclose(
        opened(1e-9).displacement(PLACES), expected, atol=1e-12 * np.abs(expected).max()
    )


def test_the_deeper_it_is_cut_the_wider_it_opens() -> None:
    moved = [opened(depth).displacement(PLACES) for depth in (1e-9, 5e-3, 1e-2)]
    assert np.all(np.diff([field[1, 0] for field in moved]) > 1e-6)
    assert np.all(np.diff([field[0, 2] for field in moved]) < 0)


def test_a_load_that_pulls_the_faces_apart_unevenly_is_refused() -> None:
    with pytest.raises(InputError, match="mirror each other"):
        OpenedBlock(pad(), size=SIZE, support=Support.BASE, load=LOAD[:1], depth=5e-3, mesh=COARSE)

"""The liver that the project makes itself."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import gamma

from trocar.errors import InputError
from trocar.tissues import Layer
from trocar.waves.mesh.elements import Elements
from trocar.waves.mesh.organ import Liver
from trocar.waves.mesh.parts import parts
from trocar.waves.mesh.solid_mesh import volumes_of

LIVER = Layer(name="liver", thickness=0.03, young_modulus=4.5e3, poisson_ratio=0.48, density=1060)


@pytest.mark.parametrize("spacing", [0.05, 0.03, 0.0125])
def test_every_resolution_is_one_solid(spacing):
    mesh = Liver().mesh(LIVER, spacing=spacing)  # refused, were an element inverted
    assert parts(mesh.cells, len(mesh.corners)).max() == 0
    assert mesh.size == pytest.approx((0.2, 0.116), rel=0.1)  # it narrows before its widest place
    assert mesh.corners[:, 2].max() == 0


def test_at_full_resolution_it_has_twenty_thousand_nodes():
    count = Elements(Liver().mesh(LIVER)).nodes.shape[1]
    assert 18_000 < count < 22_000


def test_an_even_one_has_the_volume_of_its_formula():
    # Without taper and fold, sections at every height are superellipses; the area of one is Euler's integral.
    liver = replace(Liver(), taper=1.0, fold=0.0)
    p, total = 2.4, 0.0
    outline = 4 * gamma(1 + 1 / p) ** 2 / gamma(1 + 2 / p) * 0.1 * 0.07  # area where the height is nothing
    for q, depth in ((2.0, 0.07 / 1.3), (4.0, 0.3 * 0.07 / 1.3)):
        # the section at height z has the area outline (1 - (z/d)^q), for it scales with the square root
        total += outline * depth * (1 - 1 / (q + 1))
    coarse, fine = (
        volumes_of(mesh.corners, mesh.cells).sum() / total - 1
        for mesh in (liver.mesh(LIVER, spacing=s) for s in (0.02, 0.01))
    )
    assert -0.015 < fine < 0  # chords cut off
    assert coarse / fine == pytest.approx(4, rel=0.1)  # second order


def test_elements_are_shorter_where_tools_press():
    place = np.array([0.13, 0.05])
    even, closer = Liver().mesh(LIVER, spacing=0.02), Liver().mesh(LIVER, spacing=0.02, around=tuple(place))
    assert closer.size == pytest.approx(even.size, rel=0.02)

    def near(mesh):
        return (
            np.linalg.norm(mesh.corners[mesh.surfaces["surface"]].mean(axis=1)[:, :2] - place, axis=1) < 0.01
        ).sum()

    assert near(closer) > 5 * near(even)  # nine times, less towards the rim of what is near
    with pytest.raises(InputError, match="around: expected a place on the liver"):
        Liver().mesh(LIVER, around=(0.5, 0.05))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"length": 5.0}, "liver: length"),
        ({"taper": 0.0}, "liver: taper: expected a share from 0.2"),
        ({"height": float("nan")}, "liver: height"),
    ],
)
def test_what_is_no_liver_is_refused(change, said):
    with pytest.raises(InputError, match=said):
        replace(Liver(), **change)


@pytest.mark.parametrize(
    ("spacing", "said"), [(0.0, "above 0"), (1e-3, "take a larger one"), (0.5, "spacing")]
)
def test_a_spacing_that_is_none_is_refused(spacing, said):
    with pytest.raises(InputError, match=said):
        Liver().mesh(LIVER, spacing=spacing)

"""Stress and compression of fields whose strain is known everywhere."""

from __future__ import annotations

import numpy as np
import pytest

from trocar.model import Press
from trocar.reference import FEASolid, MeshSize
from trocar.reference.mesh import Bricks
from trocar.reference.stress import largest_compression, largest_von_mises
from trocar.tissues import Layer, Tissue

BRICKS = Bricks(
    x=np.array([0.0, 0.7, 2.4]),
    y=np.array([0.0, 1.1]),
    z=np.array([-1.5, -0.4, 0.0]),
    slab_layer=np.array([1, 0]),
)
LAYERS = (
    Layer(name="upper", thickness=0.4, young_modulus=3.0, poisson_ratio=0.3, density=1.0, prestress_x=0.5),
    Layer(name="lower", thickness=1.1, young_modulus=1.0, poisson_ratio=0.4, density=1.0),
)


def test_uniaxial_stress() -> None:
    """Stretch e along z with free sides: von Mises is E |e|; each layer loses e of its thickness."""
    x, y, z = BRICKS.nodes
    e, nu = -0.01, LAYERS[1].poisson_ratio
    field = np.stack([-nu * e * x, -nu * e * y, e * z])
    assert largest_von_mises(BRICKS, LAYERS, [field], prestress=False)[1] == pytest.approx(0.01, rel=1e-12)
    assert largest_compression(BRICKS, LAYERS, [0 * field, field]) == pytest.approx([0.01, 0.01], rel=1e-12)
    assert largest_compression(BRICKS, LAYERS, [-field]) == [0.0, 0.0]


def test_simple_shear() -> None:
    """u_x = g z: von Mises is sqrt(3) mu |g|."""
    field = np.stack([0.02 * BRICKS.nodes[2], 0 * BRICKS.nodes[2], 0 * BRICKS.nodes[2]])
    found = largest_von_mises(BRICKS, LAYERS, [field], prestress=False)
    assert found == pytest.approx([np.sqrt(3) * layer.shear_modulus * 0.02 for layer in LAYERS], rel=1e-12)


def test_prestress_counts() -> None:
    assert largest_von_mises(BRICKS, LAYERS, [np.zeros((3, BRICKS.nodes.shape[1]))], prestress=True) == [
        0.5,
        0.0,
    ]


def test_ratio_to_strength_grows_with_the_force() -> None:
    tissue = Tissue(
        layers=(
            Layer(name="wall", thickness=1e-3, young_modulus=2e5, poisson_ratio=0.45, density=1050.0,
                  tensile_strength=1e5),
            Layer(name="fat", thickness=6e-3, young_modulus=1e4, poisson_ratio=0.48, density=950.0),
        )
    )  # fmt: skip
    press = Press(x=0.011, y=0.014, radius=3e-3, force=0.1, tilt=0.3)
    mesh = MeshSize(per_radius=1.5, growth=1.0, top=0.5, deepening=1.0)
    model = FEASolid(tissue, size=(0.03, 0.024), support="edges+base", around=(press,), mesh=mesh)
    one, two = (model.static((press.with_force(force),)) for force in (0.1, 0.2))
    assert model.strength_ratio(one)["wall"] == pytest.approx(model.stress(one)["wall"] / 1e5)
    assert model.strength_ratio(one)["fat"] == 0.0  # its strength is not known: infinite
    assert model.stress(two) == pytest.approx({name: 2 * value for name, value in model.stress(one).items()})
    assert 0.0 < model.compression(one)["fat"] < 1.0
    mirrored = Press(x=0.03 - press.x, y=press.y, radius=3e-3, force=0.1, tilt=0.3, azimuth=np.pi)
    assert model.stress(model.static((mirrored,))) == pytest.approx(model.stress(one), rel=1e-6)

"""Every tissue model, bound to the contract."""

from dataclasses import replace

import pytest

from contracts.tissue_model import OTHER, PRESS, WHERE, TissueModelContract
from sample_tissues import three_layers
from trocar.model import Press
from trocar.reference.block import MeshSize
from trocar.reference.fea import FEASolid
from trocar.reference.mesh_free import Cut, MeshFree
from trocar.reference.springs.mass_spring import MassSpring, lattice_size
from trocar.tissues import Layer, NeoHookean, Tissue
from trocar.waves.membrane import WaveMembrane
from trocar.waves.mesh.block import block_mesh, lines_around
from trocar.waves.mesh.wave_mesh import WaveMesh
from trocar.waves.solid import WaveSolid
from trocar.waves.stretch.stretching_waves import StretchingWaves

SIZE = (0.06, 0.06)


class TestWaveMembrane(TissueModelContract):
    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        return WaveMembrane.fitted(three_layers(), size=SIZE, modes=(24, 24))


class TestWaveSolid(TissueModelContract):
    # Statics come from a banded factorisation, moving modes from dense inverses: condition 1e6 times rounding.
    rounding = 1e-8

    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        return WaveSolid(three_layers(), size=SIZE, modes=(32, 32), dynamic_modes=(12, 12))


class TestClampedWaveSolid(TestWaveSolid):
    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        return WaveSolid(
            three_layers(),
            size=SIZE,
            support="edges+base",
            modes=(32, 32),
            dynamic_modes=(12, 12),
            side_modes=(16, 16),
        )


def remembering():
    series = ((0.5, 0.002), (1.0, 0.04)), ((0.8, 0.02),), ((1.5, 0.005), (0.4, 0.04))
    layers = three_layers().layers
    return Tissue(layers=tuple(replace(layer, prony=own) for layer, own in zip(layers, series, strict=True)))


class TestRememberingWaveSolid(TestWaveSolid):
    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        return WaveSolid(remembering(), size=SIZE, modes=(32, 32), dynamic_modes=(12, 12))


class TestCreepingWaveSolid(TestWaveSolid):
    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        return WaveSolid(remembering(), size=SIZE, modes=(32, 32), massless=True)


class TestRememberingWaveMembrane(TissueModelContract):
    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        return WaveMembrane.fitted(remembering(), size=SIZE, modes=(24, 24))


class TestCreepingWaveMembrane(TissueModelContract):
    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        return WaveMembrane.fitted(
            remembering(), size=SIZE, support="edges+base", modes=(24, 24), massless=True
        )


class StretchingContract(TissueModelContract):
    # Of four steps of 50 ms two balances differ by 1e-13 each, and beds of a fitted stack are a million times stiffer.
    rounding = 1e-8

    def test_equilibria_scale_and_add(self, model):
        """Only small ones do: the sheet resists with the cube of the deflection, here 1e-6 of the load."""
        small, other = PRESS.with_force(1e-4), OTHER.with_force(1e-4)
        both = model.displacement(model.static((small.with_force(3e-4), other)), WHERE, "fat")
        apart = 3 * model.displacement(model.static((small,)), WHERE, "fat")
        apart += model.displacement(model.static((other,)), WHERE, "fat")
        self.assert_close(both, apart, 1e-5)


class TestStretchingWaveMembrane(StretchingContract):
    # The sheet bears more than the waves here, and in steps of 50 ms the mean of its resistance at both ends swings
    # about the equilibrium for long, as average acceleration does.
    settled = 3e-2

    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        membrane = WaveMembrane.fitted(three_layers(), size=SIZE, support="edges", modes=(20, 20))
        return StretchingWaves.of(membrane, three_layers())


class TestStretchingWaveSolid(StretchingContract):
    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        solid = WaveSolid(three_layers(), size=SIZE, modes=(32, 32), dynamic_modes=(12, 12))
        return StretchingWaves.of(solid, three_layers())


class TestRememberingStretchingWaves(StretchingContract):
    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        return StretchingWaves.of(
            WaveMembrane.fitted(remembering(), size=SIZE, modes=(16, 16)), remembering()
        )


class TestMasslessStretchingWaves(StretchingContract):
    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        solid = WaveSolid(three_layers(), size=SIZE, modes=(32, 32), massless=True)
        return StretchingWaves.of(solid, three_layers())


class TestFEASolid(TissueModelContract):
    # Average acceleration damps nothing by itself, and 50 ms steps leave the fast modes ringing for long.
    settled = 1e-2

    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        around = (Press(x=0.026, y=0.031, radius=0.003, force=1.0),)
        coarse = MeshSize(per_radius=1.0, growth=1.0, top=0.6, deepening=1.0)
        return FEASolid(three_layers(), size=SIZE, support="base", around=around, mesh=coarse)


class TestWaveMesh(TissueModelContract):
    rounding = 1e-8  # an iterative eigenproblem, and seven vectors of each press that are nearly the same

    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        around = (Press(x=0.026, y=0.031, radius=3e-3, force=1.0),)
        return WaveMesh(block_mesh(three_layers(), lines_around(three_layers(), SIZE, around)), modes=30)


class TestRememberingWaveMesh(TestWaveMesh):
    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        around = (Press(x=0.026, y=0.031, radius=3e-3, force=1.0),)
        lines = lines_around(remembering(), SIZE, around, coarser=1.5)
        return WaveMesh(block_mesh(remembering(), lines), modes=12)


class TestCreepingWaveMesh(TestWaveMesh):
    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        around = (Press(x=0.026, y=0.031, radius=3e-3, force=1.0),)
        lines = lines_around(remembering(), SIZE, around, coarser=1.5)
        return WaveMesh(block_mesh(remembering(), lines), modes=12, massless=True)


class TestCreepingFEASolid(TissueModelContract):
    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        around = (Press(x=0.026, y=0.031, radius=0.003, force=1.0),)
        coarse = MeshSize(per_radius=1.0, growth=1.2, top=0.8, deepening=1.2, side=0.8)
        return FEASolid(remembering(), size=SIZE, support="base", around=around, mesh=coarse, massless=True)


class TestLinearisedMassSpring(TissueModelContract):
    settled = 1e-2  # as of finite elements, with which it shares the step

    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        around = (Press(x=0.026, y=0.031, radius=0.003, force=1.0),)
        return MassSpring(
            three_layers(),
            size=SIZE,
            support="base",
            around=around,
            mesh=lattice_size(1.5),
            linearised=True,
        )


class TestCreepingMassSpring(TissueModelContract):
    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        around = (Press(x=0.026, y=0.031, radius=0.003, force=1.0),)
        return MassSpring(
            remembering(),
            size=SIZE,
            support="edges+base",
            around=around,
            mesh=lattice_size(1.5),
            linearised=True,
            massless=True,
        )


class LargeContract(TissueModelContract):
    """The contract of a model that follows large deformation."""

    def test_equilibria_scale_and_add(self, model):
        """Only small ones do; the next term is of the order of the strain, here 1e-6."""
        small, other = PRESS.with_force(1e-5), OTHER.with_force(1e-5)
        both = model.displacement(model.static((small.with_force(3e-5), other)), WHERE, "fat")
        apart = 3 * model.displacement(model.static((small,)), WHERE, "fat")
        apart += model.displacement(model.static((other,)), WHERE, "fat")
        self.assert_close(both, apart, 1e-4)


class TestLargeFEASolid(LargeContract):
    # As of the linear one, and more of what rings lies in the few unknowns of this mesh.
    settled = 3e-2

    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        tissue = Tissue(layers=tuple(replace(layer, law=NeoHookean()) for layer in three_layers().layers))
        coarse = MeshSize(per_radius=0.5, growth=3.0, top=3.0, deepening=3.0)
        around = (Press(x=0.03, y=0.03, radius=0.012, force=1.0),)
        return FEASolid(tissue, size=SIZE, support="base", around=around, mesh=coarse)


class TestMassSpring(LargeContract):
    settled = 3e-2  # as of the large finite elements

    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        around = (Press(x=0.03, y=0.03, radius=0.012, force=1.0),)
        return MassSpring(three_layers(), size=SIZE, support="base", around=around, mesh=lattice_size(1.5))


class TestMeshFree(TissueModelContract):
    # Average acceleration, as of the finite elements.
    settled = 1e-2

    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        around = (Press(x=0.026, y=0.031, radius=0.006, force=1.0),)
        return MeshFree(
            three_layers(), size=SIZE, support="base", around=around, resolution=0.6, stepping="implicit"
        )


class TestCutMeshFree(TestMeshFree):
    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        around = (Press(x=0.026, y=0.031, radius=0.006, force=1.0),)
        cuts = (Cut(start=(0.02, 0.02), end=(0.04, 0.04), depth=0.004, lean=0.3),)
        return MeshFree(
            three_layers(),
            size=SIZE,
            support="base",
            around=around,
            resolution=0.6,
            cuts=cuts,
            stepping="implicit",
        )


class TestExplicitMeshFree(TissueModelContract):
    """Thick soft layers: the stiffest mode of a thin stiff one asks for a thousand million steps."""

    settled = 1e-3  # the lowest modes lose so much in two seconds

    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        base = {"poisson_ratio": 0.4, "density": 1100.0, "loss_factor": 0.2, "loss_frequency": 50.0}
        layers = tuple(
            Layer(name=name, thickness=height, young_modulus=E, **base)
            for name, height, E in (("epidermis", 4e-3, 4e3), ("dermis", 4e-3, 3e3), ("fat", 8e-3, 2e3))
        )
        around = (Press(x=0.03, y=0.03, radius=0.025, force=1.0),)
        return MeshFree(Tissue(layers=layers), size=SIZE, support="base", around=around, resolution=0.5)


class TestLargeMeshFree(TestLargeFEASolid):
    """Without inertia: every step is an equilibrium."""

    settled = 1e-6

    @pytest.fixture(scope="class")
    @classmethod
    def model(cls):
        tissue = Tissue(layers=tuple(replace(layer, law=NeoHookean()) for layer in three_layers().layers))
        around = (Press(x=0.03, y=0.03, radius=0.012, force=1.0),)
        return MeshFree(tissue, size=SIZE, support="base", around=around, resolution=0.5, massless=True)

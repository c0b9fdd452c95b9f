"""The end of the linear range: closed forms of every measure, and one neo-Hookean block of CalculiX."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from math import pi
from pathlib import Path

import numpy as np
import pytest

import trocar
from reference.neo_hookean import NeoHookeanBlock, executable
from trocar.errors import InputError
from trocar.model import FloatArray, Load, Press, Support
from trocar.study.linear_range import (
    AGREEMENT,
    LARGEST_DEFLECTION_SHARE,
    LARGEST_STRAIN,
    LARGEST_STRETCHING,
    STEEPEST_SLOPE,
    Samples,
    judged,
    linear_range,
    sampled,
)
from trocar.tissues import Layer, Tissue
from trocar.waves.solid import WaveSolid

SIZE = (0.06, 0.05)
SOFT = Layer(name="soft", thickness=0.01, young_modulus=5e3, poisson_ratio=0.4, density=1000.0)
STIFF = Layer(name="stiff", thickness=0.002, young_modulus=1e5, poisson_ratio=0.4, density=1000.0)
TISSUE = Tissue(layers=(STIFF, SOFT))
PRESS = Press(x=0.03, y=0.025, radius=0.004, force=1.0)


@dataclass(frozen=True)
class Moment:
    """The state of a column: how far it is compressed, as a multiple of its equilibrium under 1 N."""

    time: float
    amount: float


@dataclass(frozen=True)
class Column:
    """Layers squeezed evenly by the force over the whole block's area: no slope anywhere."""

    tissue: Tissue = TISSUE
    size: tuple[float, float] = SIZE
    support: Support = Support.BASE

    dofs: int = 2

    @property
    def layer_names(self) -> tuple[str, ...]:
        return self.tissue.layer_names

    def init(self) -> Moment:
        return Moment(0.0, 0.0)

    def step(self, state: Moment, load0: Load, load1: Load, dt: float) -> Moment:
        return Moment(state.time + dt, self.static(load1).amount)

    def static(self, load: Load) -> Moment:
        return Moment(0.0, sum(press.force for press in load))

    def displacement(self, state: Moment, points: FloatArray, layer: str | None = None) -> FloatArray:
        below = self.tissue.layers[self.tissue.index(layer) :]
        pressure = state.amount / (self.size[0] * self.size[1])
        result = np.zeros((len(points), 3))
        result[:, 2] = -sum(pressure / modulus(part) * part.thickness for part in below)
        return result


def modulus(layer: Layer) -> float:
    """Confined compression: stress over strain [Pa]."""
    return layer.lame_lambda + 2 * layer.shear_modulus


def wave(amplitude: float, *, count: int = 241, base_held: bool = True) -> Samples:
    """Both faces follow one sine; the upper one moves `amplitude`, the lower half of it."""
    x, y = (np.linspace(0.0, side, count) for side in SIZE)
    shape = np.outer(np.sin(pi * x / SIZE[0]), np.sin(pi * y / SIZE[1]))
    return Samples(
        x=x,
        y=y,
        vertical=-amplitude * np.stack([shape, 0.5 * shape]),
        base_held=base_held,
        work=1e-4,
        force=2.0,
    )


def test_a_column_is_judged_by_the_strain_of_its_softest_layer() -> None:
    pressure = 1.0 / (SIZE[0] * SIZE[1])
    found = linear_range(Column(), TISSUE, (PRESS,))
    assert found.strain == pytest.approx(pressure / modulus(SOFT), rel=1e-12)
    shortening = 0.01 * pressure / modulus(SOFT) + 0.002 * pressure / modulus(STIFF)
    assert found.deflection_share == pytest.approx(shortening / 0.012, rel=1e-12)
    assert found.slope == pytest.approx(0.0, abs=1e-12)
    assert found.stretching == pytest.approx(0.0, abs=1e-12)
    assert found.limiting == "strain"
    assert found.force_limit == pytest.approx(LARGEST_STRAIN / found.strain, rel=1e-12)


def test_at_the_force_limit_inside_turns_into_outside() -> None:
    limit = linear_range(Column(), TISSUE, (PRESS,)).force_limit
    below, above = (
        linear_range(Column(), TISSUE, (PRESS.with_force(s * limit),)) for s in (1 - 1e-9, 1 + 1e-9)
    )
    assert below.inside
    assert not above.inside
    assert below.force_limit == pytest.approx(limit, rel=1e-12)
    assert above.force_limit == pytest.approx(limit, rel=1e-12)


def test_pulling_is_judged_as_pushing() -> None:
    push, pull = (linear_range(Column(), TISSUE, (PRESS.with_force(force),)) for force in (1.0, -1.0))
    assert push == pull


def test_a_free_base_leaves_the_lowest_layer_to_the_deflection() -> None:
    free = linear_range(Column(support=Support.EDGES), TISSUE, (PRESS,))
    held = linear_range(Column(), TISSUE, (PRESS,))
    assert free.strain == pytest.approx(1.0 / (SIZE[0] * SIZE[1]) / modulus(STIFF), rel=1e-9)
    assert free.deflection_share == held.deflection_share
    assert free.limiting == "deflection_share"
    assert free.force_limit == pytest.approx(LARGEST_DEFLECTION_SHARE / free.deflection_share, rel=1e-12)


def test_a_moving_block_is_judged_where_it_is_and_keeps_the_force_limit() -> None:
    still = linear_range(Column(), TISSUE, (PRESS,))
    moving = linear_range(Column(), TISSUE, (PRESS,), Moment(0.02, 1.5))
    assert moving.strain == pytest.approx(1.5 * still.strain, rel=1e-12)
    assert moving.force_limit == still.force_limit


def test_stretching_of_a_moving_block_grows_as_the_square_of_its_deflection() -> None:
    model = WaveSolid(TISSUE, size=SIZE, modes=(24, 24))
    still = linear_range(model, TISSUE, (PRESS,))
    moving = linear_range(model, TISSUE, (PRESS,), model.static((PRESS.with_force(3.0),)))
    assert moving.stretching == pytest.approx(9.0 * still.stretching, rel=1e-9)


def test_slope_and_stretching_of_a_sine() -> None:
    amplitude = 1e-3
    found = judged(TISSUE, wave(amplitude))
    k, q = pi / SIZE[0], pi / SIZE[1]
    # Central differences over 240 intervals: k h = 0.013, so (k h)^2 / 6 = 3e-5 in the slope.
    assert found.slope == pytest.approx(amplitude * max(k, q), rel=1e-4)
    # Means of cos^4 and sin^4 are 3/8, of sin^2 cos^2 1/8, in s^2 = A^2 (k^2 cos^2 sin^2 + q^2 sin^2 cos^2).
    fourth = amplitude**4 * SIZE[0] * SIZE[1] * ((k**4 + q**4) * 9 / 64 + 2 * k**2 * q**2 / 64)
    energy = sum(
        layer.young_modulus * layer.thickness / (1 - layer.poisson_ratio**2) / 8 * fourth * share**4
        for layer, share in ((STIFF, 1.0), (SOFT, 0.5))
    )
    assert found.stretching == pytest.approx(2 * energy / 1e-4, rel=1e-3)


@pytest.mark.parametrize(
    ("measure", "threshold", "power"),
    [
        ("strain", LARGEST_STRAIN, 1),
        ("deflection_share", LARGEST_DEFLECTION_SHARE, 1),
        ("slope", STEEPEST_SLOPE, 1),
        ("stretching", LARGEST_STRETCHING, 2),
    ],
)
def test_every_measure_can_limit(measure: str, threshold: float, power: int) -> None:
    thick = Tissue(layers=(replace(STIFF, thickness=0.3), replace(SOFT, thickness=0.3)))
    faint = Tissue(layers=tuple(replace(layer, young_modulus=1.0) for layer in thick.layers))
    tissue, samples = {
        "strain": (TISSUE, wave(1e-4)),
        "deflection_share": (TISSUE, replace(wave(1e-4), base_held=False, work=1.0)),
        "slope": (faint, replace(wave(1e-2), base_held=False)),
        "stretching": (thick, replace(wave(1e-3), work=1e-9)),
    }[measure]
    if measure == "deflection_share":  # both faces move alike, so that no layer that can be seen is squeezed
        samples = replace(samples, vertical=np.repeat(samples.vertical[:1], 2, axis=0))
    found = judged(tissue, samples)
    assert found.limiting == measure
    value = getattr(found, measure)
    assert found.force_limit == pytest.approx(samples.force * (threshold / value) ** (1 / power), rel=1e-12)
    assert found.inside == (value <= threshold)


def test_the_work_is_half_of_force_times_mean_displacement() -> None:
    tilted = replace(PRESS, tilt=0.5, azimuth=0.7)
    pressure = 1.0 / (SIZE[0] * SIZE[1])
    shortening = 0.01 * pressure / modulus(SOFT) + 0.002 * pressure / modulus(STIFF)
    assert sampled(Column(), (PRESS,)).work == pytest.approx(0.5 * shortening, rel=1e-12)
    assert sampled(Column(), (tilted,)).work == pytest.approx(0.5 * np.cos(0.5) * shortening, rel=1e-12)


def test_the_samples_reach_both_ends_and_are_fine_at_every_tool() -> None:
    load = (replace(PRESS, x=0.012, radius=0.002), replace(PRESS, x=0.047))
    x = sampled(Column(), load).x
    assert (x[0], x[-1]) == (0.0, pytest.approx(SIZE[0]))
    for press in load:
        near = np.abs(0.5 * (x[1:] + x[:-1]) - press.x) < press.radius
        assert (
            np.diff(x)[near].max() < 0.2 * press.radius
        )  # the spacing under a tool is an eighth of its radius


@pytest.mark.parametrize("load", [(), (PRESS.with_force(0.0),)])
def test_a_load_without_force_is_refused(load: Load) -> None:
    with pytest.raises(InputError, match="force other than 0"):
        linear_range(Column(), TISSUE, load)


@pytest.mark.parametrize("key", ["work", "force"])
@pytest.mark.parametrize("value", [0.0, -1.0, float("nan")])
def test_samples_of_no_load_are_refused(key: str, value: float) -> None:
    with pytest.raises(InputError, match=key):
        judged(TISSUE, replace(wave(1e-4), **{key: value}))


def test_skin_parts_from_neo_hookean_where_the_criterion_says(tmp_path: Path) -> None:
    if executable() is None:
        if os.environ.get("CI") == "true":
            pytest.fail("CalculiX is missing; install the Debian package calculix-ccx")
        pytest.skip("CalculiX is not installed (Debian package calculix-ccx)")
    tissue, size, radius = trocar.tissue("skin"), (0.06, 0.06), 0.004
    press = Press(x=0.03, y=0.03, radius=radius, force=1.0)
    model = WaveSolid(tissue, size=size, modes=(96, 96))
    limit = linear_range(model, tissue, (press,)).force_limit
    block = NeoHookeanBlock(tissue=tissue, size=size, support=Support.BASE, radius=radius, per_radius=1.5)
    steps = block.pressed((0.01 * limit, limit, 4 * limit), tmp_path)
    assert len(steps) == 3
    assert all(step.sane for step in steps)
    linear, within, beyond = (np.array(step.deflection) / step.force for step in steps)
    assert np.abs(within / linear - 1).max() < AGREEMENT
    assert np.abs(beyond / linear - 1).max() > AGREEMENT
    centre = np.array([[0.03, 0.03, 0.0]])
    state = model.static((press,))
    waves = [-model.displacement(state, centre, name)[0, 2] for name in tissue.layer_names]
    assert linear == pytest.approx(waves, rel=0.01)  # so coarse a mesh is within 1 % of the waves

"""The compiled tick does what a model's own `step` does under a force held, and reads what it moves."""

from dataclasses import replace

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press, Profile, Support
from trocar.tissues import Tissue
from trocar.tissues.catalogue import tissue
from trocar.waves.membrane import WaveMembrane
from trocar.waves.patch import (
    go_on,
    hold,
    let_go,
    place_patch,
    push_each_other,
    read_layers,
    read_patches,
    sines_and_cosines,
)
from trocar.waves.solid import WaveSolid
from trocar.waves.stack import Coupling, Sheet, Stack
from trocar.waves.state import WaveState
from trocar.waves.tick import FAR, _spectrum, at_rest, make_tick, oscillators_of

DT = 1e-3
SIZE = (0.06, 0.045)
WINDOW = 2e-3
OFFSETS = np.array([[-0.8e-3, 0.0, 0.8e-3], [-0.5e-3, 0.1e-3, 0.9e-3]])  # of two patches of nine points
EVEN = Stack(  # one sheet, undamped
    sheets=(Sheet(name="dermis", tension_x=25.7, tension_y=9.0, areal_density=1.1),),
    couplings=(Coupling(stiffness=1e5),),
)
UNEVEN = Stack(  # layers damped differently: complex and real pairs of poles
    sheets=(
        Sheet(name="epidermis", tension_x=5, tension_y=5, areal_density=0.2, bending=1e-7, damping=3.0),
        Sheet(name="dermis", tension_x=25.7, tension_y=10, areal_density=1.1, retardation_time=1e-3),
        Sheet(name="fat", tension_x=3, tension_y=3, areal_density=9.0, damping=300.0),
    ),
    couplings=(
        Coupling(stiffness=1e8, retardation_time=1e-4),
        Coupling(stiffness=1e6),
        Coupling(stiffness=3e5),
    ),
)

REMEMBERING = Stack(  # layers that relax within a tick, within the walk and after it
    sheets=(
        Sheet(name="epidermis", tension_x=5, tension_y=5, areal_density=0.2, prony=((0.5, 1e-3),)),
        Sheet(
            name="dermis", tension_x=25.7, tension_y=10, areal_density=1.1, prony=((1.0, 4e-3), (0.3, 90.0))
        ),
    ),
    couplings=(Coupling(stiffness=1e7, prony=((0.5, 1e-3),)), Coupling(stiffness=1e6, prony=((2.0, 90.0),))),
)


def skin():
    return WaveMembrane.fitted(tissue("skin"), size=SIZE, modes=(4, 4), support="base").stack


def tick_of(model, **options):
    return make_tick(model, DT, **{"window": WINDOW, "offsets": OFFSETS, **options})


def walk(ticks=12, seed=1):
    """Places of both patches and forces of their points, at random."""
    rng = np.random.default_rng(seed)
    places = np.cumsum(rng.normal(0, 2e-4, (ticks, 2, 2)), axis=0) + np.array([[0.02, 0.03], [0.055, 0.004]])
    return np.clip(places, 1.5e-3, [0.058, 0.043]), rng.uniform(0, 0.05, (ticks, 2, 9))


def points_of(places):
    """Places of every point, patch by patch, x slowest, shape (2, 9, 2)."""
    grids = [np.stack(np.meshgrid(own, own, indexing="ij"), axis=-1).reshape(-1, 2) for own in OFFSETS]
    return places[:, None] + np.stack(grids)


def load(places, forces):
    """The same forces as presses of the library: its Gaussian of radius R passes exp(-(R k)^2/8)."""
    return tuple(
        Press(x=x, y=y, radius=2**0.5 * WINDOW, force=force, profile=Profile.GAUSSIAN)
        for (x, y), force in zip(
            points_of(places).reshape(-1, 2).tolist(), forces.ravel().tolist(), strict=True
        )
    )


def felt(model, state, places, passed=WINDOW):
    """How deep the top face lies at the points, smoothed as a press is, by a plain sum."""
    series = model.series
    smooth = np.exp(-0.25 * passed**2 * (series.kx[:, None] ** 2 + series.ky**2))
    table = model.amplitudes(state)
    vertical = table[2] if table.ndim == 3 else table
    return np.stack([-series.vertical(vertical * smooth, own) for own in points_of(places)])


@pytest.mark.parametrize(
    ("stack", "modes"),
    [(EVEN, (9, 13)), (UNEVEN, (70, 67)), (REMEMBERING, (20, 17)), (skin(), (24, 24))],
    ids=["even", "uneven", "remembering", "skin"],
)
def test_the_tick_is_the_models_step_with_its_load_held(stack, modes):
    model = WaveMembrane(stack, size=SIZE, modes=modes)
    tick = tick_of(model)
    state, slow, peak = at_rest(tick), model.init(), 0.0
    sunk, layers = np.zeros((2, 9)), np.zeros((len(model.layer_names), *tick.shape[2:]))
    for places, forces in zip(*walk(), strict=True):
        for tool, (x, y) in enumerate(places.tolist()):
            place_patch(tick, state, tool, x, y)
        go_on(tick, state)
        read_patches(tick, state, sunk)
        free = felt(model, model.step(slow, (), (), DT), places)
        hold(tick, state, forces)
        read_layers(tick, state, layers)
        pressed = load(places, forces)
        slow = model.step(slow, pressed, pressed, DT)
        expected = np.stack([model.amplitudes(slow, name)[1:, 1:] for name in model.layer_names])
        peak = max(peak, np.abs(felt(model, slow, places)).max())
        # 1e-12 of the deepest so far: sums of thousands of terms in another order, 12 ticks long.
        assert sunk == pytest.approx(free, rel=0, abs=1e-12 * peak)
        assert layers == pytest.approx(expected, rel=0, abs=1e-12 * np.abs(expected).max())
    found = WaveState(slow.time, (oscillators_of(tick, state),))
    anywhere = np.random.default_rng(2).uniform(0, 0.045, (20, 3))
    for name in model.layer_names:
        one, other = (model.displacement(which, anywhere, name) for which in (found, slow))
        assert one == pytest.approx(other, rel=0, abs=1e-12 * np.abs(other).max() + 1e-12 * peak)


@pytest.mark.parametrize("series", [(), ((0.8, 3e-3), (0.5, 20.0))], ids=["forgets", "remembers"])
def test_it_is_the_layered_solids_step_too(skin, series):
    """Moving waves alone: what a solid answers at once, beyond its slowest modes, a tick's modes follow as well."""
    top = replace(skin.layers[0], prony=series)
    layered = Tissue(layers=(top, *skin.layers[1:]), name="skin")
    model = WaveSolid(layered, size=SIZE, support=Support.BASE, modes=(16, 12), dynamic_modes=(16, 12))
    tick = tick_of(model)
    state, waves = at_rest(tick), model.oscillators_wv
    slow, layers = waves.rest, np.zeros((3, *tick.shape[2:]))
    for places, forces in zip(*walk(), strict=True):
        for tool, (x, y) in enumerate(places.tolist()):
            place_patch(tick, state, tool, x, y)
        go_on(tick, state)
        hold(tick, state, forces)
        read_layers(tick, state, layers)
        across, _ = model.moving_forces(load(places, forces))
        slow = waves.step(slow, across, across, DT)
        expected = waves.read(slow)[:, 0::2].T.reshape(3, *model.surface_modes)
        assert layers == pytest.approx(
            expected, rel=0, abs=1e-12 * np.abs(expected).max()
        )  # rounding, as above


@pytest.mark.parametrize("places", [[[0.02, 0.03], [0.027, 0.024]], [[0.0025, 0.03], [0.004, 0.042]]])
def test_points_push_each_other_in_as_the_step_says(places):
    """One newton on a point, held for a tick from rest, sinks every point by a column of the matrix."""
    model = WaveMembrane(UNEVEN, size=SIZE, modes=(30, 30))
    tick, places = tick_of(model), np.array(places)
    state = at_rest(tick)
    for tool, (x, y) in enumerate(places.tolist()):
        place_patch(tick, state, tool, x, y)
    blocks = np.zeros((2, 2, 9, 9))
    for one in range(2):
        for other in range(2):
            push_each_other(tick, state, one, other, blocks[one, other])
    whole = blocks.transpose(0, 2, 1, 3).reshape(18, 18)
    for point in (0, 5, 13):
        forces = np.zeros(18)
        forces[point] = 1.0
        pressed = load(places, forces)
        expected = felt(model, model.step(model.init(), pressed, pressed, DT), places).ravel()
        assert whole[:, point] == pytest.approx(expected, rel=0, abs=1e-12 * expected.max())  # rounding
    assert np.linalg.eigvalsh(whole).min() > -1e-14 * whole.max()


def test_far_from_the_sides_points_know_only_each_other():
    """Where mirror images are further than `apart`, the table made once is the matrix at any place."""
    model = WaveMembrane(skin(), size=SIZE, modes=(60, 60))
    tick = tick_of(model)
    state, out = at_rest(tick), np.zeros((9, 9))
    margin = 0.5 * tick.apart + 2e-3
    assert 2 * margin < min(SIZE)
    for place in ([margin, margin], [0.03, 0.0225], [0.0311, SIZE[1] - margin]):
        for tool in range(2):
            place_patch(tick, state, tool, *place)
            push_each_other(tick, state, tool, tool, out)
            # `FAR` for each of two sides and their corner, and the rounding of the continued waves.
            assert out == pytest.approx(tick.inside[tool], rel=0, abs=5 * FAR * out.max())
    place_patch(tick, state, 0, 0.3 * margin, 0.0225)
    push_each_other(tick, state, 0, 0, out)
    assert np.abs(out - tick.inside[0]).max() > 1e-3 * out.max()


def test_inside_and_its_mirror_images_are_the_matrix_anywhere():
    """Of two points at x and x' the images lie at x + x', as `_spectrum` says: here by its own cosines."""
    model = WaveMembrane(UNEVEN, size=SIZE, modes=(30, 20))
    tick = tick_of(model)
    state, out = at_rest(tick), np.zeros((9, 9))
    place = np.array([0.003, 0.041])
    place_patch(tick, state, 0, *place)
    push_each_other(tick, state, 0, 0, out)
    at_once = np.zeros((30, 20))
    at_once[:, :] = tick.at_once[:, :20]
    kx, ky = np.pi / SIZE[0] * np.arange(31), np.pi / SIZE[1] * np.arange(21)
    spectrum = _spectrum(at_once) * np.exp(-0.5 * WINDOW**2 * (kx[:, None] ** 2 + ky**2))
    spots = points_of(np.array([place, place]))[0]

    def between(x, y):
        return np.einsum("...m,mn,...n->...", np.cos(x[..., None] * kx), spectrum, np.cos(y[..., None] * ky))

    x, y = spots[:, 0], spots[:, 1]
    less_x, more_x = x[:, None] - x[None], x[:, None] + x[None]
    less_y, more_y = y[:, None] - y[None], y[:, None] + y[None]
    images = between(more_x, more_y) - between(more_x, less_y) - between(less_x, more_y)
    assert between(less_x, less_y) == pytest.approx(tick.inside[0], rel=0, abs=1e-12 * out.max())  # rounding
    assert tick.inside[0] + images == pytest.approx(
        out, rel=0, abs=1e-11 * out.max()
    )  # images cancel in part


def test_modes_beyond_the_cut_off_are_left_out():
    model = WaveMembrane(UNEVEN, size=SIZE, modes=(40, 40))
    cutoff = 5.0 / WINDOW  # exp(-(s k)^2/2) is 4e-6 there
    whole, cut = tick_of(model), tick_of(model, cutoff=cutoff)
    assert len(cut.kept) < 0.8 * len(whole.kept)
    states, sunk = (at_rest(whole), at_rest(cut)), np.zeros((2, 2, 9))
    for places, forces in zip(*walk(), strict=True):
        for which, tick in enumerate((whole, cut)):
            for tool, (x, y) in enumerate(places.tolist()):
                place_patch(tick, states[which], tool, x, y)
            go_on(tick, states[which])
            read_patches(tick, states[which], sunk[which])
            hold(tick, states[which], forces)
    assert (
        0 < np.abs(sunk[0] - sunk[1]).max() < 1e-6 * np.abs(sunk[0]).max()
    )  # what the window passes, and less


def test_a_released_tissue_comes_to_rest_without_subnormal_numbers():
    model = WaveMembrane(UNEVEN, size=SIZE, modes=(8, 8))
    tick = tick_of(model)
    state = at_rest(tick)
    places, forces = walk(1)
    place_patch(tick, state, 0, *places[0, 0])
    place_patch(tick, state, 1, *places[0, 1])
    hold(tick, state, forces[0])
    go_on(tick, state)
    let_go(state)
    seen = []
    for _ in range(40_000):
        go_on(tick, state)
        size = np.abs(state.blocks)
        seen.append(bool(((size > 0) & (size < 1e-300)).any()))
    assert not any(seen)
    assert not state.blocks.any()


@pytest.mark.parametrize("place", [1e-9, 1e-4, 0.013, 0.03, 0.0301, 0.0599])
def test_shapes_by_differences_are_sines_and_cosines(place):
    out = np.empty((2, 128))
    sines_and_cosines(place, 0.06, out)
    m = np.arange(1, 129)
    near = min(place, 0.06 - place)  # the mirrored argument, so that the test's own sine is not the worse one
    beyond = place > 0.03
    sines = np.sin(m * np.pi * near / 0.06) * np.where(beyond & (m % 2 == 0), -1, 1)
    cosines = np.cos(m * np.pi * near / 0.06) * np.where(beyond & (m % 2 == 1), -1, 1)
    # Errors of one rounding a step, 128 steps, each amplified by at most m.
    assert out[0] == pytest.approx(sines, rel=0, abs=2e-12 * min(1, np.abs(sines).max()))
    assert out[1] == pytest.approx(cosines, rel=0, abs=2e-12)


@pytest.mark.parametrize(
    ("arguments", "key"),
    [
        ({"offsets": np.zeros((2, 0))}, "offsets"),
        ({"offsets": np.array([[0.0, np.nan]])}, "offsets"),
        ({"offsets": np.zeros(3)}, "offsets"),
        ({"window": 0.0}, "window"),
        ({"window": float("nan")}, "window"),
        ({"dt": 0.0}, "dt"),
        ({"cutoff": 10.0}, "cutoff"),
    ],
)
def test_an_impossible_tick_is_refused(arguments, key):
    model = WaveMembrane(EVEN, size=SIZE, modes=(3, 3))
    with pytest.raises(InputError, match=key):
        make_tick(model, **{"dt": DT, "window": WINDOW, "offsets": OFFSETS, **arguments})

"""Cutting and rejoining the mesh-free model, against finite elements with released nodes and closed forms."""

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press, Support
from trocar.reference.block import MeshSize
from trocar.reference.mesh_free import Cut, MeshFree
from trocar.reference.opening import OpenedBlock
from trocar.tissues import Layer, Tissue

SIZE = (0.03, 0.03)
BESIDE = (
    Press(x=0.0095, y=0.015, radius=4e-3, force=0.05),
    Press(x=0.0205, y=0.015, radius=4e-3, force=0.05),
)
COARSE = MeshSize(per_radius=2.0, growth=0.6, top=0.4, deepening=0.7)
PLACES = np.array([[0.0095, 0.015], [0.01499, 0.015]])  # under a tool, at the lip of the cut


def pad(*thicknesses):
    """One material, in as many layers as asked for: nodes lie on every interface."""
    return Tissue(
        layers=tuple(
            Layer(name=f"pad {i}", thickness=h, young_modulus=1e4, poisson_ratio=0.48, density=1e3)
            for i, h in enumerate(thicknesses)
        )
    )


def model(tissue=None, resolution=1.0, **options):
    return MeshFree(
        tissue or pad(0.01), size=SIZE, support="base", around=BESIDE, resolution=resolution, **options
    )


def across(depth):
    return Cut(start=(0.015, 0.0), end=(0.015, 0.03), depth=depth)


def under(solid, load=BESIDE):
    return solid.displacement(solid.static(load), np.c_[PLACES, np.zeros(2)])


@pytest.mark.parametrize(("depth", "lip"), [(0.005, 0.3), (0.01, 0.2)])
def test_a_cut_opens_as_it_does_in_finite_elements(depth, lip):
    """Coarse nodes open a cut too little; `bench/mesh_free.py` prints by how much less the finer they are."""
    tissue = pad(*[0.0025] * 4)
    fea = OpenedBlock(tissue, size=SIZE, support=Support.BASE, load=BESIDE, depth=depth, mesh=COARSE)
    assert fea.depth == depth
    expected = fea.displacement(PLACES)
    found = under(model(tissue, cuts=(across(depth),)))
    assert found[0, 2] == pytest.approx(expected[0, 2], rel=0.03)
    assert found[1, 0] == pytest.approx(expected[1, 0], rel=lip)


def test_where_nothing_is_cut_nothing_opens():
    cut, whole = (under(model(resolution=0.7, cuts=cuts))[1, 0] for cuts in ((across(0.005),), ()))
    assert abs(whole) < 0.01 * cut


def test_cut_through_no_force_is_left_across():
    cut = model().cut(across(1.0))
    moved = cut.static(BESIDE[:1]).displacement
    right = cut.nodes[:, 0] > 0.0151
    assert not moved[right].any()
    assert np.abs(moved[~right]).max() > 1e-4


def test_each_half_of_a_strip_cut_through_answers_as_if_alone():
    """The other half's tools and cuts do not matter, and the halves are each other's mirror image."""
    cut = model(resolution=0.8).cut(across(1.0))
    alone = under(cut, BESIDE[:1])
    both = under(cut.cut(Cut(start=(0.022, 0.01), end=(0.022, 0.02), depth=0.004)))
    np.testing.assert_allclose(both, alone, atol=1e-10 * np.abs(alone).max())
    mirrored = cut.displacement(cut.static(BESIDE[1:]), np.c_[0.03 - PLACES[:, 0], PLACES[:, 1], np.zeros(2)])
    np.testing.assert_allclose(mirrored * [-1, 1, 1], alone, atol=1e-9 * np.abs(alone).max())


def test_a_deeper_cut_gives_way_more():
    whole = model(pad(0.003, 0.003, 0.004), 0.7)
    depths = [under(one)[0, 2] for one in (whole, *(whole.cut(across(d)) for d in (0.003, 0.006, 0.01)))]
    assert (np.diff(depths) < 0).all()


def test_rejoining_gives_back_the_uncut():
    whole = model(resolution=0.7)
    first, second = across(0.006), Cut(start=(0.006, 0.02), end=(0.012, 0.024), depth=0.003, lean=-0.4)
    joined = whole.cut(first).cut(second).rejoin(first).rejoin(second)
    assert joined.cuts == ()
    assert (under(joined) == under(whole)).all()
    assert not (under(whole.cut(second)) == under(whole)).all()


def test_a_step_in_time_does_not_cross_a_cut_either():
    cut = model().cut(across(1.0))
    state = cut.step(cut.init(), BESIDE[:1], BESIDE[:1], 2e-3)
    assert not state.displacement[cut.nodes[:, 0] > 0.0151].any()


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"depth": 0.0}, "depth"),
        ({"depth": float("nan")}, "depth"),
        ({"end": (0.015, 0.0)}, "end"),
        ({"start": (float("inf"), 0.0)}, "start"),
        ({"lean": 1.5}, "lean"),
    ],
)
def test_an_impossible_cut_is_refused(change, word):
    with pytest.raises(InputError, match=word):
        Cut(**({"start": (0.015, 0.0), "end": (0.015, 0.03), "depth": 0.01} | change))


def test_what_was_not_cut_is_not_joined_and_states_are_not_mixed():
    whole = model()
    with pytest.raises(InputError, match="one of the model's cuts"):
        whole.rejoin(across(0.01))
    with pytest.raises(InputError, match="nodes, as this model has"):
        whole.cut(across(0.01)).step(whole.init(), (), (), 1e-3)


def test_a_state_is_carried_through_cutting_and_sewing():
    whole = model(resolution=0.7)
    first, second = across(0.006), Cut(start=(0.0, 0.015), end=(0.03, 0.015), depth=0.004)
    cut = whole.cut(first)
    opened = cut.static(BESIDE)
    both = cut.cut(second)
    carried = both.carried(opened, cut)
    places = np.c_[PLACES, np.zeros(2)] + [0, 0.002, 0]
    np.testing.assert_allclose(
        both.displacement(carried, places)[1, 0], cut.displacement(opened, places)[1, 0], rtol=0.2
    )
    back = cut.carried(carried, both)
    np.testing.assert_allclose(back.displacement, opened.displacement, atol=1e-15)
    sewn = whole.carried(opened, cut)
    assert abs(whole.displacement(sewn, places)[1, 0]) < 0.1 * cut.displacement(opened, places)[1, 0]
    with pytest.raises(InputError, match="cuts alone"):
        model(resolution=1.0).carried(opened, cut)

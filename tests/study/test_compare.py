"""One case through several models."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Support
from trocar.reference.stress import Deformation
from trocar.study.cases.reading import Tool, case_from_tissue, load_case
from trocar.study.compare import compare
from trocar.study.deflection import deflections, search_points
from trocar.study.models import MOST_MODES, QUICK_MODELS, check_names, series_modes
from trocar.study.stated_range import departures
from trocar.tissues import Fibre, Layer, NeoHookean, Tissue
from trocar.waves.solid import WaveSolid

EXAMPLES = Path(__file__).parent.parent.parent / "examples"
PRESS, PAIR, TAP = (load_case(EXAMPLES / f"{name}.toml") for name in ("press", "pair", "dynamic"))


def test_a_ramp_up_and_down_is_followed_in_proportion():
    result = compare(PRESS, ("wave-solid",))
    history = result["wave-solid"]
    assert history.force[0] == history.force[-1] == 0.0
    assert history.force.max() == pytest.approx(PRESS.peak_force)
    for depths in history.deflection.values():
        assert depths == pytest.approx(depths.max() * history.force / PRESS.peak_force, abs=1e-15)
    assert (history.block == np.max(list(history.deflection.values()), axis=0)).all()


def test_the_largest_deflection_is_that_under_the_tool():
    history = compare(PRESS, ("wave-solid",))["wave-solid"]
    model = WaveSolid(PRESS.tissue, size=PRESS.size, modes=series_modes(PRESS))
    (tool,) = PRESS.tools
    centre = np.array([[*tool.position, 0.0]])
    state = model.static((tool.press(tool.peak),))
    for layer, depths in history.deflection.items():
        # On so even a bowl the middle is the lowest point; the stiff epidermis dips a little off it.
        assert depths.max() == pytest.approx(-model.displacement(state, centre, layer)[0, 2], rel=2e-3)


def test_two_tools_add_up_point_by_point():
    both = compare(PAIR, ("wave-solid",))["wave-solid"]
    model = WaveSolid(PAIR.tissue, size=PAIR.size, modes=series_modes(PAIR))
    middle = int(np.argmax(both.force))
    state = model.static(PAIR.load_at(both.time[middle]))
    under = np.array([[*tool.position, 0.0] for tool in PAIR.tools])
    deepest = -model.displacement(state, under)[:, 2].min()
    assert both.deflection["epidermis"][middle] == pytest.approx(deepest, rel=2e-3)


def test_a_tap_leaves_the_tissue_moving_and_waves_agree_with_finite_elements():
    coarse = replace(TAP, sampling=replace(TAP.sampling, period=2e-3))
    result = compare(coarse, ("wave-solid", "fea"))
    one, two = result["wave-solid"], result["fea"]
    assert one.force[-1] == 0.0
    assert one.deflection["dermis"][-1] != 0.0
    for layer, depths in two.deflection.items():
        assert one.deflection[layer] == pytest.approx(depths, abs=0.02 * depths.max())


def test_what_comes_out_is_what_the_format_says():
    plain = json.loads(json.dumps(compare(PRESS, ("wave-membrane",)).as_dict()))
    assert plain["case"]["title"] == PRESS.title
    (model,) = plain["models"].values()
    assert set(model) == {"time_s", "force_n", "max_deflection_mm", "cpu_s", "dofs", "in_range"}
    assert list(model["max_deflection_mm"]) == ["epidermis", "dermis", "fat"]
    assert model["in_range"] is True
    assert len(model["time_s"]) == len(model["force_n"]) == len(model["max_deflection_mm"]["fat"])


def test_the_papers_load_is_outside_the_linear_range():
    case = load_case(EXAMPLES / "paper-5n.toml")
    found = compare(case, ("wave-solid",))["wave-solid"].linear_range
    assert not found.inside
    assert found.force_limit < 0.1


def test_springs_turn_where_the_laws_of_the_case_hold_at_large_strain():
    case = replace(PRESS, sampling=replace(PRESS.sampling, period=2.0))
    laws = Tissue(layers=tuple(replace(layer, law=NeoHookean()) for layer in case.tissue.layers))
    both = compare(case, ("mass-spring", "fea"), builders=QUICK_MODELS)
    still, elements = both["mass-spring"], both["fea"]
    turning = compare(replace(case, tissue=laws), ("mass-spring",), builders=QUICK_MODELS)["mass-spring"]
    for layer, depths in still.deflection.items():
        assert depths.max() == pytest.approx(elements.deflection[layer].max(), rel=0.1)
        apart = abs(turning.deflection[layer].max() / depths.max() - 1)
        assert 1e-4 < apart < 0.03  # 0.1 N lies within the linear range, and that means 3 %
    assert (still.large_deformation, turning.large_deformation) == (False, True)
    assert still.in_range
    assert turning.in_range


def test_progress_is_told_to_the_end():
    told = []
    compare(PAIR, ("wave-solid",), watch=lambda model, share: told.append((model, share)))
    assert told == [("wave-solid", 0.5), ("wave-solid", 1.0)]


@pytest.mark.parametrize(
    ("names", "word"),
    [
        ((), "at least one"),
        (("fem",), "fem"),
    ],
)
def test_models_that_are_not_there_are_refused(names, word):
    with pytest.raises(InputError, match=word):
        check_names(names)


def test_a_model_named_twice_runs_once():
    assert check_names(("fea", "wave-solid", "fea")) == ("fea", "wave-solid")


def test_a_tool_too_small_for_the_block_is_refused_by_the_waves():
    (tool,) = PRESS.tools
    tiny = replace(PRESS, size=(0.5, 0.5), tools=(replace(tool, diameter=1e-3),))
    with pytest.raises(InputError, match="take a smaller block"):
        compare(tiny, ("wave-solid",))
    wide = replace(PRESS, size=(0.5, 0.5), tools=(replace(tool, diameter=5e-3),))
    assert max(series_modes(wide)) <= MOST_MODES


def test_membranes_that_could_not_be_fitted_are_out_of_range():
    """One even layer answers short waves as 1/k, which no sheet with tension and bending does."""
    (tool,) = PRESS.tools
    even = replace(PRESS.tissue, layers=PRESS.tissue.layers[-1:])
    thick = replace(PRESS, tissue=even, tools=(replace(tool, peak=1e-5, rate=1e-5, diameter=1.5e-3),))
    history = compare(thick, ("wave-membrane",))["wave-membrane"]
    assert history.linear_range.inside
    assert history.fit_error > 0.05
    assert not history.in_range
    assert compare(PRESS, ("wave-membrane",))["wave-membrane"].fit_error < 0.05


def test_waves_are_not_stated_close_to_a_clamped_side_nor_in_motion_between_them():
    (tool,) = PRESS.tools
    edges = replace(PRESS, support=Support.EDGES, tools=(replace(tool, peak=1e-3),))
    near = replace(edges, tools=(replace(tool, peak=1e-3, position=(0.006, 0.03)),))
    assert compare(edges, ("wave-solid",))["wave-solid"].in_range
    history = compare(near, ("wave-solid",))["wave-solid"]
    assert history.linear_range.inside
    assert not history.in_range
    assert "nearer to a clamped side than 3.75 mm" in history.departures[0]
    assert compare(replace(near, support=Support.BASE), ("wave-solid",))["wave-solid"].departures == ()
    assert compare(near, ("fea",))["fea"].departures == ()
    moving = replace(TAP, support=Support.EDGES_AND_BASE)
    (reason,) = departures(moving, "wave-solid", fit_error=0.0, modes=(96, 96))
    assert "moving waves" in reason


def test_membranes_are_not_stated_in_motion_or_with_too_few_modes():
    assert departures(TAP, "wave-membrane", fit_error=0.0, modes=(96, 96)) == (
        "membranes are fitted to slow loads",
    )
    assert departures(PRESS, "wave-membrane", fit_error=0.0, modes=(96, 96)) == ()
    (reason,) = departures(PRESS, "wave-membrane", fit_error=0.0, modes=(8, 8))
    assert "modes a side" in reason
    assert departures(PRESS, "wave-solid", fit_error=0.0, modes=(8, 8)) == ()


def test_the_quick_models_are_coarser():
    quick = compare(PRESS, ("fea",), builders=QUICK_MODELS)["fea"]
    usual = compare(PRESS, ("fea",))["fea"]
    assert quick.dofs < usual.dofs / 2
    for layer, depths in usual.deflection.items():
        assert quick.deflection[layer] == pytest.approx(depths, rel=0.015, abs=1e-12)


def pressed_hard(law, **more):
    """One layer, so that quick finite elements have few unknowns: 0.3 N on 10 mm, a seventh of the thickness deep."""
    pad = Layer(name="pad", thickness=8e-3, young_modulus=2e4, poisson_ratio=0.45, density=1e3, law=law)
    values = {"diameter": 0.01, "position": (0.01, 0.01), "peak": 0.3, "rate": 0.1} | more
    return case_from_tissue(
        tissue=Tissue(layers=(pad,)), size=(0.02, 0.02), tools=(Tool(**values),), period=0.25
    )


def test_finite_elements_follow_large_deformation_and_waves_beside_them_say_they_do_not():
    case = pressed_hard(NeoHookean())
    result = compare(case, ("wave-solid", "fea"), builders=QUICK_MODELS)
    waves, elements = result["wave-solid"], result["fea"]
    assert elements.large_deformation
    assert elements.in_range
    assert not waves.large_deformation
    assert not waves.in_range
    assert elements.linear_range.force_limit == pytest.approx(waves.linear_range.force_limit, rel=0.05)
    depths = elements.deflection["pad"]
    assert depths[0] == depths[-1] == 0.0
    model = QUICK_MODELS["fea"](case)
    points = search_points(case.size, case.load_at(0.0))
    for number in (2, 9, 12):  # the curve between the forces that are solved, the release, the peak
        state = model.static(case.load_at(elements.time[number]))
        direct = deflections(model, state, points, ("pad",)).max()
        assert depths[number] == pytest.approx(direct, rel=1e-3)
    small = compare(replace(case, tissue=case.tissue.linearised), ("fea",), builders=QUICK_MODELS)["fea"]
    assert depths[1] / small.deflection["pad"][1] == pytest.approx(1, abs=0.05)
    assert abs(depths.max() / small.deflection["pad"].max() - 1) > 0.01


def test_the_mesh_free_model_follows_large_deformation_too():
    case = pressed_hard(NeoHookean())
    result = compare(case, ("fea", "mesh-free"), builders=QUICK_MODELS)
    elements, free = result["fea"], result["mesh-free"]
    assert free.large_deformation
    assert free.in_range
    assert free.block.max() == pytest.approx(elements.block.max(), rel=0.04)  # two coarse models


def test_explicit_time_that_would_take_days_is_refused():
    layer = replace(pressed_hard(NeoHookean()).tissue.layers[0], thickness=1e-4, loss_factor=0.2)
    case = replace(pressed_hard(NeoHookean()), tissue=Tissue(layers=(layer,)))
    case = replace(case, sampling=replace(case.sampling, dynamic=True))
    with pytest.raises(InputError, match="explicit time"):
        compare(case, ("mesh-free",), builders=QUICK_MODELS)


def test_tools_that_do_not_keep_their_ratio_are_followed_together():
    case = pressed_hard(NeoHookean())
    (tool,) = case.tools
    one, other = (
        replace(tool, diameter=5e-3, peak=0.06, position=at) for at in ((5e-3, 0.01), (0.015, 0.01))
    )
    pair = replace(case, tools=(one, replace(other, rate=0.2)), sampling=replace(case.sampling, period=0.5))
    history = compare(pair, ("fea",), builders=QUICK_MODELS)["fea"]
    assert np.isfinite(history.block).all()
    assert history.block[-1] == 0.0
    assert history.block.max() > 0.0


def test_waves_leave_fibres_out_and_say_so():
    case = pressed_hard(Fibre(k1=1e4, k2=1.0), peak=0.01, rate=0.01)
    history = compare(case, ("wave-solid",))["wave-solid"]
    assert history.linear_range.inside
    assert not history.in_range
    assert any("fibres" in reason for reason in history.departures)


def test_tissue_squeezed_beyond_its_law_is_reported():
    case = pressed_hard(NeoHookean())
    squeezed = {"pad": Deformation(stretch=(0.21, 2.0), volume_ratio=(0.9, 1.1))}
    (reason,) = departures(case, "fea", fit_error=0.0, modes=None, deformation=squeezed)
    assert "pad is squeezed to 0.21 of its length" in reason


def skin_pressed(peak, fat=1e4, support=Support.BASE):
    skin = Layer(
        name="skin", thickness=1e-3, young_modulus=4e5, poisson_ratio=0.48, density=1e3, law=NeoHookean()
    )
    below = Layer(
        name="fat", thickness=8e-3, young_modulus=fat, poisson_ratio=0.48, density=1e3, law=NeoHookean()
    )
    tool = Tool(diameter=8e-3, position=(0.02, 0.02), peak=peak, rate=peak)
    return case_from_tissue(
        tissue=Tissue(layers=(skin, below)), size=(0.04, 0.04), tools=(tool,), support=support, period=0.5
    )


def test_waves_stiffen_where_layers_have_laws_for_large_strain():
    case = skin_pressed(0.6)
    linear = replace(case, tissue=case.tissue.linearised)
    for model in ("wave-solid", "wave-membrane"):
        hard, straight = compare(case, (model,))[model], compare(linear, (model,))[model]
        assert hard.large_deformation
        assert not straight.linear_range.inside
        assert hard.block.max() < 0.9 * straight.block.max()
        assert hard.block[1] < 0.6 * hard.block.max()  # half the force at half the time: deeper than half
        assert hard.in_range == (hard.fit_error < 0.05)  # two sheets are fitted less well than three


def test_stiffening_waves_say_where_they_are_not_stated():
    too_deep = compare(skin_pressed(1.2), ("wave-solid",))["wave-solid"]
    assert "beyond the third they are stated for" in too_deep.departures[0]
    assert not too_deep.in_range
    firm = compare(skin_pressed(0.6, fat=1e5), ("wave-solid",))["wave-solid"]
    (reason,) = firm.departures
    assert "4 times stiffer than its bed" in reason
    capsule = departures(
        skin_pressed(0.1, fat=1e3), "wave-membrane", fit_error=0.0, modes=(96, 96), dent=1e-3
    )
    assert "400 times stiffer than its bed, beyond 110" in capsule[0]
    clamped = compare(skin_pressed(0.1, support=Support.EDGES), ("wave-solid",))["wave-solid"]
    assert not clamped.large_deformation  # it stays linear there, and is judged as such

"""What every tissue model owes its users. A test module binds it: subclass, and give `model` and `settled`."""

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press, TissueModel

PRESS = Press(x=0.026, y=0.031, radius=0.003, force=0.1)
OTHER = Press(x=0.040, y=0.022, radius=0.004, force=0.05)
WHERE = np.array([[0.026, 0.031, 0.0], [0.03, 0.03, 0.0], [0.012, 0.044, 0.0], [0.05, 0.05, 0.0]])


class TissueModelContract:
    """Inherit, and give `model`: a fixture of a damped model of `skin` on 60 x 60 mm.

    `rounding` is what two ways to one answer may differ by, relative to the largest displacement.
    `settled` likewise bounds what is left after a load was held for long.
    """

    rounding = 1e-9
    settled = 1e-6

    def assert_close(self, actual, expected, tolerance):
        assert actual == pytest.approx(expected, abs=tolerance * np.abs(expected).max())

    def test_it_is_a_tissue_model(self, model):
        assert isinstance(model, TissueModel)
        assert model.layer_names == ("epidermis", "dermis", "fat")
        assert model.size == (0.06, 0.06)

    def test_at_rest_nothing_has_moved(self, model):
        state = model.init()
        assert state.time == 0.0
        assert not model.displacement(state, WHERE).any()

    def test_pushing_in_moves_the_tissue_down_and_deep_layers_with_it(self, model):
        state = model.static((PRESS,))
        depths = [model.displacement(state, WHERE[:1], layer)[0, 2] for layer in model.layer_names]
        assert max(depths) < 0
        assert model.displacement(state, WHERE).shape == (4, 3)
        assert model.dofs > 0

    def test_no_layer_named_means_the_top_one(self, model):
        state = model.static((PRESS,))
        assert (model.displacement(state, WHERE) == model.displacement(state, WHERE, "epidermis")).all()

    def test_equilibria_scale_and_add(self, model):
        both = model.displacement(model.static((PRESS.with_force(0.3), OTHER)), WHERE, "fat")
        apart = 3 * model.displacement(model.static((PRESS,)), WHERE, "fat")
        apart += model.displacement(model.static((OTHER,)), WHERE, "fat")
        self.assert_close(both, apart, self.rounding)

    def test_a_step_changes_neither_its_state_nor_its_loads(self, model):
        start = model.step(model.init(), (PRESS.with_force(0.0),), (PRESS,), 1e-3)
        before = model.displacement(start, WHERE).copy()
        model.step(start, (PRESS,), (PRESS.with_force(0.0),), 1e-3)
        assert (model.displacement(start, WHERE) == before).all()

    def test_time_is_the_sum_of_the_steps(self, model):
        state = model.init()
        for dt in (1e-3, 2e-3, 5e-4):
            state = model.step(state, (PRESS,), (PRESS,), dt)
        assert state.time == pytest.approx(3.5e-3)

    def test_the_same_step_gives_the_same_bits(self, model):
        one, two = (model.step(model.init(), (PRESS.with_force(0.0),), (PRESS,), 1e-3) for _ in range(2))
        assert (model.displacement(one, WHERE) == model.displacement(two, WHERE)).all()

    def test_a_held_load_ends_in_equilibrium(self, model):
        state = model.step(model.init(), (PRESS.with_force(0.0),), (PRESS,), 0.05)
        for _ in range(40):
            state = model.step(state, (PRESS,), (PRESS,), 0.05)
        still = model.displacement(model.static((PRESS,)), WHERE)
        self.assert_close(model.displacement(state, WHERE), still, self.settled)

    @pytest.mark.parametrize("dt", [0.0, -1e-3, float("nan"), float("inf")])
    def test_an_impossible_step_is_refused(self, model, dt):
        with pytest.raises(InputError, match="dt"):
            model.step(model.init(), (PRESS,), (PRESS,), dt)

    def test_loads_that_do_not_pair_up_are_refused(self, model):
        with pytest.raises(InputError, match="load1"):
            model.step(model.init(), (PRESS,), (PRESS, OTHER), 1e-3)

    def test_an_unknown_layer_is_refused(self, model):
        with pytest.raises(InputError, match="epidermis, dermis, fat"):
            model.displacement(model.init(), WHERE, "muscle")

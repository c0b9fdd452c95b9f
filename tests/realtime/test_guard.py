"""The force chain: each stage by itself, then all of them against hands that do their worst."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from trocar.realtime.guard import (
    LATCHED,
    LIMITED,
    UNTOUCHED,
    GuardLimits,
    beat_factor,
    energy_given,
    forget,
    growth_bound,
    guarded,
    stiffness_bound,
    tank_bound,
    unloaded,
)

T = 1e-3  # [s]
B = 0.2  # [N s/m]
LIMITS = GuardLimits()
WIDE = GuardLimits(damping=1e6, still_growth=1e6, reserve=1e6, credit=1e6, slew=1e9, clamp=1e6)


class Hand:
    """One hand that the chain guards."""

    def __init__(self, limits=LIMITS, hand=0):
        self.limits, self.hand, self.state = limits, hand, unloaded()

    def feels(self, force, place=(0, 0, 0), holds=True, silence=0.0):
        out = np.full(3, np.nan)
        wanted, where = np.array(force, float), np.array(place, float)
        self.did = guarded(self.limits, self.state, self.hand, wanted, where, holds, silence, T, out)
        return out


def test_a_sampled_wall_gives_energy_above_the_bound_and_none_at_it():
    # A hand that moves in and out of a wall from tick to tick, steadily, meets the held force of the place it left.
    for share in (0.98, 1.0, 1.02):
        K = share * stiffness_bound(B, T)
        depth = 2e-3
        net = sum(
            energy_given(work, depth, B, T) for work in (0.0 * depth, K * depth * depth)
        )  # in, against no force; out, with K depth along the way
        assert np.sign(round(net / (K * depth**2), 12)) == np.sign(round(share - 1.0, 12))


def test_a_force_grows_with_the_motion_of_the_hand():
    assert growth_bound(1.0, 1e-3, LIMITS, T) == pytest.approx(1.0 + 400.0 * 1e-3 + 2.0 * T)


def test_the_tank_is_what_the_worst_motion_would_take():
    bound = tank_bound(1e-3, 5e-3, B, T)
    moves = np.linspace(0.0, 0.1, 100_001)
    worst = max(energy_given(bound * dx, dx, B, T) for dx in moves)
    assert worst == pytest.approx(4e-3, rel=1e-6)  # the grid's own error
    assert tank_bound(6e-3, 5e-3, B, T) == 0.0


@pytest.mark.parametrize(("silence", "left"), [(0.0, 1.0), (0.05, 1.0), (0.075, 0.5), (0.1, 0.0), (9.0, 0.0)])
def test_a_force_falls_without_a_beat(silence, left):
    assert beat_factor(silence) == pytest.approx(left, abs=1e-12)
    assert Hand(WIDE).feels((0, 0, 1), silence=silence)[2] == pytest.approx(left, abs=1e-12)


def test_what_is_within_every_bound_passes_unchanged():
    hand = Hand(WIDE)
    assert hand.feels((1, -2, 3)).tolist() == [1, -2, 3]
    assert hand.did == UNTOUCHED


def test_a_still_hand_feels_a_force_grow_slowly():
    hand = Hand()
    sizes = [hand.feels((0, 0, 1))[2] for _ in range(3)]
    assert sizes == pytest.approx([0.002, 0.004, 0.006])
    assert hand.did == LIMITED


def test_a_force_turns_no_faster_than_the_slew():
    hand = Hand(WIDE._replace(slew=100.0))
    for _ in range(100):
        hand.feels((1, 0, 0))
    assert np.linalg.norm(hand.feels((0, 1, 0)) - (1, 0, 0)) == pytest.approx(0.1)


def test_a_force_that_falls_is_not_held_up():
    hand = Hand(WIDE._replace(slew=100.0))
    for _ in range(100):
        hand.feels((0, 0, 3))
    assert hand.feels((0, 0, 0)).tolist() == [0, 0, 0]


def test_no_force_is_above_the_clamp():
    hand = Hand(WIDE._replace(clamp=3.3))
    assert np.linalg.norm(hand.feels((0, 30, 40))) == pytest.approx(3.3)
    assert hand.feels((0, 30, 40)) == pytest.approx([0, 1.98, 2.64])


@pytest.mark.parametrize(
    ("where", "wrong"),
    [(where, wrong) for where in ("force", "place") for wrong in (np.nan, np.inf, -np.inf)]
    + [("force", 1e300)],  # its square is not finite
)
def test_what_is_not_finite_cuts_the_force_until_a_reset(where, wrong):
    hand = Hand(WIDE)
    hand.feels((0, 0, 1))
    broken = {"force": (0, 0, 1), "place": (0, 0, 0), where: (0, wrong, 0)}
    assert hand.feels(broken["force"], broken["place"]).tolist() == [0, 0, 0]
    assert hand.did == LATCHED
    assert hand.feels((0, 0, 1)).tolist() == [0, 0, 0]
    forget(hand.state)
    assert hand.feels((0, 0, 1)).tolist() == [0, 0, 1]


def test_one_hand_knows_nothing_of_the_other():
    left = Hand(WIDE)
    right = Hand(WIDE, hand=1)
    right.state = left.state
    left.feels((np.nan, 0, 0))
    assert right.feels((0, 0, 2)).tolist() == [0, 0, 2]


def test_an_instrument_in_no_hand_pulls_at_none():
    hand = Hand(WIDE)
    hand.feels((0, 0, 1))
    assert hand.feels((0, 0, 1), holds=False).tolist() == [0, 0, 0]


def test_a_jump_while_it_was_out_of_the_hand_is_no_motion():
    hand = Hand()
    hand.feels((0, 0, 0), place=(0, 0, 0))
    hand.feels((0, 0, 0), place=(0, 0, 0), holds=False)
    assert hand.feels((0, 0, 3), place=(1, 0, 0))[2] == pytest.approx(0.002)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(seed=st.integers(0, 2**32 - 1), stiffness=st.sampled_from([150.0, 400.0, 1000.0, 1e5]))
def test_a_hand_is_never_given_more_than_the_reserve(seed, stiffness):
    # Random motion up to 1 m/s with reversals every tick, against a spring far above the bound and random forces.
    rng = np.random.default_rng(seed)
    hand = Hand()
    place, last, given = np.zeros(3), np.zeros(3), 0.0
    worst = 0.0
    for _ in range(200):
        step = rng.normal(size=3)
        step *= rng.choice([0.0, 1e-5, 1e-3]) / np.linalg.norm(step)
        if rng.random() < 0.5 and last.any():  # with the force, as far as pays most
            step = last * T / (2 * B)
        place = place + step
        given += last @ step - B * step @ step / T
        worst = max(worst, given)
        wanted = np.array([0, 0, -stiffness * min(place[2], 0)]) + rng.normal(size=3) * rng.choice([0, 10])
        last = hand.feels(wanted, place)
    assert worst <= LIMITS.reserve * (1 + 1e-9)


def test_a_wall_above_the_bound_would_give_energy_without_the_chain():
    place = np.array([0.0, 2e-3] * 50)
    force = -1000.0 * place
    step = np.diff(place)
    assert sum(force[:-1] * step - B * step**2 / T) > LIMITS.reserve

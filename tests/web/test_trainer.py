"""The live trainer as the stream's source: poses become forces and dents, a dead servo is told of and started again."""

import os
import signal
import threading
import time
from contextlib import contextmanager

import numpy as np
import pytest

from trocar.contact.instrument import default_instruments
from trocar.devices.simulated import SimulatedDevice
from trocar.errors import InputError
from trocar.simulation.live import LIVE_SIZE
from trocar.web.messages import Hello
from trocar.web.source import LEFT, RIGHT, Pose, Status, Touch
from trocar.web.stage import set_stage
from trocar.web.trainer import Trainer
from web.visitor import until

LEFT_HAND, RIGHT_HAND = default_instruments(LIVE_SIZE)
PATIENCE = 60.0  # [s] on a busy machine; nothing here is a timing


@contextmanager
def living(trainer):
    """Open a trainer and beat it from a thread, as the server does."""
    trainer.open()
    over = threading.Event()

    def beat():
        while not over.wait(0.01):
            trainer.beat()

    beating = threading.Thread(target=beat)
    beating.start()
    try:
        yield trainer
    finally:
        over.set()
        beating.join()
        trainer.close()


@pytest.fixture(scope="module")
def trainer():
    with living(Trainer(set_stage("skin"))) as opened:
        yield opened


class Hand:
    """Moves one instrument's tip smoothly, as a hand would."""

    def __init__(self, trainer, instrument, shape):
        self.trainer, self.instrument, self.shape, self.sequence = trainer, instrument, shape, 0
        self.tip = np.array(shape.reach_of(shape.handle).tip)

    def pose(self, tip, jaw=1.0, present=True):
        self.sequence += 1
        handle = self.shape.handle_for(tuple(tip))
        self.trainer.pose(
            self.instrument,
            Pose(
                instrument=self.instrument,
                sequence=self.sequence,
                present=present,
                handle=handle,
                roll=0.0,
                jaw=jaw,
            ),
        )

    def go(self, *tip, jaw=1.0):
        steps = max(2, int(np.linalg.norm(np.subtract(tip, self.tip)) / 2e-4))
        for share in np.linspace(0, 1, steps):
            self.pose(self.tip + share * (np.array(tip) - self.tip), jaw)
            time.sleep(2e-3)
        self.tip = np.array(tip)

    def leave(self):
        self.pose(self.tip, present=False)


@pytest.fixture
def hands(trainer):
    trainer.reset()
    both = Hand(trainer, LEFT, LEFT_HAND), Hand(trainer, RIGHT, RIGHT_HAND)
    yield both
    for hand in both:
        hand.leave()
    until(lambda: not any(state.touch for state in trainer.latest().instruments), PATIENCE)


def test_it_greets_with_what_there_is(trainer):
    hello = trainer.hello()
    assert isinstance(hello, Hello)
    assert hello.tissue.name == "skin"
    assert [layer.name for layer in hello.tissue.layers] == ["epidermis", "dermis", "fat"]
    assert [shape.tip for shape in hello.instruments] == ["grasper", "probe"]
    assert hello.steered_by == "page"
    assert 0.05 < hello.linear_force_n < 0.1  # skin under 5 mm: bench/linear_range.py


def test_a_press_comes_back_as_a_dent_a_force_and_its_number(trainer, hands):
    _, right = hands
    before = trainer.latest()
    assert Status.ALIVE in before.status
    right.go(0.042, 0.03, -0.0005)
    until(lambda: trainer.latest().pose_sequence[RIGHT] == right.sequence, PATIENCE)
    until(
        lambda: trainer.latest().heights.min() < -0.4e-3, PATIENCE
    )  # a servo that lags is still on its way there
    state = trainer.latest()
    assert state.instruments[RIGHT].force[2] > 0.03
    assert state.instruments[RIGHT].touch == Touch.PRESENT | Touch.TOUCHING
    assert state.tick > before.tick
    assert state.in_plane.shape == (2, 64, 64)
    # The lever: the port bears what lies across the shaft, so both ends do the same work.
    assert np.linalg.norm(state.instruments[RIGHT].handle_force) > 0.01


def test_a_deep_press_is_beyond_the_linear_range(trainer, hands):
    _, right = hands
    right.go(0.042, 0.03, -0.0015)
    until(lambda: Status.BEYOND_LINEAR in trainer.latest().status, PATIENCE)
    right.go(0.042, 0.03, 0.004)
    until(lambda: Status.BEYOND_LINEAR not in trainer.latest().status, PATIENCE)


def test_a_closing_jaw_takes_hold_and_lifts(trainer, hands):
    left, _ = hands
    left.go(0.02, 0.03, -0.0005)
    until(lambda: Touch.TOUCHING in trainer.latest().instruments[LEFT].touch, PATIENCE)
    left.pose(left.tip, jaw=0.0)
    until(lambda: Touch.HOLDING in trainer.latest().instruments[LEFT].touch, PATIENCE)
    left.go(0.02, 0.03, 0.002, jaw=0.0)
    until(lambda: trainer.latest().heights.max() > 1e-3, PATIENCE)
    assert trainer.latest().instruments[LEFT].force[2] < -0.05
    left.pose(left.tip, jaw=1.0)
    until(lambda: trainer.latest().instruments[LEFT].touch == Touch.PRESENT, PATIENCE)


def test_a_killed_servo_gives_no_force_is_told_of_and_comes_back(trainer, hands):
    _, right = hands
    right.go(0.042, 0.03, -0.0005)
    until(lambda: trainer.latest().instruments[RIGHT].force[2] > 0.03, PATIENCE)
    trainer.notices()
    os.kill(trainer.servo.process_id, signal.SIGKILL)
    until(lambda: Status.ALIVE not in trainer.latest().status, PATIENCE)
    dead = trainer.latest()
    assert Status.FORCES_CUT in dead.status
    assert not np.any(dead.instruments[RIGHT].force)
    assert not np.any(dead.instruments[RIGHT].handle_force)
    until(lambda: Status.ALIVE in trainer.latest().status, PATIENCE)
    said = [notice.text for notice in trainer.notices()]
    assert said[0] == "The servo was killed by SIGKILL. Forces are off; it is being started again."
    until(lambda: said + [notice.text for notice in trainer.notices()] and trainer.servo.alive, PATIENCE)
    assert abs(trainer.latest().heights).max() < 1e-9


def test_simulated_hands_move_by_themselves_and_the_page_cannot_interfere():
    device = SimulatedDevice("press")
    with living(Trainer(set_stage("skin"), device=device)) as trainer:
        assert trainer.hello().steered_by == "trainer"
        pushed = Pose(
            instrument=RIGHT,
            sequence=10**6,
            present=True,
            handle=RIGHT_HAND.handle_for((0.05, 0.05, 0.0)),
            roll=0.0,
            jaw=1.0,
        )
        until(lambda: Touch.TOUCHING in trainer.latest().instruments[RIGHT].touch, PATIENCE)
        trainer.pose(RIGHT, pushed)
        assert trainer.latest().pose_sequence[RIGHT] < 10**6


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"tissue": "granite"}, "granite"),
        ({"tissue": "skin", "model": "fea"}, "model: expected wave-membrane or wave-solid, got 'fea'"),
        ({"tissue": "skin", "ports": "oblik"}, "did you mean oblique?"),
        ({"tissue": "skin-paper-2014"}, "paper"),
    ],
)
def test_what_does_not_go_together_is_refused_at_once(arguments, words):
    with pytest.raises(InputError, match=words):
        set_stage(**arguments)


def test_another_stage_is_entered_with_its_own_ports(trainer):
    before, first = trainer.hello(), trainer.servo
    trainer.enter(set_stage("skin", ports="oblique"))
    try:
        assert trainer.hello().instruments[0].port_m != before.instruments[0].port_m
        assert not first.alive
        assert trainer.servo.alive
        until(lambda: Status.ALIVE in trainer.latest().status, PATIENCE)
    finally:
        trainer.enter(set_stage("skin"))
    assert trainer.hello() == before

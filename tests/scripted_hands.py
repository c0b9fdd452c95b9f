"""A scripted trainee's hands at a live servo, and a task that is soon done."""

import time
from dataclasses import replace

import numpy as np

from trocar.simulation import HANDLE, JAW, PRESENT, ROLL
from trocar.training.players import ScriptedPlayer, Skill
from trocar.training.session import ground_of
from trocar.training.tasks.moment import Moment
from trocar.training.tasks.palpate import palpate
from trocar.training.tasks.progress import Progress

PERIOD = 0.01  # [s] between poses


def first_step(level=1):
    """Return palpate with its first point alone."""
    whole = palpate(level)
    return replace(whole, steps=whole.steps[:1])


class Hands:
    """A scripted trainee at a live servo."""

    def __init__(self, servo, attempted, skill=Skill.EXPERT):
        self.servo, self.task = servo, attempted
        self.player = ScriptedPlayer(attempted.instruments, skill, 1, dt=PERIOD, ground=ground_of(attempted))
        self.progress, self.began = Progress(attempted), time.monotonic()

    def move(self):
        moment = Moment(time.monotonic() - self.began, np.array(self.servo.latest().records))
        self.progress.advance(moment)
        for hand, pose in enumerate(self.player.poses(moment, self.progress)):
            x, y, z = pose[HANDLE : HANDLE + 3]
            self.servo.command(
                hand, present=bool(pose[PRESENT]), handle=(x, y, z), roll=pose[ROLL], jaw=pose[JAW]
            )
        time.sleep(PERIOD)

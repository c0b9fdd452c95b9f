"""Scripted trainees, an expert and a novice: they do a task with the same eyes and hands as people, better or worse.

A player sees what a trainee sees: the step that is on, where its own tips are and how hard they press. Each hand goes
to its mark on minimum-jerk ways (Flash and Hogan 1985, J Neurosci 5:1688) above the tissue, comes down, and presses by
correcting its depth. The novice is slower, stops to think, misses at first, wavers on the way, presses with a force and
raises to a height of its own choosing before it corrects them, and trembles more. Nothing in tasks or scores knows a
player.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from itertools import repeat
from math import inf, isinf, isnan, nan
from typing import Protocol

import numpy as np

from trocar.contact.instrument import Instrument
from trocar.devices.unsteadiness import Tremor
from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.simulation import HANDLE, JAW, POSE, PRESENT
from trocar.training.palpation import Palpation
from trocar.training.tasks.cut import Cut
from trocar.training.tasks.find import Find
from trocar.training.tasks.moment import Moment
from trocar.training.tasks.progress import Progress
from trocar.training.tasks.step import Follow, LetGo, Lift, Press, Step, Together
from trocar.training.wish import Wish

_THERE = 1e-4  # [m] from where a snip is meant
_ABOVE = 4e-3  # [m] over the tissue, where a hand goes from mark to mark
_CLEAR = 3e-3  # [m] over the tissue, at least, on the way
_SHARES = tuple(np.linspace(0.1, 0.9, 9).tolist())  # of a way, at which it is looked at
_GAIN = 0.1  # [m/(N s)] by which a hand corrects its depth: on skin it is there in a tenth of a second
_CLOSE = 0.25  # [s] for a jaw
_LIGHTEST = 0.4  # of the force that is right, that anybody presses with at first
_RAISING = 0.125  # of the speed it comes down with, with tissue in the jaw
_SNIPPED = 0.5  # of the most force, to cut with
_LEARNING = 3e-3  # [1/tick] of an error that is seen is taken away


Ground = Callable[[float, float], float]


def level(x: float, y: float) -> float:
    """Return how high a block's surface lies [m]."""
    return 0.0


class Skill(StrEnum):
    """How well a player plays."""

    EXPERT = "expert"
    NOVICE = "novice"


def skill_of(text: str) -> Skill:
    """Return the skill of that name.

    Raises:
        InputError: there is none.
    """
    if text not in list(Skill):
        raise InputError("skill", " or ".join(Skill), text)
    return Skill(text)


@dataclass(frozen=True, kw_only=True)
class Habits:
    """What makes a player an expert or a novice.

    Attributes:
        speed: of a tip on its way [m/s].
        lowering: of a tip that comes down or goes up at the tissue [m/s].
        pause: before each way, on average [s].
        miss: of the first aim at a mark, in each direction [m].
        miss_each: of the aim of each snip [m].
        waver: of a way to either side [m].
        force_error: of the force first pressed with and the height first raised to, relative.
        patience: until an aim, a force or a height is corrected [s].
        tremor: of the handle, root mean square [m].
        feels_every: distance of the places it feels when it looks for something [m].
        feels_again: whether it feels more closely around the best of them.
    """

    speed: float
    lowering: float
    pause: float
    miss: float
    miss_each: float
    waver: float
    force_error: float
    patience: float
    tremor: float
    feels_every: float
    feels_again: bool


HABITS = {
    Skill.EXPERT: Habits(
        speed=0.030,
        lowering=0.004,
        pause=0.15,
        miss=2e-4,
        miss_each=1e-4,
        waver=2e-4,
        force_error=0.05,
        patience=0.2,
        tremor=2e-5,
        feels_every=10e-3,
        feels_again=True,
    ),
    Skill.NOVICE: Habits(
        speed=0.014,
        lowering=0.006,
        pause=0.9,
        miss=3e-3,
        miss_each=3e-3,
        waver=4e-3,
        force_error=1.2,
        patience=1.0,
        tremor=6e-5,
        feels_every=11e-3,
        feels_again=False,
    ),
}


class Player(Protocol):
    """Whoever moves both hands in a task."""

    def poses(self, moment: Moment, progress: Progress, /) -> FloatArray:
        """Return both poses for the next tick, having seen the last; shape (2, POSE)."""
        ...


class ScriptedPlayer:
    """A scripted trainee.

    Args:
        instruments: left and right.
        skill: which habits.
        seed: of its chances, 0 or above.
        dt: length of a tick [s].
        ground: how high the tissue at rest lies at x, y [m], as it is seen.

    Raises:
        InputError: the seed is negative.
    """

    def __init__(
        self,
        instruments: tuple[Instrument, Instrument],
        skill: Skill,
        seed: int,
        *,
        dt: float,
        ground: Ground = level,
    ) -> None:
        if seed < 0:
            raise InputError("player: seed", "a whole number, 0 or above", seed)
        habits = HABITS[skill]
        self._habits = habits
        self._search: tuple[Find, Palpation] | None = None
        self._hands = tuple(
            _Hand(
                hand,
                instrument,
                habits,
                np.random.default_rng((seed, hand, list(Skill).index(skill))),
                f"{skill} {seed} {hand}",
                dt,
                ground,
            )
            for hand, instrument in enumerate(instruments)
        )

    def poses(self, moment: Moment, progress: Progress, /) -> FloatArray:
        """Return both poses for the next tick, having seen the last; shape (2, POSE)."""
        step = progress.step
        wanted = self._searched(step).wishes(moment) if isinstance(step, Find) else _wishes(step)
        return np.stack([hand.pose(moment, wanted.get(hand.number)) for hand in self._hands])

    def _searched(self, step: Find) -> Palpation:
        if self._search is None or self._search[0] is not step:
            habits = self._habits
            self._search = (
                step,
                Palpation(step, spacing=habits.feels_every, careful=habits.feels_again),
            )
        return self._search[1]


def _wishes(step: Step | None) -> dict[int, Wish]:
    if isinstance(step, Together):
        return _wishes(step.base) | _wishes(step.step)
    if isinstance(step, Press):
        return {step.hand: Wish(place=step.place, force=0.5 * (step.least + step.most), aim=step.place)}
    if isinstance(step, Follow):
        force = max(0.4 * step.most, 2 * step.least)
        return {step.hand: Wish(place=step.curve[step.to], force=force, aim=step.curve, slide=step.to > 0)}
    if isinstance(step, Lift):
        return {
            step.hand: Wish(
                place=step.place, force=0.5 * step.most, aim=step.place, height=1.15 * step.height
            )
        }
    if isinstance(step, Cut):
        force = _SNIPPED * step.most
        return {step.hand: Wish(place=step.ahead, force=force, aim=step.line, slide=True, snip=True)}
    assert step is None or isinstance(step, LetGo)
    return {}


class _Hand:
    """One hand of a player."""

    def __init__(
        self,
        number: int,
        instrument: Instrument,
        habits: Habits,
        rng: np.random.Generator,
        seed: str,
        dt: float,
        ground: Ground,
    ) -> None:
        self.number = number
        self._ground = ground
        self._instrument, self._habits, self._rng, self._dt = instrument, habits, rng, dt
        self._tip = np.array(instrument.reach_of(instrument.handle).tip)
        self._tremor = Tremor(seed, habits.tremor)
        self._jaw = 1.0
        self._aim: object = None
        self._miss = np.zeros(2)
        self._force_share = 1.0
        self._height_share = nan  # of the height that is right, once it raises
        self._since = 0.0
        self._way: _Way | None = None
        self._missed = False  # the jaw closed on nothing
        self._opening = False  # blades that have just cut

    def pose(self, moment: Moment, wish: Wish | None) -> FloatArray:
        time = moment.time
        if wish is None or self._missed or (self._aim is not None and wish.aim != self._aim):
            self._leave(moment)
            if self._height >= 0.9 * _ABOVE and self._jaw == 1.0 and not moment.touches(self.number):
                self._aim, self._missed = None, False
        if wish is not None and self._aim is None:
            self._begin(wish, time)
        if wish is not None and wish.aim == self._aim and not self._missed:
            self._do(moment, wish)
        pose = np.zeros(POSE)
        pose[PRESENT], pose[JAW] = 1.0, self._jaw
        pose[HANDLE : HANDLE + 3] = self._instrument.handle_for(tuple(self._tip)) + np.array(
            self._tremor.at(time)
        )
        return pose

    def _begin(self, wish: Wish, time: float) -> None:
        """Aim at a mark, more or less well."""
        habits = self._habits
        self._aim, self._since = wish.aim, time
        self._miss = habits.miss * self._rng.uniform(-1, 1, 2)
        self._force_share, self._height_share = self._share(), nan
        pause = habits.pause * self._rng.uniform(0.5, 1.5)
        x, y = np.array(wish.place) + self._miss
        target = np.array([x, y, self._ground(x, y) + _ABOVE])
        self._way = _Way(
            self._tip,
            target,
            time + pause,
            habits.speed,
            habits.waver * self._rng.uniform(-1, 1, 2),
            self._ground,
        )

    @property
    def _height(self) -> float:
        """How high the tip is over the tissue at rest [m]."""
        return float(self._tip[2]) - self._ground(self._tip[0], self._tip[1])

    def _share(self) -> float:
        """Return the share of the force or height that is right, which this hand tries at first."""
        return max(_LIGHTEST, 1 + self._habits.force_error * self._rng.uniform(-1, 1))

    def _do(self, moment: Moment, wish: Wish) -> None:
        if self._way is not None:
            self._tip = self._way.at(moment.time)
            if moment.time < self._way.end:
                return
            self._way = None
            self._since = moment.time
        patient = moment.time - self._since
        if patient > self._habits.patience:
            self._miss *= 1 - _LEARNING  # it sees where the mark is, and how hard it presses
            self._force_share = 1 + (1 - _LEARNING) * (self._force_share - 1)
            self._height_share = 1 + (1 - _LEARNING) * (self._height_share - 1)
        if wish.height is not None and (moment.holds(self.number) or self._jaw < 1.0):
            self._raise(moment, wish.height)
            return
        if wish.snip and self._jaw < 1.0:
            self._snip(moment.time)
            return
        left = self._across(wish)
        target = wish.force * self._force_share
        error = target - moment.force(self.number)
        fastest = self._habits.lowering
        self._tip[2] -= self._dt * float(np.clip(_GAIN * error, -fastest, fastest))
        ready = wish.height is not None or (wish.snip and left < _THERE)
        if ready and abs(error) < 0.3 * target:
            self._jaw = 1.0 - self._dt / _CLOSE

    def _snip(self, time: float) -> None:
        """Close the blades, open them, and aim anew."""
        self._jaw = min(1.0, max(0.0, self._jaw + (1 if self._opening else -1) * self._dt / _CLOSE))
        if self._jaw == 0.0:
            self._opening = True
        elif self._jaw == 1.0:
            self._opening = False
            self._since = time
            self._miss = self._habits.miss_each * self._rng.uniform(-1, 1, 2)
            self._force_share = self._share()

    def _across(self, wish: Wish) -> float:
        """Go on towards a place along the tissue; return how far it still is [m]."""
        away = np.array(wish.place) + self._miss - self._tip[:2]
        distance = float(np.hypot(*away))
        fastest = (0.11 if wish.slide else 0.15) * self._habits.speed * self._dt
        if distance > 0:
            self._tip[:2] += away * min(1.0, fastest / distance)
        return distance

    def _raise(self, moment: Moment, height: float) -> None:
        if self._jaw > 0.0:
            self._jaw = max(0.0, self._jaw - self._dt / _CLOSE)
            return
        if not moment.holds(self.number):
            self._missed = True
            return
        if isnan(self._height_share):
            self._height_share, self._since = self._share(), inf  # it looks when it is up
        low = height * self._height_share - self._tip[2]
        fastest = _RAISING * self._habits.lowering
        self._tip[2] += self._dt * float(np.clip(low / self._dt, -fastest, fastest))
        if isinf(self._since) and abs(low) <= fastest * self._dt:
            self._since = moment.time

    def _leave(self, moment: Moment) -> None:
        self._way = None
        self._jaw = min(1.0, self._jaw + self._dt / _CLOSE)
        if not moment.holds(self.number):
            highest = self._tip[2] - self._height + _ABOVE
            self._tip[2] = min(highest, self._tip[2] + self._habits.lowering * 4 * self._dt)


class _Way:
    """A minimum-jerk way that may waver to a side; over what is higher than both its ends it goes in an arch."""

    def __init__(
        self,
        start: FloatArray,
        end: FloatArray,
        begin: float,
        speed: float,
        waver: FloatArray,
        ground: Ground,
    ) -> None:
        self._start, self._end, self._begin = start.copy(), end, begin
        self._waver = np.array([*waver, 0.0])
        self._arch = np.array([0.0, 0.0, max(map(self._lacks, repeat(ground), _SHARES))])
        # A minimum-jerk way's highest speed is 15/8 of its mean.
        self._lasts = max(0.3, 15 / 8 * float(np.linalg.norm(end - start)) / speed)

    def _lacks(self, ground: Ground, share: float) -> float:
        """Return how much higher an arch must be to pass the ground at a share of the straight way [m]."""
        x, y, z = self._start + share * (self._end - self._start)
        return max(0.0, ground(x, y) + _CLEAR - float(z)) / (4 * share * (1 - share))

    @property
    def end(self) -> float:
        """When it is over [s]."""
        return self._begin + self._lasts

    def at(self, time: float) -> FloatArray:
        """Return the place at a time [m]."""
        share = min(max((time - self._begin) / self._lasts, 0.0), 1.0)
        gone = share**3 * (10 - 15 * share + 6 * share**2)
        aside: FloatArray = np.sin(2 * np.pi * gone) * self._waver
        over = 4 * gone * (1 - gone) * self._arch
        return self._start + gone * (self._end - self._start) + aside + over

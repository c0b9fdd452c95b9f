"""How a scripted trainee looks for something hidden: by pressing here and there, and feeling where less gives way.

One hand presses with the same light force on a grid of places and notes how deep it came. Where that was least the
other hand takes hold. It is told, as everybody is, when there is nothing; then it tries the next best place.
"""

from __future__ import annotations

from itertools import product
from math import dist

import numpy as np

from trocar.training.tasks.find import Find
from trocar.training.tasks.moment import Moment
from trocar.training.tasks.step import Place
from trocar.training.wish import Wish

_PRESSED = 0.6  # of the most force, to feel with
_STEADY = 0.1  # of that force: so near it, for so long [s], is a depth read
_FOR = 0.06
_THERE = 2e-3  # [m] from the place that was meant
_TAKE = 0.5  # of the most force, to take hold with
_RAISED = 1e-4  # [m] above the surface at rest, with tissue in the jaw
_DOUBT = 1.6  # times as long as it should last, until a hand believes that nothing is there
_WIDTH = 0.5  # of the spacing: one standard deviation of the bump that a careful hand believes in
_FINEST = 1e-3  # [m] between the places where it tries it
_CLOSER = 0.5  # of the spacing: where a careful hand feels again around the best place


class Palpation:
    """One search.

    Args:
        step: what is looked for.
        spacing: of the places felt [m].
        careful: whether it feels more closely around the best place, and goes by all that it felt.
    """

    def __init__(self, step: Find, *, spacing: float, careful: bool) -> None:
        self._step, self._spacing, self._careful = step, spacing, careful
        (x0, y0), (x1, y1) = step.within
        rows = [
            [float(x) for x in np.linspace(x0, x1, max(2, round((x1 - x0) / spacing) + 1))],
            [float(y) for y in np.linspace(y0, y1, max(2, round((y1 - y0) / spacing) + 1))],
        ]
        self._left = [(x, y) for x, y in product(*rows)]
        self._depths: dict[Place, float] = {}
        self._closer = not careful
        self._steady_since: float | None = None
        self._holding_since: float | None = None
        self._guess: Place | None = None

    def wishes(self, moment: Moment) -> dict[int, Wish]:
        """Return what either hand should do now."""
        feeling = 1 - self._step.hand
        if self._left:
            self._feel(moment, feeling)
        if not self._left and not self._closer:
            self._closer = True
            x, y = self._best
            step = _CLOSER * self._spacing
            self._left = [(x - step, y), (x, y - step), (x + step, y), (x, y + step)]
        if self._left:
            place = self._left[0]
            return {feeling: Wish(place=place, force=_PRESSED * self._step.most, aim=place)}
        return {self._step.hand: self._take(moment)}

    @property
    def _best(self) -> Place:
        return min(self._depths, key=self._depths.__getitem__)

    def _feel(self, moment: Moment, hand: int) -> None:
        """Note how deep the tip came, once its force is steady."""
        wanted = _PRESSED * self._step.most
        steady = (
            abs(moment.force(hand) - wanted) < _STEADY * wanted and moment.away(hand, self._left[0]) < _THERE
        )
        if not steady:
            self._steady_since = None
        elif self._steady_since is None:
            self._steady_since = moment.time
        elif moment.time - self._steady_since > _FOR:
            self._depths[self._left.pop(0)] = moment.depth(hand)
            self._steady_since = None

    def _take(self, moment: Moment) -> Wish:
        """Take hold where it seems to be; where nothing is, forget that place."""
        if self._guess is None:
            self._guess = self._middle() if self._careful else self._best
        if not moment.holds(self._step.hand):
            self._holding_since = None
        elif self._holding_since is None:
            self._holding_since = moment.time
        elif moment.time - self._holding_since > _DOUBT * self._step.lasting and len(self._depths) > 1:
            near = {place for place in self._depths if dist(place, self._guess) < 0.5 * self._spacing}
            for place in near or {self._best}:
                if len(self._depths) > 1:
                    del self._depths[place]
            self._guess, self._careful = self._best, False
            self._holding_since = None
        return Wish(place=self._guess, force=_TAKE * self._step.most, aim=self._guess, height=_RAISED)

    def _middle(self) -> Place:
        """Return where a bump as wide as half the spacing explains best how deep the tip came."""
        places, depths = np.array(list(self._depths)), np.array(list(self._depths.values()))
        (x0, y0), (x1, y1) = self._step.within
        tried = [(x, y) for x in np.arange(x0, x1, _FINEST) for y in np.arange(y0, y1, _FINEST)]
        misfits = []
        for at in tried:
            bump = np.exp(-((places - at) ** 2).sum(axis=1) / (2 * (_WIDTH * self._spacing) ** 2))
            table = np.stack([np.ones(len(bump)), -bump], axis=1)
            level, height = np.linalg.lstsq(table, depths)[0]
            misfits.append(float(((table @ (level, max(height, 0.0)) - depths) ** 2).sum()))
        x, y = tried[int(np.argmin(misfits))]
        return float(x), float(y)

"""Many random trajectories of two instruments on undamped tissue, and the energy contact made of nothing in them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from trocar.model import FloatArray
from trocar.study.contact.energy import energies_along, energy_forms
from trocar.study.contact.scenes import SIZE, Setting
from trocar.study.contact.trajectories import KINDS, random_poses

ROUNDING = 1e-8  # of what is stored: well above what rounding adds up to in a trajectory, some 1e-10


@dataclass(frozen=True, kw_only=True)
class Passivity:
    """What trajectories of one kind came to.

    Attributes:
        kind: of `KINDS`.
        trajectories: how many.
        stored: the most any of them stored [J].
        rise: the largest growth of stored energy minus work over what the trajectory stored at most [1].
        rising: share of them where that is more than `ROUNDING` [1].
        above: the most that stored energy minus work lay above zero, over the same [1].
        finite: whether no number was anything else.
    """

    kind: str
    trajectories: int
    stored: float
    rise: float
    rising: float
    above: float
    finite: bool


def passivity(
    settings: Sequence[Setting],
    trajectories: int,
    *,
    seed: int = 0,
    tell: Callable[[int], None] | None = None,
) -> list[Passivity]:
    """Play random trajectories, every kind and setting in turn.

    Args:
        settings: undamped.
        trajectories: how many in all.
        seed: of the first; each has its own.
        tell: called with the number of trajectories done.

    Returns:
        One for each kind.
    """
    forms = [energy_forms(one.model, one.scene) for one in settings]
    kinds = list(KINDS)
    found: dict[str, list[tuple[float, float, float, bool]]] = {kind: [] for kind in kinds}
    for i in range(trajectories):
        kind, which = kinds[i % len(kinds)], i // len(kinds) % len(settings)
        one = settings[which]
        poses = random_poses(kind, np.random.default_rng((seed, i)), one.instruments, SIZE)
        stored, work, finite = energies_along(one.scene, forms[which], poses)
        most = float(stored.max())
        excess = stored - work
        share = 1.0 / most if most > 0 else 0.0
        found[kind].append((most, share * rise(excess), share * float(excess.max()), finite))
        if tell is not None:
            tell(i + 1)
    return [
        Passivity(
            kind=kind,
            trajectories=len(rows),
            stored=max(row[0] for row in rows),
            rise=max(row[1] for row in rows),
            rising=float(np.mean([row[1] > ROUNDING for row in rows])),
            above=max(row[2] for row in rows),
            finite=all(row[3] for row in rows),
        )
        for kind, rows in found.items()
        if rows
    ]


def rise(excess: FloatArray) -> float:
    """Return the largest growth of a history from any moment to a later one; it begins at zero."""
    history = np.concatenate([[0.0], excess])
    return float((history - np.minimum.accumulate(history)).max())

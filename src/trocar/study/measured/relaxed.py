"""Relaxing beef foretold: a Prony series fitted to the holds of one session, judged on those of another.

Quasi-linear viscoelasticity (Y. C. Fung 1981, Biomechanics, sec. 7.6): the force is that of an elastic indentation,
convolved,

    F(t) = integral of G(t - s) d(c u(s)^p),    G(t) = 1 + sum over i of g_i exp(-t/tau_i),

with the measured indentation u(t), taken as linear between samples of c u^p, for which a branch advances without error
(R. L. Taylor, K. S. Pister, G. L. Goudreau 1970). The indenter is not known: each test has its own c, and one p serves
all. Weights are relative to the long-term modulus, as in a layer's `prony`; of a hold of ten seconds, "long" is
what lasts much longer than that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trocar.model import FloatArray
from trocar.study.measured.fit import positive_fit
from trocar.study.measured.relaxation import Hold
from trocar.tissues.layer import Prony

FITTED, JUDGED = "230407", "230411"
LONGEST = 8.5  # [s] after the peak, to which a hold is followed; shorter ones are left out
MOMENTS = (0.5, 1.0, 2.0, 5.0, 8.0)
"""After the peak [s]: where measured and foretold are tabled."""

_START = ((0.5, 0.3), (0.7, 1.5), (1.0, 8.0))
_TIMES = (0.05, 60.0)  # [s] between which relaxation times are sought: half a sample, six holds
_POWERS = (0.5, 6.0)


@dataclass(frozen=True, kw_only=True)
class ForetoldHolds:
    """The series and how it does.

    Args:
        prony: (g, tau [s]) of each term.
        power: p.
        fitted: root mean square error of force over peak in the fitted session, from the peak on [1].
        judged: the same in the other session.
        mean_curve: the same of the mean measured curve of the fitted session, without any model.
        spread: standard deviation between tests of the judged session of force over peak [1], shape (moments,).
        measured: mean of the judged session at `MOMENTS` [1], shape (moments,).
        foretold: likewise.
        counts: tests fitted and judged.
        since_peak: times for the curves [s], shape (n,).
        curves: of the judged session, force over peak, measured; shape (tests, n).
        foretold_curves: likewise.
    """

    prony: Prony
    power: float
    fitted: float
    judged: float
    mean_curve: float
    spread: FloatArray
    measured: FloatArray
    foretold: FloatArray
    counts: tuple[int, int]
    since_peak: FloatArray
    curves: FloatArray
    foretold_curves: FloatArray


def foretell_holds(holds: Sequence[Hold]) -> ForetoldHolds | None:
    """Fit one session and judge the other; None where one of them has none that lasts."""
    sessions = [
        [hold for hold in holds if hold.session == name and hold.time[-1] - hold.time[hold.peak] >= LONGEST]
        for name in (FITTED, JUDGED)
    ]
    if not all(sessions):
        return None
    since = np.arange(0.0, LONGEST + 0.05, 0.1)
    measured = [np.array([_since_peak(hold, hold.force, since) for hold in session]) for session in sessions]
    count = len(_START)

    def curves(session: Sequence[Hold], given: FloatArray) -> FloatArray:
        weights, times, power = given[:count], given[count : 2 * count], float(given[-1])
        found = zip(session, responses(session, weights, times, power), strict=True)
        return np.array([_since_peak(hold, force, since) for hold, force in found])

    start = [*(weight for weight, _ in _START), *(time for _, time in _START), 1.5]
    found = positive_fit(
        lambda given: curves(sessions[0], given).ravel(),
        measured[0].ravel(),
        start,
        floor=1.0,
        ranges=[*[_TIMES] * count, _POWERS],
    )
    foretold = [curves(session, found) for session in sessions]
    at = np.searchsorted(since, np.array(MOMENTS) - 1e-9)
    order = np.argsort(found[count : 2 * count])
    return ForetoldHolds(
        prony=tuple((float(found[i]), float(found[count + i])) for i in order),
        power=float(found[-1]),
        fitted=_off(foretold[0], measured[0]),
        judged=_off(foretold[1], measured[1]),
        mean_curve=_off(measured[0].mean(axis=0), measured[1]),
        spread=measured[1][:, at].std(axis=0),
        measured=measured[1][:, at].mean(axis=0),
        foretold=foretold[1][:, at].mean(axis=0),
        counts=(len(sessions[0]), len(sessions[1])),
        since_peak=since,
        curves=measured[1],
        foretold_curves=foretold[1],
    )


def responses(
    holds: Sequence[Hold], weights: FloatArray, times: FloatArray, power: float
) -> tuple[FloatArray, ...]:
    """Return the force over c of each hold at its times.

    Args:
        holds: whose indentation is followed.
        weights: g of each branch [1], shape (m,).
        times: tau of each [s], shape (m,).
        power: p.
    """
    longest = max(len(hold.time) for hold in holds)
    elastic, steps = np.zeros((longest, len(holds))), np.ones((longest - 1, len(holds)))
    for column, hold in enumerate(holds):
        rows = len(hold.time)
        elastic[:rows, column] = np.maximum(hold.indentation, 0.0) ** power
        elastic[rows:, column] = elastic[rows - 1, column]
        steps[: rows - 1, column] = np.diff(hold.time)
    x = steps[:, :, None] / times
    kept, gained = np.exp(-x), -np.expm1(-x) / x * np.diff(elastic, axis=0)[:, :, None]
    branches = np.repeat(elastic[0, :, None], len(times), axis=1)
    force = [elastic[0] + branches @ weights]
    for step in range(longest - 1):
        branches = kept[step] * branches + gained[step]
        force.append(elastic[step + 1] + branches @ weights)
    whole = np.array(force).T
    return tuple(whole[row, : len(hold.time)] for row, hold in enumerate(holds))


def _since_peak(hold: Hold, force: FloatArray, since: FloatArray) -> FloatArray:
    return np.asarray(np.interp(hold.time[hold.peak] + since, hold.time, force) / force[hold.peak])


def _off(foretold: FloatArray, measured: FloatArray) -> float:
    return float(np.sqrt(((foretold - measured) ** 2).mean()))

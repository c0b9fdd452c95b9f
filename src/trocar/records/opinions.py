"""What the answers say: the middle of each item, whether the items hang together, and whether two groups differ.

Each trainee counts once, with what was answered last: tests of two groups ask for answers that do not depend on each
other. Where too few answered, there is no number but how many would be needed.

Quartiles are Hyndman and Fan's second definition (1996, Am Stat 50:361): the inverse of the empirical distribution,
halfway where it is flat, so that half a step is the finest there is on a scale of whole ones.

Cronbach's alpha (1951, Psychometrika 16:297, equation 2), over those who answered every item:

    alpha = k/(k - 1) (1 - sum of V_i / V_t)

with k items, V_i the variance of an item and V_t that of the sums over items. It grows with the number of items and
says nothing about whether they ask for one thing.

Mann and Whitney's U (1947, Ann Math Stat 18:50) counts the pairs in which a of group A is above b of group B, ties
half. Its p is two-sided: exact over all ways to divide the given answers, ties included, where those are few,
otherwise from the normal approximation with the variance corrected for ties and a correction for continuity. Items are
tested one by one, and p is not corrected for their number.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import comb
from typing import Literal

import numpy as np
from scipy.stats import PermutationMethod, mannwhitneyu

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.records.questionnaire import GROUPS, ITEMS
from trocar.records.sheets import Sheet

FEWEST_FOR_QUARTILES = 4  # a quarter of fewer is nobody
FEWEST_FOR_ALPHA = 10  # our convention; with fewer its spread is as wide as the scale of alphas in use
FEWEST_PER_GROUP = 4  # of three against three, no outcome has a two-sided p below 0.1
MOST_DIVISIONS = 20_000  # of the answers into two groups that are all gone through


@dataclass(frozen=True, kw_only=True)
class Middle:
    """Where the answers of a group to an item lie; quartiles are None where too few answered."""

    item: str
    group: str
    n: int
    quartiles: tuple[float, float, float] | None

    @property
    def note(self) -> str:
        """Why there is no number, if there is none."""
        return _too_few(self.n, FEWEST_FOR_QUARTILES) if self.quartiles is None else ""

    def as_dict(self) -> dict[str, object]:
        """Return it as JSON takes it."""
        lower, median, upper = self.quartiles or (None, None, None)
        found = {"lower_quartile": lower, "median": median, "upper_quartile": upper}
        return {"item": self.item, "group": self.group, "n": self.n, **found, "note": self.note}


@dataclass(frozen=True, kw_only=True)
class Consistency:
    """Cronbach's alpha, None where too few answered every item or all have the same sum."""

    n: int
    alpha: float | None

    @property
    def note(self) -> str:
        """Why there is no number, if there is none."""
        if self.alpha is not None:
            return ""
        if self.n < FEWEST_FOR_ALPHA:
            return _too_few(self.n, FEWEST_FOR_ALPHA)
        return "everyone's answers have the same sum"

    def as_dict(self) -> dict[str, object]:
        """Return it as JSON takes it."""
        return {"n": self.n, "alpha": self.alpha, "note": self.note}


@dataclass(frozen=True, kw_only=True)
class Difference:
    """Two groups in one item; u and p are None where too few answered.

    Attributes:
        item: name.
        n_a: answers of the first group.
        n_b: answers of the second.
        u: Mann and Whitney's U of the first group.
        p: two-sided.
        exact: whether p is.
    """

    item: str
    n_a: int
    n_b: int
    u: float | None
    p: float | None
    exact: bool

    @property
    def chance(self) -> float | None:
        """That one of the first group agrees more than one of the second, ties half: U/(n_a n_b)."""
        return None if self.u is None else self.u / (self.n_a * self.n_b)

    @property
    def note(self) -> str:
        """Why there is no number, if there is none."""
        return _too_few(min(self.n_a, self.n_b), FEWEST_PER_GROUP) if self.u is None else ""

    def as_dict(self) -> dict[str, object]:
        """Return it as JSON takes it."""
        return {
            "item": self.item,
            "n_a": self.n_a,
            "n_b": self.n_b,
            "u": self.u,
            "chance": self.chance,
            "p": self.p,
            "exact": self.exact,
            "note": self.note,
        }


def last_sheets(sheets: Iterable[Sheet]) -> list[Sheet]:
    """Return what each trainee answered last."""
    latest: dict[str, Sheet] = {}
    for sheet in sorted(sheets, key=lambda one: one.answered):
        latest[sheet.trainee] = sheet
    return list(latest.values())


def middles(sheets: Iterable[Sheet]) -> list[Middle]:
    """Return where the answers lie, item by item, and group by group of those that answered."""
    latest = last_sheets(sheets)
    groups = [group for group in GROUPS if any(sheet.group == group for sheet in latest)]
    found = []
    for item in ITEMS:
        for group in groups:
            values = _values(latest, item, group)
            enough = len(values) >= FEWEST_FOR_QUARTILES
            found.append(
                Middle(item=item, group=group, n=len(values), quartiles=quartiles(values) if enough else None)
            )
    return found


def quartiles(values: Sequence[float]) -> tuple[float, float, float]:
    """Return lower quartile, median and upper quartile (Hyndman and Fan's second definition)."""
    lower, middle, upper = np.quantile(values, (0.25, 0.5, 0.75), method="averaged_inverted_cdf").tolist()
    return lower, middle, upper


def consistency(sheets: Iterable[Sheet]) -> Consistency:
    """Return Cronbach's alpha over those who answered every item."""
    complete = [
        [sheet.values[item] for item in ITEMS]
        for sheet in last_sheets(sheets)
        if sheet.values.keys() >= ITEMS.keys()
    ]
    alpha = None
    if len(complete) >= FEWEST_FOR_ALPHA:
        answers = np.asarray(complete, dtype=np.float64)
        alpha = cronbach_alpha(answers) if answers.sum(axis=1).var() > 0 else None
    return Consistency(n=len(complete), alpha=alpha)


def cronbach_alpha(answers: FloatArray) -> float:
    """Return Cronbach's alpha.

    Args:
        answers: of each person to each item, shape (n, k), n and k at least 2, not all persons with the same sum.

    Raises:
        InputError: alpha does not exist for them.
    """
    n, k = answers.shape
    total = float(answers.sum(axis=1).var(ddof=1)) if n > 1 else 0.0
    if k < 2 or total == 0:
        raise InputError(
            "alpha: answers", "two persons and items or more, and sums that differ", answers.shape
        )
    items = float(answers.var(axis=0, ddof=1).sum())
    return float(k / (k - 1) * (1 - items / total))


def differences(sheets: Iterable[Sheet], group_a: str, group_b: str) -> list[Difference]:
    """Return how two groups differ, item by item.

    Raises:
        InputError: there is no such group, or both are the same.
    """
    for group in (group_a, group_b):
        if group not in GROUPS:
            raise InputError("opinions: group", " or ".join(GROUPS), group)
    if group_a == group_b:
        raise InputError("opinions: groups", "two that differ", f"{group_a} twice")
    latest = last_sheets(sheets)
    return [
        _difference(item, _values(latest, item, group_a), _values(latest, item, group_b)) for item in ITEMS
    ]


def mann_whitney(a: Sequence[float], b: Sequence[float]) -> tuple[float, float, bool]:
    """Return U of the first sample, its two-sided p, and whether that is exact."""
    exact = comb(len(a) + len(b), len(a)) <= MOST_DIVISIONS
    if len({*a, *b}) == 1:  # all the same: every division has this U, and the normal approximation no spread
        return len(a) * len(b) / 2, 1.0, True
    method: PermutationMethod | Literal["asymptotic"] = (
        PermutationMethod(n_resamples=MOST_DIVISIONS) if exact else "asymptotic"
    )
    found = mannwhitneyu(
        np.asarray(a, dtype=np.float64),
        np.asarray(b, dtype=np.float64),
        alternative="two-sided",
        method=method,
    )
    return float(found.statistic), float(found.pvalue), exact


def _too_few(n: int, fewest: int) -> str:
    return f"too few answers: {n}, {fewest} are needed"


def _difference(item: str, a: Sequence[float], b: Sequence[float]) -> Difference:
    u, p, exact = None, None, False
    if min(len(a), len(b)) >= FEWEST_PER_GROUP:
        u, p, exact = mann_whitney(a, b)
    return Difference(item=item, n_a=len(a), n_b=len(b), u=u, p=p, exact=exact)


def _values(sheets: Iterable[Sheet], item: str, group: str) -> list[float]:
    return [float(sheet.values[item]) for sheet in sheets if sheet.group == group and item in sheet.values]

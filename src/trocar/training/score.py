"""A score after the pattern of FLS: what is left of the time allowed, less penalties, as a share of an expert's.

    score = 100 max(0, cutoff - time - penalties)/(cutoff - expert's time)

so that an expert without error has 100 in every task, whatever its length, and whoever reaches the cut-off has none.
FLS subtracts alike (Derossis et al. 1998, Am J Surg 175:482); its own weights are not public, so these are ours.
"""

from __future__ import annotations

from dataclasses import dataclass

from trocar.errors import InputError


@dataclass(frozen=True, kw_only=True)
class Marking:
    """How a task is marked.

    Attributes:
        cutoff: time at which nothing is left [s].
        expert_time: that of an expert without error [s].
        pass_score: least score that passes.
        per_error: penalty for each error [s].
        per_second_over_limit: penalty for each second with a force above the task's limit [s/s].
        per_metre_off: penalty for each metre that a cut lies beside its line, on average [s/m].
    """

    cutoff: float
    expert_time: float
    pass_score: float
    per_error: float = 10.0
    per_second_over_limit: float = 5.0
    per_metre_off: float = 0.0

    def __post_init__(self) -> None:
        if not 0 < self.expert_time < self.cutoff:
            raise InputError(
                "marking: expert_time", f"between 0 and the cut-off, {self.cutoff:g} s", self.expert_time
            )
        if not 0 < self.pass_score <= 100:
            raise InputError("marking: pass_score", "above 0, at most 100", self.pass_score)
        for name in ("per_error", "per_second_over_limit", "per_metre_off"):
            if not getattr(self, name) >= 0:
                raise InputError(f"marking: {name}", "at least 0", getattr(self, name))


def score(marking: Marking, *, time: float, errors: int, over_limit: float, off: float = 0.0) -> float:
    """Return the score, 0 to 100 for an expert's time and more for a quicker one.

    Args:
        marking: of the task.
        time: taken [s].
        errors: made.
        over_limit: time with a force above the limit [s].
        off: mean distance of a cut from its line [m].
    """
    penalties = marking.per_error * errors + marking.per_second_over_limit * over_limit
    penalties += marking.per_metre_off * off
    left = max(0.0, marking.cutoff - time - penalties)
    return 100 * left / (marking.cutoff - marking.expert_time)

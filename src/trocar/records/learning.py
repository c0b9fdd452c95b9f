"""A trainee's way through one task: every finished attempt, whether luck explains it, and what remains to be done.

A limit of the chart counts as crossed where it is reached, as in Wald's test (1945, Ann Math Stat 16:117), so that
with the usual rates two failures in a row are an alarm. Interrupted attempts do not count: nobody can say how they
would have ended.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from trocar.model import FloatArray
from trocar.records.rows import AttemptRow, stamp
from trocar.training.practice import Cusum, proficient

IN_A_ROW = 2  # passes one after the other that make a trainee proficient, as FLS asks for
_NUMBERS = ("no", "one", "two", "three", "four", "five", "six")


@dataclass(frozen=True, kw_only=True)
class History:
    """Finished attempts at one task and level, and what they say.

    Attributes:
        trainee: name.
        task: name.
        level: of it.
        rows: finished attempts, oldest first.
        cusum: what the chart is drawn for.
    """

    trainee: str
    task: str
    level: int
    rows: tuple[AttemptRow, ...]
    cusum: Cusum = field(default_factory=Cusum)

    @property
    def passed(self) -> tuple[bool, ...]:
        """Each attempt, in order."""
        return tuple(bool(row.passed) for row in self.rows)

    @property
    def chart(self) -> FloatArray:
        """CUSUM after each attempt, shape (n,); a failure is an attempt that was not passed."""
        return self.cusum.chart([not one for one in self.passed])

    @property
    def alarm_after(self) -> int | None:
        """How many attempts it took until the chart had risen by the alarm's height above its lowest point."""
        return self.cusum.alarm_after([not one for one in self.passed])

    @property
    def proof_after(self) -> int | None:
        """How many attempts it took until the chart had fallen by the proof's height below its highest point."""
        return self.cusum.proof_after([not one for one in self.passed])

    @property
    def proficient_after(self) -> int | None:
        """How many attempts it took until enough passes stood in a row."""
        return proficient(self.passed, in_a_row=IN_A_ROW)

    @property
    def remains(self) -> str:
        """What remains to be done, as a sentence without its full stop."""
        if self.proficient_after is not None:
            return f"nothing: proficient after attempt {self.proficient_after}"
        run = next((back for back, one in enumerate(reversed(self.passed)) if not one), len(self.passed))
        left = IN_A_ROW - run
        if run:
            return f"{_NUMBERS[left]} more pass{'' if left == 1 else 'es'} in a row"
        return f"{_NUMBERS[left]} passes in a row"

    def as_dict(self) -> dict[str, object]:
        """Return it as JSON takes it."""
        return {
            "trainee": self.trainee,
            "task": self.task,
            "level": self.level,
            "attempts": [
                {
                    "id": row.id,
                    "began": stamp(row.began),
                    "duration_s": row.duration,
                    "score": row.score,
                    "passed": row.passed,
                    "cusum": float(height),
                }
                for row, height in zip(self.rows, self.chart, strict=True)
            ],
            "cusum": {
                "acceptable_failure_rate": self.cusum.acceptable,
                "unacceptable_failure_rate": self.cusum.unacceptable,
                "alarm": self.cusum.alarm,
                "proof": self.cusum.proof,
                "alarm_after": self.alarm_after,
                "proof_after": self.proof_after,
            },
            "proficient_after": self.proficient_after,
            "remains": self.remains,
        }

"""Score cards as the trainer gives them, without an attempt."""

from math import nan

from trocar.training.metrics.measures import MEASURES
from trocar.training.session import Card
from trocar.training.tasks.progress import Mistake


def card(*, task="palpate", level=1, score=80.0, passed=True, completed=True, duration=25.5):
    metrics = {measure.name: 0.5 * number for number, measure in enumerate(MEASURES)}
    return Card(
        task=task,
        level=level,
        score=score,
        passed=passed,
        completed=completed,
        duration=duration,
        metrics=metrics | {"bimanual_dexterity": nan},
        mistakes=(Mistake(time=3.25, step=1, words="used too much force"),),
        advice=("Go straight.",),
    )


def attempt(records, name="Anna", **values):
    """Let somebody finish an attempt, and return its number."""
    made = card(**values)
    number = records.begin(
        records.trainee(name), task=made.task, level=made.level, device="web", header={"form": 1}, dt=1e-3
    )
    records.add(number, b"recorded", 25500)
    records.finish(number, made)
    return number

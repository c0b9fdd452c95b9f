"""Steps and progress on ticks made by hand: what is met, what is a mistake, and what is not."""

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.simulation import FORCE, RECORD, TIP, TOUCH, TOUCH_HOLDING, TOUCH_PRESENT, TOUCH_TOUCHING
from trocar.training.score import Marking
from trocar.training.session import ground_of
from trocar.training.tasks.catalogue import LEVELS, TASKS, task
from trocar.training.tasks.find import Find
from trocar.training.tasks.moment import Moment
from trocar.training.tasks.progress import TOO_MUCH, Progress
from trocar.training.tasks.step import Follow, LetGo, Lift, Press, Together
from trocar.training.tasks.task import Task

DT = 1e-3
PRESS = Press(hand=1, place=(0.03, 0.03), radius=3e-3, least=0.02, most=0.06, lasting=1.0)
OTHER = Press(hand=1, place=(0.05, 0.03), radius=3e-3, least=0.02, most=0.06, lasting=0.0)
BASE = Press(hand=0, place=(0.02, 0.03), radius=3e-3, least=0.01, most=0.07, lasting=1.0)
LINE = tuple((0.03 + 1e-3 * k, 0.03) for k in range(5))


def at(time, left=(0.0, 0.0, 0.05), right=(0.0, 0.0, 0.05), forces=(0.0, 0.0), holding=(False, False)):
    records = np.zeros((2, RECORD))
    for hand, (tip, force, held) in enumerate(zip((left, right), forces, holding, strict=True)):
        records[hand, TIP : TIP + 3] = tip
        records[hand, FORCE + 2] = force
        records[hand, TOUCH] = (
            TOUCH_PRESENT + (TOUCH_TOUCHING if force else 0) + (TOUCH_HOLDING if held else 0)
        )
    return Moment(time, records)


def of(*steps, limit=0.07):
    return Task(
        name="made",
        title="Made up",
        level=1,
        purpose="A test.",
        tissue="skin",
        ports="usual",
        steps=steps,
        force_limit=limit,
        marking=Marking(cutoff=60.0, expert_time=10.0, pass_score=75.0),
        pass_source="a test",
    )


def played(task, *parts):
    """Play parts of so many seconds, each with the arguments of `at`."""
    progress, tick = Progress(task), 0
    for seconds, given in parts:
        for _ in range(round(seconds / DT)):
            tick += 1
            progress.advance(at(tick * DT, **given))
    return progress


def test_a_press_must_last_without_a_break():
    there = {"right": (0.031, 0.03, -1e-3), "forces": (0.0, 0.04)}
    softer = there | {"forces": (0.0, 0.01)}
    assert played(of(PRESS), (1.05, there)).done
    broken = played(of(PRESS), (0.9, there), (0.3, softer), (0.9, there))
    assert not broken.done
    assert broken.mistakes == []
    assert broken.now == "Hold it so."


def test_a_lapse_shorter_than_a_tremor_breaks_nothing():
    there = {"right": (0.031, 0.03, -1e-3), "forces": (0.0, 0.04)}
    softer = there | {"forces": (0.0, 0.01)}
    assert played(of(PRESS), (0.6, there), (0.15, softer), (0.35, there)).done
    assert not played(of(PRESS), (0.6, there), (0.15, softer), (0.2, there)).done


@pytest.mark.parametrize(
    ("given", "hint"),
    [
        ({"right": (0.05, 0.03, 0.0)}, "Go to the mark."),
        ({"right": (0.03, 0.03, 0.0)}, "Down, until it touches."),
        ({"right": (0.03, 0.03, 0.0), "forces": (0.0, 0.01)}, "A little harder."),
        ({"right": (0.03, 0.03, 0.0), "forces": (0.0, 0.065)}, "Softer."),
    ],
)
def test_hints(given, hint):
    assert played(of(PRESS), (0.01, given)).now == hint


def test_too_much_force_counts_once_while_it_lasts():
    hard = {"right": (0.03, 0.03, 0.0), "forces": (0.0, 0.09)}
    soft = hard | {"forces": (0.0, 0.01)}
    found = played(of(PRESS), (0.3, hard), (0.2, soft), (0.3, hard), (0.8, soft), (0.3, hard))
    assert [one.words for one in found.mistakes] == [TOO_MUCH, TOO_MUCH]  # a break of 0.2 s is none


def test_pressing_beside_the_mark_is_a_mistake_but_not_where_the_last_step_was():
    beside = {"right": (0.04, 0.03, 0.0), "forces": (0.0, 0.04)}
    assert [one.words for one in played(of(PRESS), (0.01, {}), (0.5, beside)).mistakes] == [
        "pressed beside the mark"
    ]
    there = {"right": (0.03, 0.03, 0.0), "forces": (0.0, 0.04)}
    still = played(of(PRESS, OTHER), (3.0, there))
    assert still.number == 1
    assert still.mistakes == []


def test_a_line_is_followed_point_by_point():
    task = of(*(Follow(hand=1, curve=LINE, to=k, width=1e-3, least=0.004, most=0.05) for k in range(5)))
    parts = [(0.05, {"right": (*place, 0.0), "forces": (0.0, 0.02)}) for place in LINE]
    assert played(task, *parts).done
    lifted = played(task, *parts[:2], (0.3, {"right": (*LINE[1], 1e-3)}), *parts[2:])
    assert [one.words for one in lifted.mistakes] == ["lifted off the line"]
    hard = played(task, *parts[:2], (0.3, {"right": (*LINE[1], 0.0), "forces": (0.0, 0.06)}), *parts[2:])
    assert [one.words for one in hard.mistakes] == ["pressed too hard on the line"]
    left = played(task, *parts[:2], (0.3, {"right": (0.031, 0.034, 0.0), "forces": (0.0, 0.02)}))
    assert [one.words for one in left.mistakes] == ["left the line"]
    bounced = played(task, *parts[:2], (0.15, {"right": (*LINE[1], 1e-3)}), *parts[2:])
    assert bounced.mistakes == []


def test_both_hands_are_needed_together():
    task = of(Together(base=BASE, step=PRESS))
    both = {"left": (0.02, 0.03, 0.0), "right": (0.03, 0.03, 0.0), "forces": (0.03, 0.04)}
    assert played(task, (1.05, both)).done
    alone = both | {"forces": (0.0, 0.04)}
    found = played(task, (0.01, {}), (2.0, alone))
    assert not found.done
    assert [one.words for one in found.mistakes] == ["worked on tissue that was not held down"]
    assert found.now == "Left: Down, until it touches."


def test_tissue_is_lifted_by_a_jaw_that_holds_it():
    task = of(
        Lift(hand=0, place=(0.02, 0.03), radius=3e-3, height=4e-4, most=0.07, lasting=1.0), LetGo(hand=0)
    )
    up = {"left": (0.02, 0.03, 5e-4), "forces": (0.02, 0.0)}
    assert played(task, (2.0, up)).number == 0
    held = up | {"holding": (True, False)}
    assert played(task, (1.05, held)).number == 1
    assert played(task, (1.05, held | {"left": (0.03, 0.03, 5e-4)})).number == 0  # not there
    assert played(task, (1.05, held), (0.01, {})).done


def test_what_is_hidden_is_held_where_it_lies_and_nowhere_else():
    find = Find(
        hand=0, place=(0.02, 0.03), radius=4e-3, within=((0.01, 0.01), (0.05, 0.05)), most=0.05, lasting=1.0
    )
    over, beside = (0.021, 0.03, 0.0), (0.04, 0.03, 0.0)
    assert not find.met(at(1.0, left=over, forces=(0.02, 0.0)))  # touched, not held
    held = at(1.0, left=over, forces=(0.02, 0.0), holding=(True, False))
    assert find.met(held)
    assert (find.hint(held), find.mistake(held)) == ("Hold it so.", "")
    hard = at(1.0, left=over, forces=(0.06, 0.0), holding=(True, False))
    assert not find.met(hard)
    assert find.hint(hard) == "Softer."
    wrong = at(1.0, left=beside, forces=(0.02, 0.0), holding=(True, False))
    assert not find.met(wrong)
    assert find.hint(wrong).startswith("Nothing is here.")
    assert find.mistake(wrong) == "took hold where nothing is"
    assert find.mistake(at(1.0, left=beside, forces=(0.02, 0.0))) == ""
    assert [mark.hidden for mark in find.marks] == [True]


@pytest.mark.parametrize("name", list(TASKS))
@pytest.mark.parametrize("level", LEVELS)
def test_every_task_is_possible(name, level):
    found = task(name, level)
    assert (found.name, found.level) == (name, level)
    assert 0 < found.ideal_length < 0.5
    for step in found.steps:
        assert step.words.endswith(".")
        for mark in step.marks:
            assert all(0.005 < each < side - 0.005 for each, side in zip(mark.place, found.size, strict=True))
            height = ground_of(found)(*mark.place)
            found.instruments[mark.hand].handle_for((*mark.place, height))  # in reach


@pytest.mark.parametrize(
    ("arguments", "words"),
    [(("palpat",), "did you mean palpate"), (("lift", 4), "level"), (("lift", 0), "level")],
)
def test_what_there_is_not_is_refused(arguments, words):
    with pytest.raises(InputError, match=words):
        task(*arguments)


def test_a_task_without_steps_is_refused():
    with pytest.raises(InputError, match="steps"):
        of()

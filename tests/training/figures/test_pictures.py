"""Each picture is one SVG that the page may show, says its key figures in words, and stands any attempt."""

import re
from concurrent.futures import ThreadPoolExecutor
from xml.etree import ElementTree

import matplotlib as mpl
import numpy as np
import pytest

from trocar.errors import InputError
from trocar.simulation import DIRECTION, FORCE, RECORD, TIP, TOUCH, TOUCH_PRESENT, TOUCH_TOUCHING
from trocar.training.figures.cusum import cusum
from trocar.training.figures.forces import forces
from trocar.training.figures.learning_curve import learning_curve
from trocar.training.figures.page import LIMIT, SCORE, thinned
from trocar.training.figures.paths import paths
from trocar.training.figures.stages import stage_steps, stages_of
from trocar.training.figures.time_spent import spent, time_spent
from trocar.training.metrics.attempt import Attempt
from trocar.training.tasks.catalogue import TASKS, task
from trocar.training.tasks.moment import Moment
from trocar.training.tasks.progress import Mistake, Progress

OF_ATTEMPTS = (forces, paths, time_spent)
SVG = "{http://www.w3.org/2000/svg}"


def pressed(name="palpate", seconds=30.0, steps=99, force=0.04, hands=(0, 1)):
    """Somebody who is at each step's mark at once, and presses after a second, until so many steps are done."""
    tried, progress = task(name), None
    progress = Progress(tried)
    records, times = [], []
    since = 0.0
    while len(times) < seconds * 100 and not progress.done and progress.number < steps:
        time = (len(times) + 1) * 1e-2
        now = np.zeros((2, RECORD))
        for hand in hands:
            now[hand, TOUCH] = TOUCH_PRESENT
            now[hand, DIRECTION + 2] = -1.0
            now[hand, TIP : TIP + 3] = (0.02 + 0.02 * hand, 0.03, 4e-3)
        for mark in progress.step.marks[:2]:
            if mark.hand in hands:
                now[mark.hand, TIP : TIP + 2] = mark.place
                if time - since > 1.0:
                    now[mark.hand, TIP + 2], now[mark.hand, FORCE + 2] = -5e-4, force
                    now[mark.hand, TOUCH] += TOUCH_TOUCHING
        number = progress.number
        progress.advance(Moment(time, now))
        since = time if progress.number != number else since
        records.append(now)
        times.append(time)
    return Attempt(times=np.array(times), records=np.stack(records), force_limit=tried.force_limit), progress


def described(svg):
    root = ElementTree.fromstring(svg)
    return root.find(f"{SVG}title").text, root.find(f"{SVG}desc").text


def in_colour(svg, colour):
    """Return how many marks have a colour."""
    return sum(
        use.get("stroke", use.get("fill")) == colour or use.get("fill") == colour
        for use in ElementTree.fromstring(svg).iter(f"{SVG}use")
    )


def pictures():
    attempt, progress = pressed()
    for draw in OF_ATTEMPTS:
        yield draw.__name__, draw(attempt, progress, pressed(seconds=20))
    yield "learning_curve", learning_curve([50.0, 80.0, 90.0], [False, True, True], pass_score=75)
    yield "cusum", cusum([True, False, False])


@pytest.fixture(scope="module")
def drawn():
    return dict(pictures())


def test_the_page_lets_it_in_and_everybody_can_read_it(drawn):
    for name, svg in drawn.items():
        root = ElementTree.fromstring(svg)
        assert root.get("role") == "img", name
        assert not re.search(r"\sstyle=|<style|<script|<metadata|<!DOCTYPE|@import", svg), name
        title, words = described(svg)
        assert title
        assert words.endswith(".")
        ids = [each.get("id") for each in root.iter() if each.get("id")]
        assert len(ids) == len(set(ids))
        prefix = name.replace("_", "-")
        assert all(each.startswith(f"{prefix}-") for each in ids)
        assert set(root.get("aria-labelledby").split()) <= set(ids)
        used = re.findall(r'href="#([^"]+)"|url\(#([^)]+)\)', svg)
        assert {one or other for one, other in used} <= set(ids)
        assert root.get("width") == "720"
        assert "#ffffff" not in svg, name  # transparent


def test_it_is_the_same_again_from_any_thread_and_leaves_no_setting_behind(drawn):
    before = dict(mpl.rcParams)
    with ThreadPoolExecutor(3) as threads:
        again = [threads.submit(lambda: dict(pictures())) for _ in range(3)]
        assert all(each.result() == drawn for each in again)
    assert dict(mpl.rcParams) == before


@pytest.mark.parametrize("name", list(TASKS))
@pytest.mark.parametrize("draw", OF_ATTEMPTS)
def test_every_task_can_be_drawn_from_its_first_tick_on(draw, name):
    for seconds in (0.01, 0.03, 5.0):
        attempt, progress = pressed(name, seconds)
        assert described(draw(attempt, progress))[1]
    ElementTree.fromstring(draw(attempt, progress, pressed(name, 0.02)))


@pytest.mark.parametrize("draw", OF_ATTEMPTS)
def test_one_hand_alone_and_a_force_beyond_all_limits_can_be_drawn(draw):
    ElementTree.fromstring(draw(*pressed("trace", hands=(1,), seconds=3)))
    ElementTree.fromstring(draw(*pressed(hands=(0,), force=5.0, seconds=3)))


def test_forces_say_the_peaks_and_mark_each_mistake():
    attempt, progress = pressed(force=0.05)
    words = described(forces(attempt, progress))[1]
    assert (
        "0.05 N with the left hand and 0.05 N with the right hand; the limit is 0.07 N. 0 mistakes." in words
    )
    kinds = ("used too much force", "pressed beside the mark")
    progress.mistakes = [Mistake(time=0.7 * n, step=0, words=kinds[n % 2]) for n in range(20)]
    svg = forces(attempt, progress)
    assert "20 mistakes" in described(svg)[1]
    assert in_colour(svg, LIMIT) == 20


def test_a_hand_that_no_step_asks_for_and_that_touches_nothing_has_no_panel():
    one, two = (forces(*pressed(name, 3.0)) for name in ("trace", "palpate"))
    assert "axes_2" not in one
    assert "axes_2" in two


def test_paths_say_how_far_each_tip_went():
    attempt, progress = pressed()
    far = {name: 1e3 * tip.length() for name, tip in attempt.tips.items()}
    words = described(paths(attempt, progress))[1]
    assert (
        words
        == f"Seen from above, the left tip went {far['left']:.0f} mm and the right tip went {far['right']:.0f} mm."
    )


def test_stages_are_steps_but_one_line_is_one():
    assert stage_steps(task("palpate")) == [range(n, n + 1) for n in range(6)]
    assert stage_steps(task("trace")) == [range(241)]
    attempt, progress = pressed(steps=3, seconds=30)
    stages = stages_of(attempt, progress)
    assert [stage.done for stage in stages[:3]] == [True, True, True]
    assert [stage.end for stage in stages[:3]] == progress.ended
    assert stages[0].words == "right: press"


def bands(step):
    return [step.band(hand) for hand in (0, 1)]


def test_what_a_step_asks_of_each_hand():
    palpate, bimanual, lift = task("palpate"), task("bimanual-hold"), task("lift")
    assert bands(palpate.steps[0]) == [None, (0.015, 0.065)]
    assert bands(bimanual.steps[1]) == [(0.0075, 0.07), (0.015, 0.065)]
    assert bands(lift.steps[0]) == [(0.0, 0.065), None]
    assert bands(lift.steps[1]) == [None, None]


@pytest.mark.parametrize("name", ["palpate", "bimanual-hold", "trace"])
def test_times_of_all_kinds_add_up_to_the_attempt(name):
    attempt, progress = pressed(name)
    found = spent(attempt, progress)
    total = sum(each.total(kind) for each in found for kind in range(3))
    assert total == pytest.approx(attempt.times[-1])
    for each in found:
        assert each.runs[0][1] == each.stage.begin
        assert each.runs[-1][2] == each.stage.end


def test_a_second_on_the_way_and_two_as_asked():
    attempt, progress = pressed("palpate")
    first = spent(attempt, progress)[0]
    # To the ten ticks, of 10 ms here, in which kinds are told apart.
    assert first.total(0) == pytest.approx(1.0, abs=0.11)
    assert first.total(1) == 0.0
    assert first.total(2) == pytest.approx(2.0, abs=0.11)
    soft, _ = spent(*pressed("palpate", seconds=4.0, force=0.01)), None
    assert soft[0].total(1) == pytest.approx(3.0, abs=0.11)


def test_thinning_keeps_peaks_and_ends():
    times = np.arange(60_000) * 1e-3
    values = np.sin(times)
    values[[12_345, 40_001]] = 9.0, -9.0
    at, kept = thinned(times, values)
    assert len(at) < 2000
    assert {9.0, -9.0} <= set(kept.tolist())
    assert (at[0], at[-1]) == (times[0], times[-1])
    assert (np.diff(at) > 0).all()
    assert thinned(times[:100], values[:100])[0] is not None
    assert len(thinned(times[:100], values[:100])[0]) == 100


def test_the_learning_curve_tells_passes_and_when_proficient():
    svg = learning_curve([40.0, 80.0, 60.0, 90.0, 85.0], [False, True, False, True, True], pass_score=75)
    assert described(svg)[1] == (
        "5 attempts, 3 passed; the first scored 40, the last 85, the best 90, the pass mark is 75. "
        "Proficient with attempt 5."
    )
    assert in_colour(svg, LIMIT) == 2 + 1  # and the legend's
    assert in_colour(svg, SCORE) == 3 + 1
    assert "Not proficient yet" in described(learning_curve([80.0], [True], pass_score=75))[1]
    assert described(learning_curve([], [], pass_score=75))[1] == "No attempt yet."
    with pytest.raises(InputError, match="one for each score"):
        learning_curve([1.0], [], pass_score=75)


def test_cusum_tells_alarm_and_proof():
    assert "20 showed that 5% at most" in described(cusum([False] * 30))[1]
    assert "neither limit" in described(cusum([False] * 19))[1]
    # 1.816 up is reached by two failures, 2 ln 3 = ln 9, whatever the rounding.
    assert "attempt 2 raised the alarm" in described(cusum([True, True]))[1]
    assert "attempt 12 raised the alarm" in described(cusum([False] * 10 + [True, True]))[1]
    assert "neither" in described(cusum([True]))[1]
    assert described(cusum([]))[1] == "No attempt yet."


@pytest.mark.parametrize("count", [0, 1, 100])
def test_practice_of_any_length_can_be_drawn(count):
    passed = [n % 3 > 0 for n in range(count)]
    ElementTree.fromstring(learning_curve([60.0 + n % 50 for n in range(count)], passed, pass_score=75))
    ElementTree.fromstring(cusum([not one for one in passed]))

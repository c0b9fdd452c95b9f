"""What the page says where something is in the way: another's attempt, a wait, a name, a trainer that is gone."""

from __future__ import annotations

import re

import pytest

from browser.open_page import MODULES, axe_is_content
from browser.trainee import PATIENCE, Trainee
from live_process import training, watching

pytestmark = pytest.mark.alone  # attempts are timed
SAYS = """  // keeps every text that the panel ever showed
  window.said = [];
  new MutationObserver(() => {
    const text = document.getElementById("task")?.innerText ?? "";
    if (text !== window.said.at(-1)) window.said.push(text);
  }).observe(document, {childList: true, subtree: true, characterData: true});
"""


@pytest.fixture(scope="module")
def address():
    with training() as (_, address):
        yield address


@pytest.fixture
def opened(browser):
    """Yield a way to open a page as somebody in a browser of their own."""
    contexts = []

    def enter(address, watcher, script="", size=(900, 560)):
        context = browser.new_context(viewport={"width": size[0], "height": size[1]})
        contexts.append(context)
        page = context.new_page()
        page.add_init_script((MODULES / "axe-core" / "axe.min.js").read_text(encoding="utf-8"))
        if script:
            page.add_init_script(script)
        page.goto(address)
        page.select_option("#sharpness", "fast")
        return Trainee(page, watcher)

    yield enter
    for context in contexts:
        context.close()


@pytest.fixture
def watcher(address):
    with watching(address) as watcher:
        yield watcher


def panel(trainee):
    return trainee.page.inner_text("#task")


def keeper(held):
    def keep(route):  # playwright takes no bound method of a list
        held.append(route)

    return keep


def is_over(watcher):
    return watcher.guiding["state"] in {"finished", "interrupted"}


def test_another_page_looks_on_keeps_its_choice_and_ends_nothing_by_one_click(opened, address, watcher):
    ada, bob = opened(address, watcher), opened(address, watcher)
    bob.choose("lift", who="Bob")
    ada.choose("alternate", who="Ada")
    number = ada.begin()
    ada.until(lambda: "Ada's attempt" in panel(ada), "her page says whose attempt it is")
    bob.until(lambda: "Ada is at it, on another page." in panel(bob), "his page says who is at it")
    bob.until(lambda: bob.button("End Ada's attempt").count() == 1, "it may be ended")
    assert bob.button("End the attempt").count() == bob.button("Begin").count() == 0
    axe_is_content(bob.page)

    bob.button("End Ada's attempt").dblclick()  # a careless hand
    assert "Ada's attempt would end as it stands" in panel(bob)
    bob.button("Let it go on").click()
    assert watcher.guiding["attempt"] == number
    assert watcher.guiding["state"] == "running"

    bob.button("End Ada's attempt").click()
    bob.button("End it").click()
    bob.until(lambda: is_over(watcher), "it ends")
    bob.until(lambda: bob.button("Begin").count() == 1, "his page offers again what he chose")
    assert re.match(r"Take hold and lift, level 1\s+Bob\. ", panel(bob))
    assert not bob.page.locator("#card").is_visible()
    # On a busy machine a word of the servo's may stand before it for a moment.
    bob.until(lambda: "Ada's attempt is over." in bob.page.inner_text("#notice"), "he is told")
    assert ada.button("End the attempt").count() == 0
    number = bob.begin()
    row = bob.page.request.get(f"{bob.page.url}api/attempts/{number}").json()
    assert (row["trainee"], row["task"]) == ("Bob", "lift")
    bob.button("End the attempt").click()
    bob.until(lambda: is_over(watcher), "it ends")


def test_a_page_that_is_loaded_again_says_nothing_before_it_knows_and_takes_its_attempt_up(
    opened, address, watcher
):
    ada = opened(address, watcher, SAYS)
    ada.until(lambda: any("Free practice" in said for said in ada.page.evaluate("said")), "nothing is on")
    ada.choose("trace")
    ada.begin()
    ada.page.reload()
    ada.until(lambda: ada.button("End the attempt").count() == 1, "it is taken up as hers")
    said = ada.page.evaluate("said")
    assert said
    assert not [each for each in said if "Free practice" in each or "recorded" in each]
    ada.page.locator("#sharpness").dblclick()
    ada.page.get_by_role("heading", name="Task").dblclick()
    assert ada.page.evaluate("getSelection().toString()") == ""
    ada.button("End the attempt").click()
    ada.until(lambda: ada.button("End the attempt").count() == 0, "there is nothing left to end")
    ada.until(lambda: is_over(watcher), "it ends")


def test_a_film_that_takes_its_time_is_waited_for_in_words_that_stay(opened, address, watcher):
    ada = opened(address, watcher)
    ada.choose("palpate")
    held = []
    ada.page.route("**/film", keeper(held))
    ada.button("Watch the expert").click()
    ada.until(lambda: held, "the film is asked for")
    assert "a minute or more" in panel(ada)
    assert ada.page.get_by_role("progressbar").is_visible()
    assert ada.page.locator("#task button:enabled").count() == 0
    ada.until(lambda: "2 s so far" in panel(ada), "it is seen to go on")
    assert "is being filmed" in ada.page.inner_text("#told-now")
    axe_is_content(ada.page)
    held[0].continue_()
    ada.page.wait_for_selector("#film:not([hidden])", timeout=1e3 * PATIENCE)
    assert "a minute or more" not in panel(ada)
    assert ada.page.inner_text("#told-now") == ""
    assert ada.page.locator("#task button:disabled").count() == 0


def test_a_picture_that_is_not_there_yet_has_its_place_and_says_so(opened, address, watcher):
    ada = opened(address, watcher, size=(420, 800))
    ada.choose("palpate")
    held = []
    ada.page.route("**/figures/*.svg", keeper(held))
    ada.begin()
    ada.until(lambda: any(each.touch for each in watcher.look().instruments), "both hands are there")
    ada.button("End the attempt").click()
    ada.card()
    ada.until(lambda: len(held) == 3, "the pictures are asked for")
    assert ada.page.locator("#card figure").all_inner_texts() == ["This picture is being drawn."] * 3
    places = [each.bounding_box() for each in ada.page.locator("#card figure").all()]
    before = [place["height"] for place in places]
    assert min(before) > 150
    axe_is_content(ada.page)
    for route in held[:2]:
        route.continue_()
    held[2].abort()
    ada.until(
        lambda: (
            ada.page.locator("#card figure").all_inner_texts() == ["", "", "This picture could not be drawn."]
        ),
        "two are there, and one cannot be",
    )
    first = ada.page.locator("#card figure").first
    assert first.bounding_box()["height"] == pytest.approx(before[0], rel=0.02)
    assert first.locator("img").bounding_box()["width"] > 500  # its words can be read; it scrolls
    assert ada.page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
    assert "mistakes" in ada.page.locator("#card .metrics").first.inner_text()
    ada.closes("#card")


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("   ", "Write your name"),
        ("A\u200bda", "nobody can see"),
        ("A\u202eda", "nobody can see"),
        ("Scripted expert", "A program"),
    ],
)
def test_a_name_that_cannot_be_is_refused_when_it_is_given(opened, address, watcher, name, words):
    ada = opened(address, watcher)
    ada.choose("palpate", who=name)
    assert ada.page.locator("#choose").is_visible()
    assert words in ada.page.inner_text("#choose-trouble")
    assert ada.page.evaluate("localStorage.length") == 0
    axe_is_content(ada.page)
    ada.page.fill("#trainee", "Ada")
    assert ada.page.inner_text("#choose-trouble") == ""
    ada.page.get_by_role("button", name="Go on").click()
    assert "Ada. " in panel(ada)


@pytest.mark.parametrize("size", [(900, 560), (420, 800)])
def test_a_long_name_stays_in_its_place(opened, address, watcher, size):
    ada = opened(address, watcher, size=size)
    ada.choose("palpate", who="x" * 80)
    assert "x" * 80 in panel(ada)
    assert ada.page.locator("aside").evaluate("each => each.scrollWidth - each.clientWidth") <= 0
    assert ada.page.locator("#task").evaluate("each => each.scrollWidth - each.clientWidth") <= 0
    ada.button("History").click()
    ada.page.wait_for_selector("#history[open]")
    assert ada.page.locator("#history").evaluate("each => each.scrollWidth - each.clientWidth") <= 0


def test_a_trainer_that_is_gone_is_told_of_in_one_sentence_that_stays(opened):
    with training() as (process, address), watching(address) as watcher:
        ada = opened(address, watcher)
        ada.choose("palpate")
        ada.begin()
        ada.until(lambda: ada.page.inner_text("#told-now") != "", "a hint is shown")
        process.kill()
        ada.until(lambda: "does not answer" in ada.page.inner_text("#notice"), "it is told")
        gone = ada.page.inner_text("#notice")
        assert "start it again with trocar train and open the address that it prints" in gone
        for _ in range(40):  # two tries to come again, at least
            ada.page.wait_for_timeout(100)
            assert ada.page.inner_text("#notice") == gone
        assert "The attempt does not go on." in panel(ada)
        assert "kept, as interrupted" in panel(ada)
        assert ada.page.locator("#task button").count() == 0
        assert ada.page.inner_text("#told-now") == ""
        assert "asked" not in ada.page.inner_text("#bars")
        axe_is_content(ada.page)

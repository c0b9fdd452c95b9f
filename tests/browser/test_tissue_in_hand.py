"""Tissue that is dragged, gripped and lifted, and instruments that the trainer's own device moves."""

from __future__ import annotations

import numpy as np

from browser.open_page import MODULES, axe_is_content, disc, open_page
from browser.synthetic_trainer import Hand, SyntheticTrainer, hello

LEFT, RIGHT = (0.018, 0.028, 0.006), (0.042, 0.030, 0.006)  # tips at rest [m]
MIDDLE = (0.03, 0.03)  # of the block, and of the picture [m]
AWAY = Hand((0.0, 0.0, 0.05), present=False)
SEEN = 12.0  # a change of grey anyone would see, of 255


class Script:
    """Hold both instruments where the test says."""

    def __init__(self, left: Hand = AWAY, right: Hand = AWAY) -> None:
        self.hands = (left, right)

    def __call__(self, now: float) -> tuple[Hand, Hand]:
        return self.hands


def steered(script: Script) -> SyntheticTrainer:
    return SyntheticTrainer(greeting=hello(steered_by="trainer"), script=script)


def test_instruments_the_trainer_moves_are_drawn_from_frames_and_the_page_sends_no_pose(browser):
    script = Script()
    with open_page(browser, steered(script)) as opened:
        page, trainer = opened.page, opened.trainer
        empty = opened.picture()
        script.hands = (Hand(LEFT), Hand((*MIDDLE, 0.004)))
        there = opened.picture()
        assert np.abs(there - empty)[disc(empty, 0.2)].max() > 3 * SEEN  # its tip came into the middle
        script.hands = (Hand(LEFT), Hand((0.05, 0.05, 0.02)))
        assert np.abs(opened.picture() - there)[disc(empty, 0.2)].max() > 3 * SEEN  # and left it
        page.keyboard.press("Space")
        page.keyboard.down("ArrowLeft")
        box = page.locator("#picture").bounding_box()
        page.mouse.move(box["x"] + 200, box["y"] + 200)
        page.mouse.move(box["x"] + 260, box["y"] + 200)
        page.mouse.down()
        opened.drawn()
        page.mouse.up()
        page.keyboard.up("ArrowLeft")
        assert trainer.poses == {}
        page.keyboard.press("Tab")  # no hand to take: Tab goes on through the page
        assert page.evaluate("document.activeElement.name") == "scope"


def test_the_page_says_that_the_trainer_steers_and_what_still_works(browser):
    axe = (MODULES / "axe-core" / "axe.min.js").read_text(encoding="utf-8")
    with open_page(browser, steered(Script(Hand(LEFT), Hand(RIGHT))), script=axe) as opened:
        page = opened.page
        assert page.inner_text("#active") == "moved by the trainer"
        assert "The trainer's own device moves the instruments." in page.inner_text("aside")
        assert "endoscope" in page.locator("#picture").get_attribute("aria-label")
        axe_is_content(page)
        before = opened.picture()
        page.locator("#picture").focus()
        page.keyboard.down("l")
        opened.until(lambda: np.abs(opened.picture() - before).mean() > 3, "the endoscope still pans")
        page.keyboard.up("l")
        page.keyboard.press("h")
        help_page = page.get_by_role("dialog", name="Keys and help")
        assert "now without effect" in help_page.inner_text()
        assert [table.locator("caption").inner_text() for table in help_page.get_by_role("table").all()] == [
            "Keyboard, endoscope"
        ]
        axe_is_content(page)


def test_held_tissue_is_lifted_to_a_tent_and_the_panel_says_holding(browser):
    script = Script()
    with open_page(browser, steered(script)) as opened:
        said = opened.page.locator("#bars .bar").first
        flat = opened.picture()
        script.hands = (Hand((*MIDDLE, -0.001)), AWAY)
        opened.until(lambda: "touching" in said.inner_text(), "it touches")
        script.hands = (Hand((*MIDDLE, -0.001), jaw=0.0), AWAY)
        opened.until(lambda: "holding tissue" in said.inner_text(), "it holds")
        script.hands = (Hand((*MIDDLE, 0.006), jaw=0.0), AWAY)
        opened.until(lambda: "0.7" in said.inner_text(), "the force of 6 mm at 120 N/m")
        opened.picture()
        # The instrument is taken out of sight, the tent stays: what is seen then is tissue alone.
        opened.trainer.wander = (*MIDDLE, -0.006)
        script.hands = (AWAY, AWAY)
        tent = opened.picture()
        opened.trainer.wander = (*MIDDLE, 0.006)
        hollow = opened.picture()
        around = disc(flat, 0.35)
        assert np.abs(tent - flat)[around].mean() > SEEN / 2
        assert np.abs(tent - hollow)[around].mean() > SEEN / 2  # up does not look like down


def test_a_sliding_tip_drags_the_texture_along(browser):
    script = Script()
    with open_page(browser, steered(script)) as opened:
        flat = opened.picture()
        opened.trainer.drag = (*MIDDLE, 0.003)
        dragged = opened.picture()
        around = disc(flat, 0.3)
        assert (
            np.abs(dragged - flat)[around].mean()
            > 4 * np.abs(dragged - flat)[disc(flat, 0.85) & ~disc(flat, 0.7)].mean()
        )
        assert np.abs(dragged - flat)[around].max() > SEEN


def test_a_trainer_without_lessons_offers_free_practice_alone(browser):
    with open_page(browser, SyntheticTrainer(), size=(1280, 720)) as opened:
        place = opened.page.get_by_role("region", name="Task")
        assert "Free practice" in place.inner_text()
        assert place.get_by_role("button").count() == 0

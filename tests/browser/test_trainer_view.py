"""The trainer's page in a real browser: it connects, draws, obeys hands, and can be read and operated by everyone."""

from __future__ import annotations

import re

import numpy as np
import pytest

from browser.open_page import MODULES, axe_is_content, disc, open_page
from browser.synthetic_trainer import STATIC, SyntheticTrainer

LEFT, RIGHT = 0, 1
STEP = 1e-3  # a movement anyone would see [m]


def hold(opened, key: str, told, what: str) -> None:
    """Hold a key down until something is so."""
    opened.page.locator("#picture").focus()
    opened.page.keyboard.down(key)
    opened.until(told, what)
    opened.page.keyboard.up(key)
    opened.drawn()


def test_it_connects_and_draws_a_round_picture_with_a_dent(browser):
    with open_page(browser, SyntheticTrainer()) as opened:
        assert opened.page.inner_text("#notice") == "Connected."
        assert opened.page.inner_text("#tissue") == "skin: epidermis, dermis, fat"
        assert opened.page.inner_text("#rate") == "1000 Hz"
        assert opened.page.inner_text("#missed") == "3"
        flat = opened.picture()
        inside, outside = disc(flat, 0.85), ~disc(flat, 1.02)
        assert flat[inside].mean() > 40  # lit, of 255
        assert flat[inside].std() > 15  # and not one colour
        assert np.median(flat[outside]) < 2  # the mask: black outside the round, but for a few words
        opened.trainer.wander = (
            0.03,
            0.03,
            0.006,
        )  # in the middle of the block, which is that of the picture
        changed = np.abs(opened.picture() - flat)
        assert changed[disc(flat, 0.3)].mean() > 8 * changed[disc(flat, 0.85) & ~disc(flat, 0.7)].mean()
        assert changed[disc(flat, 0.3)].max() > 25


def test_the_keyboard_alone_moves_both_instruments_presses_and_leaves(browser):
    with open_page(browser, SyntheticTrainer()) as opened:
        trainer, page = opened.trainer, opened.page
        assert page.evaluate("document.activeElement.id") == "picture"
        left, right = trainer.tip(LEFT), trainer.tip(RIGHT)
        hold(opened, "ArrowRight", lambda: trainer.tip(RIGHT)[0] < right[0] - STEP, "hand right, tip left")
        assert np.allclose(trainer.tip(LEFT), left)
        hold(opened, "w", lambda: trainer.tip(RIGHT)[1] < right[1] - STEP, "hand up, tip down the picture")
        page.keyboard.press("Tab")
        assert page.inner_text("#active") == "left hand: grasper"
        left = trainer.tip(LEFT)
        hold(opened, "a", lambda: trainer.tip(LEFT)[0] > left[0] + STEP, "the left hand left, its tip right")
        page.keyboard.press("Space")
        opened.until(lambda: trainer.poses[LEFT].jaw == 0, "the jaw closes")
        assert trainer.poses[RIGHT].jaw == 1
        hold(opened, "q", lambda: trainer.tip(LEFT)[2] < -STEP, "in, until the tip presses")
        meter = page.get_by_role("meter", name="Force, left, grasper")
        opened.until(lambda: float(meter.get_attribute("aria-valuenow")) > 0.05, "the bar shows the force")
        assert re.search(r"\d\.\d\d\d N", page.inner_text("#bars .bar:first-child"))
        page.keyboard.press("Escape")
        page.keyboard.press("Tab")
        assert (
            page.evaluate("document.activeElement.name") == "scope"
        )  # no trap: Tab goes on through the page


def test_the_mouse_moves_the_tip_the_other_way_slides_and_squeezes(browser):
    with open_page(browser, SyntheticTrainer()) as opened:
        trainer, mouse = opened.trainer, opened.page.mouse
        box = opened.page.locator("#picture").bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        before = trainer.tip(RIGHT)
        mouse.move(x, y)
        mouse.move(x + 60, y)
        opened.until(lambda: trainer.tip(RIGHT)[0] < before[0] - STEP, "mouse right, tip left")
        before = trainer.tip(RIGHT)
        mouse.wheel(0, -300)
        opened.until(lambda: trainer.tip(RIGHT)[2] < before[2] - STEP, "the wheel slides it in")
        mouse.down()
        opened.until(lambda: trainer.poses[RIGHT].jaw == 0, "the button closes the jaw")
        mouse.up()
        opened.until(lambda: trainer.poses[RIGHT].jaw == 1, "and lets it open")
        mouse.click(x, y, button="right")
        opened.until(lambda: opened.page.inner_text("#active").startswith("left"), "the other hand")


def test_a_gamepad_moves_both_hands_at_once(browser):
    pad = """
      const buttons = Array.from({length: 17}, () => ({value: 0, pressed: false, touched: false}));
      window.pad = {connected: true, mapping: "standard", id: "test", index: 0, axes: [0, 0, 0, 0], buttons};
      navigator.getGamepads = () => [window.pad];
    """
    with open_page(browser, SyntheticTrainer(), script=pad) as opened:
        trainer = opened.trainer
        left, right = trainer.tip(LEFT), trainer.tip(RIGHT)
        opened.page.evaluate("pad.axes = [1, 0, -1, 0]; pad.buttons[6].value = 0.5")
        opened.until(lambda: trainer.tip(LEFT)[0] < left[0] - STEP, "left stick right, left tip left")
        opened.until(lambda: trainer.tip(RIGHT)[0] > right[0] + STEP, "right stick left, right tip right")
        opened.until(lambda: trainer.poses[LEFT].jaw == 0.5, "half a trigger, half closed")
        opened.page.evaluate("pad.axes = [0, 0, 0, 0]")


def test_an_emulated_headset_with_two_controllers(browser):
    emulator = (MODULES / "iwer" / "build" / "iwer.min.js").read_text(encoding="utf-8")
    install = """
      window.xrDevice = new IWER.XRDevice(IWER.metaQuest3);
      xrDevice.installRuntime({forceInstall: true});
      xrDevice.position.set(0, 1.6, 0);
      xrDevice.controllers.left.position.set(-0.15, 1.45, -0.3);
      xrDevice.controllers.right.position.set(0.15, 1.45, -0.3);
    """
    with open_page(browser, SyntheticTrainer(), script=emulator + ";" + install) as opened:
        page, trainer = opened.page, opened.trainer
        start = trainer.poses[RIGHT].handle
        page.get_by_role("button", name="Enter the headset").click()
        opened.until(
            lambda: np.linalg.norm(trainer.poses[RIGHT].handle - start) > STEP, "the controller arrives"
        )
        page.wait_for_timeout(500)
        left, right = trainer.poses[LEFT].handle, trainer.poses[RIGHT].handle
        assert right[0] - left[0] == pytest.approx(
            0.3, abs=0.02
        )  # as far apart as the controllers, less the grips
        # 2 cm right, 1 cm up, 3 cm away from the user are x, z and y of the block. Poses reach the page in float32.
        page.evaluate("xrDevice.controllers.right.position.set(0.17, 1.46, -0.33)")
        page.evaluate("xrDevice.controllers.right.updateButtonValue('trigger', 1)")
        moved = np.add(right, (0.02, 0.03, 0.01))
        opened.until(
            lambda: np.allclose(trainer.poses[RIGHT].handle, moved, atol=1e-6), "it moves as the hand"
        )
        opened.until(lambda: trainer.poses[RIGHT].jaw == 0, "the trigger squeezes")
        assert np.allclose(trainer.poses[LEFT].handle, left, atol=1e-6)
        assert trainer.poses[LEFT].present
        page.evaluate("document.getElementById('headset').click()")  # the emulator lies over the page
        opened.until(lambda: page.get_by_role("button", name="Enter the headset").count() == 1, "it ends")


def test_trouble_is_said_in_a_sentence_and_a_lost_trainer_found_again(browser):
    with open_page(browser, SyntheticTrainer()) as opened:
        page, trainer = opened.page, opened.trainer
        status = page.get_by_role("status")
        trainer.status = 1 | 2
        opened.until(lambda: "does not hold" in status.inner_text(), "a degraded servo is said")
        trainer.status = 1 | 4
        opened.until(lambda: "beyond the linear range" in status.inner_text(), "a force too large is said")
        trainer.status = 1 | 8
        cut = "The trainer lost touch with its servo: forces are off."
        opened.until(lambda: status.inner_text() == cut, "forces that were cut are said")
        trainer.status = 0
        opened.until(lambda: "servo has stopped" in status.inner_text(), "a dead servo is said")
        again = "The servo was started again; the tissue is at rest."
        trainer.notices.append({"type": "notice", "level": "info", "text": again})
        opened.until(lambda: not trainer.notices, "the notice is sent")
        opened.drawn()
        assert "servo has stopped" in status.inner_text()  # as long as that is so
        trainer.status = 1 | 2  # a new servo has no second behind it yet
        opened.until(lambda: status.inner_text() == again, "a notice is shown")
        trainer.status = 1
        held = trainer.poses[RIGHT].handle
        trainer.hang_up()
        opened.until(lambda: "does not answer" in status.inner_text(), "a lost connection is said")
        trainer.answering.set()
        opened.until(lambda: status.inner_text() == "Connected.", "it comes again")
        opened.until(lambda: len(trainer.poses) == 2, "poses arrive again")
        assert np.allclose(trainer.poses[RIGHT].handle, held)
        opened.complaints.clear()  # the browser itself notes each connection that was refused meanwhile


def test_scope_and_reset(browser):
    with open_page(browser, SyntheticTrainer()) as opened:
        page = opened.page
        straight = opened.picture()
        page.get_by_label("30°").check()
        assert np.abs(opened.picture() - straight).mean() > 3
        assert page.locator("#rim").is_visible()
        page.locator("#picture").focus()
        page.keyboard.press("0")
        assert page.get_by_label("0°", exact=True).is_checked()
        assert np.abs(opened.picture() - straight).mean() < 1.5  # home again, but for what resampling leaves
        hold(opened, "l", lambda: np.abs(opened.picture() - straight).mean() > 3, "pan")
        page.get_by_role("button", name="Tissue to rest").click()
        opened.until(lambda: {"type": "reset"} in opened.trainer.texts, "reset is sent")


@pytest.mark.parametrize("size", [(1280, 720), (390, 780)])
def test_axe_finds_nothing_and_nothing_runs_out(browser, size):
    axe = (MODULES / "axe-core" / "axe.min.js").read_text(encoding="utf-8")
    with open_page(browser, SyntheticTrainer(), size=size, script=axe) as opened:
        page = opened.page
        assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
        picture = page.locator("#picture").bounding_box()
        assert picture["width"] == pytest.approx(picture["height"], abs=1)
        assert picture["width"] > 0.8 * min(size[0], 0.9 * size[1])
        heights = page.locator("#keys-short kbd:first-child").evaluate_all(
            "all => all.map((each) => [each.offsetHeight, each.parentElement.offsetHeight])"
        )
        assert all(line <= 2 * key for key, line in heights)  # no key stands apart from what it does
        axe_is_content(page)
        page.get_by_role("button", name="Keys and help").click()
        assert page.get_by_role("dialog", name="Keys and help").is_visible()
        axe_is_content(page)


def test_what_is_shipped_holds_no_map_no_test_tool_and_no_inline_script():
    files = [path for path in STATIC.rglob("*") if path.is_file()]
    assert {path.suffix for path in files} <= {".html", ".js", ".css", ""}
    for path in files:
        text = path.read_text(encoding="utf-8").lower()
        assert "iwer" not in text
        assert "axe-core" not in text
        assert "sourcemappingurl" not in text
    page = (STATIC / "index.html").read_text(encoding="utf-8")
    assert re.findall(r"<script(?![^>]*\ssrc=)", page) == []
    assert " style=" not in page

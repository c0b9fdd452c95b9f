"""The whole trainer with a real browser before it: hands on the page press real tissue, and the page shows it."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

import numpy as np
import pytest

from browser.open_page import HEADSET, MODULES
from live_process import training, watching
from trocar.contact.instrument import default_instruments
from trocar.web.source import RIGHT, Status, Touch

PATIENCE = 120.0  # [s] for a page drawn by software on a busy machine; nothing here is about speed
FELT = 0.01  # [N]
HAND = default_instruments((0.06, 0.06))[RIGHT]
PAD = """
  const buttons = Array.from({length: 17}, () => ({value: 0, pressed: false, touched: false}));
  window.pad = {connected: true, mapping: "standard", id: "test", index: 0, axes: [0, 0, 0, 0], buttons};
  navigator.getGamepads = () => [window.pad];
"""


@pytest.fixture(scope="module")
def running():
    with training() as (process, address):
        yield process, address


@pytest.fixture
def opened(browser, running, request):
    """Open the page of the running trainer and look on beside it; yields the page, a watcher and a way to wait."""
    script = getattr(request, "param", "")
    with watching(running[1]) as watcher:
        context = browser.new_context(viewport={"width": 700, "height": 460})
        page = context.new_page()
        complaints = []
        page.on("console", lambda said: complaints.append(said.text) if said.type == "error" else None)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        if script:
            page.add_init_script(script)
        page.goto(running[1])
        page.select_option("#sharpness", "fast")

        def until(told, what):
            end = time.monotonic() + PATIENCE
            while not told(watcher.look()):
                assert time.monotonic() < end, f"it never came to this: {what}; complaints: {complaints}"
                page.wait_for_timeout(20)

        until(
            lambda state: all(each.touch & Touch.PRESENT for each in state.instruments),
            "both hands are there",
        )
        yield page, watcher, until
        context.close()
        # A page that goes takes its instruments out of the tissue.
        until_gone = time.monotonic() + PATIENCE
        while any(each.touch for each in watcher.look().instruments):
            assert time.monotonic() < until_gone
    assert complaints == []


def presses(state):
    return state.instruments[RIGHT].force[2] > FELT and state.heights.min() < -1e-4


def test_the_keyboard_alone_presses_and_the_page_shows_the_force(opened):
    page, watcher, until = opened
    page.locator("#picture").focus()
    page.keyboard.down("Shift")
    page.keyboard.down("q")
    until(presses, "the right tip presses")
    page.keyboard.up("q")
    page.keyboard.up("Shift")
    until(lambda _: "touching" in page.inner_text("#bars"), "the page says that it touches")
    until(lambda _: page.inner_text("#rate").endswith("Hz"), "the page shows the rate")
    page.keyboard.press("r")
    page.keyboard.down("e")
    until(lambda state: not np.any(state.instruments[RIGHT].force), "out again")
    page.keyboard.up("e")
    assert Status.ALIVE in watcher.look().status


def test_the_mouse_presses(opened):
    page, _, until = opened
    box = page.locator("#picture").bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)

    def wheel(state):
        if not presses(state):
            page.mouse.wheel(0, -40)  # away from the user is inwards
        return presses(state)

    until(wheel, "the wheel slides the tip in until it presses")


@pytest.mark.parametrize("opened", [PAD], indirect=True, ids=["pad"])
def test_a_gamepad_presses_with_both_hands(opened):
    page, _, until = opened
    page.evaluate("pad.buttons[4].value = 0.3; pad.buttons[4].pressed = true")
    page.evaluate("pad.buttons[5].value = 0.3; pad.buttons[5].pressed = true")
    until(lambda state: all(each.force[2] > FELT for each in state.instruments), "both tips press")
    page.evaluate("pad.buttons.forEach((each) => { each.value = 0; each.pressed = false; })")
    until(lambda _: page.inner_text("#bars").count("touching") == 2, "the page says so")


@pytest.mark.parametrize(
    "opened",
    [(MODULES / "iwer" / "build" / "iwer.min.js").read_text(encoding="utf-8") + ";" + HEADSET]
    if (MODULES / "iwer").is_dir()
    else [""],
    indirect=True,
    ids=["headset"],
)
def test_an_emulated_headset_presses_with_a_controller(opened):
    page, _, until = opened
    page.get_by_role("button", name="Enter the headset").click()
    place = np.array([0.15, 1.45, -0.3])
    until(lambda state: state.instruments[RIGHT].touch & Touch.PRESENT, "the controller is there")

    def lower(state):
        """Bring the tip over the block and down: the handle to where it would be, in steps, as a hand does by eye."""
        if presses(state):
            return True
        seen = state.instruments[RIGHT]
        handle = np.array(seen.tip) - HAND.length * np.array(seen.direction)
        over = np.hypot(seen.tip[0] - 0.042, seen.tip[1] - 0.03) < 3e-3
        to = np.array(HAND.handle_for((0.042, 0.03, -1e-3 if over else 0.01))) - handle
        step = to * min(1.0, 0.01 / max(np.linalg.norm(to), 1e-9))
        place[:] += [step[0], step[2], -step[1]]  # right, up, towards the user
        page.evaluate("([x, y, z]) => xrDevice.controllers.right.position.set(x, y, z)", place.tolist())
        return False

    until(lower, "the controller presses the tip into the tissue")


def test_a_killed_servo_is_told_of_on_the_page_and_comes_back(opened, running):
    _, watcher, until = opened
    children = Path(f"/proc/{running[0].pid}/task/{running[0].pid}/children").read_text().split()
    servos = [int(n) for n in children if b"spawn_main" in Path(f"/proc/{n}/cmdline").read_bytes()]
    assert servos
    os.kill(servos[-1], signal.SIGKILL)
    until(lambda state: Status.ALIVE not in state.status, "the stream says that the servo is dead")
    assert not any(np.any(each.force) for each in watcher.look().instruments)
    until(lambda state: Status.ALIVE in state.status, "it lives again")
    until(lambda _: watcher.notices, "a sentence came")
    assert watcher.notices[0].startswith("The servo was killed by SIGKILL. Forces are off")

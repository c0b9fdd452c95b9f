"""The trainer's page in a headless Chromium, with the synthetic trainer behind it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

import numpy as np
from PIL import Image
from playwright.sync_api import Browser, Page

from browser.synthetic_trainer import SyntheticTrainer

MODULES = Path(__file__).parents[2] / "client" / "node_modules"
HEADSET = """  // a headset and two controllers for the emulator, iwer
  window.xrDevice = new IWER.XRDevice(IWER.metaQuest3);
  xrDevice.installRuntime({forceInstall: true});
  xrDevice.position.set(0, 1.6, 0);
  xrDevice.controllers.left.position.set(-0.15, 1.45, -0.3);
  xrDevice.controllers.right.position.set(0.15, 1.45, -0.3);
"""
PATIENCE = 60.0  # for a page drawn by software on a busy machine; nothing here is about speed [s]


@dataclass
class Opened:
    """A page, its trainer, and what the page complained of."""

    page: Page
    trainer: SyntheticTrainer
    complaints: list[str]

    def until(self, told: Callable[[], object], what: str) -> None:
        """Wait until something is so."""
        end = time.monotonic() + PATIENCE
        while not told():
            if time.monotonic() > end:
                raise AssertionError(f"it never came to this: {what}; complaints: {self.complaints}")
            self.page.wait_for_timeout(50)

    def drawn(self, frames: int = 3) -> None:
        """Wait until the page has taken some more frames, so that what changed before is drawn."""
        reached = max(self.trainer.acknowledged, default=0) + frames
        self.until(lambda: max(self.trainer.acknowledged, default=0) >= reached, f"frame {reached} taken")

    def picture(self) -> np.ndarray:
        """Return the picture as it is on the screen, grey, 0 to 255, shape (height, width)."""
        self.drawn()
        shot = self.page.locator("#picture").screenshot()
        return np.asarray(Image.open(BytesIO(shot)).convert("L"), dtype=float)


@contextmanager
def open_page(
    browser: Browser, trainer: SyntheticTrainer, *, size: tuple[int, int] = (900, 560), script: str = ""
) -> Iterator[Opened]:
    """Open the page and wait until it is connected and has drawn.

    Args:
        browser: a running Chromium.
        trainer: what the page shall find.
        size: of the window [px].
        script: run in the page before anything else.
    """
    server = trainer.start()
    context = browser.new_context(viewport={"width": size[0], "height": size[1]})
    complaints: list[str] = []
    try:
        page = context.new_page()
        page.on("console", lambda said: complaints.append(said.text) if said.type == "error" else None)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        if script:
            page.add_init_script(script)
        page.goto(f"http://127.0.0.1:{trainer.port}/")
        opened = Opened(page, trainer, complaints)
        if trainer.greeting["steered_by"] == "page":
            opened.until(lambda: len(trainer.poses) == 2, "both instruments' poses arrive")
        opened.drawn()
        yield opened
        assert complaints == []
        assert trainer.errors == []
        assert trainer.outstanding <= 2
    finally:
        context.close()
        server.shutdown()


def disc(picture: np.ndarray, radius: float) -> np.ndarray:
    """Return which pixels lie within a share of the round picture's radius."""
    height, width = picture.shape
    y, x = np.mgrid[0:height, 0:width]
    return np.hypot(x - width / 2, y - height / 2) < radius * min(height, width) / 2


def axe_is_content(page: Page) -> None:
    """Let axe-core look at the page as it is; it must have been put there."""
    found = page.evaluate("axe.run()")
    broken = [(each["id"], [node["html"] for node in each["nodes"]]) for each in found["violations"]]
    assert not broken, broken
    assert len(found["passes"]) > 10  # it did look

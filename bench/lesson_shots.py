"""Take pictures of a lesson with headless Chromium (make shots): choose, attempt, card, replay, history, board.

A scripted novice's attempt is recorded, and plays as the trainer's own device; attempts before it, the later the
better, make the history. The board is what an emulated headset shows of the card.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from browsing import chromium
from playwright.sync_api import Page
from shots import (
    EMULATOR,
    HEADSET,
    LEAN,
    OUT,
    PATIENCE,
    WINDOW,
    ShotError,
    trainer,
    until,
    wait_for_turns,
)

from trocar.records.scripted import attempt_on_record
from trocar.records.store import Records
from trocar.training.headless import attempt
from trocar.training.tape import write_attempt

TASK, SEED = "palpate", 3
BEFORE = (("novice", 5), ("novice", 1), ("novice", 4), ("novice", 8), ("novice", 2), ("expert", 1))
WHO = "Ada"


def take(page: Page, address: str, out: Path) -> None:
    """Go through a lesson, and write a picture of each of its parts."""

    def shoot(name: str, settle: int = 1500) -> None:
        page.wait_for_timeout(settle)
        save(page, out / f"{name}.jpg")

    def drawn(where: str) -> None:
        pictures = page.locator(f"{where} figure img")
        complete = "all => all.length > 0 && all.every((each) => each.complete)"
        until(page, lambda: pictures.evaluate_all(complete), f"the pictures of {where} did not come")

    def press(name: str) -> None:
        page.get_by_role("button", name=name, exact=True).click()

    page.set_default_timeout(PATIENCE)
    page.goto(address)
    page.select_option("#sharpness", "sharp")
    press("Choose a task")
    page.fill("#trainee", WHO)
    shoot("choose")
    press("Go on")
    press("Begin")
    until(page, lambda: page.inner_text("#told-now") == "Hold it so.", "nobody held a tip still")
    shoot("attempt", settle=0)
    page.wait_for_selector("#card[open]")
    drawn("#card")
    shoot("card")
    press("Look at it again, beside the expert")
    page.wait_for_selector("#beside:not([hidden])")
    until(page, lambda: float(page.inner_text("#film-told").split()[0]) > 6.0, "the film did not run")
    press("Pause")
    shoot("replay")
    page.locator("#film-close").click()
    press("History")
    page.wait_for_selector("#history[open]")
    drawn("#history")
    shoot("history")


def take_board(page: Page, address: str, out: Path) -> None:
    """Look at the newest card in an emulated headset, and write a picture of the board."""

    def press(name: str) -> None:
        page.get_by_role("button", name=name, exact=True).click()

    page.set_default_timeout(PATIENCE)
    page.add_init_script(EMULATOR.read_text(encoding="utf-8") + HEADSET)
    page.goto(address)
    press("Choose a task")
    page.fill("#trainee", WHO)
    press("Go on")
    press("History")
    page.get_by_role("button", name="Score card of attempt").first.click()
    page.locator("#card").get_by_role("button", name="Close", exact=True).click()
    press("Enter the headset")
    leave = page.get_by_role("button", name="Leave the headset")
    until(page, lambda: leave.count() == 1, "the headset's session did not begin")
    wait_for_turns(page)  # the block is put before the head when that is first tracked
    page.evaluate(LEAN)
    wait_for_turns(page)
    save(page, out / "board.jpg")


def save(page: Page, path: Path) -> None:
    """Write a picture of a page."""
    image = page.screenshot(path=path, type="jpeg", quality=88, timeout=PATIENCE)
    print(f"{path}: {len(image) / 1000:.0f} kB", flush=True)


def main() -> int:
    """Read the command line and take the pictures."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--out", type=Path, default=OUT)
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    try:
        with TemporaryDirectory(prefix="trocar-shots-") as folder, chromium() as browser:
            os.environ["TROCAR_DATA"] = folder
            with Records.open() as records:
                for skill, seed in BEFORE:
                    attempt_on_record(records, TASK, skill=skill, seed=seed, trainee=WHO)
            recording = Path(folder) / "novice.csv"
            write_attempt(recording, attempt(TASK, skill="novice", seed=SEED).recording)
            with trainer("--device", "recorded", "--recording", str(recording)) as address:
                take(browser.new_page(viewport=WINDOW), address, arguments.out)
                take_board(browser.new_page(viewport=WINDOW), address, arguments.out)
    except (FileNotFoundError, ShotError) as error:
        print(f"shots: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())

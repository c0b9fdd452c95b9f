"""Print how the servo keeps time: `trocar bench servo`, on request with a real browser attached all the while.

Run: python bench/servo.py [--browser] [--seconds 60] [--rounds 10]. The browser shows the trainer's page with whatever
the measured servo does; while the empty loop runs it is sent the last state again and again, at the same rate.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace

from browsing import MISSING, chromium

import trocar
from trocar.cli.bench_servo import report
from trocar.realtime.bench import alternate
from trocar.realtime.servo import Servo
from trocar.realtime.sliding import sliding_contact
from trocar.web.messages import Hello, Notice
from trocar.web.serve import serving
from trocar.web.source import Pose, Snapshot
from trocar.web.stage import set_stage
from trocar.web.trainer import Trainer

TISSUE = "skin"


class Attended:
    """A source that shows the servo being measured, and while none is, what was seen last.

    Args:
        trainer: not opened; it greets, and draws a servo's state.
    """

    def __init__(self, trainer: Trainer) -> None:
        self._trainer = trainer
        self._servo: Servo | None = None
        self._last: Snapshot | None = None

    def attend(self, servo: Servo | None) -> None:
        """Show another servo, or none."""
        self._servo = servo

    def hello(self) -> Hello:
        """Return the trainer's own."""
        return self._trainer.hello()

    def latest(self) -> Snapshot:
        """Return what there is to see; while nothing runs the tick goes on, so that frames do."""
        servo = self._servo
        if servo is not None:
            self._last = self._trainer.snapshot_of(servo.latest())
        elif self._last is not None:
            self._last = replace(self._last, tick=self._last.tick + 1)
        else:
            self._last = self._trainer.latest()
        return self._last

    def pose(self, instrument: int, pose: Pose, /) -> None:
        """Ignore it: the hands are the measurement's."""

    def reset(self) -> None:
        """Ignore it."""

    def guiding(self) -> None:
        """Return nothing: nobody attempts anything."""

    def notices(self) -> Sequence[Notice]:
        """Return none."""
        return ()

    def beat(self) -> None:
        """Ignore it: the measurement beats its servo."""


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--browser", action="store_true", help="keep the trainer's page open in Chromium")
    parser.add_argument("--seconds", type=float, default=60.0, help="of each round")
    parser.add_argument("--rounds", type=int, default=10, help="of the servo; the empty loop has one more")
    arguments = parser.parse_args()
    scene, state, motion = sliding_contact(trocar.tissue(TISSUE))

    def tell(done: int, total: int) -> None:
        print(f"round {done + 1} of {total}", file=sys.stderr, flush=True)

    with ExitStack() as stack:
        source = None
        if arguments.browser:
            source = Attended(Trainer(set_stage(TISSUE)))
            served = stack.enter_context(serving(source))
            try:
                page = stack.enter_context(chromium()).new_page()
            except FileNotFoundError:
                print(MISSING, file=sys.stderr)
                return 1
            page.goto(served.address)
            page.wait_for_selector("#rate")
        found = alternate(
            scene,
            state,
            motion,
            seconds=arguments.seconds,
            rounds=arguments.rounds,
            progress=tell,
            attend=source.attend if source is not None else lambda servo: None,
        )
    report(found)
    return 0


if __name__ == "__main__":  # its processes import this file
    sys.exit(main())

"""Kill the servo, and its parent, again and again; print what was left.

Each time a hand presses on the tissue when the servo is killed, at a random moment; forces must be zero 100 ms later
and a restart must bring them back. Every tenth time it is the parent that is killed, in a process of its own.
Run: python bench/kills.py [TIMES]
"""

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from realtime.toy_scene import TOY, at_rest, toy_scene, until
from trocar.realtime.guard import GuardLimits
from trocar.realtime.servo import Servo

LIMITS = GuardLimits(damping=1e3, still_growth=1e6, reserve=1e3, credit=1e3, slew=1e9, clamp=100.0)
TESTS = Path(__file__).parent.parent / "tests"
PARENT = TESTS / "realtime/doomed_parent.py"


def presses(servo: Servo) -> bool:
    """Press, and say whether the hand feels it."""
    servo.command(0, present=True, handle=(0.0, 0.0, -0.01))
    return until(lambda: servo.latest().hand_forces[0, 2] > 0.5, within=10.0, beating=servo)


def kill_servo(servo: Servo) -> bool:
    """Kill it; say whether it was seen, forces were gone in time and a restart brought them back."""
    pressed = presses(servo)
    end = time.monotonic() + random.uniform(0.0, 0.2)
    until(lambda: time.monotonic() > end, beating=servo)
    os.kill(servo.process_id, signal.SIGKILL)
    time.sleep(0.1)
    state = servo.latest()
    gone = not state.hand_forces.any() and not state.alive
    servo.restart()
    return pressed and gone and presses(servo)


def kill_parent() -> bool:
    """Kill a parent; say whether its servo was gone within three seconds."""
    parent = subprocess.Popen(
        [sys.executable, PARENT],
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": str(TESTS)},
    )
    child = int(parent.stdout.readline())
    time.sleep(random.uniform(0.0, 0.2))
    parent.kill()
    parent.wait()
    return until(lambda: not Path(f"/proc/{child}").exists(), within=3.0)


def main() -> None:
    """Kill and count."""
    times = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    done = {"servo": [0, 0], "parent": [0, 0]}
    with Servo(toy_scene(), at_rest(), physics=TOY, smoothing=0.0, limits=LIMITS) as servo:
        for time_ in range(times):
            what = "parent" if time_ % 10 == 9 else "servo"
            done[what][0] += 1
            done[what][1] += kill_parent() if what == "parent" else kill_servo(servo)
            servo.beat()
            if not servo.alive:  # it was forgotten while a parent was killed
                servo.restart()
            print(f"\r{time_ + 1} of {times}", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    for what, (tried, good) in done.items():
        print(f"{what} killed {tried} times: {good} times as it should be")
    sys.exit(any(tried != good for tried, good in done.values()))


if __name__ == "__main__":
    main()

"""Kill the trainer, and its servo, in the middle of attempts, again and again; print what was on record.

Each attempt is killed at a random moment between 0.2 and 3 s; everything that was acknowledged must be there up to the
last second, marked as interrupted, and the recording must give back every tick.
Run: python bench/lesson_kills.py [TIMES]
"""

import random
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from web.doomed_lesson import Trainer

SERVOS = 2  # killed of each trainer, before it is killed itself; it starts a servo again three times


def main() -> int:
    """Kill and count."""
    times = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    done = {"servo": [], "trainer": []}
    with TemporaryDirectory(prefix="trocar-kills-") as folder:
        while (count := sum(map(len, done.values()))) < times:
            trainer = Trainer(Path(folder))
            try:
                for _ in range(min(SERVOS, times - count - 1)):
                    done["servo"].append(trainer.lesson(random.uniform(0.2, 3.0), kill_servo=True))
                done["trainer"].append(trainer.lesson(random.uniform(0.2, 3.0), kill_servo=False))
            finally:
                trainer.close()
            print(f"\r{sum(map(len, done.values()))} of {times}", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    for what, found in done.items():
        good = sum(each.good for each in found)
        missing = max((each.lived - each.kept for each in found), default=0.0)
        print(
            f"{what} killed {len(found)} times: {good} as it should be; at most {missing:.2f} s were missing"
        )
        for each in found:
            if not each.good:
                print(f"  {each}")
    return int(any(not each.good for found in done.values() for each in found))


if __name__ == "__main__":
    sys.exit(main())

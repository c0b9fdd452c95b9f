"""A program that starts a servo, prints its process number, and beats until it is killed or interrupted."""

import sys
import time

from realtime.toy_scene import TOY, at_rest, toy_scene
from trocar.realtime.servo import Servo


def main():
    with Servo(toy_scene(), at_rest(), physics=TOY) as servo:
        sys.stdout.write(f"{servo.process_id}\n")
        sys.stdout.flush()
        while True:
            servo.beat()
            time.sleep(0.01)


if __name__ == "__main__":
    main()

"""A program that starts a servo, prints its process number, and beats until it is killed or interrupted."""

import signal
import sys
import time

from realtime.toy_scene import TOY, at_rest, toy_scene
from trocar.realtime.servo import Servo


def main():
    signal.signal(
        signal.SIGINT, signal.default_int_handler
    )  # ignored where a shell starts it in the background
    with Servo(toy_scene(), at_rest(), physics=TOY) as servo:
        sys.stdout.write(f"{servo.process_id}\n")
        sys.stdout.flush()
        while True:
            servo.beat()
            time.sleep(0.01)


if __name__ == "__main__":
    main()

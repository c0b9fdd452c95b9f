"""One servo for the tests that leave it as it was, and a way to make others."""

import threading
from contextlib import contextmanager

import pytest

from realtime.toy_scene import TOY, at_rest, toy_scene
from trocar.realtime.servo import Servo


@contextmanager
def beaten(servo):
    """Beat from a thread while a test does other things."""
    over = threading.Event()

    def beat():
        while not over.wait(0.01):
            servo.beat()

    thread = threading.Thread(target=beat)
    thread.start()
    try:
        yield servo
    finally:
        over.set()
        thread.join()


@pytest.fixture
def make_servo():
    made = []

    def make(scene=None, physics=TOY, **options):
        servo = Servo(toy_scene() if scene is None else scene, at_rest(), physics=physics, **options)
        made.append(servo)
        return servo

    yield make
    for servo in made:
        servo.close()


@pytest.fixture(scope="module")
def running():
    with Servo(toy_scene(), at_rest(), physics=TOY, smoothing=0.0) as servo, beaten(servo):
        yield servo

"""The servo's clock is the system's monotonic one, and its sleep ends no earlier than it should."""

import time

from trocar.realtime.clock import SECOND, now, sleep_until


def test_it_is_the_monotonic_clock():
    before = time.monotonic_ns()
    read = now()
    assert before <= read <= time.monotonic_ns()


def test_it_sleeps_until_it_is_due():
    due = now() + SECOND // 50
    sleep_until(due)
    assert now() >= due


def test_it_does_not_sleep_for_what_has_passed():
    sleep_until(now() - SECOND)
    sleep_until(0)

"""What one side writes the other reads whole, or not at all."""

import threading

import numpy as np
from numba import njit

from trocar.realtime.shared import (
    allocate,
    copy_of,
    forces_of,
    poses_of,
    publish,
    read,
    records_of,
    view,
)

SHAPE = (2, 8, 8)
LIVE = (3, 41, 41)


@njit(nogil=True)
def write_many(own, area, rounds):
    for k in range(rounds):
        own.words[:] = k
        own.reals[:] = k
        publish(own, area)


@njit(nogil=True)
def torn_reads(area, own, last):
    """Read until the writer's last round is seen; count copies that mix rounds."""
    torn = 0
    while own.words[0] != last:
        if read(area, own):
            for value in own.reals:
                if value != own.words[0]:
                    torn += 1
                    break
    return torn


def test_parts_do_not_overlap():
    both = view(allocate(SHAPE), SHAPE)
    parts = [*both.command, *both.state, *both.field, both.signals, both.totals]
    for number, part in enumerate(parts, 1):
        part[...] = number
    for number, part in enumerate(parts, 1):
        assert (part == number).all()
        assert part.ctypes.data % 64 == 0


def test_two_views_of_a_block_are_the_same_memory():
    block = allocate(SHAPE)
    here, there = view(block, SHAPE), view(block, SHAPE)
    own = copy_of(here.state)
    records_of(own)[1, 3] = 7.0
    forces_of(own)[0, 2] = -2.0
    publish(own, here.state)
    seen = copy_of(there.state)
    assert read(there.state, seen)
    assert records_of(seen)[1, 3] == 7.0
    assert forces_of(seen)[0, 2] == -2.0


def test_poses_lie_in_the_command():
    both = view(allocate(SHAPE), SHAPE)
    poses_of(both.command)[:] = 3.0
    assert (both.command.reals == 3.0).all()


def test_a_reader_never_sees_half_a_round():
    rounds = (
        40_000  # of some microseconds: both sides run at once for many of them, where there are two cores
    )
    area = view(allocate(LIVE), LIVE).field
    own, seen = copy_of(area), copy_of(area)
    write_many(own, area, 1)  # compiled before both run
    torn_reads(area, seen, 0)
    writer = threading.Thread(target=write_many, args=(own, area, rounds))
    writer.start()
    assert torn_reads(area, seen, rounds - 1) == 0
    writer.join()


def test_a_writer_that_died_halfway_is_not_read_and_not_waited_for():
    area = view(allocate(SHAPE), SHAPE).state
    area.lock[0] = 5
    area.reals[:] = np.nan
    assert not read(area, copy_of(area))

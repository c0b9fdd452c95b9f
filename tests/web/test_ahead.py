"""Code made ahead: of every kind of scene, in a process that gives way to all others and ends with the trainer."""

import multiprocessing
import os
import time

from numba import typeof

from trocar.simulation.kind import kind_of
from trocar.training.tasks.catalogue import TASKS, task
from trocar.web.ahead import of_each_kind, prepare, preparing
from trocar.web.stage import stage_of


def kinds_of(one):
    scene = stage_of(one).scene
    return typeof(scene), typeof(kind_of(scene).at_rest(scene))


def test_every_task_is_of_a_kind_that_is_compiled_ahead():
    ahead = {kinds_of(one) for one in of_each_kind().values()}
    assert len(ahead) == len(of_each_kind()) == 3
    assert {kinds_of(task(name)) for name in TASKS} == ahead


def test_all_of_it_is_compiled_and_how_far_it_is_is_told():
    told = []
    prepare(lambda what, share: told.append((what, share)))
    shares = [share for _, share in told]
    assert shares == sorted(shares)
    assert 0.0 == shares[0] < shares[-1] < 1.0
    assert {what.rpartition(" a")[2] for what, _ in told} == {" block", "n organ", " sheet"}
    for one in of_each_kind().values():
        scene = stage_of(one).scene
        kind = kind_of(scene)
        of_scene = [arguments for arguments in kind.play.overloads if arguments[0] == typeof(scene)]
        assert of_scene
        for function in (kind.advance, kind.amplitudes, kind.come_to_rest):
            assert any(arguments[0] == typeof(scene) for arguments in function.overloads)


def test_beside_the_trainer_it_gives_way_and_ends_with_it():
    def children():
        return [child for child in multiprocessing.active_children() if child.name == "trocar ahead"]

    with preparing():
        (child,) = children()
        end = time.monotonic() + 60.0  # [s] for Python to start on a busy machine
        while os.getpriority(os.PRIO_PROCESS, child.pid) != 19:
            assert time.monotonic() < end
            time.sleep(0.02)
    assert children() == []

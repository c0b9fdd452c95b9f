"""`make shots` against the synthetic trainer: it finds the moments it is after and takes pictures of them."""

from __future__ import annotations

import importlib
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from browser.chromium import required
from browser.synthetic_trainer import Hand, SyntheticTrainer, hello
from trocar.web.source import InstrumentState, Touch

BENCH = Path(__file__).parents[2] / "bench"
LEFT, RIGHT = (0.018, 0.028, 0.006), (0.042, 0.030, 0.006)  # tips at rest [m]
ACT = 1.5  # [s]
PERIOD = 4 * ACT
FREE = Touch(0)


@pytest.fixture
def bench(monkeypatch):
    monkeypatch.syspath_prepend(str(BENCH))
    yield importlib.import_module("shots"), importlib.import_module("film")
    for name in ("shots", "film"):
        sys.modules.pop(name, None)


def press_slide_lift(now: float) -> tuple[Hand, Hand]:
    """Rest, press with the right hand and slide, lift with the left, over and over."""
    act, into = divmod(now % PERIOD, ACT)
    if act == 1:
        return Hand(LEFT), Hand((0.040, 0.030, -0.0015))
    if act == 2:  # 10 mm/s
        return Hand(LEFT), Hand((0.030 + 0.010 * into, 0.025, -0.0015))
    if act == 3:
        height = 0.0035 if into > 0.7 else -0.0008
        return Hand((0.020, 0.030, height), jaw=0.0 if into > 0.4 else 1.0), Hand(RIGHT)
    return Hand(LEFT), Hand(RIGHT)


def test_it_films_a_trainer_and_keeps_every_scene(bench, tmp_path, capsys):
    shots, _ = bench
    required()
    if not shots.EMULATOR.is_file():
        pytest.fail("the headset's emulator is not installed: python hatch_build.py check")
    trainer = SyntheticTrainer(greeting=hello(steered_by="trainer"), script=press_slide_lift)
    server = trainer.start()
    try:
        address = f"http://127.0.0.1:{trainer.port}/?token=abc"
        code = shots.main(["--address", address, "--seconds", str(2 * PERIOD), "--out", str(tmp_path)])
    finally:
        server.shutdown()
    said = capsys.readouterr()
    assert code == 0, said.err
    assert "oblique, organ: left out" in said.out
    assert {path.name for path in tmp_path.iterdir()} == {
        f"{name}.jpg" for name in ("rest", "press", "slide", "lift", "headset")
    }
    pictures = {path.stem: np.asarray(Image.open(path), dtype=float) for path in tmp_path.iterdir()}
    for name in ("press", "slide", "lift"):
        assert np.abs(pictures[name] - pictures["rest"]).max() > 40  # something moved, of 255
    assert pictures["headset"].std() > 10  # something is seen
    assert trainer.poses == {}  # a page that only watches sends none


def state(touch: Touch, depth: float) -> InstrumentState:
    """Return an instrument that does something so deep."""
    zero = (0.0, 0.0, 0.0)
    return InstrumentState(
        tip=(0.03, 0.03, -depth), direction=(0.0, 0.0, -1.0), roll=0.0, jaw=0.0, force=zero, handle_force=zero,
        touch=Touch.PRESENT | touch, depth=depth,
    )  # fmt: skip


def test_the_deepest_press_and_slide_and_the_highest_lift_are_kept(bench):
    _, film = bench

    def moment(name: str, touch: Touch = FREE, depth: float = 0.0, speed: float = 0.0):
        return film.Moment(name.encode(), (state(touch, depth), state(Touch(0), 0.0)), 0.0, speed)

    touching, holding = Touch.TOUCHING, Touch.TOUCHING | Touch.HOLDING
    found = film.choose(
        [
            moment("rest"),
            moment("light", touching, 1e-4),
            moment("press", touching, 1e-3),
            moment("slide", touching, 2e-3, 0.02),
            moment("gripped", holding, 5e-3),
            moment("lift", holding, -3e-3),
        ]
    )
    assert {name: chosen.frame.decode() for name, chosen in found.items()} == {
        name: name for name in ("rest", "press", "slide", "lift")
    }
    assert film.choose([moment("rest")]).keys() == {"rest"}


def test_the_speed_is_that_of_the_tip_that_goes_on_touching(bench):
    _, film = bench
    here, there = state(Touch.TOUCHING, 1e-3), replace(state(Touch.TOUCHING, 1e-3), tip=(0.033, 0.034, 0.0))
    free = state(Touch(0), 0.0)
    before = film.Moment(b"", (here, free), 1.0)
    assert film.across(before, (there, free), 1.5) == pytest.approx(0.01)  # 3, 4, 5 mm in half a second
    assert film.across(before, (replace(there, touch=Touch.PRESENT), free), 1.5) == 0.0
    assert film.across(before, (there, free), 1.0) == 0.0
    assert film.across(None, (there, free), 1.5) == 0.0


def test_a_trainer_that_does_not_start_is_told_in_a_sentence(bench, monkeypatch):
    shots, _ = bench
    monkeypatch.setattr(shots.sys, "executable", "/bin/false")
    with pytest.raises(shots.ShotError, match="printed no address"), shots.trainer("--device", "none"):
        pass

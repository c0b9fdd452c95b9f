"""A trainee's lesson through the server: choose, do, read the card, look at it again, find it in the history."""

import json
import threading
import time
from contextlib import contextmanager

import pytest

from scripted_hands import Hands, first_step
from trocar.records.store import Records
from trocar.records.trouble import RecordsFullError
from trocar.training.session import assess
from trocar.training.strip import recorded
from trocar.training.tasks import catalogue
from trocar.web.lessons import Lessons
from trocar.web.serve import serving
from trocar.web.source import Pose
from trocar.web.stage import set_stage
from trocar.web.trainer import Trainer
from trocar.web.wire import decode_frame
from web.visitor import Visitor, until

PATIENCE = 60.0  # [s] on a busy machine; nothing here is a timing


@pytest.fixture(scope="module")
def school(tmp_path_factory):
    """Yield a visitor and what it visits; palpate has one point only."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(catalogue.TASKS, "palpate", first_step)
        trainer = Trainer(set_stage("skin"))
        trainer.open()
        try:
            with Records.open(tmp_path_factory.mktemp("school")) as records:
                lessons = Lessons(trainer, records)
                with serving(trainer, lessons) as served:
                    yield Visitor(served), trainer, lessons
                lessons.close()
        finally:
            trainer.close()


@contextmanager
def moved(trainer, task):
    """Let scripted hands do a task while the block runs."""
    over, hands = threading.Event(), Hands(trainer.servo, task)

    def move():
        while not over.is_set():
            hands.move()

    thread = threading.Thread(target=move)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


def stands(visitor, number):
    return visitor.ask(f"/api/attempts/{number}")[1]


def begin(visitor, trainee="Ada", **more):
    return visitor.ask("/api/attempts", {"trainee": trainee, "task": "palpate", "level": 1, **more})


@pytest.fixture(scope="module")
def done(school):
    """Yield an attempt that was done, and all that the page was told meanwhile."""
    visitor, trainer, _ = school
    told, stop = [], threading.Event()

    def listen():
        with visitor.live() as (stream, _):
            while not stop.is_set():
                message = stream.recv(timeout=10)
                if isinstance(message, bytes):
                    sequence = int.from_bytes(message[4:8], "little")
                    stream.send(json.dumps({"type": "ack", "sequence": sequence}))
                else:
                    told.append(json.loads(message))

    listener = threading.Thread(target=listen)
    listener.start()
    status, row = begin(visitor)
    assert status == 201, row
    assert (row["status"], row["trainee"]) == ("running", "Ada")
    with moved(trainer, first_step()):
        until(lambda: stands(visitor, row["id"])["status"] != "running", PATIENCE)
    until(lambda: told[-1].get("state") == "finished", PATIENCE)
    stop.set()
    listener.join()
    return row["id"], told


def test_the_page_is_guided_from_the_first_step_to_the_card(school, done):
    number, told = done
    guided = [each for each in told if each["type"] == "guiding"]
    assert {each["attempt"] for each in guided} == {number}
    states = [each["state"] for each in guided]
    assert states == sorted(states, key=["running", "marking", "finished"].index)
    assert set(states) == {"running", "marking", "finished"}
    running = [each for each in guided if each["state"] == "running"]
    step = first_step().steps[0]
    assert running[0]["words"] == step.words
    assert running[0]["marks"] == [{"place_m": list(step.place), "radius_m": step.radius, "hand": "right"}]
    assert (running[0]["least_n"][1], running[0]["most_n"]) == (step.least, [0.0, step.most])
    assert "Hold it so." in [each["hint"] for each in running]
    assert running[-1]["time_s"] > 2.0
    assert running[-1]["time_s"] + running[-1]["left_s"] == pytest.approx(96.0)


def test_the_card_is_on_record_and_comes_out_of_the_recording_again(school, done):
    visitor, _, lessons = school
    kept = stands(visitor, done[0])
    assert kept["status"] == "finished"
    assert kept["card"]["completed"]
    assert kept["score"] == kept["card"]["score"] > 100  # one point of six
    recording = recorded(*lessons.records.chunks(done[0]))
    again = assess(first_step(), recording).as_dict()
    assert json.loads(json.dumps(again)) == kept["card"]
    assert len(recording.poses) * recording.dt == pytest.approx(kept["card"]["duration_s"] + 1e-3)


def test_it_is_in_the_list_and_in_the_history(school, done):
    visitor = school[0]
    rows = visitor.ask("/api/attempts?trainee=Ada")[1]
    assert done[0] in [row["id"] for row in rows]
    assert visitor.ask("/api/attempts?trainee=Grace")[1] == []
    history = visitor.ask("/api/history?trainee=Ada&task=palpate")[1]
    assert history["attempts"][0]["id"] == done[0]
    assert history["attempts"][0]["passed"]
    assert {"id": 1, "name": "Ada", "attempts": len(rows)} in visitor.ask("/api/trainees")[1]


def test_its_film_is_the_attempt_in_the_streams_frames(school, done):
    visitor = school[0]
    status, sheet = visitor.ask(f"/api/attempts/{done[0]}/film")
    assert (status, sheet["task"], sheet["attempt"]) == (200, "palpate", done[0])
    duration = stands(visitor, done[0])["duration_s"]
    assert sheet["frames"] == pytest.approx(duration / sheet["every_s"], abs=1)
    assert len(sheet["steps_s"]) == 1
    data = visitor.ask(f"/api/attempts/{done[0]}/film/frames?first=0&count=1000")[1]
    assert len(data) == sheet["frame_bytes"] * min(sheet["most_frames"], sheet["frames"])
    last = visitor.ask(f"/api/attempts/{done[0]}/film/frames?first={sheet['frames'] - 1}")[1]
    _, frame = decode_frame(last)
    assert frame.time == pytest.approx(sheet["frames"] * sheet["every_s"])
    right = frame.instruments[1]
    step = first_step().steps[0]
    assert right.tip[:2] == pytest.approx(step.place, abs=step.radius)
    assert step.least < right.force[2] < step.most
    assert frame.heights.min() < -1e-4
    status, refused = visitor.ask(f"/api/attempts/{done[0]}/film/frames?first=100000")
    assert (status, refused["detail"][:12]) == (422, "film: first:")


def test_the_experts_film_needs_no_attempt(school):
    sheet = school[0].ask("/api/tasks/palpate/1/film")[1]
    assert sheet["attempt"] is None
    assert len(sheet["steps_s"]) == 1
    frames = school[0].ask("/api/tasks/palpate/1/film/frames?first=0&count=2")[1]
    assert len(frames) == 2 * sheet["frame_bytes"]


def test_one_attempt_at_a_time_and_it_can_be_given_up(school):
    visitor, trainer, _ = school
    with moved(trainer, first_step(3)):
        number = begin(visitor, level=3)[1]["id"]
        until(lambda: stands(visitor, number)["duration_s"] > 0.4, PATIENCE)
        status, answer = begin(visitor, "Grace")
        assert (status, answer["detail"]) == (
            409,
            f"the trainer: attempt {number} is under way; end it first",
        )
        assert visitor.ask(f"/api/attempts/{number}/end", {})[0] == 202
        until(lambda: stands(visitor, number)["status"] == "finished", PATIENCE)
    card = stands(visitor, number)["card"]
    assert not card["completed"]
    assert card["score"] == 0.0
    assert "What was left: " + first_step(3).steps[0].words in card["advice"][0]
    assert visitor.ask(f"/api/attempts/{number}/end", {})[0] == 422


def test_the_record_says_whether_a_headset_moved_the_instruments(school):
    visitor, trainer, _ = school
    handle = trainer.hello().instruments[1].handle_m

    def hold(tracked):
        trainer.pose(
            1, Pose(instrument=1, sequence=1, present=True, handle=handle, roll=0.0, jaw=1.0, tracked=tracked)
        )

    for entering, device in ((False, "web"), (True, "headset")):
        hold(tracked=False)
        number = begin(visitor)[1]["id"]
        assert stands(visitor, number)["device"] == "web"
        hold(tracked=entering)
        until(lambda number=number: stands(visitor, number)["duration_s"] > 0.4, PATIENCE)
        hold(tracked=False)  # whoever leaves the headset before the end was in it all the same
        visitor.ask(f"/api/attempts/{number}/end", {})
        until(lambda number=number: stands(visitor, number)["status"] == "finished", PATIENCE)
        assert stands(visitor, number)["device"] == device
    hold(tracked=True)
    number = begin(visitor)[1]["id"]
    assert stands(visitor, number)["device"] == "headset"
    visitor.ask(f"/api/attempts/{number}/end", {})
    until(lambda: stands(visitor, number)["status"] != "running", PATIENCE)
    hold(tracked=False)


def test_what_cannot_be_put_on_record_is_said_and_tried_until_it_can(school, monkeypatch):
    visitor, trainer, lessons = school
    full = threading.Event()
    kept = lessons.records.finish

    def finish(number, card, **more):
        if full.is_set():
            raise RecordsFullError("the records: the disk is full")
        kept(number, card, **more)

    monkeypatch.setattr(lessons.records, "finish", finish)
    monkeypatch.setattr("trocar.web.lessons._TRIED_AGAIN", 0.1)
    full.set()
    with moved(trainer, first_step()):
        number = begin(visitor)[1]["id"]
        until(lambda: stands(visitor, number)["duration_s"] > 0.4, PATIENCE)
        visitor.ask(f"/api/attempts/{number}/end", {})
        until(lambda: trainer.guiding().reason == "the records: the disk is full", PATIENCE)
        assert trainer.guiding().state == "marking"
        assert stands(visitor, number)["status"] == "running"
        full.clear()
        until(lambda: stands(visitor, number)["status"] == "finished", PATIENCE)
    assert stands(visitor, number)["card"]["score"] == 0.0


def test_a_task_with_ports_of_its_own_changes_the_stage_and_the_page_is_greeted_again(school):
    visitor, trainer, _ = school
    usual = trainer.hello()
    with visitor.live() as (stream, greeting):
        number = begin(visitor, task="oblique-reach")[1]["id"]
        assert trainer.hello().instruments[0].port_m != usual.instruments[0].port_m
        greeted = []
        deadline = time.monotonic() + PATIENCE
        while not greeted and time.monotonic() < deadline:
            message = stream.recv(timeout=10)
            if isinstance(message, bytes):
                stream.send(json.dumps({"type": "ack", "sequence": int.from_bytes(message[4:8], "little")}))
            elif '"hello"' in message:
                greeted.append(json.loads(message))
        assert greeted[0]["instruments"] != greeting["instruments"]
        visitor.ask(f"/api/attempts/{number}/end", {})
        until(lambda: stands(visitor, number)["status"] != "running", PATIENCE)
    assert stands(visitor, number)["status"] == "interrupted"  # nobody held an instrument
    assert stands(visitor, number)["reason"] == "nobody held an instrument"


def test_what_takes_long_to_be_set_up_is_said_and_when_it_is_over(school, monkeypatch):
    visitor, trainer, _ = school
    monkeypatch.setattr("trocar.web.lessons._TOLD_AFTER", 0.0)
    trainer.notices()
    name = "lift" if trainer.stage.suits(catalogue.task("oblique-reach")) else "oblique-reach"
    number = begin(visitor, task=name)[1]["id"]
    told = [notice.text for notice in trainer.notices()]
    assert told[0].startswith("The task's tissue is being set up; the first time its code is compiled")
    assert told[1:] == ["The task's tissue is ready."]
    visitor.ask(f"/api/attempts/{number}/end", {})
    until(lambda: stands(visitor, number)["status"] != "running", PATIENCE)


def test_on_another_tissue_no_frame_comes_before_its_greeting(school):
    """The sheet has one layer, the pad two, skin three; a page shown other layers than it was told of gives up."""
    visitor, _, _ = school
    # Where the sheet's code is compiled first, beginning takes longer than a stream is kept that nobody reads.
    number = begin(visitor, task="cut-along-the-line")[1]["id"]
    visitor.ask(f"/api/attempts/{number}/end", {})
    until(lambda: stands(visitor, number)["status"] != "running", PATIENCE)
    seen = []
    with visitor.live() as (stream, greeting):
        layers = len(greeting["tissue"]["layers"])

        def watch():
            nonlocal layers
            message = stream.recv(timeout=10)
            if isinstance(message, bytes):
                sequence, snapshot = decode_frame(message)
                stream.send(json.dumps({"type": "ack", "sequence": sequence}))
                seen.append((layers, len(snapshot.heights)))
                assert (snapshot.cut is not None) == (len(snapshot.heights) == 1)  # the sheet's alone
            elif '"hello"' in message:
                layers = len(json.loads(message)["tissue"]["layers"])

        for task, expected in (("find-nodule", 2), ("palpate", 3), ("cut-along-the-line", 1)):
            number = begin(visitor, task=task)[1]["id"]
            deadline = time.monotonic() + PATIENCE
            while seen[-5:] != [(expected, expected)] * 5 and time.monotonic() < deadline:
                watch()
            visitor.ask(f"/api/attempts/{number}/end", {})
            until(lambda number=number: stands(visitor, number)["status"] != "running", PATIENCE)
    assert {own for own, _ in seen} == {1, 2, 3}
    assert [pair for pair in seen if pair[0] != pair[1]] == []


@pytest.mark.parametrize(
    ("path", "body", "status", "words"),
    [
        ("/api/attempts", {"trainee": "Ada", "task": "palpat"}, 422, "did you mean palpate?"),
        ("/api/attempts", {"trainee": "Ada", "task": "palpate", "level": 7}, 422, "level: expected 1 to 3"),
        ("/api/attempts", {"trainee": "Ada", "task": "palpate", "level": "1"}, 422, "level: "),
        ("/api/attempts", {"trainee": "  ", "task": "palpate"}, 422, "name"),
        ("/api/attempts", {"trainee": "Ada", "task": "palpate", "extra": 1}, 422, "extra"),
        ("/api/attempts", {"trainee": "Ada"}, 422, "task: it is missing; /api/openapi.json tells"),
        ("/api/attempts", {"trainee": "a\u200bb", "task": "palpate"}, 422, "characters that can be seen"),
        ("/api/attempts", {"trainee": "Scripted expert", "task": "palpate"}, 422, "programs"),
        ("/api/attempts", b"{", 422, "json"),
        ("/api/attempts/99999/end", {}, 422, "under way"),
        ("/api/trainees", {"name": "x" * 500}, 422, "name"),
        ("/api/answers", {"trainee": "Ada", "group": "novice", "values": {"picture": 6}}, 422, "picture"),
        ("/api/answers", {"trainee": "Ada", "group": "nobody", "values": {"picture": 5}}, 422, "group"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(school, path, body, status, words):
    found, answer = school[0].ask(path, body)
    assert found == status
    assert words in answer["detail"]


def test_what_is_not_there_is_not_found(school):
    assert school[0].ask("/api/attempts/99999")[0] == 404
    assert school[0].ask("/api/attempts/99999/film")[0] == 404


@pytest.mark.parametrize("body", [None, {}])
def test_a_path_that_there_is_not_answers_with_a_sentence(school, body):
    told = {"detail": "/api/atempts: there is nothing here; /api/openapi.json tells what is expected"}
    assert school[0].ask("/api/atempts", body) == (404, told)


def test_a_path_that_takes_something_else_says_what(school):
    told = {"detail": "/api/tasks: expected GET, got POST; /api/openapi.json tells what is expected"}
    assert school[0].ask("/api/tasks", {}) == (405, told)


def test_the_questionnaire_is_asked_and_kept(school):
    visitor, _, lessons = school
    asked = visitor.ask("/api/questionnaire")[1]
    values = dict.fromkeys(asked["items"], 4)
    answer = visitor.ask("/api/answers", {"trainee": "Ada", "group": "resident", "values": values})
    assert answer == (201, {"kept": len(values)})
    assert lessons.records.answers()[-1].values == values


def test_the_interface_describes_itself(school):
    paths = school[0].ask("/api/openapi.json")[1]["paths"]
    assert {"/api/tasks", "/api/attempts", "/api/attempts/{number}/film"} <= set(paths)

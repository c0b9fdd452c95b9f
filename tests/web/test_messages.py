"""Text messages: what a client may send, and that what the server says is finite and whole."""

import pytest
from pydantic import ValidationError

from trocar.training.tasks.catalogue import task
from trocar.web.asking import asking
from trocar.web.messages import Acknowledgement, Camera, Hello, Notice, Reset, read_client_message
from web.scripted_source import HELLO


def test_what_a_client_may_say():
    assert read_client_message('{"type": "ack", "sequence": 4294967295}') == Acknowledgement(
        sequence=2**32 - 1
    )
    assert read_client_message('{"sequence": 0, "type": "ack"}') == Acknowledgement(sequence=0)
    assert read_client_message(' {"type": "reset"} ') == Reset()


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{}",
        "null",
        '{"type": "ack"}',
        '{"type": "ack", "sequence": true}',
        '{"type": "ack", "sequence": 4294967296}',
    ],
)
def test_what_it_may_not(text):
    with pytest.raises(ValueError, match="validation error"):
        read_client_message(text)


def test_a_greeting_holds_finite_numbers_only():
    with pytest.raises(ValidationError):
        Camera(port_m=(0.0, 0.0, float("nan")), target_m=(0.0, 0.0, 0.0))


def test_the_pages_hands_steer_unless_the_trainer_says_otherwise():
    assert HELLO.steered_by == "page"
    assert HELLO.model_copy(update={"steered_by": "trainer"}).model_dump()["steered_by"] == "trainer"
    with pytest.raises(ValidationError):
        Hello.model_validate(HELLO.model_dump() | {"steered_by": "nobody"})


def test_a_notice_has_a_known_level():
    with pytest.raises(ValidationError):
        Notice(level="shout", text="hello")


def test_the_block_is_as_thick_as_its_layers():
    assert HELLO.tissue.thickness == pytest.approx(0.0121, rel=1e-12)


def test_what_must_be_found_is_shown_when_it_is_over_and_not_before():
    step = task("find-nodule").steps[0]
    assert asking(step)["marks"] == ()
    assert asking(step, hidden=True)["marks"][0].place_m == step.place
    assert asking(task("palpate").steps[0])["marks"] != ()

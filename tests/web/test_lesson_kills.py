"""Whoever is killed, what was done of an attempt is on record. `bench/lesson_kills.py` does it a hundred times."""

from web.doomed_lesson import Trainer


def test_a_killed_servo_and_a_killed_trainer_leave_the_attempt_up_to_its_last_second(tmp_path):
    trainer = Trainer(tmp_path)
    try:
        without_servo = trainer.lesson(1.7, kill_servo=True)
        alone = trainer.lesson(1.3, kill_servo=False)
    finally:
        trainer.close()
    assert without_servo.good, without_servo
    assert without_servo.reason == "the servo ended"
    assert alone.good, alone
    assert alone.acknowledged > 0.0

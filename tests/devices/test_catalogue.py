"""Devices by name."""

import pytest

from trocar.devices.catalogue import DEVICES, device
from trocar.errors import InputError


def test_every_entry_is_what_its_device_says(tmp_path):
    recording = tmp_path / "moves.csv"
    recording.write_text(
        "# trocar recording, version 1\n"
        "time_s,instrument,present,handle_x_m,handle_y_m,handle_z_m,roll_rad,jaw\n"
        "0,left,0,0,0,0,0,0\n"
    )
    options = {"recorded": {"recording": recording}}
    assert list(DEVICES) == ["simulated", "recorded", "web"]
    for name, entry in DEVICES.items():
        made = device(name, **options.get(name, {}))
        assert made.name == name == entry.as_dict()["name"]
        for word in ("description", "steered_by_page", "every_tick"):
            assert getattr(made, word) == getattr(entry, word)


def test_options_reach_the_device():
    assert device("simulated", script="press").duration != device("simulated", script="lift").duration


@pytest.mark.parametrize(
    ("name", "options", "said"),
    [
        ("simulatd", {}, "did you mean simulated?"),
        ("haptic", {}, "one of simulated, recorded, web"),
        ("web", {"seed": 3}, "web device: seed: expected no such option, got 3; leave it out"),
        ("recorded", {}, "recorded device: expected the option --recording"),
    ],
)
def test_what_is_not_there_is_refused(name, options, said):
    with pytest.raises(InputError, match=said):
        device(name, **options)

"""Tremor and noise: their size, their band, and that they repeat."""

import numpy as np
import pytest

from trocar.devices.unsteadiness import HIGHEST, LOWEST, SensorNoise, Tremor
from trocar.errors import InputError

TIMES = np.arange(0, 60, 0.005)


def sampled(source):
    return np.array([source.at(time) for time in TIMES])


@pytest.mark.parametrize("seed", ["0 left", "0 right", "7 left"])
def test_tremor_has_the_asked_amplitude_and_band(seed):
    moved = sampled(Tremor(seed, 2e-4))
    # Fifteen sines over a minute: what is left of their products is a few per cent, unless two nearly coincide.
    assert np.sqrt((moved**2).sum(axis=1).mean()) == pytest.approx(2e-4, rel=0.2)
    power = (np.abs(np.fft.rfft(moved * np.hanning(len(moved))[:, None], axis=0)) ** 2).sum(axis=1)
    frequency = np.fft.rfftfreq(len(TIMES), 0.005)
    inside = (frequency > LOWEST - 0.1) & (frequency < HIGHEST + 0.1)
    assert power[inside].sum() / power.sum() > 0.999


def test_noise_has_the_asked_deviation_at_each_reading():
    noise = SensorNoise("0 left", 1e-5)
    readings = np.array([noise.at(number / 100) for number in range(4000)])
    assert readings.std(axis=0) == pytest.approx(1e-5, rel=0.05)  # 4000 draws: 1.1 % each way
    assert readings.mean(axis=0) == pytest.approx(np.zeros(3), abs=1e-6)
    assert np.corrcoef(readings[:-1, 0], readings[1:, 0])[0, 1] == pytest.approx(0.0, abs=0.06)


@pytest.mark.parametrize("kind", [Tremor, SensorNoise])
def test_it_is_a_function_of_seed_and_time_alone(kind):
    one, other = kind("3 left"), kind("3 left")
    shuffled = np.random.default_rng(1).permutation(TIMES[:200])
    assert {time: one.at(time) for time in TIMES[:200]} == {time: other.at(time) for time in shuffled}
    assert kind("3 right").at(1.0) != one.at(1.0)
    assert kind("4 left").at(1.0) != one.at(1.0)


@pytest.mark.parametrize("kind", [Tremor, SensorNoise])
def test_none_is_none(kind):
    assert not sampled(kind("3 left", 0.0)).any()


@pytest.mark.parametrize("kind", [Tremor, SensorNoise])
@pytest.mark.parametrize("amplitude", [-1e-6, 0.01, float("nan"), float("inf")])
def test_an_impossible_amplitude_is_refused(kind, amplitude):
    with pytest.raises(InputError, match="amplitude"):
        kind("3 left", amplitude)

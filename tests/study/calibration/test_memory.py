"""Creep out of static answers: against a closed form and against steps of the whole model."""

import itertools

import numpy as np
import pytest

from pressed_pads import blank, pad, triangle
from trocar.study.calibration.memory import Creeping, at_rate
from trocar.study.calibration.parameter import Specimen
from trocar.study.calibration.probes import probes
from trocar.study.calibration.response import builder, response

G, TAU = 0.7, 0.6
HOLD = np.linspace(0.0, 6.0, 49)
RAMP = 0.05 * np.minimum(HOLD, 1.0)


def spring(specimen):
    return np.array([1.0 / specimen.tissue.layers[1].young_modulus])


def test_a_standard_linear_solid_creeps_as_in_the_books():
    case = pad(prony=((G, TAU),))
    record = blank(HOLD, RAMP)
    read = probes(record, case.tissue, np.zeros((2, 3)))
    rows, at_once = Creeping(spring, record, read)(Specimen(tissue=case.tissue))
    # J(t) = 1/E (1 - g/(1 + g) exp(-t/theta)), theta = tau (1 + g); under a ramp of rate R that stops after a second
    theta, lost = TAU * (1 + G), G / (1 + G)

    def grown(t):
        return np.where(t > 0, t - lost * theta * (1 - np.exp(-np.maximum(t, 0.0) / theta)), 0.0)

    compliance = 1 / case.tissue.layers[1].young_modulus
    exact = 0.05 * compliance * (grown(HOLD) - grown(HOLD - 1.0))
    # collocation at five rates a decade: 3e-5 for sums of exponentials
    assert np.abs(rows - exact).max() < 5e-5 * exact.max()
    step = compliance * (1 - lost * np.exp(-HOLD[1] / theta))
    assert at_once == pytest.approx(step, rel=1e-3)


def test_the_ends_of_the_transform_are_the_long_and_the_sudden_load():
    specimen = Specimen(tissue=pad(prony=((G, TAU),)).tissue)
    layer = specimen.tissue.layers[1]
    assert at_rate(specimen, 0.0).tissue.layers[1].young_modulus == layer.young_modulus
    assert at_rate(specimen, np.inf).tissue.layers[1].young_modulus == layer.instantaneous_modulus
    assert at_rate(specimen, 1 / TAU).tissue.layers[1].young_modulus == pytest.approx(
        layer.young_modulus * (1 + G / 2)
    )


def test_layers_that_remember_follow_as_the_exact_step_says():
    case = pad(prony=((G, TAU),), prestress_x=1e3, prestress_y=1e3)
    time, force = triangle(17)
    specimen = Specimen(tissue=case.tissue)
    predict, read = response(case, "wave-solid", blank(time, force), specimen, ())
    rows, _ = predict(specimen)
    model, tool = builder(case, "wave-solid")(specimen), case.tools[0]
    state, depths = model.init(), [0.0]
    for f0, f1 in itertools.pairwise(force):
        state = model.step(state, (tool.press(f0),), (tool.press(f1),), float(time[1]))
        depths.append(-model.displacement(state, read.points)[0, 2])
    assert np.abs(rows - depths).max() < 5e-5 * max(depths)

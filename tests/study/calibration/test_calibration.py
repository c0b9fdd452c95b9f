"""Whole calibrations: what each kind of case gives back, and what is refused or warned of."""

from dataclasses import replace

import numpy as np
import pytest

from pressed_pads import PEAK, blank, filled, pad, softer, triangle
from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.reference.fea import FEASolid
from trocar.study.calibration.calibration import calibrate
from trocar.study.calibration.measurement import Readings
from trocar.study.calibration.parameter import parameters
from trocar.study.calibration.response import first_specimen, response
from trocar.study.cases.experiment import Sampling
from trocar.study.history import run
from trocar.study.models import MODELS

NAME = "body.young_modulus"
NOISE = 2e-6  # [m]


def test_intervals_hold_the_truth_of_an_independent_solver() -> None:
    """Twenty records of finite elements: with p = 0.95 each, 15 or fewer of 20 have a probability of 0.003."""
    case = pad()
    truth = softer(pad(young_modulus=5e4), 1.3)
    time, force = triangle(rows=61)
    places = 1e-3 * np.array([[20.5, 15.0], [15.0, 22.0], [26.0, 15.0]])
    model = FEASolid(truth, size=case.size, support=case.support, around=case.load_at(0.0), massless=True)
    state = model.static((case.tools[0].press(1.0),))
    depth = -model.displacement(state, np.array([[0.015, 0.015, 0.0]]))[0, 2] * force
    sunk = np.outer(force[5::5], model.displacement(state, np.column_stack([places, np.zeros(3)]))[:, 2])
    held = np.zeros(2)
    for seed in range(20):
        shake = np.random.default_rng(seed)

        def noisy(values: FloatArray, size: float, shake: np.random.Generator = shake) -> FloatArray:
            return values + shake.normal(0.0, size, len(values))

        marks = Readings(
            name="markers' uz",
            time=np.repeat(time[5::5], 3),
            places=np.tile(places, (len(sunk), 1)),
            value=noisy(sunk.ravel(), NOISE),
        )
        record = blank(time, noisy(force, 1e-4), marks)
        record = replace(record, series=(replace(record.series[0], value=noisy(depth, NOISE)), marks))
        done = calibrate(record, case, (NAME, "skin.young_modulus"), hold_out=0.0, noise_force=1e-4)
        for i, (one, true) in enumerate(zip(done.known.estimates, (1.56e4, 5e4), strict=True)):
            assert one.low is not None
            assert one.high is not None
            held[i] += one.low <= true <= one.high
    assert (held >= 16).all()


@pytest.mark.parametrize(
    ("case", "model", "names"),
    [
        (pad(tilt=0.3), "wave-solid", (NAME,)),
        (pad(support="edges+base"), "wave-solid", (NAME,)),
        (pad(contact="rigid"), "wave-solid", (NAME,)),
        (pad(prony=((0.5, 0.4),)), "wave-solid", ("body.prony[0].g", "body.prony[0].tau")),
        (pad(), "wave-membrane", ("foundation",)),
    ],
    ids=["tilted", "clamped", "rigid", "remembers", "sheets"],
)
def test_every_kind_of_case_gives_its_own_parameter_back(case, model, names):
    record = blank(*triangle(rows=25))
    start = first_specimen(case, model, names)
    wanted, true = parameters(names, start), start
    for one in wanted:
        true = one.put(true, 1.2 * one.get(start))
    rows, _ = response(case, model, record, start, wanted)[0](true)
    record = replace(record, series=(replace(record.series[0], value=rows),))
    done = calibrate(record, case, names, model=model, hold_out=0.0)
    for one in done.known.estimates:
        assert one.value == pytest.approx(one.parameter.get(true), rel=1e-3)
    assert done.warnings == ()


def test_a_moving_tissue_is_followed_as_compare_does():
    case = replace(pad(dynamic=True), sampling=Sampling(period=1e-3, dynamic=True))
    history = run(case, "wave-solid", MODELS["wave-solid"])
    record = blank(history.time, history.force)
    start = first_specimen(case, "wave-solid", ())
    rows, _ = response(case, "wave-solid", record, start, ())[0](start)
    depth = history.deflection["skin"]
    # in motion the lowest point wanders by parts of a millimetre, and this one stays
    assert np.abs(rows - depth).max() < 1e-3 * depth.max()


def test_the_end_of_a_record_is_predicted():
    case = pad()
    record = filled(blank(*triangle(rows=81)), case, softer(case, 1.4), noise=NOISE)
    done = calibrate(record, case, (NAME,))
    assert done.held_out is not None
    assert done.held_out.time[0] > 1.5
    assert 0.6 < done.held_out.ratio < 1.5  # 20 rows: four standard errors
    assert "the last 25 % of pad.csv" in done.held_out.sentence
    assert done.as_dict()["held_out"]["holds"] is True


def test_another_record_is_predicted_and_one_of_another_tissue_is_not():
    case = pad()
    record = filled(blank(*triangle(rows=81)), case, softer(case), noise=NOISE)
    other = replace(
        filled(blank(*triangle(rows=51)), case, softer(case), noise=NOISE, offset=4e-5, seed=5),
        source="other.csv",
    )
    good = calibrate(record, case, (NAME,), check=other).held_out
    assert good is not None
    assert good.holds
    assert good.own_zero
    assert "In other.csv" in good.sentence
    stiff = replace(filled(other, case, softer(case, 1.5), noise=NOISE), source="other.csv")
    bad = calibrate(record, case, (NAME,), check=stiff).held_out
    assert bad is not None
    assert not bad.holds
    assert "do not trust" in bad.sentence


def bent(time, force, depth):
    return depth * (1 - 0.5 * force / PEAK)


def looped(time, force, depth):
    return depth + 0.1 * depth.max() * np.where(time > 1.0, np.sin(np.pi * time / 2), 0.0)


def crept(time, force, depth):
    return depth * (1 + 0.05 * np.log1p(np.maximum(time - 1, 0.0) / 0.1))


@pytest.mark.parametrize(
    ("change", "held", "words"),
    [
        (bent, False, "stiffens as the force grows"),
        (looped, False, "otherwise as the force rises than as it falls"),
        (crept, True, "goes on while the force stands still"),
    ],
)
def test_readings_that_a_model_cannot_follow_are_told_with_the_reason(change, held, words):
    case = pad()
    time, force = triangle(rows=81)
    if held:
        force = PEAK * np.minimum(time, 1.0)
    record = filled(blank(time, force), case, softer(case), noise=1e-7)
    depth = replace(record.series[0], value=change(time, force, record.series[0].value))
    done = calibrate(replace(record, series=(depth,)), case, (NAME,), hold_out=0.0)
    assert any("cannot follow the displacement" in one and words in one for one in done.warnings), (
        done.warnings
    )


def test_an_offset_and_a_large_force_are_told():
    case = pad()
    time, force = triangle()
    record = filled(blank(time, force), case, softer(case, 0.02), offset=2e-3)
    warned = " ".join(calibrate(record, case, (NAME,), hold_out=0.0).warnings)
    assert "the offset was estimated" in warned
    assert "beyond the linear range" in warned


def test_a_depth_is_read_where_the_fitted_face_is_lowest():
    case = pad()  # a body forty times as stiff is stiffer than the skin, which then sinks beside the middle
    record = filled(blank(*triangle()), case, softer(case, 40.0))
    done = calibrate(record, case, (NAME,), hold_out=0.0)
    assert done.known.estimates[0].value == pytest.approx(40 * 1.2e4, rel=1e-3)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda d: 1e-3 * d, "a unit a thousand off"),
        (lambda d: 1e3 * d, "a unit a thousand off"),
    ],
)
def test_a_unit_that_is_off_is_refused(change, words):
    case = pad()
    record = filled(blank(*triangle()), case, softer(case))
    record = replace(record, series=(replace(record.series[0], value=change(record.series[0].value)),))
    with pytest.raises(InputError, match=words):
        calibrate(record, case, (NAME,))


def test_exchanged_columns_are_refused():
    case = pad()
    record = filled(blank(*triangle()), case, softer(case))
    depth = record.series[0].value
    swapped = replace(
        record, force=1e3 * depth, series=(replace(record.series[0], value=1e-3 * record.force),)
    )
    with pytest.raises(InputError, match="look exchanged"):
        calibrate(swapped, case, (NAME,))


@pytest.mark.parametrize(
    ("case", "options", "words"),
    [
        (pad(), {"model": "wave-mesh"}, "--model: expected one of"),
        (pad(contact="rigid"), {"model": "fea"}, "takes a rigid tip"),
        (pad(prony=((0.5, 1.0),)), {"model": "wave-membrane"}, "Prony series"),
        (pad(), {"hold_out": 0.95}, "--hold-out"),
        (pad(), {"hold_out": 0.9}, "rows to fit"),
        (pad(), {"noise_force": -1.0}, "--noise-n"),
        (pad(), {"model_error": 2.0}, "--model-error"),
    ],
)
def test_what_cannot_be_calibrated_is_refused(case, options, words):
    with pytest.raises(InputError, match=words):
        calibrate(blank(*triangle()), case, (NAME,), **options)


def test_a_record_that_begins_under_load_is_refused_where_layers_remember():
    time, force = triangle()
    with pytest.raises(InputError, match="begins before the load"):
        calibrate(blank(time[10:], force[10:]), pad(prony=((0.5, 1.0),)), (NAME,))

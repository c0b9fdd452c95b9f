"""Two-layer pads and records of pressing them, that tests of calibration share."""

from dataclasses import replace

import numpy as np

from trocar.study.calibration.fit import Problem
from trocar.study.calibration.measurement import DEPTH, Measurement, Readings
from trocar.study.calibration.parameter import parameters
from trocar.study.calibration.response import first_specimen, response
from trocar.study.cases.experiment import case_from_tissue
from trocar.study.cases.tool import Contact, Tip, Tool
from trocar.tissues import Layer, Tissue

SIDE = 0.03
PEAK = 0.05


def pad(*, prony=(), support="base", contact="dead", tip="flat", tilt=0.0, dynamic=False, place=None, **skin):
    """A small pad under a tool of 8 mm; keywords change the skin."""
    layers = (
        Layer(
            **({"name": "skin", "thickness": 2e-3, "young_modulus": 6e4, "poisson_ratio": 0.48} | skin),
            density=1070.0,
        ),
        Layer(
            name="body",
            thickness=8e-3,
            young_modulus=1.2e4,
            poisson_ratio=0.48,
            density=1e3,
            prony=prony,
            loss_factor=0.2,
        ),
    )
    tool = Tool(
        diameter=8e-3,
        position=place or (SIDE / 2, SIDE / 2),
        peak=PEAK,
        rate=5.0 if dynamic else 0.05,
        tilt=tilt,
        tip=Tip(tip),
        contact=Contact(contact),
    )
    return case_from_tissue(
        tissue=Tissue(layers=layers),
        size=(SIDE, SIDE),
        tools=(tool,),
        support=support,
        dynamic=dynamic,
        title="pad",
    )


def triangle(rows=41, duration=2.0):
    """Times and a force that goes up and down."""
    time = np.linspace(0.0, duration, rows)
    return time, 2 * PEAK / duration * np.minimum(time, duration - time)


def blank(time, force, *more):
    """A record that has still to be filled with readings of the depth."""
    depth = Readings(name=DEPTH, time=time, value=force * 1e-3)
    return Measurement(source="pad.csv", time=time, force=force, series=(depth, *more))


def filled(measurement, case, true, *, model="wave-solid", noise=0.0, offset=0.0, seed=0):
    """The record as a model of the true case reads it, with noise and an offset [m] in the depth."""
    specimen = first_specimen(replace(case, tissue=true), model, ())
    rows, _ = response(replace(case, tissue=true), model, measurement, specimen, ())[0](specimen)
    shake = np.random.default_rng(seed)
    series, first = [], 0
    for one in measurement.series:
        value = rows[first : first + len(one.time)] + shake.normal(0.0, noise, len(one.time)) * (noise > 0)
        series.append(replace(one, value=value + (offset if one.places is None else 0.0)))
        first += len(one.time)
    return replace(measurement, series=tuple(series))


def softer(case, share=1.0, **body):
    """The case's layers, the body's modulus changed by a share and its other fields as named."""
    skin, old = case.tissue.layers
    return Tissue(layers=(skin, replace(old, young_modulus=old.young_modulus * share, **body)))


def problem(case, measurement, names, model="wave-solid", **fields):
    """What `fit` takes."""
    start = first_specimen(case, model, names)
    wanted = parameters(names, start)
    predict, read = response(case, model, measurement, start, wanted)
    used = np.ones(len(read.time), dtype=bool)
    return Problem(
        measurement=measurement,
        probes=read,
        response=predict,
        parameters=wanted,
        start=start,
        used=used,
        **fields,
    )

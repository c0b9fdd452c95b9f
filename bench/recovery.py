"""Fit waves to noisy finite elements a hundred times: how often do 95 % intervals hold the truth?

    python bench/recovery.py [--repetitions 100] [--case elastic|memory]

The pads and their noise are those of `bench/phantom.py`. `FEASolid` presses each once, on its default mesh; every
repetition adds its own noise to force, depth and markers and calibrates `WaveSolid`, which differs from the finite
elements by what the first line says (bias). The elastic pad's skin and body are fitted to depth and markers, the body's
modulus, weight and relaxation time to a ramp that is held. Printed for each parameter: how often the interval holds the
truth, the estimates' mean error and spread, and the mean half width of the intervals, all relative to the truth.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from time import perf_counter

import numpy as np
from phantom import (
    BODY,
    DEPTH_NOISE,
    EXAMPLES,
    FORCE_NOISE,
    MARKER_EVERY,
    MARKER_NOISE,
    PRONY,
    SKIN,
    Truth,
    truth,
)

from trocar.study.calibration.calibration import calibrate
from trocar.study.calibration.measurement import DEPTH, Measurement, Readings
from trocar.study.calibration.parameter import Specimen, parameters
from trocar.study.calibration.response import response
from trocar.study.cases.reading import load_case

TRUE = {
    "body.young_modulus": BODY,
    "skin.young_modulus": SKIN,
    "body.prony[0].g": PRONY[0][0],
    "body.prony[0].tau": PRONY[0][1],
}
CASES = {
    "elastic": ("phantom.toml", ("body.young_modulus", "skin.young_modulus")),
    "memory": ("phantom-hold.toml", ("body.young_modulus", "body.prony[0].g", "body.prony[0].tau")),
}


def measured(found: Truth, noise: np.random.Generator | None, *, markers: bool) -> Measurement:
    """Return the truth as a record, with noise or without."""

    def shake(size: float, values: np.ndarray) -> np.ndarray:
        return values if noise is None else values + noise.normal(0.0, size, values.shape)

    depth = Readings(name=DEPTH, time=found.time, value=shake(DEPTH_NOISE, found.depths[0]))
    rows = np.arange(MARKER_EVERY // 2, len(found.time), MARKER_EVERY)
    seen = Readings(
        name="markers' uz",
        time=np.repeat(found.time[rows], len(found.places)),
        places=np.tile(found.places[:, :2], (len(rows), 1)),
        value=shake(MARKER_NOISE, found.markers[:, rows].T.ravel()),
    )
    return Measurement(
        source="synthetic",
        time=found.time,
        force=shake(FORCE_NOISE, found.force),
        series=(depth, seen) if markers else (depth,),
    )


def recover(name: str, repetitions: int) -> None:
    """Print one case."""
    file, names = CASES[name]
    case = load_case(EXAMPLES / file)
    remembers = name == "memory"
    found = truth(case, remembers=remembers)
    clean = measured(found, None, markers=not remembers)
    true = Specimen(tissue=case.tissue)
    for parameter in parameters(names, true):
        true = parameter.put(true, TRUE[parameter.name])
    predict, read = response(
        replace(case, tissue=true.tissue), "wave-solid", clean, true, parameters(names, true)
    )
    part = read.parts[0]
    bias = np.abs(predict(true)[0][part] - clean.series[0].value).max() / clean.series[0].value.max()
    began = perf_counter()
    inside, errors, widths = [], [], []
    for seed in range(repetitions):
        record = measured(found, np.random.default_rng([seed, remembers]), markers=not remembers)
        done = calibrate(record, case, names, hold_out=0.0, noise_force=FORCE_NOISE)
        estimates = done.known.estimates
        inside.append([one.told and one.low <= TRUE[one.parameter.name] <= one.high for one in estimates])
        errors.append([one.value / TRUE[one.parameter.name] - 1 for one in estimates])
        widths.append([1.96 * one.error for one in estimates])
    seconds = (perf_counter() - began) / repetitions
    print(f"\n{name}: bias of the waves {100 * bias:.2f} % of the depth, {seconds:.2f} s a fit")
    print(
        "| parameter | intervals that hold the truth | mean error | spread | half width |\n|---|---|---|---|---|"
    )
    for parameter, hits, error, width in zip(
        names, np.sum(inside, axis=0), np.array(errors).T, np.array(widths).T, strict=True
    ):
        print(
            f"| {parameter} | {hits} of {repetitions} | {100 * error.mean():+.2f} % | {100 * error.std():.2f} % | "
            f"{100 * width.mean():.2f} % |"
        )


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repetitions", type=int, default=100)
    parser.add_argument("--case", choices=CASES, default=None)
    arguments = parser.parse_args()
    for name in CASES if arguments.case is None else (arguments.case,):
        recover(name, arguments.repetitions)


if __name__ == "__main__":
    main()

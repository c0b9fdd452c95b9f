"""Recompute a score card from an attempt's table, by code of its own that imports nothing of trocar.

Run: python bench/recompute_metrics.py attempt.csv card.json. It reads attempt.task.json beside the table, follows
docs/explanation/scores.md, prints every metric twice, and exits 1 if one differs by more than 1e-6 of itself.

    trocar train --headless --device simulated --task palpate --out attempt.rec --json > card.json

writes a recording and its card, and `trocar replay RECORDING --table` the table.
"""

from __future__ import annotations

import argparse
import csv
import json
import sys
from itertools import pairwise
from math import hypot, inf, isnan, log, nan, sqrt
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline, InterpolatedUnivariateSpline
from scipy.signal import butter, freqz, sosfilt, sosfilt_zi

RELATIVE = 1e-6
RATE, CUTOFF, PADDING = 100.0, 6.0, 0.5  # [Hz], [Hz], [s]
USED, MOVING, MOVEMENT, TOUCHING = 5e-3, 5e-3, 0.4, 1e-3  # [m], [m/s], [s], [N]
QUIET, STRIDE, TURN = (20.0, 45.0), 1e-4, 1e-3  # [Hz], [m], [rad]
AGAIN = 0.5  # [s]
TOO_MUCH = "used too much force"


def read_table(path):
    """Return the table's columns by instrument: {"left": {column: array}, "right": ...}."""
    found = {}
    with Path(path).open(newline="", encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            found.setdefault(row.pop("instrument"), []).append([float(value) for value in row.values()])
            names = list(row)
    return {hand: dict(zip(names, np.array(rows).T, strict=True)) for hand, rows in found.items()}


def both_ways(values, rate, band=CUTOFF):
    """Filter forwards and backwards, from a steady state, the motion continued by its point reflection at both ends."""
    sections = butter(4, band, "lowpass" if band is CUTOFF else "bandpass", fs=rate, output="sos")
    steady = sosfilt_zi(sections)
    count = min(len(values) - 1, round(PADDING * rate))
    longer = np.concatenate(
        [2 * values[0] - values[count:0:-1], values, 2 * values[-1] - values[-2 : -count - 2 : -1]]
    )
    for _ in range(2):
        longer = sosfilt(sections, longer, zi=steady * longer[0])[0][::-1]
    return longer[count : count + len(values)]


def white(rate, band, derivative):
    """Return the mean square of a derivative of white noise of one-sided density 1, filtered both ways."""
    kind = "lowpass" if band is CUTOFF else "bandpass"
    at, response = freqz(*butter(4, band, kind, fs=rate), worN=100_001, fs=rate, include_nyquist=True)
    return trapezium((2 * np.pi * at) ** (2 * derivative) * np.abs(response) ** 4, at)


def walked(places, stride):
    """Return the places that are a stride or more from the one before them that was returned, and the last."""
    found = [places[0]]
    for place in places[1:]:
        if sqrt(sum((place - found[-1]) ** 2)) >= stride:
            found.append(place)
    return [*found, places[-1]]


class Motion:
    """Columns of one instrument while it is in the hand: filtered, sampled at 100 Hz, with quintic splines."""

    def __init__(self, hand, names):
        here = hand["present"] != 0
        at = hand["time_s"][here]
        seconds = at[-1] - at[0]
        rate = max(1 / float(np.median(np.diff(at))), RATE)
        even = np.linspace(at[0], at[-1], max(round(seconds * rate), 8) + 1)
        self.times = np.linspace(at[0], at[-1], max(round(seconds * RATE), 8) + 1)
        rate = (len(even) - 1) / (even[-1] - even[0])
        read = [np.interp(even, at, hand[name][here]) for name in names]
        self.columns = [CubicSpline(even, both_ways(column, rate))(self.times) for column in read]
        floor = sum(float((both_ways(column, rate, QUIET) ** 2).mean()) for column in read)
        self.noise = seconds * floor / white(rate, QUIET, 0) * white(rate, CUTOFF, 3)
        self.splines = [InterpolatedUnivariateSpline(self.times, column, k=5) for column in self.columns]

    @property
    def seconds(self):
        """From the first sample to the last [s]."""
        return self.times[-1] - self.times[0]

    def length(self, stride=STRIDE):
        """Return the sum of the distances between samples a stride apart."""
        return sum(sqrt(sum((b - a) ** 2)) for a, b in pairwise(walked(np.array(self.columns).T, stride)))

    def speed(self):
        """Return the speed at every sample."""
        return np.sqrt(sum(spline.derivative()(self.times) ** 2 for spline in self.splines))

    def jerk_squared(self):
        """Return the time integral of the squared jerk, five trapezia to a sample, less what noise adds."""
        fine = np.linspace(self.times[0], self.times[-1], 5 * (len(self.times) - 1) + 1)
        values = sum(spline.derivative(3)(fine) ** 2 for spline in self.splines)
        return max(0.0, trapezium(values, fine) - self.noise)


def arc_length(speed):
    """Return SPARC of one movement."""
    count = 2 ** (int(np.ceil(np.log2(len(speed)))) + 4)
    height = np.abs(np.fft.rfft(speed, count))
    height = height[: int(10.0 * count / RATE) + 1] / height.max()
    last = max(at for at, one in enumerate(height) if one >= 0.05)
    first = min(at for at, one in enumerate(height) if one >= 0.05)
    return -sum(hypot(1 / (last - first), b - a) for a, b in pairwise(height[first : last + 1].tolist()))


def median_arc_length(speed):
    """Return the median SPARC of the movements; nan where there is none."""
    found, begin = [], None
    for at, one in enumerate([*speed.tolist(), 0.0]):
        if one > MOVING and begin is None:
            begin = at
        elif one <= MOVING and begin is not None:
            if at - begin >= MOVEMENT * RATE:
                found.append(arc_length(speed[begin:at]))
            begin = None
    return float(np.median(found)) if found else nan


def angle_sum(directions):
    """Return the sum of the angles between successive directions, not quite of length one after the filter."""
    total = 0.0
    for a, b in pairwise(walked(directions, TURN)):
        total += float(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b))
    return total


def triple(hand, name, unit):
    """Return three columns side by side, shape (n, 3)."""
    return np.stack([hand[f"{name}_{axis}{unit}"] for axis in "xyz"], axis=1)


def trapezium(values, times):
    """Return an integral by the trapezium rule."""
    return float(((values[1:] + values[:-1]) / 2 * np.diff(times)).sum())


def above(values, times, limit):
    """Return how long values joined by straight lines are above a limit."""
    total = 0.0
    for (a, b), seconds in zip(pairwise(values.tolist()), np.diff(times).tolist(), strict=True):
        if min(a, b) > limit:
            total += seconds
        elif max(a, b) > limit:
            total += seconds * (max(a, b) - limit) / abs(b - a)
    return total


def largest_work(hands):
    """Return the most both tips had worked since neither touched."""
    vectors = [
        [
            triple(hand, *column)
            for column in (("tip", "_m"), ("shaft", ""), ("force", "_n"), ("moment", "_n_m"))
        ]
        for hand in hands
    ]
    most = since = 0.0
    for tick in range(1, len(hands[0]["time_s"])):
        if not any(hand["touching"][tick] for hand in hands):
            since = 0.0
            continue
        for hand, (tip, shaft, force, moment) in zip(hands, vectors, strict=True):
            if hand["present"][tick] and hand["present"][tick - 1]:
                roll = hand["roll_rad"][tick] - hand["roll_rad"][tick - 1]
                turn = np.cross(shaft[tick - 1], shaft[tick]) + roll * shaft[tick]
                since -= force[tick] @ (tip[tick] - tip[tick - 1]) + moment[tick] @ turn
        most = max(most, since)
    return most


def snips(hands, *, idle):
    """Return both ends of every snip: where what the table tells of a hand's last changes; idle ones cut nothing."""
    found = []
    for hand in hands:
        told = np.stack(
            [hand[f"cut_{name}"] for name in ("links", "from_x_m", "from_y_m", "to_x_m", "to_y_m")], 1
        )
        before = np.vstack([np.zeros(5), told[:-1]])
        new = (told != before).any(axis=1) & (told[:, 1:].any(axis=1) if idle else told[:, 0] > 0)
        found += [(row[1:3], row[3:5]) for row in told[new]]
    return found


def to_line(place, line):
    """Return how far a place is from a line of points."""
    nearest = inf
    for a, b in pairwise(line):
        share = min(max((place - a) @ (b - a) / ((b - a) @ (b - a)), 0.0), 1.0)
        nearest = min(nearest, hypot(*(place - a - share * (b - a))))
    return nearest


def deviations(cuts, line):
    """Return how far places along the cuts, at most 0.1 mm apart, are from the line: mean and largest."""
    found = []
    for begin, end in cuts:
        count = int(hypot(*(end - begin)) / 1e-4) + 2
        found += [to_line(begin + share * (end - begin), line) for share in np.linspace(0, 1, count)]
    return (sum(found) / len(found), max(found)) if found else (nan, nan)


def gone_by(cuts, line, width):
    """Return the share of the line's points that a cut goes by within the width, and half a step before and after."""
    count = 0
    for number, place in enumerate(line):
        half = 0.5 * hypot(*(line[max(number, 1)] - line[max(number - 1, 0)]))
        for begin, end in cuts:
            long = hypot(*(end - begin))
            along, to = (end - begin) / long, place - begin
            if half <= to @ along <= long - half and abs(to[0] * along[1] - to[1] * along[0]) <= width:
                count += 1
                break
    return count / len(line)


def heavy_hand(times, worst, limit):
    """Return how often the force went over the limit, half a second apart."""
    count, last = 0, -inf
    for time in times[worst > limit].tolist():
        count += time - last >= AGAIN
        last = time
    return count


def recompute(table, constants):
    """Return every metric by name."""
    hands = [table["left"], table["right"]]
    times = hands[0]["time_s"]
    used = []
    for hand in hands:
        here = hand["present"] != 0
        if here.sum() > 1 and np.ptp(hand["time_s"][here]) >= 0.1:
            tip = Motion(hand, ("tip_x_m", "tip_y_m", "tip_z_m"))
            if max(np.ptp(column) for column in tip.columns) > USED:
                used.append((hand, tip))
    tips = [tip for _, tip in used]
    shafts = [Motion(hand, ("shaft_x", "shaft_y", "shaft_z")) for hand, _ in used]
    rolls = [Motion(hand, ("roll_rad",)) for hand, _ in used]
    slides = [Motion(hand, ("outside_m",)) for hand, _ in used]
    forces = np.stack([np.sqrt((triple(hand, "force", "_n") ** 2).sum(axis=1)) for hand in hands])
    path = sum(tip.length() for tip in tips)
    dexterity = moving = nan
    if len(tips) == 2:
        begin, end = max(tip.times[0] for tip in tips), min(tip.times[-1] for tip in tips)
        grid = np.arange(begin, end, 1 / RATE)
        if len(grid) > 1:
            speeds = [np.interp(grid, tip.times, tip.speed()) for tip in tips]
            together = (speeds[0] - speeds[0].mean()) * (speeds[1] - speeds[1].mean())
            dexterity = together.sum() / np.abs(together).sum() if np.abs(together).sum() > 0 else nan
            moving = above(np.minimum(*speeds), grid, MOVING) / (grid[-1] - grid[0])
    pressed = forces[forces > TOUCHING]
    jerks = [
        sqrt(tip.seconds**5 / (2 * tip.length() ** 2) * tip.jerk_squared())
        for tip in tips
        if tip.length() > 0 and tip.jerk_squared() > 0
    ]
    logs = [
        -log(tip.seconds**3 / tip.speed().max() ** 2 * tip.jerk_squared())
        for tip in tips
        if tip.jerk_squared() > 0
    ]
    arcs = [one for one in (median_arc_length(tip.speed()) for tip in tips) if not isnan(one)]
    cut = (nan, nan, nan)
    if constants["line_m"] is not None:
        line, width = np.array(constants["line_m"]), constants["line_width_m"]
        cut = (*deviations(snips(hands, idle=False), line), gone_by(snips(hands, idle=True), line, width))
    strength = constants["tensile_strength_pa"]
    stress = max(one.max() / area for one, area in zip(forces, constants["tip_sections_m2"], strict=True))
    worst = forces.max(axis=0)
    return {
        "time": times[-1] - times[0],
        "path_length": path,
        "angular_path": sum(angle_sum(np.array(shaft.columns).T) for shaft in shafts)
        + sum(roll.length(TURN) for roll in rolls),
        "economy_of_motion": constants["ideal_length_m"] / path
        if constants["completed"] and path > 0
        else nan,
        "depth_perception": sum(slide.length() for slide in slides),
        "integrated_jerk": max(jerks, default=nan),
        "log_dimensionless_jerk": min(logs, default=nan),
        "sparc_per_movement": min(arcs, default=nan),
        "idle_time": float(np.mean([tip.seconds - above(tip.speed(), tip.times, MOVING) for tip in tips]))
        if tips
        else nan,
        "bimanual_dexterity": dexterity,
        "both_moving": moving,
        "peak_force": float(worst.max()),
        "rms_force": sqrt((pressed**2).mean()) if len(pressed) else 0.0,
        "impulse": trapezium(forces.sum(axis=0), times),
        "time_over_limit": above(worst, times, constants["force_limit_n"]),
        "peak_stress_ratio": stress / strength if strength else nan,
        "work_on_tissue": largest_work(hands),
        "cut_deviation": cut[0],
        "cut_deviation_most": cut[1],
        "cut_share": cut[2],
        "errors": float(hands[0]["mistakes"][-1]),
    }


def differences(table, constants, card):
    """Print both values of everything on a card; return the names of what differs."""
    found = recompute(table, constants)
    on_card = {name: metric["value"] for name, metric in card["metrics"].items()}
    worst = np.maximum(
        *(np.linalg.norm(triple(table[hand], "force", "_n"), axis=1) for hand in ("left", "right"))
    )
    heavy = heavy_hand(table["left"]["time_s"], worst, constants["force_limit_n"])
    penalties = constants["seconds_per_mistake"] * found["errors"]
    penalties += constants["seconds_per_second_over_limit"] * found["time_over_limit"]
    if not isnan(found["cut_deviation"]):
        penalties += constants["seconds_per_metre_off"] * found["cut_deviation"]
    left = max(0.0, constants["cutoff_s"] - found["time"] - penalties) * constants["completed"]
    pairs = {name: (on_card.get(name, nan), value) for name, value in found.items()}
    pairs |= {name: (value, nan) for name, value in on_card.items() if name not in found}
    pairs["score"] = (card["score"], 100 * left / (constants["cutoff_s"] - constants["expert_time_s"]))
    pairs["duration"] = (card["duration_s"], found["time"])
    pairs["mistakes on the card"] = (len(card["mistakes"]), found["errors"])
    pairs[f"times they {TOO_MUCH}"] = (sum(one["words"] == TOO_MUCH for one in card["mistakes"]), heavy)
    wrong = []
    for name, (ours, theirs) in pairs.items():
        same = abs(ours - theirs) <= RELATIVE * abs(ours) or (isnan(ours) and isnan(theirs))
        apart = abs(ours - theirs) / abs(ours) if ours else abs(theirs)
        print(f"{name:32} {ours:24.16g} {theirs:24.16g} {apart:9.1e} {'' if same else 'DIFFERS'}")
        if not same:
            wrong.append(name)
    return wrong


def main() -> int:
    """Compare and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("table", type=Path)
    parser.add_argument("card", type=Path)
    arguments = parser.parse_args()
    constants = json.loads(arguments.table.with_suffix(".task.json").read_text(encoding="utf-8"))
    card = json.loads(arguments.card.read_text(encoding="utf-8"))
    print(f"{constants['task']}, level {constants['level']}")
    print(f"{'':32} {'on the card':>24} {'from the table':>24} {'apart':>9}")
    wrong = differences(read_table(arguments.table), constants, card)
    print(f"{len(wrong)} differ" + (f": {', '.join(wrong)}" if wrong else f" by more than {RELATIVE:g}"))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

"""Table 2: what its t, p and critical values imply about each other and about the samples."""

from __future__ import annotations

from functools import cache
from itertools import permutations

import numpy as np
from scipy import optimize, stats

from trocar.study.ledger import paper
from trocar.study.ledger.entry import (
    Entry,
    Verdict,
    agrees,
    half_digit,
    recomputed_entry,
    unspecified_entry,
)
from trocar.study.statistics.published import p_two_tailed, t_critical, t_test

MOST_DF = 2000  # far beyond where the critical value leaves the printed digits
PERIODS = (0.1, 0.2, 0.25, 0.5, 1.0, 1.25, 2.0, 2.5, 4.0, 5.0, 10.0)  # [s], round sampling periods
LAYERS = tuple(paper.T_TESTS)


@cache
def degrees_of_freedom() -> tuple[int, int]:
    """Return the first and last whole degrees of freedom whose critical value rounds to the printed one."""
    critical = paper.T_TESTS[LAYERS[0]][2]
    every = np.arange(1, MOST_DF)
    values = np.asarray(stats.t.isf(float(paper.ALPHA) / 2, every))
    fitting = [int(df) for df, value in zip(every, values, strict=True) if agrees(critical, float(value))]
    return fitting[0], fitting[-1]


def p_range(printed_t: str) -> tuple[float, float]:
    """Return the smallest and largest p of any t that prints so, at any degrees of freedom that fit."""
    t, half = abs(float(printed_t)), half_digit(printed_t)
    p = [p_two_tailed(t + shift, df) for shift in (-half, half) for df in degrees_of_freedom()]
    return min(p), max(p)


def could_print(printed_p: str, printed_t: str) -> bool:
    """Return whether some t that prints as `printed_t` has a p that prints as `printed_p`."""
    low, high = p_range(printed_t)
    p, half = float(printed_p), half_digit(printed_p)
    return low <= p + half and p - half <= high


def matching_orders() -> tuple[tuple[str, ...], ...]:
    """Return the orders of the p column that fit the t column: item i is where layer i's p is printed."""
    return tuple(
        order
        for order in permutations(LAYERS)
        if all(
            could_print(paper.T_TESTS[source][1], paper.T_TESTS[layer][0])
            for layer, source in zip(LAYERS, order, strict=True)
        )
    )


def fitting_periods() -> tuple[tuple[float, float, int], ...]:
    """Return (load time [s], period [s], samples) for round periods that give fitting degrees of freedom."""
    first, last = degrees_of_freedom()
    one_way = float(paper.FORCE_N) / float(paper.RATE_N_S)
    counts = [
        (time, period, round(time / period) + 1) for time in (one_way, 2 * one_way) for period in PERIODS
    ]
    return tuple(found for found in counts if first <= 2 * found[2] - 2 <= last)


def triangle(n: int) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return n samples of a curve that goes up to 1 and back in straight lines, as a linear model's would."""
    return 1 - np.abs(np.linspace(-1, 1, n))


def amplitude_gap(t: float, n: int) -> float:
    """Return by which part the amplitude of one of two such curves must fall short to give this |t| [1]."""
    curve = triangle(n)
    return float(optimize.brentq(lambda gap: t_test(curve, (1 - gap) * curve).t - abs(t), 0.0, 0.9))


def t_test_entries() -> tuple[Entry, ...]:
    """Return the entries of Table 2."""
    first, last = degrees_of_freedom()
    times = fitting_periods()
    n = max(times, key=lambda found: found[0])[2]  # both ways, as figure 6 shows them
    df = 2 * n - 2
    return (
        *(_p_entry(layer, df) for layer in LAYERS),
        _order_entry(),
        recomputed_entry(
            "t_critical",
            paper.T_TESTS[LAYERS[0]][2],
            t_critical(df, float(paper.ALPHA)),
            "1",
            f"Two tails, 0.05; the digits fit {first} to {last} degrees of freedom, taken here at {df}.",
        ),
        *(_decision_entry(layer, df) for layer in LAYERS),
        _criterion_entry(df),
        *_sample_entries(first, last, n, times),
    )


def _p_entry(layer: str, df: int) -> Entry:
    t, p, _ = paper.T_TESTS[layer]
    low, high = p_range(t)
    fits = could_print(p, t)
    belongs = [order[LAYERS.index(layer)] for order in matching_orders()]
    moved = "" if fits else f" Its value is printed under {' or '.join(belongs) or 'no layer'}."
    return Entry(
        id=f"p_{layer}",
        printed=p,
        recomputed=p_two_tailed(float(t), df),
        unit="1",
        verdict=Verdict.REPRODUCED if fits else Verdict.INCONSISTENT,
        note=f"From t = {t} with {df} degrees of freedom; any t that prints so and any fitting degrees of "
        f"freedom give {low:.4f} to {high:.4f}.{moved}",
    )


def _order_entry() -> Entry:
    """Return how many rows of the p column fit where they stand."""
    orders = matching_orders()
    fitting = sum(could_print(paper.T_TESTS[layer][1], paper.T_TESTS[layer][0]) for layer in LAYERS)
    shifts = [
        shift
        for shift in range(len(LAYERS))
        if tuple(LAYERS[(i + shift) % len(LAYERS)] for i in range(len(LAYERS))) in orders
    ]
    how = f"a rotation by {min(shifts[0], len(LAYERS) - shifts[0])} row" if shifts else "not a rotation"
    return recomputed_entry(
        "p_rows_in_place",
        str(len(LAYERS)),
        fitting,
        "rows",
        f"Orders of the p column that fit the t column: {len(orders)} of 6, {how}. The p of "
        f"{', '.join(LAYERS)} is printed under {' or '.join(', '.join(order) for order in orders)}.",
    )


def _decision_entry(layer: str, df: int) -> Entry:
    """Return whether the printed t supports the printed "True", as 1 or 0."""
    t = float(paper.T_TESTS[layer][0])
    alpha = float(paper.ALPHA)
    holds = p_two_tailed(t, df) > alpha and abs(t) < t_critical(df, alpha)
    return Entry(
        id=f"not_rejected_{layer}",
        printed="True",
        recomputed=float(holds),
        unit="1",
        verdict=Verdict.REPRODUCED if holds else Verdict.INCONSISTENT,
        note="p > 0.05 and |t| < t critical; not rejecting equal means is no evidence of equality.",
    )


def _criterion_entry(df: int) -> Entry:
    """Return the significance level of the rule "t stat < t critical" taken by itself."""
    critical = float(paper.T_TESTS[LAYERS[0]][2])
    return recomputed_entry(
        "criterion",
        paper.ALPHA,
        p_two_tailed(critical, df) / 2,
        "1",
        '"t stat < t critical" drops the sign: alone it passes any negative t and rejects half as often as '
        "stated. Harmless for the printed values; the p criterion beside it has two tails.",
    )


def _sample_entries(
    first: int, last: int, n: int, times: tuple[tuple[float, float, int], ...]
) -> tuple[Entry, ...]:
    guesses = "; ".join(f"every {period:g} s of {time:g} s: {count}" for time, period, count in times)
    seen = {layer: amplitude_gap(float(paper.T_TESTS[layer][0]), n) for layer in LAYERS}
    blind = amplitude_gap(t_critical(2 * n - 2, float(paper.ALPHA)), n)
    implied = ", ".join(f"{layer} {100 * gap:.2g} %" for layer, gap in seen.items())
    return (
        unspecified_entry("df", "1", f"Not printed; {first} to {last} by the critical value.", 2.0 * n - 2),
        unspecified_entry(
            "sample_size",
            "samples a model",
            f"Not printed; {(first + 2) / 2:g} to {(last + 2) / 2:g} by the critical value if both models "
            f"have equally many. Round sampling periods that fit: {guesses} (an inference).",
            float(n),
        ),
        unspecified_entry(
            "t_sign", "1", "Which model is subtracted from which is not said; epidermis differs in sign."
        ),
        unspecified_entry(
            "amplitude_error_unseen",
            "1",
            "Smallest error of amplitude the published test would reject, for two curves that rise and fall "
            f"in straight lines, with that many samples. The printed t would mean, in size: {implied}.",
            blind,
        ),
    )

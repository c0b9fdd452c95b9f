"""Write what was foretold of measured tissue as plain values."""

from __future__ import annotations

from dataclasses import asdict

from trocar.study.measured.fit import Fitted
from trocar.study.measured.indented import PUBLISHED, LimbResults
from trocar.study.measured.leg import MeasuredLeg
from trocar.study.measured.pressed import CALIBRATED, GROWTH_STRAINS, PhantomResults
from trocar.study.measured.relaxed import MOMENTS, ForetoldHolds
from trocar.study.writing.plain import plain


def measured_results(leg: MeasuredLeg) -> dict[str, object]:
    """Return every figure of the third leg as plain values for JSON, in SI; what was not there is null or empty."""
    return {
        "missing": list(leg.sets.missing),
        "seconds": leg.seconds,
        "phantoms": None if leg.phantoms is None else _phantoms(leg.phantoms),
        "grades": [asdict(grade) for grade in leg.grades],
        "limbs": None if leg.limbs is None else _limbs(leg.limbs),
        "strips": [
            {
                "tissue": strip.tissue,
                "largest_stretch": strip.limit,
                "error": strip.errors,
                "laws": {name: _law(fitted) for name, fitted in strip.laws.items()},
            }
            for strip in leg.strips
        ],
        "holds": None if leg.holds is None else _holds(leg.holds),
        "rubber": [
            {
                "law": law.name,
                "fitted": _law(law.fitted),
                "largest_stretch": law.stretch,
                "error_uniaxial": law.uniaxial,
                "error_biaxial": law.biaxial,
                "median_biaxial": law.median,
                "points": law.points,
            }
            for law in leg.rubber
        ],
    }


def _phantoms(results: PhantomResults) -> dict[str, object]:
    return {
        "calibrated_to_strain": CALIBRATED,
        "growth_strains": list(GROWTH_STRAINS),
        "alone": list(results.alone),
        "discs": [plain(asdict(disc)) for disc in results.discs],
        "specimens_apart": [asdict(one) for one in results.specimens],
    }


def _limbs(results: LimbResults) -> dict[str, object]:
    ways = (results.linear, results.exponential, *results.baselines)
    return {
        "people": {"fitted": results.people[0], "judged": results.people[1]},
        "trials": {"judged": int(results.judged.sum()), "incomplete": results.limbs.incomplete},
        "shear_modulus": {
            "linear": list(results.shear_moduli),
            "exponential": list(results.exponential_moduli),
        },
        "steepness": results.steepness,
        "error": {
            way.name: {"median_fitted": way.fitted_median, "median": way.median, "mean": way.mean}
            for way in ways
        },
        "published_two_springs": PUBLISHED,
        "alike_people_apart": results.neighbours if results.pairs else None,
        "alike_pairs": results.pairs,
    }


def _holds(holds: ForetoldHolds) -> dict[str, object]:
    return {
        "prony": [list(term) for term in holds.prony],
        "power": holds.power,
        "tests": {"fitted": holds.counts[0], "judged": holds.counts[1]},
        "error": {"fitted": holds.fitted, "judged": holds.judged, "mean_curve": holds.mean_curve},
        "after_peak_s": list(MOMENTS),
        "measured": holds.measured.tolist(),
        "foretold": holds.foretold.tolist(),
        "spread": holds.spread.tolist(),
    }


def _law(fitted: Fitted) -> dict[str, object]:
    return {
        "law": type(fitted.law).__name__,
        "shear_modulus": fitted.shear_modulus,
        "parameters": plain(asdict(fitted.law)),
    }

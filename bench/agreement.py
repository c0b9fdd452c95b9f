"""Print how far the wave models agree with finite elements, support by support.

python bench/agreement.py base            all nine places (three and their mirror images), about half an hour
python bench/agreement.py edges+base --central
python bench/agreement.py edges --central
python bench/agreement.py edges+base --central --fat-mm 14 --dermis-kpa 35 --dermis-kpa 500
python bench/agreement.py edges --near-side    one tissue, a 6 mm tool ever closer to one side and to two
python bench/agreement.py edges --motion       half a sine of 20 ms on the preset skin
"""

import argparse
import sys

import numpy as np

from trocar.model import Press, Support
from trocar.reference.fea import FEASolid
from trocar.study.half_sine import half_sine
from trocar.study.statistics.agreement import nrmse
from trocar.study.sweep_of_agreement import DERMIS, FAT, PLACES, SIZE, agreements, largest, skin_like
from trocar.tissues.catalogue import tissue
from trocar.units import MILLIMETRE
from trocar.waves.solid import WaveSolid


def main() -> int:
    """Run the sweep named on the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("support", choices=[kind.value for kind in Support])
    parser.add_argument("--central", action="store_true", help="only a tool in the middle")
    parser.add_argument("--motion", action="store_true", help="half a sine in time instead")
    parser.add_argument("--near-side", action="store_true", help="how close a tool may come to a side")
    parser.add_argument("--fat-mm", type=float, action="append", help="thickness; may be repeated")
    parser.add_argument("--dermis-kpa", type=float, action="append", help="modulus; may be repeated")
    choice = parser.parse_args()
    if choice.motion:
        motion(Support(choice.support))
        return 0
    if choice.near_side:
        near_side(Support(choice.support))
        return 0
    fats = tuple(1e-3 * thickness for thickness in choice.fat_mm or ()) or FAT
    dermises = tuple(1e3 * modulus for modulus in choice.dermis_kpa or ()) or DERMIS
    places = PLACES[:1] if choice.central else PLACES
    print(
        "fat mm | E epidermis, dermis, fat kPa | place | d mm | FEA mm | WaveSolid - FEA, % | WaveMembrane - FEA, %"
    )
    rows = []
    for row in agreements(Support(choice.support), places=places, fats=fats, dermises=dermises):
        rows.append(row)
        print(
            f"{1e3 * row.fat_thickness:4.0f} | {row.epidermis / 1e3:5.0f} {row.dermis / 1e3:5.0f} {row.fat / 1e3:3.0f}"
            f" | {row.place[0]:.2f} {row.place[1]:.2f} | {1e3 * row.diameter:.0f} | {1e3 * row.reference[0]:8.4f}"
            f" | {' '.join(f'{100 * e:+7.3f}' for e in row.solid)}"
            f" | {' '.join(f'{100 * e:+7.3f}' for e in row.membrane)}",
            flush=True,
        )
    for name in ("solid", "membrane"):
        errors = np.abs([getattr(row, name) for row in rows])
        print(
            f"{name}: {len(rows)} presses, largest {100 * errors.max():.3f} %, "
            f"median {100 * np.median(errors):.3f} %, layers {np.round(100 * errors.max(axis=0), 3)}"
        )
    return 0


def motion(support: Support) -> None:
    """Print how far the moving layered waves are from finite elements, over the range of the motion."""
    skin, press = tissue("skin"), Press(x=0.03, y=0.03, radius=3 * MILLIMETRE, force=0.05)
    models = {
        "fea": FEASolid(skin, size=SIZE, support=support, around=(press,)),
        "wave-solid": WaveSolid(skin, size=SIZE, support=support),
    }
    curves = half_sine(models, press)
    print(
        f"half a sine of 20 ms, 6 mm, {support.value}: NRMSE {100 * nrmse(curves['fea'], curves['wave-solid']):.2f} %"
    )


def near_side(support: Support) -> None:
    """Print the layered waves' difference by the distance of the tool's rim from a side and from a corner."""
    layers = skin_like(1e6, 2e5, 1e4, 10 * MILLIMETRE)
    models = {
        side_modes: WaveSolid(
            layers, size=SIZE, support=support, modes=(160, 160), side_modes=(side_modes,) * 2
        )
        for side_modes in ((48, 80) if support.sides_clamped else (48,))
    }
    print("from rim to side, mm | to one or two sides | FEA mm | WaveSolid - FEA, %, by side modes")
    for gap in (0.0, 0.5, 1.0, 2.0, 4.5, 7.0, 12.0):
        near = 3 * MILLIMETRE + gap * MILLIMETRE
        for sides, place in ((1, (near, SIZE[1] / 2)), (2, (near, near))):
            press = Press(x=place[0], y=place[1], radius=3 * MILLIMETRE, force=1.0)
            reference = largest(FEASolid(layers, size=SIZE, support=support, around=(press,)), press)
            differences = " | ".join(
                f"{side_modes}: " + " ".join(f"{100 * e:+.2f}" for e in largest(model, press) / reference - 1)
                for side_modes, model in models.items()
            )
            print(f"{gap:4.1f} | {sides} | {1e3 * reference[0]:.4f} | {differences}", flush=True)


if __name__ == "__main__":
    sys.exit(main())

"""What a folder of measurements holds: one sub-folder a set, each of them optional."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from trocar.errors import InputError
from trocar.study.measured import elastomer, limbs, phantom, relaxation, rubber, strips

_CALLED = {
    phantom.FOLDER: "Silicone phantoms are",
    limbs.FOLDER: "Limbs are",
    strips.FOLDER: "A sow's tissues are",
    relaxation.FOLDER: "Relaxing beef is",
    elastomer.FOLDER: "Silicones in tension are",
    rubber.FOLDER: "Rubber is",
}


@dataclass(frozen=True, kw_only=True)
class MeasuredSets:
    """The sets that were found.

    Args:
        phantoms: silicone discs in compression; empty where there is no such set.
        limbs: indented in vivo, or None.
        strips: of a sow's tissues in tension.
        holds: of beef, relaxing.
        pulls: of silicones in tension.
        rubber: of Treloar and Kawabata, or None.
        missing: one sentence for each set that is not there.
    """

    phantoms: tuple[phantom.Compression, ...] = ()
    limbs: limbs.Indentations | None = None
    strips: tuple[strips.Strip, ...] = ()
    holds: tuple[relaxation.Hold, ...] = ()
    pulls: tuple[elastomer.Pull, ...] = ()
    rubber: rubber.Rubber | None = None
    missing: tuple[str, ...] = ()


def read_sets(folder: Path) -> MeasuredSets:
    """Read every set of a folder.

    Raises:
        InputError: the folder is not one or holds no set, or a file in it is broken.
    """
    if not folder.is_dir():
        raise InputError(f"data: {folder}", "a folder of measured sets", "no such folder")
    there = {name: (folder / name).is_dir() for name in _CALLED}
    if not any(there.values()):
        raise InputError(
            f"data: {folder}",
            f"at least one sub-folder such as {phantom.FOLDER}",
            "none",
            "name the folder that holds the sets",
        )
    return MeasuredSets(
        phantoms=phantom.read_phantoms(folder / phantom.FOLDER) if there[phantom.FOLDER] else (),
        limbs=limbs.read_limbs(folder / limbs.FOLDER) if there[limbs.FOLDER] else None,
        strips=strips.read_strips(folder / strips.FOLDER) if there[strips.FOLDER] else (),
        holds=relaxation.read_holds(folder / relaxation.FOLDER) if there[relaxation.FOLDER] else (),
        pulls=elastomer.read_pulls(folder / elastomer.FOLDER) if there[elastomer.FOLDER] else (),
        rubber=rubber.read_rubber(folder / rubber.FOLDER) if there[rubber.FOLDER] else None,
        missing=tuple(
            f"{what} left out: there is no folder {name} in {folder.name}."
            for name, what in _CALLED.items()
            if not there[name]
        ),
    )

"""An organ out of a few numbers: a liver's lobes, lying on a bed, hung on ligaments.

The shape is a product of our own, no patient's. Seen from above its outline is a superellipse that tapers from right to
left; its upper side is a dome, its lower side nearly flat with a blunt rim. With s from -1 at the left end to 1 at the
right, half width w(s), height d(s) and the outline's power p, the surface is where

    (|s|^p + |y / w|^p)^(2/p) + |z / d|^q = 1,    q = 2 above the plane of the rim, q = 4 and d times `flatness` below.

A fold between the lobes and a notch in the front rim are smooth dents of w and d.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.tissues.layer import Layer
from trocar.waves.mesh.faces import above, below, outer_faces
from trocar.waves.mesh.solid_mesh import LONGEST, Held, SolidMesh, placed
from trocar.waves.mesh.stuffing import stuffed

EVEN_SPACING = 0.0125  # [m] along x, of elements that are as long everywhere
_POWER = 2.4  # of the outline: 2 is an ellipse
_UPPER, _LOWER = 2.0, 4.0  # powers of the height: a dome, and a flat side with a blunt rim
_STRETCH = 1.8  # elements are as much lower than long: most happens through the thickness
_CLOSER, _WITHIN = 3.0, 0.02  # elements are so many times shorter, within so far of where tools press [m]
_LINES, _BEFORE = 500, 250  # places of the grading along a side, and beyond each end
_FOLD_AT, _FOLD_WIDE = -0.28, 0.10  # s of the fold between the lobes, and how wide it is
_LIGAMENT = 0.06  # s to either side of the fold, where the falciform ligament holds the upper side
_BEHIND = 0.55  # of the half width: farther back, the upper side hangs on the coronary ligament


@dataclass(frozen=True, kw_only=True)
class Liver:
    """Describe a liver.

    Args:
        length: from left to right, along x [m].
        width: from front to back at its widest, along y [m].
        height: of its right lobe, along z [m].
        taper: width and height of the left end, as a share of those of the right.
        flatness: of the lower side: its depth as a share of the dome's height.
        fold: depth of the fold between the lobes, as a share of the height there.

    Raises:
        InputError: a value is not possible.
    """

    length: float = 0.20
    width: float = 0.14
    height: float = 0.07
    taper: float = 0.38
    flatness: float = 0.3
    fold: float = 0.12

    def __post_init__(self) -> None:
        for key in ("length", "width", "height"):
            value = getattr(self, key)
            if not (isfinite(value) and 0.01 <= value <= LONGEST):
                raise InputError(f"liver: {key}", f"a length from 0.01 to {LONGEST:g} m", value)
        for key, low, high in (("taper", 0.2, 1.0), ("flatness", 0.1, 1.0), ("fold", 0.0, 0.4)):
            value = getattr(self, key)
            if not low <= value <= high:
                raise InputError(f"liver: {key}", f"a share from {low:g} to {high:g}", value)

    def _level(self, places: FloatArray) -> FloatArray:
        """Return the level at places before they are narrowed [m], shape (n, 3), from the middle and the rim."""
        s = places[:, 0] / (0.5 * self.length)
        dent = self.fold * np.exp(-(((s - _FOLD_AT) / _FOLD_WIDE) ** 2))
        half = 0.5 * self.width * (1 - 0.5 * dent * (places[:, 1] < 0))
        up = places[:, 2] > 0
        height = _STRETCH * self.height / (1 + self.flatness) * np.where(up, 1 - dent, self.flatness)
        outline = (np.abs(s) ** _POWER + np.abs(places[:, 1] / half) ** _POWER) ** (2 / _POWER)
        upright = np.abs(places[:, 2] / height) ** np.where(up, _UPPER, _LOWER)
        return np.asarray(np.sqrt(outline + upright) - 1.0)

    def _narrowing(self, s: FloatArray) -> FloatArray:
        t = np.clip(0.5 * (s + 1), 0.0, 1.0)
        return self.taper + (1 - self.taper) * t * t * (3 - 2 * t)

    def _site(self, around: tuple[float, float] | None) -> tuple[float | None, float | None]:
        """Return where a place is before it is narrowed, from the middle [m]."""
        if around is None:
            return None, None
        s = np.linspace(-1.0, 1.0, 1001)
        widest = float((self._narrowing(s) * (1 - np.abs(s) ** _POWER) ** (1 / _POWER)).max())
        x = around[0] - 0.5 * self.length
        y = around[1] - 0.5 * self.width * widest
        if not (abs(x) <= 0.5 * self.length and abs(y) <= 0.5 * self.width * widest):
            raise InputError("around", "a place on the liver, as seen from above [m]", around)
        return x, y / float(self._narrowing(np.array(2 * x / self.length)))

    def mesh(
        self, layer: Layer, *, spacing: float = EVEN_SPACING, around: tuple[float, float] | None = None
    ) -> SolidMesh:
        """Return its tetrahedra, held by the bed below, the falciform ligament above, and the coronary ligament behind.

        Args:
            layer: its material; the thickness does not matter.
            spacing: of the lattice of tetrahedra, along x [m]; where the organ is narrower they are smaller.
            around: x and y of a place where tools press [m], as seen from above; elements are a third as long there.

        Raises:
            InputError: the spacing is too small, or as large as the organ.
        """
        high = np.array([0.5 * self.length, 0.5 * self.width, _STRETCH * self.height / (1 + self.flatness)])
        low = -high * np.array([1.0, 1.0, self.flatness])
        lines = [_closer(low[axis], high[axis], place) for axis, place in enumerate(self._site(around))]
        starts = np.array([*(even[_BEFORE] for even, _ in lines), low[2]])
        stops = np.array([*(even[-1 - _BEFORE] for even, _ in lines), high[2]])

        def graded(places: FloatArray) -> FloatArray:
            x, y = (np.interp(places[:, axis], *line) for axis, line in enumerate(lines))
            return np.stack([x, y, places[:, 2]], axis=1)

        corners, cells = stuffed(lambda places: self._level(graded(places)), starts, stops, spacing)
        corners = graded(corners)
        narrowing = self._narrowing(corners[:, 0] / (0.5 * self.length))
        corners = corners * np.stack([np.ones_like(narrowing), narrowing, narrowing / _STRETCH], axis=1)
        outside, top = outer_faces(cells)[0], above(corners, cells)
        middle = corners[top].mean(axis=1)
        s = middle[:, 0] / (0.5 * self.length)
        behind = middle[:, 1] > _BEHIND * 0.5 * self.width * self._narrowing(s)
        falciform = np.abs(s - _FOLD_AT) < max(_LIGAMENT, spacing / self.length)
        hung = (falciform & (middle[:, 1] > 0)) | (behind & (np.abs(s) < 0.5))
        held = [below(corners, cells), top[hung]]
        if not all(len(faces) for faces in held):
            raise InputError(
                "spacing", f"one that leaves faces to hold, of {len(outside)}", spacing, "halve it"
            )
        return placed(
            SolidMesh(
                corners=corners,
                cells=cells,
                region=np.zeros(len(cells), dtype=np.int64),
                materials=(layer,),
                held=tuple(Held(faces=faces) for faces in held),
                surfaces={"surface": top},
            )
        )


def _closer(low: float, high: float, middle: float | None) -> tuple[FloatArray, FloatArray]:
    """Return even places and those that they stand for [m], which are closer about a middle; `_BEFORE` lie outside."""
    step = (high - low) / _LINES
    places = np.asarray(low + step * np.arange(-_BEFORE, _LINES + _BEFORE + 1), dtype=np.float64)
    if middle is None:
        return places, places
    density = 1 + (_CLOSER - 1) * np.exp(-(((places - middle) / _WITHIN) ** 2))
    even = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))]) * step
    return even, places

"""Press and release as a moving picture: the deforming face, the force, and the depth of every layer beside it.

What does not move is drawn once and kept as pixels; each frame only adds the face and three marks, so that a film of
ninety frames takes a few seconds.
"""

from __future__ import annotations

from dataclasses import dataclass
from io import BytesIO

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from PIL import Image

from trocar.model import FloatArray
from trocar.study.film import Film
from trocar.study.report.figures.axonometry import View, colours, draw_surface, fit, quads
from trocar.study.report.figures.block import enlargement
from trocar.study.report.figures.film import DENT
from trocar.study.report.figures.style import (
    BLACK,
    DEPTHS,
    GREY,
    LAYER_COLOURS,
    LAYER_STYLES,
    VERMILION,
    settings,
    three,
)
from trocar.units import MILLIMETRE, MILLISECOND

IntArray = npt.NDArray[np.int64]

SLOWER = 20  # times slower than real: 180 ms last 3.6 s, and 2 ms are the 40 ms of a frame
PAUSE = 700  # [ms] on the last frame before the film begins again
BITS = 5  # of each colour channel that decide which colour of the palette is nearest
TICK = 10  # [ms] the unit of time in a GIF
SHADES = 96  # colours of the face; enough for smooth shading, few enough for a small file
PURE = (
    "#ffffff",
    BLACK,
    GREY,
    "#e8eaed",
    VERMILION,
    *LAYER_COLOURS,
)  # colours of lines, each with its pale edges
EDGES = (1.0, 0.7, 0.4)  # how strong, from the line to what the smoothing of its edge leaves
SIZE, DOTS = (7.2, 3.7), 100  # [in], [1/in]
KEEP = 1  # every how many of the film's grid lines is drawn


@dataclass(frozen=True, kw_only=True)
class Moving:
    """A moving picture and one of its frames.

    Attributes:
        gif: endless, the content of a file.
        still: the deepest frame as PNG, for paper and for readers who do not want motion.
        frames: how many.
    """

    gif: bytes
    still: bytes
    frames: int


def animation(film: Film) -> Moving:
    """Draw press and release.

    Args:
        film: the frames; times may be uneven.
    """
    with settings():
        pictures = _frames(film)
    deepest = int(np.argmax(-film.height.min(axis=(1, 2))))
    palette = _palette(Image.fromarray(pictures[deepest]))
    nearest = _nearest(palette)
    indexed = [_indexed(picture, palette, nearest) for picture in pictures]
    gaps = np.diff(film.time) / MILLISECOND * SLOWER
    durations = [max(TICK, TICK * round(float(gap) / TICK)) for gap in gaps] + [PAUSE]
    gif, still = BytesIO(), BytesIO()
    indexed[0].save(
        gif, "GIF", save_all=True, append_images=indexed[1:], duration=durations, loop=0, optimize=False
    )
    indexed[deepest].save(still, "PNG", optimize=True)
    return Moving(gif=gif.getvalue(), still=still.getvalue(), frames=len(indexed))


def animation_alt(film: Film) -> str:
    """Return what the moving picture shows, in words."""
    top = next(iter(film.depth.values()))
    return (
        f"Moving picture, {SLOWER} times slower than real: a tool presses the middle of the block with up to "
        f"{film.force.max():g} N, the top face sinks {three(float(top.max()) / MILLIMETRE)} mm, the tool lets go, and "
        f"the face springs back within about {1e3 * _return_time(film):.0f} ms and swings a few times before it rests."
    )


def _palette(picture: Image.Image) -> IntArray:
    """Return colours, shape (n, 3): the commonest of the picture, and the lines' own, unmixed."""
    common = picture.quantize(SHADES, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    shades = np.array(common.getpalette() or [], dtype=np.int64)[: 3 * SHADES].reshape(-1, 3)
    lines = np.array([mpl.colors.to_rgb(name) for name in PURE])
    faded = [np.round(255 * (1 - share * (1 - lines))).astype(np.int64) for share in EDGES]
    return np.concatenate([*faded, shades])


def _nearest(palette: IntArray) -> npt.NDArray[np.uint8]:
    """Return the nearest of the palette for every colour of `BITS` bits a channel, shape (2^BITS,) * 3."""
    steps = np.round(np.linspace(0, 255, 2**BITS)).astype(np.int64)
    found = np.empty((len(steps),) * 3, dtype=np.uint8)
    green, blue = np.meshgrid(steps, steps, indexing="ij")
    for i, red in enumerate(steps):
        colours = np.stack([np.full_like(green, red), green, blue], axis=-1)
        apart = ((colours[:, :, None, :] - palette) ** 2).sum(axis=-1)
        found[i] = apart.argmin(axis=-1)
    return found


def _indexed(pixels: npt.NDArray[np.uint8], palette: IntArray, nearest: npt.NDArray[np.uint8]) -> Image.Image:
    red, green, blue = np.moveaxis(pixels >> (8 - BITS), -1, 0)
    picture = Image.fromarray(nearest[red, green, blue], "P")
    picture.putpalette(palette.astype(np.uint8).tobytes())
    return picture


def _return_time(film: Film) -> float:
    """Return the time from letting go to the first passage through rest [s]."""
    top = next(iter(film.depth.values()))
    let_go = int(np.flatnonzero(film.force == film.force.max())[-1])
    below = np.flatnonzero(top[let_go:] <= 0)
    back = let_go + int(below[0]) if below.size else len(top) - 1
    return float(film.time[back] - film.time[let_go])


def _frames(film: Film) -> list[npt.NDArray[np.uint8]]:
    deepest = -float(film.height.min())
    factor = enlargement(deepest, DENT)
    scale, cmap = Normalize(0, deepest / MILLIMETRE), mpl.colormaps[DEPTHS]
    x, y = film.x[::KEEP] / MILLIMETRE, film.y[::KEEP] / MILLIMETRE
    height = film.height[:, ::KEEP, ::KEEP] / MILLIMETRE
    view = View()

    figure = Figure(figsize=SIZE, dpi=DOTS)
    canvas = FigureCanvasAgg(figure)
    scene = figure.add_axes((0.0, 0.03, 0.56, 0.8))
    force, depth = figure.add_axes((0.66, 0.69, 0.32, 0.19)), figure.add_axes((0.66, 0.14, 0.32, 0.42))
    ends = np.array([[a, b, c] for a in (x[0], x[-1]) for b in (y[0], y[-1]) for c in (-4.0, 14.0)])
    fit(scene, view, ends, margin=0.02)
    figure.text(0.02, 0.93, "Press and release", fontsize=12, fontweight="bold")
    figure.text(
        0.02,
        0.03,
        f"{SLOWER} times slower than real; displacements drawn {factor:g} times as large",
        fontsize=8.5,
        color=GREY,
    )
    _draw_curves(force, depth, film)
    first = quads(x, y, factor * height[0])
    face = draw_surface(scene, view, first, colours(first, -height[0], scale, cmap))
    order = np.argsort(-view.distance(first.mean(axis=1)))
    arrow = scene.annotate(
        "",
        (0, 0),
        (0, 1),
        arrowprops={"arrowstyle": "-|>", "color": VERMILION, "linewidth": 2.2, "shrinkB": 0},
    )
    clock = figure.text(0.02, 0.86, "", fontsize=10)
    (at_force,) = force.plot([], [], "o", color=VERMILION, markersize=6)
    (at_depth,) = depth.plot([], [], "o", color=VERMILION, markersize=6)
    moving: tuple[Artist, ...] = (face, arrow, clock, at_force, at_depth)
    for artist in moving:
        artist.set_animated(True)
    canvas.draw()  # type: ignore[no-untyped-call]
    ground = canvas.copy_from_bbox(figure.bbox)  # type: ignore[no-untyped-call]

    top = next(iter(film.depth.values())) / MILLIMETRE
    middle = np.array([x.mean(), y.mean(), 0.0])
    pictures = []
    for i, time in enumerate(film.time / MILLISECOND):
        faces = quads(x, y, factor * height[i])
        _move(face, view.project(faces[order]), colours(faces, -height[i], scale, cmap)[order])
        tip = middle - np.array([0, 0, factor * top[i]])
        share = film.force[i] / film.force.max()
        arrow.set_visible(bool(share > 0))
        arrow.xy = view.at(*tip)
        arrow.set_position(view.at(*tip[:2], tip[2] + 4.0 + 12.0 * share))
        clock.set_text(f"{time:5.0f} ms    {film.force[i]:.3f} N    {top[i]:6.2f} mm".replace("-", "−"))
        at_force.set_data([time], [film.force[i]])
        at_depth.set_data([time], [top[i]])
        canvas.restore_region(ground)  # type: ignore[no-untyped-call]
        for artist in moving:
            figure.draw_artist(artist)
        pictures.append(np.asarray(canvas.buffer_rgba())[..., :3].copy())  # type: ignore[no-untyped-call]
    return pictures


def _move(face: PolyCollection, places: FloatArray, rgba: FloatArray) -> None:
    face.set_verts(list(places))
    face.set_facecolor(rgba)  # type: ignore[arg-type]
    face.set_edgecolor(rgba)  # type: ignore[arg-type]


def _draw_curves(force: Axes, depth: Axes, film: Film) -> None:
    time = film.time / MILLISECOND
    force.plot(time, film.force, color=GREY, linewidth=1.4)
    force.set_ylim(0, 1.15 * film.force.max())
    force.set_ylabel("force / N")
    force.tick_params(labelbottom=False)
    for place, (layer, curve) in enumerate(film.depth.items()):
        depth.plot(
            time,
            curve / MILLIMETRE,
            color=LAYER_COLOURS[place % 6],
            linestyle=LAYER_STYLES[place % 6],
            linewidth=1.4,
            label=layer,
        )
    depth.set_ylabel("depth under the tool / mm")
    depth.set_xlabel("time / ms")
    depth.legend(loc="upper right", fontsize=7.5)
    for axes in (force, depth):
        axes.set_xlim(time[0], time[-1])

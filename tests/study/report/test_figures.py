"""Every figure draws, says in words what it shows, and becomes SVG that stands alone."""

import re
from io import BytesIO
from xml.etree import ElementTree

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from trocar.study.report.figures.animation import PAUSE, SLOWER, animation_alt
from trocar.study.report.figures.axonometry import View, quads, shading
from trocar.study.report.figures.block import enlargement
from trocar.study.report.figures.film import LETTERS, moments
from trocar.study.report.figures.in_time import tap_figure
from trocar.study.report.figures.style import power_of_ten, three, with_uncertainty
from trocar.study.report.picture import Picture

NAMES = (
    "exploded-block", "deflection-small-load", "deflection-paper-load", "validity", "supports", "angle-and-pair", "tap",
    "filmstrip", "normal-distributions", "bland-altman", "error-and-uncertainty", "cost",
)  # fmt: skip
SVG = "{http://www.w3.org/2000/svg}"


def test_all_figures_are_there(drawn):
    assert tuple(drawn) == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_a_figure_is_described_by_finite_numbers(drawn, name):
    picture = drawn[name]
    assert isinstance(picture.figure, Figure)
    for words in (picture.alt, picture.caption):
        assert words.endswith(".")
        assert not re.search(r"\b(nan|inf|None)\b", words)
    assert len(picture.alt) > 60


@pytest.mark.parametrize("name", NAMES)
def test_a_figure_becomes_well_formed_svg_without_fonts_or_links(drawn, name):
    picture = drawn[name]
    root = ElementTree.fromstring(picture.svg)
    assert not list(root.iter(f"{SVG}text"))
    for place in [element.get("{http://www.w3.org/1999/xlink}href") for element in root.iter()]:
        assert place is None or place.startswith(("#", "data:image/png;base64,"))
    inline = ElementTree.fromstring(picture.inline_svg())
    assert inline.get("aria-label") == picture.alt
    assert "http" not in picture.inline_svg().replace(picture.alt, "")
    identities = [element.get("id") for element in inline.iter() if element.get("id")]
    assert len(set(identities)) == len(identities)
    assert all(identity.startswith(f"{name}-") for identity in identities)
    links = re.findall(r'(?:href="#|url\(#)([^")]+)', picture.inline_svg())
    assert set(links) <= set(identities)


@pytest.mark.parametrize("name", NAMES)
def test_no_text_of_a_figure_is_cut_off(drawn, name):
    figure = drawn[name].figure
    renderer = FigureCanvasAgg(figure).get_renderer()
    figure.draw_without_rendering()
    width, height = figure.bbox.size
    slack = 2  # pixels of 1/100 inch: bounding boxes of letters include their side bearings
    hidden = _hidden(figure)
    checked = 0
    for text in figure.findobj(mpl.text.Text):
        if text.get_visible() and text.get_text().strip() and text not in hidden:
            checked += 1
            box = text.get_window_extent(renderer)
            assert box.x0 >= -slack, text.get_text()
            assert box.y0 >= -slack, text.get_text()
            assert box.x1 <= width + slack, text.get_text()
            assert box.y1 <= height + slack, text.get_text()
    assert checked >= 3


def _hidden(figure):
    """Texts that need not fit: ticks lie outside the limits too, and axes that are switched off draw nothing."""
    hidden = []
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            kept = {axis.label} if axes.axison else set()
            hidden += [text for text in axis.findobj(mpl.text.Text) if text not in kept]
    return hidden


def test_drawing_leaves_the_callers_settings_alone(study):
    before = dict(mpl.rcParams)
    Picture(name="tap", alt="", caption="", figure=tap_figure(study.tap)).inline_svg()
    assert dict(mpl.rcParams) == before


def test_the_film_is_an_endless_gif_of_the_right_pace(study, moving):
    picture = Image.open(BytesIO(moving.gif))
    assert picture.format == "GIF"
    assert picture.n_frames == moving.frames == len(study.film.time)
    assert picture.info["loop"] == 0
    assert len(moving.gif) < 2.5e6
    shown = []
    for frame in range(picture.n_frames):
        picture.seek(frame)
        shown.append(picture.info["duration"])
    assert shown[-1] == PAUSE
    # Every pause is rounded to the 10 ms of the format.
    assert sum(shown[:-1]) == pytest.approx(1e3 * SLOWER * study.film.time[-1], abs=5 * len(shown))
    still = Image.open(BytesIO(moving.still)).convert("RGB")
    assert still.size == picture.size
    assert still.getpixel((1, 1)) == (255, 255, 255)


def test_the_film_moves_and_says_so(study, moving):
    picture = Image.open(BytesIO(moving.gif))
    first = np.asarray(picture.convert("RGB"), dtype=int)
    picture.seek(moments(study.film)[2])
    assert np.abs(np.asarray(picture.convert("RGB"), dtype=int) - first).max() > 100
    assert f"{SLOWER} times slower" in animation_alt(study.film)


def test_the_strip_shows_pressing_deepest_and_release(study):
    shown = moments(study.film)
    assert len(shown) == len(LETTERS)
    force = study.film.force[shown]
    assert (force[:3] > 0).all()
    assert (force[3:] == 0).all()


def test_an_enlargement_is_round_and_fits():
    assert enlargement(0.415e-3) == 10
    assert enlargement(0.415e-3, dent=9.0) == 20
    assert enlargement(41.5e-3) == pytest.approx(0.1)


def test_a_view_keeps_lengths_along_an_axis():
    view = View()
    one, two = view.project(np.array([[[0.0, 0, 0], [1, 0, 0]], [[5.0, 7, 2], [6, 7, 2]]]))
    assert two[1] - two[0] == pytest.approx(one[1] - one[0])
    assert view.distance(np.array([0.0, 60.0, 0.0])) > view.distance(np.array([0.0, 0.0, 0.0]))
    assert view.at(1, 2, 3) == pytest.approx(tuple(view.project(np.array([1.0, 2.0, 3.0]))))


def test_a_level_face_is_fully_lit():
    flat = quads(np.arange(3.0), np.arange(4.0), np.zeros((3, 4)))
    assert flat.shape == (6, 4, 3)
    assert shading(flat) == pytest.approx(np.ones(6))
    slope = quads(np.arange(3.0), np.arange(4.0), np.outer(np.arange(3.0), np.ones(4)) * -2)
    assert (shading(slope) < 1).all()


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0, "0"),
        (0.41478, "0.415"),
        (41.5, "41.5"),
        (0.9999, "1.00"),
        (-3.2, "−3.20"),
        (1234.5, "1230"),
        (7.2e-8, "7.20×10⁻⁸"),
    ],
)
def test_three_digits(value, text):
    assert three(value) == text


def test_other_numbers():
    assert power_of_ten(6.11e-6, 3) == "6.11×10⁻⁶"
    assert with_uncertainty(0.0213, 0.142) == "0.02 ± 0.14"
    assert with_uncertainty(-12.3, 14.0) == "−12 ± 14"
    assert with_uncertainty(0.5, 0.0) == "0.500 ± 0"

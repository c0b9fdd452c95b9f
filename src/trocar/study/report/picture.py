"""One figure of the report with the words that go with it, and how it becomes SVG."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from io import StringIO
from xml.sax.saxutils import quoteattr

from matplotlib.figure import Figure

from trocar.study.report.figures.style import settings

RASTER = 220  # [1/in] of the shaded surfaces inside a drawing
_NOTHING_ABOUT_THE_MAKER = dict.fromkeys(("Creator", "Date", "Format", "Type"))


@dataclass(frozen=True, kw_only=True)
class Picture:
    """A figure, what it is called, and what it shows in words.

    Attributes:
        name: of its file, without ending.
        alt: what it shows, for those who do not see it.
        caption: what the reader should take from it.
        figure: drawn by one of `figures`.
    """

    name: str
    alt: str
    caption: str
    figure: Figure

    @cached_property
    def svg(self) -> str:
        """The content of an SVG file: text as outlines, so that it needs no font."""
        stream = StringIO()
        with settings():
            self.figure.savefig(stream, format="svg", dpi=RASTER, metadata=_NOTHING_ABOUT_THE_MAKER)
        return stream.getvalue()

    def inline_svg(self) -> str:
        """Return the drawing as an element of an HTML page, its ids made its own and nothing named outside it."""
        text = self.svg
        text = text[text.index("<svg") :]
        text = re.sub(r"<metadata>.*?</metadata>\s*", "", text, flags=re.DOTALL)
        text = re.sub(r"<!--.*?-->\s*", "", text, flags=re.DOTALL)
        text = re.sub(r'\sxmlns(:\w+)?="[^"]*"', "", text).replace("xlink:href=", "href=")
        text = re.sub(r'\b(id=")', rf"\g<1>{self.name}-", text)
        text = re.sub(r'(href="#|url\(#)', rf"\g<1>{self.name}-", text)
        width = re.search(r'<svg[^>]*?viewBox="0 0 ([\d.]+)', text)
        assert width is not None, "matplotlib writes a view box"
        head = f'<svg role="img" aria-label={quoteattr(self.alt)}'
        text = re.sub(r'(<svg\b[^>]*?)\swidth="[^"]*"', r"\1", text, count=1)
        text = re.sub(r'(<svg\b[^>]*?)\sheight="[^"]*"', r"\1", text, count=1)
        return text.replace("<svg", head, 1).strip()

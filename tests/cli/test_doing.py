"""What a long work is at, with and without a terminal."""

import io

from rich.console import Console

from trocar.cli.doing import doing


def said(*, terminal):
    stream = io.StringIO()
    log = Console(file=stream, force_terminal=terminal, width=60, highlight=False, _environ={"TERM": "xterm"})
    with doing(log, "reading") as work:
        for done in range(101):
            work.at("finding modes", done / 100)
        work.at("starting")
    return stream.getvalue()


def test_without_a_terminal_every_part_and_tenth_is_a_line():
    tenths = [f"finding modes, {10 * tenth} % ..." for tenth in range(11)]
    assert said(terminal=False).splitlines() == ["reading ...", *tenths, "starting ..."]


def test_on_a_terminal_one_line_changes_and_is_gone_at_the_end():
    shown = said(terminal=True)
    assert "starting ..." in shown
    assert "\n" not in shown.removesuffix("\n\x1b[?25h\r\x1b[1A\x1b[2K")

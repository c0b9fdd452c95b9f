"""Which links a cut crosses."""

import numpy as np
import pytest

from trocar.waves.sheet.cut import cut_along
from trocar.waves.sheet.lattice import AHEAD, make_lattice, taut
from trocar.waves.sheet.sheet import Sheet

H = 1.5e-3


@pytest.fixture
def sheet():
    lattice = make_lattice(Sheet(), 1e-3)
    return lattice, taut(lattice)


def apart(lattice, state, one, other):
    """Return whether no way along links that hold leads from one node to another."""
    n = lattice.columns
    seen, left = {one}, [one]
    while left:
        at = left.pop()
        for way, (dx, dy) in enumerate(AHEAD):
            for begin, end in ((at, at + dy * n + dx), (at - dy * n - dx, at)):
                if 0 <= begin < len(lattice.free) and state.whole[way, begin] != 0.0:
                    for node in (begin, end):
                        if node not in seen:
                            seen.add(node)
                            left.append(node)
    return other not in seen


def test_a_short_cut_takes_the_links_it_crosses(sheet):
    lattice, state = sheet
    before = state.whole.copy()
    # Between two rows, across one link straight up and the two diagonals that cross there twice.
    assert cut_along(lattice, state, 9.8 * H, 10.5 * H, 10.2 * H, 10.5 * H) == 1
    assert before.sum() - state.whole.sum() == 1
    assert state.whole[1, 10 * 41 + 10] == 0.0
    assert cut_along(lattice, state, 9.8 * H, 10.5 * H, 10.2 * H, 10.5 * H) == 0


@pytest.mark.parametrize(
    "ends",
    [((-0.001, 0.0305), (0.061, 0.0295)), ((-0.001, 0.03), (0.061, 0.03)), ((-0.001, 0.012), (0.061, 0.047))],
)
def test_a_cut_from_side_to_side_parts_the_sheet(sheet, ends):
    lattice, state = sheet
    (x0, y0), (x1, y1) = ends
    xs, ys = np.linspace(x0, x1, 30), np.linspace(y0, y1, 30)
    for k in range(29):
        cut_along(lattice, state, xs[k], ys[k], xs[k + 1], ys[k + 1])
    assert apart(lattice, state, 20, len(lattice.free) - 20)
    assert not apart(lattice, state, 20, 21)


def test_beside_the_sheet_there_is_nothing_to_cut(sheet):
    lattice, state = sheet
    assert cut_along(lattice, state, -0.02, -0.02, -0.01, -0.01) == 0
    assert cut_along(lattice, state, 0.03, 0.03, 0.03, 0.03) == 0

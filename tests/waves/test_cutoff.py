"""The modes a footprint needs, against what leaving the others out costs."""

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Profile
from trocar.tissues.catalogue import tissue
from trocar.waves.cutoff import cutoff_for, measured_cutoff, modes_for
from trocar.waves.footprint import transform
from trocar.waves.membrane import WaveMembrane

SIZE = (0.06, 0.06)
STACK = WaveMembrane.fitted(tissue("skin"), size=SIZE, modes=(1, 1)).stack


MODES = 180


@pytest.fixture(scope="module")
def compliance():
    return WaveMembrane(STACK, size=SIZE, modes=(MODES, MODES)).static_compliance()[..., 0]


def deflections(compliance, place, radius, profile):
    """What each mode adds under a tool's centre, but for the force."""
    k = np.pi / SIZE[0] * np.arange(1, MODES + 1)
    shape = np.sin(k * place)[:, None] * np.sin(k * 0.03)[None, :]
    return compliance * transform(profile, radius * np.hypot(k[:, None], k[None, :])) * shape**2


@pytest.mark.parametrize("radius", [0.004, 0.006])
@pytest.mark.parametrize("place", [0.03, 0.0213])
@pytest.mark.parametrize(
    ("profile", "tolerance"),
    [
        (Profile.GAUSSIAN, 1e-2),
        (Profile.GAUSSIAN, 1e-4),
        (Profile.SPHERE, 1e-2),
        (Profile.SPHERE, 1e-3),
        (Profile.FLAT, 1e-2),
    ],
)
def test_the_error_of_a_truncated_series_stays_below_the_tolerance(
    compliance, radius, place, profile, tolerance
):
    m, n = modes_for(radius, profile, SIZE, tolerance)
    assert max(m, n) < MODES
    added = deflections(compliance, place, radius, profile)
    assert abs(added.sum() - added[:m, :n].sum()) < tolerance * added.sum()


@pytest.mark.parametrize("radius", [0.003, 0.006])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
def test_the_measured_cut_off_is_tight(radius, tolerance):
    compliance = WaveMembrane(STACK, size=SIZE, modes=(56, 56)).static_compliance()
    k = measured_cutoff(compliance, SIZE, radius, Profile.GAUSSIAN, tolerance)
    assert k < cutoff_for(radius, Profile.GAUSSIAN, tolerance)
    m, n = np.meshgrid(np.arange(1, 57), np.arange(1, 57), indexing="ij")
    wave = np.pi / SIZE[0] * np.hypot(m, n)
    share = compliance[..., 0] * np.exp(-((radius * wave) ** 2) / 8)
    left_out = share[wave > k * (1 + 1e-9)].sum() / share.sum()  # a ring of equal k, but for rounding, stays
    # The next wave would be too much: a ring of equal k holds less than a tenth of the tail.
    assert 0.5 * tolerance < left_out <= tolerance


def test_more_modes_for_smaller_tools_and_tolerances():
    wide, narrow = (modes_for(r, Profile.GAUSSIAN, (0.06, 0.03), 1e-4) for r in (0.006, 0.003))
    assert narrow[0] in (2 * wide[0] - 1, 2 * wide[0])
    assert wide[0] in (2 * wide[1] - 1, 2 * wide[1])
    for profile in Profile:
        assert cutoff_for(0.003, profile, 1e-4) > cutoff_for(0.003, profile, 1e-3)


@pytest.mark.parametrize(
    ("radius", "tolerance"), [(0.0, 0.1), (float("nan"), 0.1), (0.003, 0.0), (0.003, 1.0)]
)
def test_an_impossible_question_is_refused(radius, tolerance):
    with pytest.raises(InputError, match="cut-off"):
        modes_for(radius, Profile.FLAT, SIZE, tolerance)


def test_a_model_with_too_few_modes_cannot_tell():
    compliance = WaveMembrane(STACK, size=SIZE, modes=(8, 8)).static_compliance()
    with pytest.raises(InputError, match="modes"):
        measured_cutoff(compliance, SIZE, 0.003, Profile.GAUSSIAN, 1e-4)

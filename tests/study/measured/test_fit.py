"""Fits find the parameters a curve was made with, and rubber's behave as rubber does."""

from __future__ import annotations

import numpy as np
import pytest

from measured_sets import measured_folder
from trocar.study.measured.fit import fit_fibre, fit_neo_hookean, fit_ogden
from trocar.study.measured.homogeneous import uniaxial
from trocar.study.measured.rubber import FOLDER, read_rubber
from trocar.study.measured.stretched import foretell_rubber
from trocar.tissues.law import Fibre, Law, NeoHookean, Ogden

STRETCH = np.linspace(1.02, 1.6, 30)
MU = 2.5e4


def pulled(law: Law, mu: float) -> np.ndarray:
    return uniaxial(law, mu, STRETCH)


def test_neo_hookean_is_found() -> None:
    assert fit_neo_hookean(pulled, pulled(NeoHookean(), MU)).shear_modulus == pytest.approx(MU, rel=1e-12)


def test_an_ogden_law_is_found_and_keeps_the_sign_of_its_exponent() -> None:
    for exponent, start in ((4.5, 2.0), (-3.0, -5.0)):
        made = pulled(Ogden(terms=((1.0, exponent),)), MU)
        found = fit_ogden(pulled, made, ((1e4, start),))
        assert isinstance(found.law, Ogden)
        # exact data: what is left is where the search stops
        assert found.law.terms[0][1] == pytest.approx(exponent, rel=1e-5)
        assert found.shear_modulus == pytest.approx(MU, rel=1e-5)


def test_a_fibre_law_is_found() -> None:
    made = pulled(Fibre(k1=8e3, k2=1.5), MU)
    found = fit_fibre(pulled, made, start=(1e4, 2e4, 0.5))
    assert isinstance(found.law, Fibre)
    # the search ends where the curves differ by 1e-8; k1 and k2 are told apart by a few per cent of the stress
    assert (found.shear_modulus, found.law.k1, found.law.k2) == pytest.approx((MU, 8e3, 1.5), rel=1e-4)


def test_what_is_fitted_to_treloar_holds_for_kawabata() -> None:
    found = {one.name: one for one in foretell_rubber(read_rubber(measured_folder() / FOLDER))}
    # two rubbers whose stress differs by 4 % in the same experiment; the margins are twice what is printed in the docs
    assert found["neo-Hookean"].biaxial < 0.2
    assert found["Ogden, 2 terms"].uniaxial < 0.1
    assert found["Ogden as of 1972"].biaxial < 0.3

"""The public names: each is found where the table says, and `import trocar` loads none of them."""

from __future__ import annotations

import subprocess
import sys
from importlib import import_module

import pytest

import trocar

HOMES = trocar._HOME


@pytest.mark.parametrize("name", sorted(HOMES))
def test_a_public_name_is_the_object_in_its_module(name: str) -> None:
    value = getattr(trocar, name)
    assert value is getattr(import_module(HOMES[name]), name)
    assert value.__module__ == HOMES[name]  # where it is defined, not a re-export of a re-export
    assert name in dir(trocar)


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'liver'"):
        _ = trocar.liver


@pytest.mark.parametrize("statement", ["import trocar", "from trocar.cli import application; application()"])
def test_the_library_is_not_loaded_before_it_is_used(statement: str) -> None:
    heavy = "{'numpy', 'scipy', 'numba', 'skfem', 'xarray', 'matplotlib', 'pandas'}"
    code = f"import sys; {statement}; print(sorted({heavy} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"

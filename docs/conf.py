"""Sphinx settings. Pages are found by globbing: a new page needs no edit here or in an index."""

from __future__ import annotations

import trocar

project = "Trocar"
author = "The Trocar developers"
copyright = "2026, The Trocar developers"
version = release = trocar.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.apidoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "sphinx.ext.napoleon",
]
exclude_patterns = ["_build"]

myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath", "fieldlist"]
myst_heading_anchors = 3

# Every module gets a page, from its docstrings alone.
apidoc_modules = [
    {
        "path": "../src/trocar",
        "destination": "reference/api",
        "separate_modules": True,
        "module_first": True,
        # A package's re-exports are documented where they live, once.
        "automodule_options": {"members", "show-inheritance", "ignore-module-all"},
    }
]
autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
napoleon_numpy_docstring = False

nitpick_ignore_regex = [
    (r"py:.*", r"(?!trocar\.).*"),  # references must resolve inside Trocar; elsewhere needs a network
    (r"py:.*", r".*\.[A-Z]"),  # type variables have no entry of their own
]

html_theme = "furo"
html_title = f"Trocar {version}"
html_copy_source = False
html_show_sphinx = False

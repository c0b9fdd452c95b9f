"""Sphinx settings. Pages are found by globbing: a new page needs no edit here or in an index."""

from __future__ import annotations

import re

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
autodoc_default_options = {"ignore-module-all": True}  # apidoc gives its options to modules, not to packages
autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
napoleon_numpy_docstring = False
napoleon_use_ivar = True  # "Attributes:" of a class lists what autodoc finds again as members

nitpick_ignore_regex = [
    (r"py:.*", r"(?!trocar\.).*"),  # references must resolve inside Trocar; elsewhere needs a network
    (r"py:.*", r".*\.[A-Z]"),  # type variables have no entry of their own
    (r"py:.*", r".*\.\w+_contra"),
]
# A short name that two modules have; that a name leads nowhere is still an error.
suppress_warnings = ["ref.python"]

highlight_language = "text"  # a literal block in a docstring is mathematics
html_theme = "furo"
html_title = f"Trocar {version}"
html_copy_source = False
html_show_sphinx = False


def setup(app) -> None:
    """Connect what reads docstrings, before napoleon does."""
    app.connect("autodoc-process-docstring", _as_written, priority=100)


def _as_written(_app, _what, _name, _object, _options, lines: list[str]) -> None:
    """Keep plain-text mathematics: an indented paragraph is a literal block, and |x| is no substitution."""
    kept: list[str] = []
    literal, last = False, ""  # last: the latest line with text
    for line in lines:
        if line.strip():
            indented = line.startswith("  ")
            starts = indented and kept and not kept[-1] and re.match(r"\S", last)
            if starts and not last.endswith("::"):
                kept += ["::", ""]
            literal = indented and (literal or bool(starts))
            last = line
            kept.append(line if literal else line.replace("|", r"\|"))
        else:
            kept.append(line)
    lines[:] = kept

# One command does everything: each target first makes .venv if it is missing or out of date.
#
# PYTHON names the interpreter; without it the first of the four below that runs, is 3.11 to 3.13 and can make a
# virtual environment is taken (a pyenv shim may be on the path and still not run, so each is tried).

SHELL := bash
.SHELLFLAGS := -eu -o pipefail -c
.ONESHELL:
.DELETE_ON_ERROR:
.DEFAULT_GOAL := help
MAKEFLAGS += --no-print-directory

PIP := .venv/bin/python -m pip -qq --disable-pip-version-check --no-input
IN_RANGE := import sys, venv, ensurepip; sys.exit(not (3, 11) <= sys.version_info[:2] <= (3, 13))
DEV_GROUP := import tomllib; print(*tomllib.load(open("pyproject.toml", "rb"))["dependency-groups"]["dev"], sep="\n")
WORKERS ?= 2

.PHONY: help
help:  ## list the targets
	@sed -nE 's/^([a-z]+)( [a-z]+)?:.*## /make \1\t/p' $(MAKEFILE_LIST) | expand -t 12

.PHONY: run
run: .venv/ready .venv/compiled  ## set up, then open the trainer in the browser; Ctrl-C ends it
	@.venv/bin/trocar train

.PHONY: study
study: .venv/ready .venv/compiled  ## set up, then run the validation study into study/
	@.venv/bin/trocar study --out study

.PHONY: test
test: .venv/ready .venv/prepared  ## set up, then run every test, the client's too (WORKERS=2)
	@.venv/bin/python hatch_build.py check
	.venv/bin/python -m pytest -q -m alone
	.venv/bin/python -m pytest -q -n $(WORKERS) -m "not alone"

.PHONY: lint
lint: .venv/ready  ## style, format, types and the layers of imports
	@.venv/bin/ruff check --quiet
	.venv/bin/ruff format --check --quiet || { echo "make: run .venv/bin/ruff format"; exit 1; }
	.venv/bin/mypy
	.venv/bin/lint-imports --no-logo

.PHONY: docs
docs: .venv/ready  ## build the documentation into docs/_build/html; a warning is an error
	@.venv/bin/sphinx-build -q -n -W --keep-going -b html docs docs/_build/html
	echo "make: docs/_build/html/index.html"

.PHONY: pictures
pictures: .venv/ready  ## draw the README's pictures again, out of a study, into docs/_static/
	@.venv/bin/python bench/showcase.py

.PHONY: shots
shots: .venv/ready  ## take the trainer's pictures with Chromium, into docs/_static/trainer/
	@.venv/bin/python bench/shots.py
	.venv/bin/python bench/lesson_shots.py

.PHONY: wheel
wheel: .venv/ready  ## build the wheel into dist/
	@rm -f dist/*.whl
	$(PIP) wheel --no-deps --no-build-isolation --wheel-dir dist .
	ls dist/*.whl

.PHONY: lock
lock:  ## pin every dependency again, by hash (needs Python 3.11: what it resolves, 3.12 and 3.13 accept)
	@python3.11 -m venv --clear build/lock
	build/lock/bin/pip --quiet --disable-pip-version-check install pip-tools==7.6.2
	compile() {
	  build/lock/bin/pip-compile --quiet --upgrade --generate-hashes --strip-extras --no-header \
	    --no-emit-index-url --no-emit-trusted-host --no-emit-find-links --no-emit-options "$$@"
	}
	compile --output-file requirements/runtime.txt pyproject.toml
	build/lock/bin/python -c '$(DEV_GROUP)' > requirements/dev.in
	compile --output-file requirements/dev.txt --constraint requirements/runtime.txt pyproject.toml requirements/dev.in
	sed -i 's|-r requirements/dev.in|the dev group (pyproject.toml)|' requirements/dev.txt
	rm requirements/dev.in

.PHONY: clean
clean:  ## remove everything that was made, the virtual environment too
	@rm -rf .venv build dist study docs/_build docs/reference/api client/node_modules src/trocar/web/static
	rm -rf .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
	find src tests docs -name __pycache__ -type d -prune -exec rm -rf {} +

# The environment, in two stamps: the pinned dependencies, then the package itself, linked to src/.

.venv/bin/python:
	@found=$(PYTHON)
	if [ -z "$$found" ]; then
	  for python in python3.13 python3.12 python3.11 python3; do
	    if $$python -c '$(IN_RANGE)' 2>/dev/null; then found=$$python; break; fi
	  done
	elif ! $$found -c '$(IN_RANGE)'; then
	  found=
	fi
	if [ -z "$$found" ]; then
	  echo "make: Trocar needs Python 3.11, 3.12 or 3.13 with its venv module, and found none that runs." >&2
	  echo "make: install one (Debian, Ubuntu: apt install python3 python3-venv) or name it: make PYTHON=..." >&2
	  exit 1
	fi
	echo "make: .venv with $$($$found --version)"
	$$found -m venv --clear .venv

.venv/dependencies: requirements/dev.txt .venv/bin/python
	@echo "make: installing $$(grep -c '==' $<) pinned packages, a minute or two the first time"
	$(PIP) install --require-hashes --only-binary :all: -r $<
	touch $@

# Making the package builds the browser client too, where its source has changed (hatch_build.py).
CLIENT := $(shell find client -name node_modules -prune -o -type f -print)

.venv/ready: pyproject.toml hatch_build.py $(CLIENT) .venv/dependencies
	@$(PIP) install --no-deps --no-build-isolation --no-index --editable .
	touch $@

# Compiled code holds copies of what it calls, and numba looks only at the file of the caller: after an edit all of it is
# compiled again.
SOURCES := $(shell find src -name '*.py')

.venv/compiled: $(SOURCES) .venv/ready
	@find src -name '*.nb[ci]' -delete
	touch $@

# Tests begin tasks at a page, and wait no longer for one than somebody would who has the code compiled already.
.venv/prepared: .venv/compiled
	@.venv/bin/trocar prepare
	touch $@

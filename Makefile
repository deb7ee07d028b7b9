# `make` alone prints this list. Every verb sets up what it needs first.
PY := .venv/bin/python
PACKAGES := compilation hsr8 navigation walking vision
SOURCES := $(PACKAGES) examples scripts tests
# One thread per process: linear algebra on tiny matrices only loses time to more.
export OMP_NUM_THREADS := 1
export OPENBLAS_NUM_THREADS := 1
export MKL_NUM_THREADS := 1
# The many processes of a test run start faster with bytecode, which container images may switch off.
export PYTHONDONTWRITEBYTECODE :=
# Two test processes, a file each; in one process, which debuggers want: make test XDIST=
XDIST ?= -n 2 --dist loadfile

.DEFAULT_GOAL := help
.PHONY: help setup run test test-all interpreters benchmarks docs lint types layers fix lock build clean

help:  ## list of targets
	@awk 'BEGIN {FS = ":.*## "} /^[a-z-]+:.*## / {printf "  make %-13s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

setup:  ## virtual environment, locked packages, OpenGL for machines without a display
	@bash scripts/setup.sh

run: setup  ## the paper's experiment, with its video: make run ARGS="--seed 7"
	@bash scripts/run_paper.sh $(ARGS)

test: setup  ## fast test suite: make test ARGS="-k gait"
	@$(PY) -m pytest $(XDIST) $(ARGS)

test-all: setup  ## all tests, including the slow studies
	@$(PY) -m pytest $(XDIST) -m "slow or not slow" --timeout 3600 $(ARGS)

interpreters: setup  ## system tests, runs and exports with every further supported Python found here
	@$(PY) scripts/check_interpreters.py

benchmarks: setup  ## results, about five hours, resumable: make benchmarks ONLY="gaze planners"
	@$(PY) scripts/benchmarks.py $(if $(ONLY),--only $(ONLY)) $(ARGS)

docs: setup  ## the manual in build/docs (installs Sphinx the first time)
	@$(PY) -c "import furo, myst_parser" 2>/dev/null || $(PY) -m pip install -qq --disable-pip-version-check --no-build-isolation --editable ".[docs]"
	@$(PY) -m sphinx --builder html --fail-on-warning --keep-going --quiet docs build/docs
	@echo ":: build/docs/README.html"

lint: setup  ## ruff: style and formatting
	@$(PY) -m ruff check $(SOURCES)
	@$(PY) -m ruff format --check $(SOURCES)

types: setup  ## mypy, strict
	@$(PY) -m mypy

layers: setup  ## import rules
	@.venv/bin/lint-imports --no-logo

fix: setup  ## ruff fixes and formatting; regenerate docs/scenarios.md, data.md and metrics.md
	@$(PY) -m ruff check --fix $(SOURCES)
	@$(PY) -m ruff format $(SOURCES)
	@$(PY) scripts/write_scenario_reference.py
	@$(PY) scripts/write_data_reference.py
	@$(PY) scripts/write_metric_reference.py

lock:  ## resolve the dependencies into requirements.lock (needs the network)
	@bash scripts/lock.sh $(ARGS)

build: setup  ## build the wheel and test it in a separate environment
	@bash scripts/smoke_wheel.sh

clean:  ## remove caches and build products; runs/ and .venv* stay
	@rm -rf build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis .import_linter_cache MUJOCO_LOG.TXT
	@find $(SOURCES) models -name __pycache__ -type d -prune -exec rm -rf {} +

# make demo      set up and run the paper's study; prints two tables and the path of the report
# make test      set up and run every check and test
# make check     format, lint, layers, types and docstrings only
# make fast      the tests without those marked slow
# make validate  every published case, spoiled inputs and the deliberate faults; writes docs/validation.md
#                (make validate ONLY=V1 runs one case again and prints its rows)
# make faults    put faults into a copy of the source; every one must make a test fail
# make bench     speed, as ratios within one run
# make dist      wheel and source archive in dist, checked as they would be published
# make docs      the manual with all references, as HTML in build/docs; a warning is an error
#                (make docs GALLERY=all runs every example for its picture, not the quick ones alone)
PYTHON ?= python3
BIN := .venv/bin

.PHONY: help demo check test fast validate faults bench dist docs clean
.DEFAULT_GOAL := help

help:
	@sed -n 's/^# //p' Makefile

.venv/.ready-run: pyproject.toml constraints.txt scripts/setup_environment.py
	$(PYTHON) scripts/setup_environment.py
	@touch $@

.venv/.ready-dev: pyproject.toml constraints.txt scripts/setup_environment.py
	$(PYTHON) scripts/setup_environment.py fast cluster records seismic roads xlsx docs dev crosscheck
	@touch $@ .venv/.ready-run

demo: .venv/.ready-run
	$(BIN)/trundle run examples/paper/study.toml --out results/paper

check: .venv/.ready-dev
	$(BIN)/ruff format --check src tests scripts benchmarks examples docs/_ext docs/conf.py
	$(BIN)/ruff check src tests scripts benchmarks examples docs/_ext docs/conf.py
	$(BIN)/lint-imports --no-cache
	$(BIN)/basedpyright --pythonpath $(BIN)/python
	$(BIN)/python -m numpydoc lint $$(git ls-files "src/*.py")

test: check
	sh scripts/setup_browser.sh
	sh scripts/setup_gltf_validator.sh
	$(BIN)/python -m pytest -n 2 -m "not longest"

fast: .venv/.ready-dev
	$(BIN)/python -m pytest -n 2 -m "not slow and not longest"

ifdef ONLY
validate: .venv/.ready-dev
	$(BIN)/python -m pytest -n 2 -k "$(ONLY)" --record=build/validation_only.json tests/validation
else
validate: .venv/.ready-dev
	$(BIN)/python -m pytest -n 2 --record=build/validation.json tests/validation
	$(BIN)/python -m pytest -n 2 -m longest tests --ignore=tests/validation
	$(BIN)/python scripts/mutate_inputs.py
	$(BIN)/python scripts/combine_studies.py
	$(BIN)/python scripts/kill_at_random.py
	$(BIN)/python scripts/check_faults.py --json build/faults.json
	$(BIN)/python scripts/validation_page.py build/validation.json build/faults.json
endif

faults: .venv/.ready-dev
	$(BIN)/python scripts/check_faults.py --json build/faults.json

bench: .venv/.ready-dev
	$(BIN)/python benchmarks/direct_step.py
	$(BIN)/python benchmarks/ensemble_kernel.py
	$(BIN)/python benchmarks/direct_ensemble.py
	$(BIN)/python benchmarks/modes.py --eigsh
	$(BIN)/python benchmarks/exact_statistics.py
	$(BIN)/python benchmarks/floor_map.py
	$(BIN)/python benchmarks/scaling.py
	$(BIN)/python benchmarks/long_record.py
	$(BIN)/python benchmarks/memory.py
	$(BIN)/python benchmarks/estimate.py
	$(BIN)/python benchmarks/meshing.py
	$(BIN)/python benchmarks/day.py
	$(BIN)/python benchmarks/parts.py
	$(BIN)/python benchmarks/hundred_workers.py
	$(BIN)/python benchmarks/report.py

dist:
	$(PYTHON) scripts/build_distributions.py

docs: .venv/.ready-dev
	GALLERY=$(GALLERY) $(BIN)/python -m sphinx -q -W --keep-going -j auto -b html -d build/docs-kept docs build/docs
	@echo "manual: build/docs/index.html"

clean:
	rm -rf .venv results build dist

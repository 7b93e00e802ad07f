# make demo   set up and run the paper's study; prints two tables and the path of the report
# make test   set up and run every check and test
# make check  lint, types, layers, docstrings only
# make fast   the tests without those marked slow
PYTHON ?= python3
BIN := .venv/bin

.PHONY: demo test check fast clean
.DEFAULT_GOAL := help

help:
	@sed -n 's/^# //p' Makefile

.venv/.ready-run: pyproject.toml constraints.txt scripts/setup_environment.py
	$(PYTHON) scripts/setup_environment.py
	@touch $@

.venv/.ready-dev: pyproject.toml constraints.txt scripts/setup_environment.py
	$(PYTHON) scripts/setup_environment.py fast dev
	@touch $@ .venv/.ready-run

demo: .venv/.ready-run
	$(BIN)/trundle run examples/paper/study.toml --out results/paper

check: .venv/.ready-dev
	$(BIN)/ruff format --check src tests scripts
	$(BIN)/ruff check src tests scripts
	$(BIN)/lint-imports --no-cache
	$(BIN)/basedpyright --pythonpath $(BIN)/python
	$(BIN)/python -m numpydoc lint $$(git ls-files "src/*.py")

test: check
	$(BIN)/python -m pytest

fast: .venv/.ready-dev
	$(BIN)/python -m pytest -m "not slow"

clean:
	rm -rf .venv results

# make demo, make test: on a machine with nothing but Python 3.11 or newer and make.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --quiet --disable-pip-version-check
DEMO := slider-between-cranks
SCHEMES := tests/dynamics/test_simulation_schemes.py
# Tests that leave the choice of the executor to the program, or ask for what is missing. Where a test names the executor
# "arrays", or nothing of it is compiled or stored, it runs the same with the extras.
WITHOUT_EXTRAS := tests/sweeps/test_without_extras.py tests/sweeps/test_sweeps.py tests/sweeps/test_refusals.py \
	tests/sweeps/test_reduced.py tests/sweeps/test_gradients.py tests/numerics/test_scans.py tests/cli/test_sweep.py \
	$(SCHEMES)::test_a_step_that_is_shown_is_a_step $(SCHEMES)::test_nothing_that_moves_it

# Matrices are small, and workers run on every core: threads of the linear algebra would only wait for each other.
quick tests tests-without-extras samples campaigns snapshots: export OPENBLAS_NUM_THREADS := 1
# Workers, and the hundreds of processes that tests start, read what one of them has compiled, also where the
# environment forbids to keep it.
quick tests tests-without-extras samples: export PYTHONDONTWRITEBYTECODE :=

# A stamp is newer than pyproject.toml when what it stands for is installed.
BASE := $(VENV)/.stamp-base
FOR_DEMO := $(VENV)/.stamp-demo
FOR_TESTS := $(VENV)/.stamp-dev

.DELETE_ON_ERROR:
.PHONY: help demo test checks quick format lint types contracts catalogue-check reference-check docs tests \
	tests-without-extras catalogues reference campaigns samples benchmarks snapshots house clean

help: ## this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-22s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

demo: $(FOR_DEMO) ## compute a built-in mechanism into demo-output/
	$(BIN)/centrode run $(DEMO) --out demo-output

# A check is one process, so two run at a time; tests have a process for every processor.
test: $(FOR_TESTS) ## everything that CI checks
	$(MAKE) --jobs 2 checks
	$(MAKE) tests tests-without-extras

checks: lint types contracts catalogue-check reference-check docs ## what is checked without tests

# tests/quick.txt names one case of each topic, command, renderer and kind of refusal, the cheapest that reaches most.
# They are named, not marked: to find marked tests, each worker would import every file of tests first.
quick: $(FOR_TESTS) ## the shortest look at everything, below a minute; pictures are left blank
	$(BIN)/pytest -q -n auto --dist loadfile --blank @tests/quick.txt

lint: $(FOR_TESTS) ## format and lint, without changing anything
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .

types: $(FOR_TESTS) ## strict types
	$(BIN)/mypy

contracts: $(FOR_TESTS) ## which room may import which
	$(BIN)/lint-imports

catalogue-check: $(FOR_TESTS) ## translations complete and compiled
	$(BIN)/python tools/catalogues.py check

reference-check: $(FOR_TESTS) ## pages made from the program are as it is
	$(BIN)/python -m tools.reference check

docs: $(FOR_TESTS) ## the documentation as a site in docs/_build/html, with warnings as errors
	$(BIN)/sphinx-build --quiet --fail-on-warning --nitpicky --builder html docs docs/_build/html

# The blocks of one document share their names. Files keep their order: long ones, of browsers, come early and short pages
# last, so that no worker waits for another one; by their number of tests, long files of few tests would come last.
tests: $(FOR_TESTS) ## tests and the code blocks of the documentation
	$(BIN)/pytest -q -n auto --dist loadfile --no-loadscope-reorder

tests-without-extras: $(FOR_TESTS) ## what machine code and stores are for, as if llvmlite and zarr were not installed
	PYTHONPATH="$(CURDIR)/tests/absent" CENTRODE_WITHOUT="llvmlite zarr" \
	$(BIN)/pytest -q -p no:zarr -n auto --dist loadfile $(WITHOUT_EXTRAS)  # zarr brings a plugin of its own

format: $(FOR_TESTS) ## format and mend what can be mended
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

catalogues: $(FOR_TESTS) ## take new sentences into the catalogues and compile them
	$(BIN)/python tools/catalogues.py update
	$(BIN)/python tools/catalogues.py compile

reference: $(FOR_TESTS) ## make the pages of the documentation that are made from the program
	$(BIN)/python -m tools.reference

campaigns: $(FOR_TESTS) ## random cases against independent oracles, as far as CAMPAIGNS says; goes on where it was
	$(BIN)/python -m tools.campaigns $(CAMPAIGNS)

samples: $(FOR_TESTS) ## the random samples of the tests in full: the suite looks at some of their cases
	CENTRODE_SAMPLES=all $(BIN)/pytest -q -n auto --dist loadfile tests

benchmarks: $(FOR_TESTS) ## ratios against peers and against the machine
	$(PIP) install --editable '.[dev,benchmarks]'
	$(BIN)/python -m benchmarks

snapshots: $(FOR_TESTS) ## compare what every command gives with its record, to 1e-12
	$(BIN)/python -m tools.snapshots check --jobs 2

house: $(BASE) ## counts of modules, names, lines and imports
	$(BIN)/python -m tools.house

clean: ## remove everything that make made
	rm -rf $(VENV) demo-output campaigns-output mutants-output docs/_build build dist .mypy_cache .ruff_cache .pytest_cache .import_linter_cache .hypothesis
	find src tests tools benchmarks docs -name __pycache__ -type d -prune -exec rm -rf {} +

$(BASE):
	@command -v "$(PYTHON)" >/dev/null 2>&1 || { echo "$(PYTHON) not found: install Python 3.11 or newer, or say make PYTHON=/path/to/python3" >&2; exit 1; }
	@"$(PYTHON)" -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "$(PYTHON) is $$($(PYTHON) --version 2>&1): centrode needs Python 3.11 or newer; say make PYTHON=/path/to/python3.11" >&2; exit 1; }
	"$(PYTHON)" -m venv $(VENV)
	@touch $@

$(FOR_DEMO): $(BASE) pyproject.toml
	$(PIP) install --editable '.[figures]'
	@touch $@

$(FOR_TESTS): $(BASE) pyproject.toml
	$(PIP) install --editable '.[dev]'
	@touch $(FOR_DEMO) $@

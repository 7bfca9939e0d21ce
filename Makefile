# `make run` and `make test` need only make and Python 3.11 or newer.
# Each makes .venv from the hashed lock when it is missing or stale (tools/environment.py).

PYTHONS := $(or $(PYTHON),python3 python3.13 python3.12 python3.11 python3.14)
BIN := .venv/bin
WORKERS ?= 2
PYTEST := $(BIN)/python -m pytest -n $(WORKERS) --dist worksteal -p no:benchmark
# What a change breaks most often: keys and units, formulas, and one impact of each kind of law.
CHECKED := $(addprefix tests/,config/test_case.py config/test_case_input.py config/test_resolve.py \
	materials numerics test_errors.py test_units.py) $(addprefix tests/validation/test_, \
	jkr_restitution.py greenwood_tripp.py rigid_paraboloid.py hunter_impact.py)
COMPILE := uv pip compile pyproject.toml --universal --fork-strategy fewest --generate-hashes \
	--no-emit-index-url --python-version 3.11 --no-header --quiet

.PHONY: help run check test validate bench frozen docs lint lock wheel clean
.PHONY: run-environment dev-environment

help:
	@echo "make run       set up, run the case glass-bead, reproduce the publication"
	@echo "make check     lint, types and a quarter of the tests, in under a minute once compiled"
	@echo "make test      set up, then lint, types, docs and all tests but the long ones"
	@echo "make validate  the long validation studies"
	@echo "make bench     the benchmarks, beside a plain SciPy script"
	@echo "make frozen    the answers of today beside the frozen set"
	@echo "make docs      the documentation, in docs/_build/html"
	@echo "make lint      ruff, mypy and the import contract"
	@echo "make lock      remake the lock files (needs uv; UPGRADE=1 moves to newer versions)"
	@echo "make wheel     the wheel, in dist"
	@echo "make clean     remove what was made, except .venv"

run: run-environment
	$(BIN)/asperity run glass-bead --force
	$(BIN)/asperity reproduce --force

check: lint
	$(PYTEST) -q $(CHECKED)

# pytest last, so that its summary closes the output.
test: dev-environment
	$(MAKE) --no-print-directory -j 2 lint docs
	$(PYTEST) --durations=10

validate: dev-environment
	$(PYTEST) -m long

bench: dev-environment
	$(BIN)/python -m benchmarks

frozen: dev-environment
	$(BIN)/python -m tools.frozen compare

# -E: executed pages and docstrings follow the code, not the last build.
docs: dev-environment
	$(BIN)/python -m sphinx -E -W --keep-going -q -j $(WORKERS) -b html docs docs/_build/html

lint: dev-environment
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports --no-logo

lock:
	@command -v uv >/dev/null || { echo "make lock needs uv (see CONTRIBUTING.md)" >&2; exit 1; }
	$(COMPILE) $(if $(UPGRADE),--upgrade) --group dev --output-file requirements-dev.lock
	$(COMPILE) --group build --constraint requirements-dev.lock --output-file requirements.lock

wheel: run-environment
	$(BIN)/python -m hatchling build --target wheel --directory dist

clean:
	rm -rf build dist docs/_build .pytest_cache .mypy_cache .ruff_cache .hypothesis \
		.benchmarks .import_linter_cache *-out
	find src tests benchmarks tools -name __pycache__ -type d -prune -exec rm -rf {} + 2>/dev/null || true

run-environment dev-environment: %-environment:
	@for python in $(PYTHONS); do \
		"$$python" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' \
			2>/dev/null && exec "$$python" tools/environment.py $*; \
	done; \
	echo "asperity needs Python 3.11 or newer with venv (tried: $(PYTHONS)); name it with PYTHON=" >&2; \
	exit 1

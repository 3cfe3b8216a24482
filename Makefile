# Every target makes .venv when it is missing or stale. OUT is where the demo writes.
PYTHON ?= python3
OUT ?= demo
BIN := .venv/bin

.PHONY: demo test lint bench verify portable notebooks docs clean

demo: .venv/installed
	$(BIN)/cogmap demo --out $(OUT)

# Many processes import the same: the first to do so leaves them its bytecode, whatever the environment says.
test: export PYTHONDONTWRITEBYTECODE =
# A worker a core: threads of one would wait for those of the others.
test: export OMP_NUM_THREADS = 1
test: .venv/installed
	$(BIN)/python -m pytest --numprocesses auto --dist loadfile --no-loadscope-reorder

lint: .venv/installed
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

bench: .venv/peers
	$(BIN)/python -m benchmarks --report docs/performance.md

verify: .venv/peers
	$(BIN)/python -m pytest -m full -rA

portable: .venv/installed
	$(BIN)/python -m pytest -m full -rA tests/verify/test_processors.py

notebooks: .venv/installed
	$(BIN)/jupyter execute --inplace --timeout=1800 notebooks/*.ipynb

docs: .venv/documented
	$(BIN)/python -m sphinx --fail-on-warning --keep-going --nitpicky --quiet -b html docs docs/_build/html
	$(BIN)/python docs/check_site.py docs/_build/html

.venv/installed: pyproject.toml constraints.txt
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt --editable '.[dev]'
	touch $@

.venv/peers: .venv/installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt --editable '.[dev,peers]'
	touch $@

.venv/documented: .venv/installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt --editable '.[dev,docs]'
	touch $@

clean:
	rm -rf .venv docs/_build docs/api/generated docs/notebooks

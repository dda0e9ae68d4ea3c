# The first two commands of the README: `make demo` and `make test`.
PYTHON ?= python3
VENV = .venv
BIN = $(VENV)/bin
INSTALL = $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile
# One BLAS thread per process: the matrices are small, and campaigns use processes.
export OMP_NUM_THREADS = 1
export OPENBLAS_NUM_THREADS = 1
export MKL_NUM_THREADS = 1
# The tests start Python hundreds of times: what is compiled is kept, also where the environment says otherwise.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: demo test lint docs bench research release lock

# What the demo needs: the package and its dependencies. Python compiles of them what is used, when it
# is used; all of it would be half of the time of the install.
$(VENV)/.demo: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(INSTALL) --editable .
	touch $@

# What tests and checks need, with LOCKED=1 in the versions and with the hashes of requirements/dev.txt; compiled,
# because they start Python many times; some files that libraries bring for other Pythons cannot be.
$(VENV)/.installed: $(VENV)/.demo
	$(INSTALL) $(if $(LOCKED),--require-hashes --requirement requirements/dev.txt,--editable ".[dev]")
	$(BIN)/python -m compileall -qq -j 0 $(VENV)/lib || true
	touch $@

demo: $(VENV)/.demo
	$(BIN)/python examples/pdms_lens.py

# Four minutes are the aim. MARK=slow has the tests of some minutes, MARK=outside those that need what is not in the
# repository, with OPTIONS (CONTRIBUTING.md). What takes seconds again and again shares a fixture or is marked slow.
MARK ?= not slow and not outside
test: $(VENV)/.installed
	$(BIN)/python -m pytest -m "$(MARK)" -n 2 --dist worksteal -q --durations=15 $(OPTIONS)

# Style, imports between rooms, types on this system and on Windows, and the links between the pages.
lint: $(VENV)/.installed
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports
	$(BIN)/pyright & $(BIN)/pyright --pythonplatform Windows src && wait $$!
	$(INSTALL) "sphinx>=9.0" "myst-parser>=5.0"
	$(BIN)/python -m sphinx -q -W --keep-going -t pages -b dummy -c docs -d out/pages-cache . out/pages

# The site in out/site, from every page, docstring and example; a warning and a broken link are errors. Four minutes.
docs: $(VENV)/.demo
	$(INSTALL) --editable ".[docs]"
	$(BIN)/python -m sphinx -q -W --keep-going -b html -c docs -d out/site-cache . out/site
	$(BIN)/python -m release.links out/site

# Speed beside the published algorithm, and stated errors beside true ones: four minutes.
bench: $(VENV)/.demo
	$(BIN)/python -m research.speed
	$(BIN)/python -m research.accuracy

# The tests of research/, and the thesis's figures and ledger from kept numbers; research/README.md has the rest.
research: $(VENV)/.installed
	$(INSTALL) --editable ".[research]"
	$(BIN)/python -m pytest research -q -m "$(MARK)"
	$(BIN)/python -m research.replication --all

# The release folder out/release of the last commit with its bill of materials (CycloneDX), built twice: fails where
# the bytes differ. URL is where its files can be read, for the links of the README on an index. Two minutes.
release: $(VENV)/.installed
	$(INSTALL) --editable ".[release]"
	mkdir -p out
	$(BIN)/cyclonedx-py environment --pyproject pyproject.toml --output-file out/sbom.json $(BIN)/python
	$(BIN)/python -m release --sbom out/sbom.json $(URL:%=--url %)

# Newest versions with hashes, for development and CI, and the lowest ones, for every system.
COMPILE = $(BIN)/uv pip compile pyproject.toml --quiet --extra dev --universal --python-version 3.11 \
	--no-annotate --custom-compile-command "make lock"
lock: $(VENV)/.demo
	$(INSTALL) "uv>=0.4"
	$(COMPILE) --upgrade --generate-hashes --output-file requirements/dev.txt
	$(COMPILE) --upgrade --resolution lowest-direct --output-file requirements/lowest.txt

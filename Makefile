# The first two commands of the README: `make demo` and `make test`.
PYTHON ?= python3
TABLE ?= rows.csv
TACK ?= tack-files
VENV := .venv
BIN := $(VENV)/bin
INSTALL = $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile
# One BLAS thread per process: the matrices are small, and campaigns use processes.
export OMP_NUM_THREADS = 1
export OPENBLAS_NUM_THREADS = 1
export MKL_NUM_THREADS = 1

.PHONY: demo test test-slow test-outside test-processors test-lowest lint types bench mutants fuzz \
	fuzz-files farm verification docs docs-pages docs-check paper lock sbom release audit clean

# What the demo needs: the package and what it stands on. Python compiles of it what is used, when it
# is used; all of it would be half of the time of the install.
$(VENV)/.demo: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(INSTALL) --editable .
	touch $@

# What tests, checks and benchmarks need beside it, with LOCKED=1 in the versions and with the hashes of
# requirements/dev.txt; compiled, for they start Python many times, and some files that libraries bring for
# other Pythons cannot be.
$(VENV)/.installed: $(VENV)/.demo
	$(INSTALL) $(if $(LOCKED),--require-hashes --requirement requirements/dev.txt,--editable ".[dev]")
	$(BIN)/python -m compileall -qq -j 0 $(VENV)/lib || true
	touch $@

demo: $(VENV)/.demo
	$(BIN)/python examples/pdms_lens.py

# Ten minutes on two quiet cores, the install excluded; four are the aim. Prints the 15 slowest and the total: what
# takes seconds again and again is shared in a fixture, made coarser, or marked slow.
test: $(VENV)/.installed
	$(BIN)/python -m pytest -m "not slow and not outside" -n 2 --dist worksteal -q --durations=15

# TABLE is the table of detachments that replication/README.md says where to get, TACK the folder of
# public tack tests that docs/tack_tests.md names.
test-outside: $(VENV)/.installed
	$(BIN)/python -m pytest -m outside -q --table="$(TABLE)" --tack="$(TACK)"

# Some minutes each; with `make test` thirty minutes on two quiet cores; twenty are the aim.
test-slow: $(VENV)/.installed
	$(BIN)/python -m pytest -m slow -n 2 --dist worksteal -q --durations=15

# The tests of `make test` with the lowest versions that pyproject.toml permits, beside which newer libraries
# warn of what will change.
test-lowest: requirements/lowest.txt
	$(PYTHON) -m venv --clear .venv-lowest
	.venv-lowest/bin/python -m pip install --quiet --requirement $<
	.venv-lowest/bin/python -m pip install --quiet --no-deps --editable .
	.venv-lowest/bin/python -m pytest -m "not slow and not outside" -n 2 -q -W ignore::DeprecationWarning \
		-W ignore::PendingDeprecationWarning

test-processors: $(VENV)/.installed
	PYTHON=$(BIN)/python .ci/processors

lint: $(VENV)/.installed
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports

# Rooms that depend on the operating system, checked for the others too.
SYSTEMS = $(addprefix src/viscotack/,system.py files pool campaign app operations)
types: $(VENV)/.installed
	$(BIN)/pyright
	$(BIN)/pyright --pythonplatform Windows $(SYSTEMS)
	$(BIN)/pyright --pythonplatform Darwin $(SYSTEMS)

# Draws COUNT mutants with SEED, of ROOMS if they are given (ROOMS=bem,theory), one to four minutes each; a
# log keeps the verdicts, so that it may be stopped.
SEED ?= 1
COUNT ?= 40
mutants: $(VENV)/.installed
	$(INSTALL) --editable ".[mutants]"
	$(BIN)/python benchmarks/mutants.py --seed $(SEED) --count $(COUNT) $(ROOMS:%=--rooms %) \
		--log out/mutants-$(SEED).jsonl

# Relations that need no reference, between answers to random problems: CHECKS of them or what fits in
# MINUTES; 80 to 100 a minute of one quiet core. Ends with 1 where one does not hold; what was stopped
# goes on by its log.
MINUTES ?= 45
CHECKS ?= 3000
fuzz: $(VENV)/.installed
	$(BIN)/python -m fuzz --seed $(SEED) --minutes $(MINUTES) --checks $(CHECKS) --log out/fuzz-$(SEED).jsonl

# FILES mutated files for each reader, in some minutes; ends with 1 where one is neither read nor refused.
FILES ?= 1000
fuzz-files: $(VENV)/.installed
	$(BIN)/python -m fuzz.files --seed $(SEED) --files $(FILES)

# Rounds of kills, exits, mutated files, relations and damage until HOURS are over, in out/farm; SHORT=1
# draws less, for a round of some minutes.
HOURS ?= 1
farm: $(VENV)/.installed
	$(BIN)/python benchmarks/farm.py --hours $(HOURS) --seed $(SEED) $(if $(SHORT),--short)

# Newest versions with hashes, for development and CI, and the lowest ones, for every system.
COMPILE = $(BIN)/uv pip compile pyproject.toml --quiet --extra dev --universal --python-version 3.11 \
	--no-annotate --custom-compile-command "make lock"
lock: $(VENV)/.demo
	$(INSTALL) "uv>=0.4"
	$(COMPILE) --upgrade --generate-hashes --output-file requirements/dev.txt
	$(COMPILE) --upgrade --resolution lowest-direct --output-file requirements/lowest.txt

# The bill of materials (CycloneDX) of what is installed, and known vulnerabilities of what is locked, which
# needs a network.
sbom: $(VENV)/.installed
	$(INSTALL) "cyclonedx-bom>=4.4"
	mkdir -p out
	$(BIN)/cyclonedx-py environment --pyproject pyproject.toml --output-file out/sbom.json $(BIN)/python

# The release folder out/release of the last commit, built twice: fails where the bytes differ. URL is where
# the files of the release can be read, for the links of the README on an index. Two minutes.
release: sbom
	$(INSTALL) --editable ".[release]"
	$(BIN)/python -m release --sbom out/sbom.json $(URL:%=--url %)

audit: $(VENV)/.installed
	$(INSTALL) "pip-audit>=2.7"
	$(BIN)/pip-audit --disable-pip --no-deps --require-hashes --requirement requirements/dev.txt

# The site in out/site, from every page, docstring and example; a warning and a broken link are errors. Four minutes.
docs: $(VENV)/.demo
	$(INSTALL) --editable ".[docs]"
	$(BIN)/python -m sphinx -q -W --keep-going -b html -c docs -d out/site-cache . out/site
	$(BIN)/python -m release.links out/site

# Whether every page is read without a warning and every link between pages leads somewhere, without the reference
# and the examples: five seconds of a processor. The next `make docs` writes the reference again.
docs-pages: $(VENV)/.demo
	$(INSTALL) "sphinx>=9.0" "myst-parser>=5.0"
	$(BIN)/python -m sphinx -q -W --keep-going -t pages -b dummy -c docs -d out/pages-cache . out/pages

# Runs the commands whose output the pages show, and compares; WRITE=1 renews the pages. Two minutes.
docs-check: $(VENV)/.installed
	$(BIN)/python benchmarks/docs_check.py $(if $(WRITE),--write)

# The manuscript: out/paper/html, and out/paper/manuscript.pdf where latexmk and pdflatex are. One minute.
paper: $(VENV)/.demo
	$(INSTALL) --editable ".[docs]"
	$(BIN)/python -m paper.build

bench: $(VENV)/.installed
	$(BIN)/python benchmarks/bench.py

verification: $(VENV)/.installed
	$(BIN)/python benchmarks/verification.py --write

clean:
	rm -rf $(VENV) .venv-lowest build dist out

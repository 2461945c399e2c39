# One command per task; each sets up what it needs in .venv and target/.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
# an environment of the caller's must not leak in
unexport VIRTUAL_ENV PYTHONPATH PYTHONHOME CONDA_PREFIX
MATURIN := VIRTUAL_ENV=$(CURDIR)/$(VENV) $(BIN)/maturin develop --release --quiet

RUST := $(shell find crates -name '*.rs' -o -name Cargo.toml) Cargo.toml Cargo.lock

.PHONY: help demo test test-rust test-python lint docs bench bench-quick bench-rust bench-orbits bench-everything bench-spart bench-against certificate-campaign fuzz soak notices clean

help: ## this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*##/\t/' | expand -t 16

$(BIN)/maturin:
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip
	$(BIN)/python -m pip install --quiet 'maturin>=1.16,<2'

$(VENV)/.built: $(RUST) pyproject.toml README.md | $(BIN)/maturin
	$(MATURIN)
	@touch $@

$(VENV)/.tested: pyproject.toml | $(VENV)/.built
	$(MATURIN) --extras test,lint
	@touch $@

notices: ## THIRD_PARTY_NOTICES.txt, from the licences of the crates that the module links
	$(PYTHON) crates/py/notices.py

demo: $(VENV)/.built ## the paper's experiment: builds, runs, leaves out/humanoid_reach
	$(BIN)/onorbit run humanoid_reach --out out/humanoid_reach --force

test: test-rust test-python ## everything that proves it

test-rust: ## the engine alone; needs no Python
	cargo test --workspace --exclude onorbit-py

test-python: $(VENV)/.built $(VENV)/.tested ## the package, against independent engines
	$(BIN)/python -m pytest -n auto --maxprocesses 8 --dist worksteal

lint: $(VENV)/.built $(VENV)/.tested ## formatting, lints as errors, types
	cargo fmt --all --check
	PYO3_PYTHON=$(CURDIR)/$(BIN)/python cargo clippy --workspace --all-targets -- -D warnings
	RUSTDOCFLAGS='-D warnings' cargo doc --no-deps -p onorbit-core
	$(BIN)/ruff format --check python tests benches examples website
	$(BIN)/ruff check python tests benches examples website
	$(BIN)/mypy

$(VENV)/.documented: pyproject.toml | $(VENV)/.built
	$(MATURIN) --extras docs
	@touch $@

docs: $(VENV)/.built $(VENV)/.documented ## the documentation: built with warnings as errors, its links checked
	$(BIN)/python website/build.py

$(VENV)/.benched: pyproject.toml | $(VENV)/.tested
	$(MATURIN) --extras bench
	@touch $@

bench: $(VENV)/.built $(VENV)/.benched ## against Pinocchio and MuJoCo, built from PyPI's wheels and alternated; keeps a history
	$(BIN)/python benches/versus

bench-quick: $(VENV)/.built $(VENV)/.benched ## the same in a minute or two, not kept
	$(BIN)/python benches/versus --rounds 3 --seconds 0.05 --no-save

# REV= another revision; ROUNDS= how many; ROWS= only rows whose name contains it; or BUILT='other-tree this-tree'
bench-against: $(VENV)/.built $(VENV)/.tested ## this tree's speed against REV=revision, alternated; fails if a row is slower
	$(BIN)/python benches/versus/against.py $(if $(BUILT),--built $(BUILT),$(if $(REV),$(REV),HEAD)) \
		$(if $(ROUNDS),--rounds $(ROUNDS)) $(if $(ROWS),--rows '$(ROWS)')

bench-rust: $(VENV)/.built $(VENV)/.tested ## criterion for the kernels, pytest-benchmark for the border
	cargo bench -p onorbit-core
	$(BIN)/python -m pytest benches -o testpaths=benches --benchmark-only --benchmark-columns=min,median,iqr

bench-orbits: $(VENV)/.built $(VENV)/.tested ## propagation against sgp4, numpy, SciPy and brahe, alternated
	$(BIN)/python -m pip install --quiet scipy 'brahe==1.8.0'
	$(BIN)/python benches/compare_orbits.py

bench-everything: $(VENV)/.built ## humanoid_reach with the whole environment on against as it is bundled, alternated
	$(BIN)/python benches/compare_everything.py

bench-spart: $(VENV)/.built $(VENV)/.tested ## forward dynamics against SPART, compiled from PyPI's spartpy, alternated
	$(BIN)/python benches/compare_spart.py

certificate-campaign: $(VENV)/.built $(VENV)/.tested ## 10 000 exact runs and 1000 made wrong against their certificates; ARGS="--minutes 10"
	$(BIN)/python tests/certificate_campaign.py $(ARGS)

# SECONDS= of each parser; COUNT= inputs in all; SEED=; ONLY= parsers whose name contains it
fuzz: $(VENV)/.built $(VENV)/.tested ## every parser, guided by coverage; findings are kept and fail (docs/reliability.md)
	$(BIN)/python tests/fuzz $(if $(SECONDS),--seconds $(SECONDS)) $(if $(COUNT),--count $(COUNT)) \
		$(if $(SEED),--seed $(SEED)) $(if $(ONLY),--only $(ONLY))

# SECONDS= in all, an hour where not given; SEED=
soak: $(VENV)/.built $(VENV)/.tested ## kills, disk faults, leaks and long runs (docs/reliability.md)
	$(BIN)/python tests/soak $(if $(SECONDS),--seconds $(SECONDS)) $(if $(SEED),--seed $(SEED))

clean: ## forgets builds and the environment
	rm -rf target $(VENV) out

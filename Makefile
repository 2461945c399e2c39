# One command per task; each installs its dependencies in .venv and target/.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
# variables of an active environment must not affect the commands
unexport VIRTUAL_ENV PYTHONPATH PYTHONHOME CONDA_PREFIX
MATURIN := VIRTUAL_ENV=$(CURDIR)/$(VENV) $(BIN)/maturin develop --release --quiet

RUST := $(shell find crates -name '*.rs' -o -name Cargo.toml) Cargo.toml Cargo.lock

.PHONY: help demo test test-rust test-python lint docs docs-publish bench bench-quick bench-rust bench-orbits bench-everything bench-spart bench-streaming bench-against certificate-campaign contact-campaign capture-campaign test-campaign test-notebooks fuzz soak test-ros2 test-peers notices wheel gallery clean

help: ## prints this list
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

notices: ## writes THIRD_PARTY_NOTICES.txt from the licences of the crates in the module
	$(PYTHON) crates/py/notices.py

wheel: $(BIN)/maturin ## builds wheel (manylinux_2_28) and source distribution into dist/, tests both in new environments
	$(BIN)/python -m pip install --quiet 'maturin[zig]>=1.16,<2'
	$(BIN)/python crates/py/check_distributions.py

demo: $(VENV)/.built ## builds, runs the experiment of the paper, writes out/humanoid_reach
	$(BIN)/onorbit run humanoid_reach --out out/humanoid_reach --force

test: test-rust test-python ## runs all tests

test-rust: ## tests the engine; needs no Python
	cargo test --workspace --exclude onorbit-py

test-python: $(VENV)/.built $(VENV)/.tested ## tests the package, also against independent engines
	$(BIN)/python -m pytest -n auto --maxprocesses 8 --dist worksteal

lint: $(VENV)/.built $(VENV)/.tested ## checks formatting, lints and types
	cargo fmt --all --check
	PYO3_PYTHON=$(CURDIR)/$(BIN)/python cargo clippy --workspace --all-targets -- -D warnings
	RUSTDOCFLAGS='-D warnings' cargo doc --no-deps -p onorbit-core
	$(BIN)/ruff format --check python tests benches examples notebooks website
	$(BIN)/ruff check python tests benches examples notebooks website
	$(BIN)/mypy

$(VENV)/.documented: pyproject.toml | $(VENV)/.built
	$(MATURIN) --extras docs
	@touch $@

docs: $(VENV)/.built $(VENV)/.documented ## builds the documentation with warnings as errors and checks its links
	$(BIN)/python website/build.py

# NAME= entry of website/gallery.toml; default: all, in a few minutes
gallery: $(VENV)/.built $(VENV)/.tested ## runs the bundled scenarios, draws their pictures, writes docs/gallery.md
	$(BIN)/python website/gallery.py $(NAME)

# TO= folder of all versions, which can be served as it is
docs-publish: docs ## adds the documentation to a folder with one website per version
	$(BIN)/python website/publish.py '$(TO)'

$(VENV)/.benched: pyproject.toml | $(VENV)/.tested
	$(MATURIN) --extras bench
	@touch $@

bench: $(VENV)/.built $(VENV)/.benched ## compares the speed with Pinocchio and MuJoCo, alternated; stores the results
	$(BIN)/python benches/versus

bench-quick: $(VENV)/.built $(VENV)/.benched ## the same in a minute or two, without storing the results
	$(BIN)/python benches/versus --rounds 3 --seconds 0.05 --no-save

# REV= other revision; ROUNDS= number of rounds; ROWS= selects rows by name; or BUILT='other-tree this-tree'
bench-against: $(VENV)/.built $(VENV)/.tested ## compares the speed with REV=revision, alternated; fails if a row is slower
	$(BIN)/python benches/versus/against.py $(if $(BUILT),--built $(BUILT),$(if $(REV),$(REV),HEAD)) \
		$(if $(ROUNDS),--rounds $(ROUNDS)) $(if $(ROWS),--rows '$(ROWS)')

bench-rust: $(VENV)/.built $(VENV)/.tested ## times the kernels (Criterion) and the Python bindings (pytest-benchmark)
	cargo bench -p onorbit-core
	$(BIN)/python -m pytest benches -o testpaths=benches --benchmark-only --benchmark-columns=min,median,iqr

bench-orbits: $(VENV)/.built $(VENV)/.tested ## compares propagation with sgp4, numpy, SciPy and brahe, alternated
	$(BIN)/python -m pip install --quiet scipy 'brahe==1.8.0'
	$(BIN)/python benches/compare_orbits.py

bench-everything: $(VENV)/.built ## compares humanoid_reach with all effects and as bundled, alternated
	$(BIN)/python benches/compare_everything.py

bench-spart: $(VENV)/.built $(VENV)/.tested ## compares forward dynamics with SPART from PyPI's spartpy, alternated
	$(BIN)/python benches/compare_spart.py

bench-streaming: $(VENV)/.built ## memory and disk of 4000 s of humanoid_reach at 1 ms with every row; fails above 500 MB
	$(BIN)/python benches/streamed_run.py

certificate-campaign: $(VENV)/.built $(VENV)/.tested ## evaluates the certificates of 10 000 exact and 1000 defective runs; ARGS="--minutes 10"
	$(BIN)/python tests/certificate_campaign.py $(ARGS)

# CASES= number of cases whose workers are killed
test-campaign: $(VENV)/.built $(VENV)/.tested ## kills the workers of campaigns of 1000 cases; times 1000 cases, also on Dask
	CASES=$(or $(CASES),1000) $(BIN)/python -m pytest -s tests/test_campaign_processes.py tests/test_campaign_dask.py \
		-k 'killed_workers or workers_killed' --timeout 3600
	$(BIN)/python benches/campaigns.py

$(VENV)/.notebooks: pyproject.toml | $(VENV)/.tested
	$(MATURIN) --extras campaign,notebooks
	@touch $@

# NAMES= notebooks, default: all; OUT= folder for the notebooks with their outputs
test-notebooks: $(VENV)/.built $(VENV)/.notebooks ## runs the notebooks whole in Jupyter, fails on errors and unexpected warnings
	$(BIN)/python tests/run_notebooks.py $(NAMES) $(if $(OUT),--out '$(OUT)')

contact-campaign: ## checks momentum and energy of random trees through 1000 contacts; CONTACTS= sets their number
	CONTACTS=$(or $(CONTACTS),1000) cargo test --release -p onorbit-core --test contact_campaign -- --ignored --nocapture

capture-campaign: $(VENV)/.built ## measures many captures of 30 s on threads and repeats drawn cases; CASES= sets their number
	$(BIN)/python benches/capture_campaign.py $(if $(CASES),--cases $(CASES))

# SECONDS= per parser; COUNT= total number of inputs; SEED=; ONLY= selects parsers by name
fuzz: $(VENV)/.built $(VENV)/.tested ## fuzzes every parser, guided by coverage; fails on findings (docs/reliability.md)
	$(BIN)/python tests/fuzz $(if $(SECONDS),--seconds $(SECONDS)) $(if $(COUNT),--count $(COUNT)) \
		$(if $(SEED),--seed $(SEED)) $(if $(ONLY),--only $(ONLY))

# SECONDS= total duration, default: an hour; SEED=
soak: $(VENV)/.built $(VENV)/.tested ## tests kills, disk faults, leaks and long runs (docs/reliability.md)
	$(BIN)/python tests/soak $(if $(SECONDS),--seconds $(SECONDS)) $(if $(SEED),--seed $(SEED))

# SECONDS= length of the measurement of joint states, default: 60
test-ros2: $(VENV)/.built $(VENV)/.tested ## tests the live node with rclpy of Jazzy, in .venv-ros2 (250 MB); skipped without wheels
	$(BIN)/python tests/rclpy_peer $(if $(SECONDS),--seconds $(SECONDS))

test-peers: $(VENV)/.built $(VENV)/.tested ## compares contacts with Drake's, in .venv-peers (420 MB); skipped without wheels
	$(BIN)/python tests/drake_peer

clean: ## removes builds and the environment
	rm -rf target $(VENV) .venv-ros2 .venv-peers out

# make demo · make test · make bench: each does all set-up that it needs.
# Needs Rust, Python 3.10+ with pip, a C compiler and make; no root.

PYTHON ?= python3
UV := $(CURDIR)/.tools/bin/uv
BIN := $(CURDIR)/.venv/bin

# Compiled modules are kept: without them, importing takes half of each child process's time.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: build wheel demo emily cycles validators results test test-all fuzz heavy-cluster software-gpu bench lint miri neon clean

build: .venv/complete
	@PATH="$(CURDIR)/.tools/bin:$$PATH" VIRTUAL_ENV="$(CURDIR)/.venv" $(BIN)/maturin develop --release --uv --quiet
	@$(BIN)/python tests/metric_stub.py

# target/wheels, tried in an empty environment and an empty folder: everything that a user does first.
wheel: build
	$(BIN)/maturin build --release --quiet -o target/wheels
	rm -rf target/wheel-try
	$(UV) venv --quiet --python "$(PYTHON)" target/wheel-try/.venv
	$(UV) pip install --quiet --python target/wheel-try/.venv target/wheels/unshade-*.whl
	cd target/wheel-try && PATH="$$PWD/.venv/bin:$$PATH" VIRTUAL_ENV= && unshade doctor && unshade init start && \
	  unshade run start/suite.toml -o run && unshade synth emily --describe

# uv lives in the project, not in the user's Python.
$(UV):
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 10))' || \
	  { echo "unshade: $(PYTHON) is older than 3.10; name a newer one: make PYTHON=python3.12" >&2; exit 2; }
	@$(PYTHON) -m pip --version >/dev/null || \
	  { echo "unshade: $(PYTHON) has no pip; install it (Debian: python3-pip), or name another: make PYTHON=..." >&2; exit 2; }
	$(PYTHON) -m pip install --quiet --disable-pip-version-check --no-warn-script-location --target .tools uv==0.13.8

# The exact pins of pyproject.toml; the mark is written last, so an interrupted set-up is done again.
.venv/complete: pyproject.toml | $(UV)
	$(UV) venv --quiet --clear --python "$(PYTHON)" .venv
	$(UV) pip install --quiet --python .venv -r pyproject.toml --extra test --extra denoise --extra history --extra cluster --extra figures --extra parquet --group build
	@touch $@

demo: build
	$(BIN)/unshade run scenes/suites/demo.toml -o runs/demo
	@echo "open runs/demo/report/index.html"

# The Digital Emily matrix of one head; the whole one, a day on two cores, is `unshade run emily -o runs/emily`.
emily: build
	$(BIN)/unshade run scenes/suites/emily-small.toml -o runs/emily-small
	$(BIN)/unshade figure fig9 runs/emily-small -o runs/emily-small-figure
	@echo "open runs/emily-small/report/index.html, runs/emily-small-figure/figure.png; all of it: unshade run emily"

# Blender's Cycles as a second renderer and for .blend files, in an environment of its own: Blender's wheel wants
# an older numpy than ours, and is for one Python alone.
cycles: .venv-cycles/complete

.venv-cycles/complete: pyproject.toml | $(UV)
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info[:2] != (3, 11))' || \
	  { echo "unshade: bpy has wheels for Python 3.11 alone; name one: make cycles PYTHON=python3.11" >&2; exit 2; }
	$(UV) venv --quiet --clear --python "$(PYTHON)" .venv-cycles
	$(UV) pip install --quiet --python .venv-cycles --group cycles
	@touch $@

# The Khronos glTF validator, for the tests of exported assets; needs npm.
validators:
	npm install --prefix .tools --no-save --no-audit --no-fund --silent gltf-validator@2.0.0-dev.3.10

# Twelve faces: seven hours on two cores; resumes. Writes all tables into runs/, and the means of every method, light
# and figure into docs/results.csv, from which the tables of the pages are written.
results: build
	$(BIN)/unshade run scenes/suites/held-out.toml -o runs/held-out
	$(BIN)/unshade run scenes/suites/held-out-lights.toml -o runs/held-out-lights
	$(BIN)/unshade run scenes/suites/mismatch.toml -o runs/mismatch
	$(BIN)/unshade table runs/mismatch -o runs/mismatch.md
	$(BIN)/unshade study runs/held-out runs/held-out-lights -o runs/study
	$(BIN)/unshade table runs/held-out runs/held-out-lights -o runs/results.md
	$(BIN)/unshade table runs/held-out runs/held-out-lights -o docs/results.csv
	$(BIN)/python docs/tables.py

# Processes take tests from one another, so that they end together.
PYTEST = $(BIN)/python -m pytest -q -n 2 --dist worksteal

test: build
	cargo test --release --workspace --quiet
	$(PYTEST) -m "not heavy"

# With the whole solves and renders that are marked heavy.
test-all: build
	cargo test --release --workspace --quiet
	$(PYTEST)

# Readers on changed files, for as long as it takes: a million inputs of each, others for another
# UNSHADE_FUZZ_SEED. `make test` tries some thousands.
FUZZ = UNSHADE_FUZZ_INPUTS=$${UNSHADE_FUZZ_INPUTS:-1000000}
fuzz: build
	$(FUZZ) cargo test --release --workspace --test fuzz -- --nocapture
	$(FUZZ) $(BIN)/python -m pytest -q -s synth/tests/test_own_head_fuzz.py

# A study of 24 cases on three local workers, one of them killed, beside one process: minutes.
heavy-cluster: build
	$(BIN)/python tests/heavy_cluster.py runs/heavy-cluster

# A Vulkan driver in software, for the GPU's tests: Debian's mesa-vulkan-drivers, where root and apt allow.
software-gpu:
	@ls /usr/share/vulkan/icd.d/lvp_icd*.json >/dev/null 2>&1 || { test "$$(id -u)" = 0 && \
	  apt-get -qq update && apt-get -qq install --no-install-recommends -y mesa-vulkan-drivers; } >/dev/null 2>&1 || \
	  echo "no software GPU: mesa-vulkan-drivers cannot be installed here, so the GPU's tests are skipped"

# Heavier than a test: the solver's kernels and steps (UNSHADE_TORCH names a Python with PyTorch to
# compare with), and the error of the cheap tiers of skin; writes docs/performance.md and docs/subsurface.md.
bench: build
	@mkdir -p runs/bench
	$(BIN)/unshade bench --json -o runs/bench/performance.json --markdown docs/performance.md
	$(BIN)/python synth/bench/scoring.py
	$(BIN)/python synth/bench/subsurface.py -o runs/bench/subsurface

lint: build .venv/lint
	cargo fmt --check
	cargo clippy --release --workspace --all-targets -- -D warnings
	$(BIN)/ruff check --quiet
	$(BIN)/ruff format --check --quiet
	$(BIN)/python tests/check_types.py

# The checkers of style and types, apart from what running and testing need.
.venv/lint: .venv/complete
	$(UV) pip install --quiet --python .venv --group lint
	@touch $@

# Planes and taps under Miri, minutes; needs `rustup component add miri rust-src
# --toolchain nightly` (written against nightly 2026-05-19).
# Tree borrows, because rayon's queues are not made for stacked ones.
MIRI = MIRIFLAGS="-Zmiri-disable-isolation -Zmiri-tree-borrows -Zmiri-permissive-provenance \
  -Zmiri-ignore-leaks" cargo +nightly miri test --target-dir target/miri -p solver
miri:
	$(MIRI) --lib -- model::planes
	$(MIRI) --test backends -- "few texels"

# The kernels' tests on aarch64 in an emulator, minutes; needs `rustup target add aarch64-unknown-linux-gnu` and
# Debian's qemu-user, gcc-aarch64-linux-gnu and libc6-dev-arm64-cross.
neon:
	CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc \
	  CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER="qemu-aarch64 -L /usr/aarch64-linux-gnu" \
	  cargo test -p solver --test backends --target aarch64-unknown-linux-gnu

clean:
	rm -rf target .venv .venv-cycles .tools runs

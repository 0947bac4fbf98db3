# Two commands carry a newcomer: `make sweep` and `make test`.

PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
# Python sources are not among them: an editable install reads them where they are.
SOURCES := $(shell find crates -name '*.rs' -o -name Cargo.toml) Cargo.toml Cargo.lock pyproject.toml

# One interpreter for every cargo call, or pyo3 would be built again for each other one that it finds.
export PYO3_PYTHON := $(abspath $(BIN)/python)
# The wider instructions of the machine, where it has them all: they take a seventh off a step, and change no bit
# (docs/step.md). Where it has not, nothing is set: set to nothing, it would hide the flags of a user's cargo configuration.
X86_64_V3 := avx avx2 bmi1 bmi2 f16c fma abm movbe xsave
ifeq ($(origin RUSTFLAGS), undefined)
ifeq ($(filter-out $(shell grep -m1 '^flags' /proc/cpuinfo 2>/dev/null),$(X86_64_V3)),)
export RUSTFLAGS := -C target-cpu=x86-64-v3
endif
endif

.PHONY: sweep test lint rust-test python-test dozen fuzz bench peers accuracy wheel deny deny-locked clean

sweep: $(VENV)/installed
	$(BIN)/tumblers sweep --robot spiked --out sweep-spiked.nc --plot sweep-spiked.png
	$(BIN)/tumblers sweep --robot spiked_ends --out sweep-spiked_ends.nc --plot sweep-spiked_ends.png

test: lint rust-test python-test

lint: $(VENV)/installed $(VENV)/developing
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --locked -- -D warnings
	$(BIN)/ruff check python tests benches
	$(BIN)/ruff format --check python tests benches
	$(BIN)/mypy python/tumblers
	$(BIN)/python -m mypy.stubtest tumblers._core

rust-test:
	cargo test --locked

python-test: $(VENV)/installed $(VENV)/developing
	$(BIN)/pytest -n auto --durations=20 --ignore=tests/test_blind_dozen.py --ignore=tests/test_paper_gap.py

# Sealed datasets, made and diagnosed, and the paper's own gap: minutes, and beside `make test` for that.
dozen: $(VENV)/installed $(VENV)/developing
	$(BIN)/pytest tests/test_blind_dozen.py tests/test_paper_gap.py

bench:
	cargo bench -p tumblers-benches --locked

# Ten million steps of random bodies, about 22 minutes of one core, and the readers. See docs/trust.md.
fuzz: $(VENV)/installed $(VENV)/developing
	cargo test --release --locked -p tumblers-dynamics --test fuzz -- --ignored
	TUMBLERS_FUZZ_EXAMPLES=5000 $(BIN)/pytest tests/trust/test_readers.py

# The wheel that users get, for any machine, built and run where there are neither the sources nor Rust.
wheel: export RUSTFLAGS :=
wheel: $(BIN)/maturin
	rm -rf target/wheels
	. $(BIN)/activate && maturin build --release --locked
	.ci/wheel $(BIN)/python target/wheels/*.whl

# Needs cargo-deny, and the list of advisories from the network.
deny:
	cargo deny --locked check

# What depends on the lock file alone, and so is the same today and tomorrow.
deny-locked:
	cargo deny --locked check bans licenses sources

# Beside other simulators, which are installed for this alone.
peers: $(VENV)/installed $(VENV)/comparing
	$(BIN)/python benches/against_mujoco.py --page docs/performance.md
	$(BIN)/python benches/against_drake.py --page docs/performance.md

# Which step, and which treatment of the torque: a quarter of an hour of one core.
accuracy: $(VENV)/installed
	$(BIN)/python benches/time_to_accuracy.py --page docs/performance.md

$(BIN)/maturin:
	@command -v $(PYTHON) >/dev/null || { \
	  echo 'tumblers needs Python 3.11 or newer, found no $(PYTHON): make PYTHON=python3.12 ...' >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit("tumblers needs Python 3.11 or newer, found " + sys.version.split()[0] + ": make PYTHON=python3.12 ..." if sys.version_info < (3, 11) else 0)'
	$(PYTHON) -m venv $(VENV) || { \
	  echo '$(PYTHON) cannot make virtual environments: install python3-venv (Debian, Ubuntu: apt install python3-venv)' >&2; \
	  exit 1; }
	$(BIN)/pip install --quiet --disable-pip-version-check 'maturin>=1.9,<2'

# An editable install of the release build.
$(VENV)/installed: $(SOURCES) | $(BIN)/maturin
	. $(BIN)/activate && maturin develop --release --locked
	touch $@

# What the tests and the lints need beside it.
$(VENV)/developing: pyproject.toml | $(BIN)/maturin
	$(call install_extra,dev)
	touch $@

# What the comparisons with other simulators need, and the tests of them.
$(VENV)/comparing: pyproject.toml | $(BIN)/maturin
	$(call install_extra,peers)
	touch $@

# The optional dependencies of that name, without the package itself.
define install_extra
	$(BIN)/python -c 'import tomllib; print(*tomllib.load(open("pyproject.toml", "rb"))["project"]["optional-dependencies"]["$(1)"], sep="\n")' >$(VENV)/$(1).txt
	$(BIN)/pip install --quiet --disable-pip-version-check -r $(VENV)/$(1).txt
endef

clean:
	rm -rf target $(VENV) sweep-*.nc sweep-*.png

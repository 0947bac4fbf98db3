# Two commands carry a newcomer: `make sweep` and `make test`.

PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
SOURCES := $(shell find crates -name '*.rs' -o -name Cargo.toml) Cargo.toml Cargo.lock pyproject.toml

.PHONY: sweep test rust-test python-test lint bench clean

sweep: $(VENV)/installed
	$(BIN)/tumblers sweep --robot spiked --out sweep-spiked.nc --plot sweep-spiked.png
	$(BIN)/tumblers sweep --robot spiked_ends --out sweep-spiked_ends.nc --plot sweep-spiked_ends.png

test: lint rust-test python-test

lint: $(VENV)/installed
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --locked -- -D warnings
	$(BIN)/ruff check python tests
	$(BIN)/ruff format --check python tests
	$(BIN)/mypy python/tumblers
	$(BIN)/python -m mypy.stubtest tumblers._core

rust-test:
	cargo test --locked

python-test: $(VENV)/installed
	$(BIN)/pytest

bench:
	cargo bench -p tumblers-benches --locked

$(BIN)/maturin:
	$(PYTHON) -c 'import sys; sys.exit("tumblers needs Python 3.11 or newer, found " + sys.version.split()[0] if sys.version_info < (3, 11) else 0)'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --disable-pip-version-check 'maturin>=1.9,<2'

# An editable install of the release build, with everything that the tests need.
$(VENV)/installed: $(BIN)/maturin $(SOURCES)
	. $(BIN)/activate && maturin develop --release --locked --extras dev
	touch $@

clean:
	rm -rf target $(VENV) sweep-*.nc sweep-*.png

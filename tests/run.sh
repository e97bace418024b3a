#!/usr/bin/env bash
# Installs what is missing and runs every test of the workspace.
set -euo pipefail
cd "$(dirname "$0")/.."

tests/setup.sh python
# With the tests, and so with the features that they ask of the dependencies: nothing is built twice. `--lib` for the Python package.
cargo build --workspace --tests --lib --bin trainer
FRIKAN_TRAINER="$(realpath "${CARGO_TARGET_DIR:-target}")/debug/trainer" cargo nextest run --workspace "$@"
# The C library as it is by default is among them; here with all that it can have.
cargo nextest run -p frikan-c --features integer,auth,signature,expression,network,effects "$@"
cargo test --workspace --doc
tests/python.sh
# Says which measured pages are older than what they measure; that is no failure.
tests/pages.sh

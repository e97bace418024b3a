#!/usr/bin/env bash
# Builds the Python package as `tests/run.sh` builds everything, so that nothing is built twice, and runs its tests and the check of its types.
set -euo pipefail
cd "$(dirname "$0")/.."

python=$PWD/target/python/bin/python
if [ ! -x "$python" ]; then
    echo "python: skipped, there is no target/python (tests/setup.sh python makes it where there is a network)"
    exit 0
fi
cargo build --quiet --workspace --tests --lib --bin trainer
built="$(realpath "${CARGO_TARGET_DIR:-target}")/debug"
cp "$built/lib_frikan.so" trainer/python/frikan/_frikan.abi3.so
"$python" -m mypy --config-file pyproject.toml
FRIKAN_TRAINER="$built/trainer" PYTHONPATH=$PWD/trainer/python "$python" -m pytest -q -p no:cacheprovider trainer/python/tests

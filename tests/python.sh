#!/usr/bin/env bash
# Builds the Python package with the profile of the tests, and runs its tests and the check of its types.
set -euo pipefail
cd "$(dirname "$0")/.."

python=$PWD/target/python/bin/python
if [ ! -x "$python" ]; then
    echo "python: skipped, there is no target/python (tests/setup.sh makes it where there is a network)"
    exit 0
fi
cargo build --quiet --package frikan-trainer --bin trainer
VIRTUAL_ENV=$PWD/target/python "$python" -m maturin develop --quiet --skip-install --profile dev
"$python" -m mypy --config-file pyproject.toml
PYTHONPATH=$PWD/trainer/python "$python" -m pytest -q -p no:cacheprovider trainer/python/tests

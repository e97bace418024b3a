#!/usr/bin/env bash
# Builds the Python package with the profile of the tests, and runs its tests and the check of its types.
set -euo pipefail
cd "$(dirname "$0")/.."

tests/setup.sh python
python=$PWD/target/python/bin/python
if [ ! -x "$python" ]; then
    echo "python: skipped, there is no target/python, which needs a network once"
    exit 0
fi
cargo build --quiet --package frikan-trainer --bin trainer
VIRTUAL_ENV=$PWD/target/python "$python" -m maturin develop --quiet --skip-install --profile dev
"$python" -m mypy --config-file pyproject.toml
PYTHONPATH=$PWD/trainer/python "$python" -m pytest -q -p no:cacheprovider trainer/python/tests

#!/bin/sh
# Generates everything in fixtures/ that is not written by hand.
set -eu
cd "$(dirname "$0")/.."
trainer="cargo run --quiet --release -p frikan-trainer --bin trainer --"
$trainer simulate fixtures/elbow.toml -o fixtures/elbow.csv --duration 12 --seed 1
$trainer simulate fixtures/elbow.toml -o fixtures/elbow-test.csv --duration 12 --seed 2
cargo run --quiet --release -p frikan-tests --bin generate_fixtures -- recordings fixtures
$trainer fit fixtures/elbow.csv --joint fixtures/elbow.toml --seed 1 -o fixtures/elbow.frk
$trainer fit fixtures/stribeck.csv --representation table --seed 1 -o fixtures/stribeck.frk
$trainer fit fixtures/stribeck.csv --target cortex-m0plus --seed 1 -o fixtures/integers.frk
cargo run --quiet --release -p frikan-tests --bin generate_fixtures -- bits fixtures

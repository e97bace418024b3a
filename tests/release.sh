#!/usr/bin/env bash
# What a release has to pass beside .ci/run, and what goes with it: licences, origins and advisories of all that is linked in, the interface of the
# libraries beside that of the release before, a package of every crate that is published, and lists of their parts (CycloneDX) in target/sbom. Takes
# minutes; installs the tools that are missing with cargo.
#
#   tests/release.sh [BASELINE]     a tag or commit, the last tag when absent
set -euo pipefail
cd "$(dirname "$0")/.."

readonly crates=(frikan-shared frikan-runtime frikan-c frikan-trainer)

tool() {
    cargo "$1" --version >/dev/null 2>&1 || cargo install --locked "cargo-$1"
}

tests/setup.sh
tool deny
cargo deny check licenses bans sources
# Advisories come from the network.
if cargo deny fetch db; then
    cargo deny check advisories
else
    echo "release: the advisories cannot be fetched; nothing is known of them"
fi

# Packages are built from what they hold, and would be accepted but for being there already; nothing is published.
cargo publish --dry-run "${crates[@]/#/--package=}"

# The oldest Rust that is promised.
rust=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)
rustup toolchain install "$rust" --profile minimal
CARGO_TARGET_DIR=target/rust-$rust cargo "+$rust" check --locked "${crates[@]/#/--package=}"

tool cyclonedx
mkdir -p target/sbom
cargo cyclonedx --format json --spec-version 1.5 --all
for crate in "${crates[@]}"; do
    find . -name "$crate.cdx.json" -not -path './target/*' -exec mv {} target/sbom/ \;
done
find . -name '*.cdx.json' -not -path './target/*' -delete

baseline=${1:-$(git describe --tags --abbrev=0 2>/dev/null || true)}
if [ -z "$baseline" ]; then
    echo "release: there is no release before this one to compare the interface with"
    exit 0
fi
tool semver-checks
cargo semver-checks --baseline-rev "$baseline" "${crates[@]/#/--package=}"

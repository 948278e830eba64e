# Sourced by the scripts beside it, which all run from the project's root.
# shellcheck shell=bash
set -euo pipefail
caller=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# A path that the caller named relative to where they stand.
from_caller() {
    case $1 in
        /*) printf '%s\n' "$1" ;;
        *) printf '%s\n' "$caller/$1" ;;
    esac
}

# One compiler cache for all presets, where there is one; a launcher that the user chose stands.
if command -v ccache >/dev/null; then
    export CMAKE_C_COMPILER_LAUNCHER=${CMAKE_C_COMPILER_LAUNCHER-ccache}
    export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER-ccache}
    # Without these ccache lets every file with precompiled headers pass uncached.
    export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS-pch_defines,time_macros}
fi

say() { printf '== %s\n' "$*"; }

# tracked PATTERN...: the project's own files of these names, NUL after each; also where the checkout is another user's.
tracked() { git -c safe.directory="$PWD" ls-files -z "$@"; }

# build PRESET [TARGET...]
build() {
    local preset=$1
    shift
    say "building $preset"
    cmake --preset "$preset" --log-level=WARNING
    cmake --build --preset "$preset" --parallel "$(nproc)" ${1:+--target "$@"}
}

# test_suites PRESET [CTEST ARGUMENT...]
test_suites() {
    local preset=$1 plain_addresses=()
    shift
    # GCC 12's thread sanitizer cannot live with the address randomisation of newer kernels.
    if [[ $preset == tsan ]] && setarch --addr-no-randomize true 2>/dev/null; then
        plain_addresses=(setarch --addr-no-randomize)
    fi
    "${plain_addresses[@]}" ctest --preset "$preset" --parallel "$(nproc)" "$@"
}

# SPDX-License-Identifier: Zlib
# shellcheck shell=bash
# shellcheck disable=SC2034,SC2154 # tests/check takes the packages, and has the root
#
# Sourced by tests/check. The kernels for 64-bit ARM, and others that depend on instructions, compile for it
# without a warning; tests/check arm64 runs them.

tools+=(aarch64-linux-gnu-g++:g++-aarch64-linux-gnu)

check_kernels() {
    local source compiler passed=0 failed=0 compilers=()
    # All at a time.
    for source in simd/kernels_neon simd/kernels_scalar simd/dispatch pairs/pair_state; do
        aarch64-linux-gnu-g++ -std=c++20 -O3 -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror \
            -DHASHPHASE_HAS_NEON_KERNELS=1 -DHASHPHASE_ENABLE_ASSERTS=1 -DHASHPHASE_SHARED=0 \
            -ffp-contract=off -fno-trapping-math -isystem /usr/include/eigen3 -I"$root" \
            -c "$root/broadphase/$source.cpp" -o /dev/null &
        compilers+=($!)
    done
    for compiler in "${compilers[@]}"; do
        if wait "$compiler"; then
            passed=$((passed + 1))
        else
            failed=$((failed + 1))
        fi
    done
    say "sources for 64-bit ARM: $passed passed, $failed failed, 0 skipped"
    ((failed == 0))
}

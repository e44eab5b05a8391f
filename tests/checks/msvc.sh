# SPDX-License-Identifier: Zlib
# shellcheck shell=bash
# shellcheck disable=SC2034,SC2154 # tests/check takes the packages, and has the root
#
# Sourced by tests/check. Clang compiles all sources of the libraries in MSVC's dialect, of a DLL, and warns of
# nothing; what MSVC itself says only MSVC can tell. Its standard headers are not to be had:
# tests/checks/msvc/standard.hpp has others.

tools+=(clang++-19:clang-19)
libraries+=(libc++-19-dev libclang-common-19-dev mingw-w64-x86-64-dev)

# as_msvc <argument>...
as_msvc() {
    local llvm=/usr/lib/llvm-19
    clang++-19 --target=x86_64-pc-windows-msvc -fms-extensions -fms-compatibility \
        -fms-compatibility-version=19.40 -std=c++20 -DHASHPHASE_SHARED=1 \
        -DHASHPHASE_HAS_SSE2_KERNELS=1 -DHASHPHASE_HAS_AVX_KERNELS=1 -Werror -Wall -Wextra -Wpedantic \
        -Wconversion -Wshadow -Wno-pragma-once-outside-header -nostdinc++ -isystem "$llvm/include/c++/v1" \
        -isystem "$llvm/lib/clang/19/include" -isystem /usr/share/mingw-w64/include \
        -isystem /usr/include/eigen3 -isystem /usr/include/bullet -I"$root" "$@"
}

check_msvc() {
    local build=$root/build/check-msvc component folder headers passed=0 failed=0
    headers=$root/tests/checks/msvc
    mkdir -p "$build"
    as_msvc -x c++-header "$headers/headers.hpp" -o "$build/headers.pch"
    for component in broadphase ai bullet camera culling effects picking terrain; do
        # One after another in one file, as in a quick build.
        folder=integration/$component
        [[ $component != broadphase ]] || folder=broadphase
        (cd "$root" && find "$folder" -name '*.cpp' ! -name 'kernels_*') |
            sort | sed 's/.*/#include <&>/' >"$build/$component.cpp"
        if as_msvc -include-pch "$build/headers.pch" -D"hashphase_${component}_EXPORTS" -c \
            "$build/$component.cpp" -o /dev/null; then
            passed=$((passed + 1))
        else
            failed=$((failed + 1))
        fi
    done
    local kernels instructions
    while read -r kernels instructions; do
        # shellcheck disable=SC2086 # one word each
        if as_msvc -include "$headers/standard.hpp" $instructions -Dhashphase_broadphase_EXPORTS -c \
            "$root/broadphase/simd/kernels_$kernels.cpp" -o /dev/null; then
            passed=$((passed + 1))
        else
            failed=$((failed + 1))
        fi
    done <<'KERNELS'
scalar
sse2
avx2 -mavx2
avx512 -mavx512f -mavx512vl -mavx512bw -mavx512dq
KERNELS
    say "libraries and kernels in MSVC's dialect: $passed passed, $failed failed, 0 skipped"
    ((failed == 0))
}

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

# msvc_compiles <source> <option>...: prints whether it does.
msvc_compiles() {
    if as_msvc "${@:2}" -c "$1" -o /dev/null; then
        echo passed
    else
        echo failed
    fi
}

check_msvc() (
    build=build/check-msvc
    headers=tests/checks/msvc
    sources=() # each with its options
    cd "$root" || exit
    mkdir -p "$build"
    as_msvc -x c++-header "$headers/headers.hpp" -o "$build/headers.pch"
    for component in broadphase ai bullet camera culling distributed effects picking terrain; do
        # One after another in one file, as in a quick build.
        folder=integration/$component
        [[ $component != broadphase ]] || folder=broadphase
        find "$folder" -name '*.cpp' ! -name 'kernels_*' |
            sort | sed 's/.*/#include <&>/' >"$build/$component.cpp"
        sources+=("$build/$component.cpp -include-pch $build/headers.pch -Dhashphase_${component}_EXPORTS")
    done
    for kernels in scalar.cpp sse2.cpp 'avx2.cpp -mavx2' \
        'avx512.cpp -mavx512f -mavx512vl -mavx512bw -mavx512dq'; do
        sources+=("broadphase/simd/kernels_$kernels -include $headers/standard.hpp -Dhashphase_broadphase_EXPORTS")
    done
    export root
    export -f as_msvc msvc_compiles
    outcomes=$(printf '%s\n' "${sources[@]}" | xargs -P2 -L1 bash -c 'msvc_compiles "$@"' msvc_compiles)
    passed=$(grep -c passed <<<"$outcomes" || true)
    # Where the program's standard library is another one.
    as_msvc -include "$headers/standard.hpp" -c -x c++ broadphase/core/same_library.hpp -o "$build/same_library.obj"
    say "libraries and kernels in MSVC's dialect: $passed passed, $((${#sources[@]} - passed)) failed, 0 skipped"
    grep -qa '/include:__imp_?librariesAreCompiledFor_libcxx@hashphase@@' "$build/same_library.obj" || {
        say "broadphase/core/same_library.hpp does not ask the linker for the name of the standard library"
        exit 1
    }
    ((passed == ${#sources[@]}))
)

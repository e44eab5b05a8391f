# SPDX-License-Identifier: Zlib
# shellcheck shell=bash
#
# Sourced by tests/check. A cross compiler compiles the libraries and their tests for 64-bit ARM; QEMU counts the
# instructions of the kernels, and runs the tests.

# shellcheck source=tests/checks/sources.sh
source "$root/tests/checks/sources.sh"

tools+=(aarch64-linux-gnu-g++:g++-aarch64-linux-gnu qemu-aarch64:qemu-user)

# kernel_program <compiler> <build> <kernels>: links kernel-instructions there, and prints from which address
# to which the kernels' code is.
kernel_program() {
    local library=$2/broadphase/libhashphase_broadphase.a
    "$1" -std=c++20 -O1 -static -no-pie -I"$root" -isystem /usr/include/eigen3 -Wl,-Map="$2/kernels.map" \
        -DHASHPHASE_ENABLE_ASSERTS=1 -DHASHPHASE_SHARED=0 -Wno-psabi \
        "$root/tests/checks/kernel_instructions.cpp" "$library" -o "$2/kernel-instructions" >&2 || return
    grep -E '^ \.text +0x' "$2/kernels.map" | grep -F "($3.cpp.o)" | awk '{ print $2, $3 }'
}

# instructions_of <emulator> <program> <operation> <set> <first address> <size>: how many the kernels run.
instructions_of() {
    timeout 300 "$1" -singlestep -d nochain,exec -dfilter "$5+$6" -D /dev/stdout "$2" "$3" "$4" |
        awk '/^Trace/ { ++count } END { print count + 0 }'
}

# compare_kernel_instructions <build for ARM64>: what NEON's kernels run is at most 1.3 times what SSE2's run for
# the same boxes.
compare_kernel_instructions() {
    local arm64=$1 neon sse2 operations operation a b counting
    configure arm64-twin -DCMAKE_BUILD_TYPE=RelWithDebInfo -DHASHPHASE_BUILD_TESTS=OFF
    cmake --build "$build" --target hashphase_broadphase >&2
    sse2=$(kernel_program g++ "$build" kernels_sse2)
    neon=$(kernel_program aarch64-linux-gnu-g++ "$arm64" kernels_neon)
    operations=$("$build/kernel-instructions")
    say "instructions of the kernels, as QEMU counts them: NEON, SSE2, ratio"
    for operation in ${operations:?}; do
        # shellcheck disable=SC2086
        instructions_of qemu-aarch64 "$arm64/kernel-instructions" "$operation" NEON $neon >"$build/neon.txt" &
        counting=$!
        # shellcheck disable=SC2086
        b=$(instructions_of qemu-x86_64 "$build/kernel-instructions" "$operation" SSE2 $sse2)
        wait "$counting"
        a=$(<"$build/neon.txt")
        awk -v name="$operation" -v a="$a" -v b="$b" 'BEGIN {
            printf "    %-20s %10d %10d %6.2f\n", name, a, b, a / b
            exit !(a > 0 && a <= 1.3 * b)
        }' >&2 || {
            say "for $operation, NEON's kernels run none, or more than 1.3 times the instructions of SSE2's"
            return 1
        }
    done
}

check_arm64() {
    local sysroot arm64
    programs=(golden broadphase bullet clients) # a last one that takes long would run alone
    sysroot=$(foreign_packages arm64 libbullet-dev libbullet3.24 libgtest-dev libgmp-dev libgmp10)
    configure arm64 -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O2 -DNDEBUG" \
        -DEigen3_DIR=/usr/share/eigen3/cmake \
        -DCMAKE_TOOLCHAIN_FILE="$root/tests/checks/arm64.cmake" -DHASHPHASE_SYSROOT="$sysroot" \
        -DCMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE=PRE_TEST
    build_tests
    arm64=$build
    compare_kernel_instructions "$arm64"
    # What takes QEMU long, and has its like among the others; H45 fills a memory that has no limit here.
    leaves_out='*/H45*:*Million*:WhoIsNear*InEveryScene:*WithAnySlack:Settled*ManySweeps*:Settled*AreFew*'
    leaves_out+=':SteadyFrame.OfAll*:ParallelAabbs.*World*:ParallelAabbs.WorkOver*:*/PairCacheBatches.DoWhat*'
    leaves_out+=':OutOfMemory.AnUpdate*:PairsInScripts/1.*InEveryScene:PairsInScripts/1.*ComesToRest*'
    leaves_out+=':PairsInScripts/1.*ComeLate*:PairsOfRefusedCrowds/1.*:OriginShift/1.AtAny*'
    run_programs "$arm64" qemu-aarch64 -L /usr/aarch64-linux-gnu
}

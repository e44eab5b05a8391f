# SPDX-License-Identifier: Zlib
# shellcheck shell=bash
#
# Programs and libraries that are compiled with different options (integration/guide/abi.md). Each program is
# compiled once for each set of options, and linked with each build of the libraries; all have to print the
# same, or not to link and say why.

tools+=(nm:binutils clang++-19:clang-19 i686-linux-gnu-g++:g++-i686-linux-gnu)

# Builds of the libraries: name, build type, options.
flags_libraries() {
    cat <<'BUILDS'
plain Release -O2
fast Release -O2 -march=native -ffast-math -fno-rtti -DEIGEN_MAX_ALIGN_BYTES=0
bare Debug -O0 -fno-exceptions -fno-threadsafe-statics -mavx2 -mfma -fshort-enums -D_GLIBCXX_ASSERTIONS
BUILDS
}

# Programs: name, options.
flags_programs() {
    cat <<'PROGRAMS'
plain -O2
unoptimised -O0
native -O3 -march=native
avx512 -O1 -mavx512f -mfma
bare -O2 -fno-exceptions -fno-rtti -fno-threadsafe-statics -DNDEBUG
unaligned -O2 -DEIGEN_MAX_ALIGN_BYTES=0
unaligned-unoptimised -O0 -DEIGEN_DONT_ALIGN -mavx2 -mfma
row-major -O1 -DEIGEN_DEFAULT_TO_ROW_MAJOR -funsigned-char -fshort-enums
asserting -O1 -DHASHPHASE_ENABLE_ASSERTS=1 -D_GLIBCXX_ASSERTIONS
fast -O3 -march=native -ffast-math
fast-small -Os -ffast-math
fast-unoptimised -O0 -ffast-math
PROGRAMS
}

flags_link=(distributed effects terrain picking culling camera ai broadphase)

# flags_compile <compiler> <source> <object> <option>...
flags_compile() {
    "$1" -std=c++20 -I"$root" -isystem /usr/include/eigen3 -isystem /usr/include/bullet "${@:4}" \
        -c "$root/tests/package/$2.cpp" -o "$3"
}

# flags_run <library build> <object> <program>: prints what it prints.
flags_run() {
    local archives=() component
    for component in bullet "${flags_link[@]}"; do
        archives+=("$(find "$folder/$1" -name "libhashphase_$component.a")")
    done
    g++ -Wl,--gc-sections "$2" -o "$3" "${archives[@]}" -lBulletDynamics -lBulletCollision -lLinearMath \
        -pthread || return
    timeout 60 "$3"
}

# flags_holds <name> <command>...: counts whether it succeeds.
flags_holds() {
    if "${@:2}"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        say "$1: FAILED"
    fi
}

# flags_symbols <library build>
flags_symbols() {
    local objects
    objects=$(find "$folder/$1/broadphase" "$folder/$1/integration" -name '*.o' | paste -sd,)
    cmake -DNM="$(command -v nm)" -DKERNELS=2 -DOBJECTS="$objects" \
        -P "$root/tests/package/check_symbols.cmake" >&2
}

# flags_agrees <library build> <source> <program>: the program prints what the plain one prints with plain
# libraries.
flags_agrees() {
    local output=$folder/$2-$3-$1.txt
    flags_run "$1" "$folder/$2-$3.o" "$folder/program" >"$output" 2>&1 || {
        tail -3 "$output" >&2
        return 1
    }
    diff "$folder/$2-plain-plain.txt" "$output" | head -5 >&2
    cmp -s "$folder/$2-plain-plain.txt" "$output"
}

# flags_refuses <library build> <object> <words>: the program does not link, and says why.
flags_refuses() {
    if flags_run "$1" "$2" "$folder/refused" >"$folder/refused.txt" 2>&1; then
        return 1
    fi
    grep -q "$3" "$folder/refused.txt"
}

# flags_refuses_program <words> <compiler> <option>...
flags_refuses_program() {
    flags_compile "$2" flag_traps "$folder/refused.o" "${@:3}" || return
    flags_refuses plain "$folder/refused.o" "$1"
}

# flags_refuses_to_compile <words> <compiler> <option>...
flags_refuses_to_compile() {
    if flags_compile "$2" flag_traps "$folder/refused.o" "${@:3}" 2>"$folder/refused.txt"; then
        return 1
    fi
    grep -q "$1" "$folder/refused.txt"
}

check_flags() {
    local folder=$root/build/check-flags name type flags source library passed=0 failed=0 skipped=0
    mkdir -p "$folder"
    while read -r name type flags; do
        configure "flags/$name" -DCMAKE_BUILD_TYPE="$type" -DCMAKE_CXX_FLAGS="$flags" \
            -DCMAKE_CXX_FLAGS_RELEASE=-DNDEBUG -DCMAKE_CXX_FLAGS_DEBUG= -DHASHPHASE_ASSERTS=AUTO \
            -DHASHPHASE_BUILD_TESTS=OFF
        cmake --build "$build" --target hashphase_bullet "${flags_link[@]/#/hashphase_}" >&2
    done < <(flags_libraries)

    for name in plain fast bare; do
        flags_holds "the symbols of $name" flags_symbols $name
    done
    while read -r flags; do
        # shellcheck disable=SC2086
        flags_holds "layouts with $flags" flags_compile g++ layouts "$folder/layouts.o" $flags
    done <<'OPTIONS'
-mavx512f -mfma
-DEIGEN_MAX_ALIGN_BYTES=0
-DEIGEN_DONT_ALIGN
-mavx2 -mfma -DEIGEN_DEFAULT_TO_ROW_MAJOR -fshort-enums
OPTIONS

    for source in flag_traps flag_worlds flag_derived; do
        while read -r name flags; do
            say "$source with $flags"
            # shellcheck disable=SC2086
            flags_holds "compiling $source with $flags" \
                flags_compile g++ $source "$folder/$source-$name.o" $flags
            if [[ $flags == *avx512* ]] && ! grep -qm1 avx512f /proc/cpuinfo; then
                skipped=$((skipped + 3))
                continue
            fi
            for library in plain fast bare; do
                if [[ $source == flag_derived && $library == fast && $flags != *-fno-rtti* ]]; then
                    flags_holds "refusing $source of $name with libraries without RTTI" \
                        flags_refuses $library "$folder/$source-$name.o" 'typeinfo for hashphase::'
                    continue
                fi
                flags_holds "$source of $name with the libraries of $library" \
                    flags_agrees $library $source "$name"
            done
        done < <(flags_programs)
    done

    flags_holds "refusing _GLIBCXX_DEBUG" \
        flags_refuses_program librariesAreCompiledWith_GLIBCXX_DEBUG g++ -O0 -D_GLIBCXX_DEBUG \
        -fdata-sections
    flags_holds "refusing _GLIBCXX_USE_CXX11_ABI=0" \
        flags_refuses_program librariesAreCompiledWithout_GLIBCXX_USE_CXX11_ABI g++ -O0 -D_GLIBCXX_USE_CXX11_ABI=0
    # Both ways round: as the compiler says it, and as users are told to.
    flags_holds "refusing clang++-19 -ffast-math" \
        flags_refuses_to_compile 'needs infinity and NaN' clang++-19 -O2 -ffast-math
    flags_holds "compiling flag_traps by clang++-19" flags_compile clang++-19 flag_traps \
        "$folder/flag_traps-clang.o" -O2 -ffast-math -fno-finite-math-only
    flags_holds "flag_traps of clang++-19 with plain libraries" flags_agrees plain flag_traps clang
    # As -m32.
    flags_holds "refusing 32 bits" flags_refuses_program 'incompatible with i386:x86-64' \
        i686-linux-gnu-g++ -O1 -msse2 -mfpmath=sse
    echo "$passed passed, $failed failed, $skipped skipped"
    ((failed == 0))
}

# SPDX-License-Identifier: Zlib
# shellcheck shell=bash
# shellcheck disable=SC2034,SC2154 # tests/check takes the packages, and has the root
#
# Sourced by tests/check. For 64-bit Windows MinGW compiles all, from sources of Debian's, and Wine runs it:
# first with static libraries, then with DLLs. Bullet is static in both, as in the packages that there are for
# Windows. What MSVC would say: tests/checks/msvc.sh.

source "$root/tests/checks/sources.sh"

tools+=(x86_64-w64-mingw32-g++-posix:g++-mingw-w64-x86-64-posix m4:m4 tclsh:tcl)
libraries+=(wine64)

windows=$root/build/check-windows
windows_prefix=$windows/prefix

# build_for_windows <name> <source> <cmake option>...: in build/check-windows/<name>.
build_for_windows() {
    say "configuring build/check-windows/$1"
    cmake -S "$2" -B "$windows/$1" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$root/tests/checks/windows.cmake" \
        -DCMAKE_INSTALL_PREFIX="$windows_prefix" "${@:3}" >&2
    cmake --build "$windows/$1" >&2
}

# What programs need of others: Bullet, GoogleTest, GMP and SQLite.
build_windows_packages() {
    local source # the folder of one
    source=$(source_package bullet)
    [[ -e $windows_prefix/lib/libBulletSoftBody.a ]] || {
        build_for_windows bullet "$source" -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=OFF \
            -DINSTALL_LIBS=ON -DBUILD_{BULLET3,BULLET2_DEMOS,CPU_DEMOS,OPENGL3_DEMOS,UNIT_TESTS,EXTRAS}=OFF \
            -DUSE_GRAPHICAL_BENCHMARK=OFF -DUSE_GLUT=OFF -DCMAKE_DISABLE_FIND_PACKAGE_OpenGL=ON
        cmake --install "$windows/bullet" >/dev/null
    }
    source=$(source_package googletest)
    [[ -e $windows_prefix/lib/libgtest.a ]] || {
        build_for_windows googletest "$source" -DCMAKE_BUILD_TYPE=Release -DBUILD_GMOCK=OFF
        cmake --install "$windows/googletest" >/dev/null
    }
    source=$(source_package gmp)
    [[ -e $windows_prefix/lib/libgmp.a ]] || (
        # Debian leaves out its manual, and what is to make it.
        mkdir -p "$source/doc" "$windows/gmp"
        : >"$source/doc/Makefile.in"
        cd "$windows/gmp" || exit
        "$source/configure" --host=x86_64-w64-mingw32 --prefix="$windows_prefix" --disable-shared \
            --enable-cxx CC=x86_64-w64-mingw32-gcc-posix CXX=x86_64-w64-mingw32-g++-posix >/dev/null
        make -j"$(nproc)" SUBDIRS="mpn mpz mpq mpf printf scanf rand cxx ." >/dev/null
        make install SUBDIRS=. >/dev/null
    )
    source=$(source_package sqlite3)
    [[ -e $windows_prefix/lib/libsqlite3.a ]] || (
        mkdir -p "$windows/sqlite"
        cd "$windows/sqlite" || exit
        "$source/configure" --disable-tcl --disable-readline >/dev/null
        make sqlite3.c sqlite3.h >/dev/null
        x86_64-w64-mingw32-gcc-posix -O1 -c sqlite3.c
        x86_64-w64-mingw32-ar rcs "$windows_prefix/lib/libsqlite3.a" sqlite3.o
        cp sqlite3.h "$windows_prefix/include"
    )
}

# on_windows <program> <argument>...: without a screen; it finds installed DLLs and those of GCC.
on_windows() {
    DISPLAY='' WINEDEBUG=-all WINEDLLOVERRIDES='mscoree,mshtml=' WINEPREFIX=$windows/wine \
        WINEPATH="Z:$installed/bin;Z:/usr/lib/gcc/x86_64-w64-mingw32/12-posix;Z:/usr/x86_64-w64-mingw32/lib" \
        /usr/lib/wine/wine64 "$@" </dev/null | tr -d '\r'
}

# count_tests <program>: adds its tests to those that have `passed`, `failed` and been `skipped`.
count_tests() {
    local output word count
    say "${1##*/}"
    output=$(on_windows "$1" --gtest_brief=1) || true
    grep -v '^takes minutes\|: Skipped$' <<<"$output" >&2
    for word in PASSED FAILED SKIPPED; do
        count=$(sed -n "s/^\[  *$word *\] \([0-9]*\) tests\?[.,].*/\1/p" <<<"$output")
        declare -g "${word,,}=$((${word,,} + ${count:-0}))"
    done
    # A program that ended early has passed nothing.
    [[ $output == *'[  PASSED  ]'* ]] || failed=$((failed + 1))
}

# count_output <what> <expected> <output>
count_output() {
    if [[ $3 == *"$2"* ]]; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        say "$1 says \"$3\", and not \"$2\""
    fi
}

# test_on_windows <static|shared> <cmake option>...
test_on_windows() {
    local name=$1 installed=$windows/installed-$1 program component
    # pkg-config knows this system's packages.
    export PKG_CONFIG_LIBDIR=$windows_prefix/lib/pkgconfig
    local options=(-DCMAKE_PREFIX_PATH="$windows_prefix" -DEigen3_DIR=/usr/share/eigen3/cmake)
    cmake -S "$root" -B "$windows/$name" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$root/tests/checks/windows.cmake" \
        "${options[@]}" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_INSTALL_PREFIX="$installed" \
        -DHASHPHASE_ASSERTS=ON -DHASHPHASE_BUILD_BENCHMARKS=OFF -DHASHPHASE_QUICK_BUILD=ON \
        -DHASHPHASE_WARNINGS_AS_ERRORS=OFF -DCMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE=PRE_TEST \
        "${@:2}" >&2
    cmake --build "$windows/$name" --target hashphase_{effects,bullet} \
        {golden,broadphase,bullet,clients}-tests >&2
    for component in libraries development; do
        cmake --install "$windows/$name" --component "hashphase_$component" >/dev/null
    done
    for program in golden broadphase integration/bullet integration/clients; do
        count_tests "$windows/$name/tests/$program/${program##*/}-tests.exe"
    done
    for program in overlapping_pair misuse_within_callback; do
        build_for_windows "$name-$program" "$root/tests/package/find_package" "${options[@]}" \
            -Dhashphase_DIR="$installed/lib/cmake/hashphase" -DCOMPONENTS=bullet -DLIBRARY=bullet \
            -DMAIN="$program.cpp"
        count_output "$program with $name libraries" "pairs: 1" \
            "$(on_windows "$windows/$name-$program/consumer.exe")"
    done
}

check_windows() {
    local passed=0 failed=0 skipped=0 stack=-Wl,--stack,1048576 # as MSVC's linker has it
    build_windows_packages
    # Tests bring a `new` of their own, which the run-time library has to take as well.
    test_on_windows static -DBUILD_SHARED_LIBS=OFF -DCMAKE_EXE_LINKER_FLAGS="-static $stack" \
        -DHASHPHASE_BUILD_DEMOS=ON -DCLI11_DIR=/usr/share/cmake/CLI11 \
        -Dnlohmann_json_DIR=/usr/share/cmake/nlohmann_json
    local installed=$windows/installed-static
    cmake --build "$windows/static" --target hashphase hashphase-compare hashphase-try >&2
    count_output 'hashphase compare' 'pair sets exact in every frame: yes' \
        "$(on_windows "$windows/static/demos/hashphase.exe" compare --objects 500 --frames 20 2>&1)"
    count_output 'hashphase try' $'is for Linux alone.\nstatus 2' \
        "$(on_windows "$windows/static/demos/hashphase.exe" try -- game.exe 2>&1 || echo "status $?")"
    test_on_windows shared -DBUILD_SHARED_LIBS=ON -DCMAKE_EXE_LINKER_FLAGS="$stack" -DHASHPHASE_BUILD_DEMOS=OFF
    say "on Windows: $passed passed, $failed failed, $skipped skipped"
    ((failed == 0))
}

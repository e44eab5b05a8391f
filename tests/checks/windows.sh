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
wine=/usr/lib/wine/wine64

# configure_for_windows <name> <source> <cmake option>...: in build/check-windows/<name>.
configure_for_windows() {
    say "configuring build/check-windows/$1"
    cmake -S "$2" -B "$windows/$1" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$root/tests/checks/windows.cmake" \
        -DCMAKE_INSTALL_PREFIX="$windows_prefix" -DCMAKE_CROSSCOMPILING_EMULATOR="$wine" "${@:3}" >&2
}

# build_for_windows <name> <source> <cmake option>...
build_for_windows() {
    configure_for_windows "$@"
    cmake --build "$windows/$1" >&2
}

# What programs need of others: Bullet, GoogleTest, GMP, SQLite, CLI11 and JSON.
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
    # Headers alone, which are not to bring along all that is beside them.
    mkdir -p "$windows_prefix/share/cmake"
    cp -r /usr/include/{CLI,nlohmann} "$windows_prefix/include"
    cp -r /usr/share/cmake/{CLI11,nlohmann_json} "$windows_prefix/share/cmake"
}

# on_windows <program> <argument>...: what it says, and its exit status if that is not 0.
on_windows() {
    timeout 600 "$wine" "$@" 2>&1 </dev/null | tr -d '\r' || echo "status $?"
}

# count_output <what> <expected end> <output>
count_output() {
    if [[ $3 == *"$2" ]]; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        say "$1 says \"$3\", and does not end with \"$2\""
    fi
}

# test_on_windows <static|shared> <cmake option>...: the libraries, what is built with them where they are
# installed, and their tests.
test_on_windows() {
    local name=$1 installed=$windows/installed-$1 program component counts output
    # Without a screen; programs find installed DLLs and those of GCC.
    export DISPLAY='' WINEDEBUG=-all WINEDLLOVERRIDES='mscoree,mshtml=' WINEPREFIX=$windows/wine
    output=$(x86_64-w64-mingw32-g++-posix -print-file-name=libstdc++-6.dll)
    export WINEPATH="Z:$installed/bin;Z:${output%/*};Z:/usr/x86_64-w64-mingw32/lib"
    # pkg-config knows this system's packages.
    export PKG_CONFIG_LIBDIR=$windows_prefix/lib/pkgconfig
    local options=(-DCMAKE_PREFIX_PATH="$windows_prefix" -DEigen3_DIR=/usr/share/eigen3/cmake)
    local own=("${options[@]}" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_INSTALL_PREFIX="$installed"
        -DHASHPHASE_ASSERTS=ON -DHASHPHASE_BUILD_BENCHMARKS=OFF -DHASHPHASE_QUICK_BUILD=ON
        -DCMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE=PRE_TEST "${@:2}")
    # Without tests, DLLs hide what is not for the user.
    build_for_windows "$name" "$root" "${own[@]}" -DHASHPHASE_BUILD_TESTS=OFF -DHASHPHASE_BUILD_DEMOS=OFF
    for component in libraries development; do
        cmake --install "$windows/$name" --component "hashphase_$component" >/dev/null
    done
    options+=(-DCMAKE_BUILD_TYPE=Release -Dhashphase_DIR="$installed/lib/cmake/hashphase")
    for program in overlapping_pair misuse_within_callback; do
        build_for_windows "$name-$program" "$root/tests/package/find_package" "${options[@]}" \
            -DCOMPONENTS=bullet -DLIBRARY=bullet -DMAIN="$program.cpp"
        count_output "$program with $name libraries" "pairs: 1" \
            "$(on_windows "$windows/$name-$program/consumer.exe")"
    done
    build_for_windows "$name-examples" "$root/demos/examples" "${options[@]}"
    output=$(timeout 600 ctest --test-dir "$windows/$name-examples" --output-on-failure 2>&1) || true
    printf '%s\n' "$output" >&2
    local examples=()
    mapfile -t examples < <(grep -L integration/mpi "$root"/demos/examples/*.cpp) # MPI is not built for Windows
    count_output "the examples with $name libraries" \
        "100% tests passed, 0 tests failed out of ${#examples[@]}" \
        "$(grep 'tests passed' <<<"$output")"
    configure_for_windows "$name" "$root" "${own[@]}" -DHASHPHASE_BUILD_TESTS=ON
    cmake --build "$windows/$name" --target "${programs[@]/%/-tests}" >&2
    counts=$(run_programs "$windows/$name" "$wine") || outcome=1
    add_counts "$counts"
}

check_windows() {
    local passed=0 failed=0 skipped=0 outcome=0 program stack=-Wl,--stack,1048576 # as MSVC's linker has it
    programs=(golden broadphase bullet clients)
    build_windows_packages
    # Tests bring a `new` of their own, which the run-time library has to take as well.
    test_on_windows static -DBUILD_SHARED_LIBS=OFF -DCMAKE_EXE_LINKER_FLAGS="-static $stack"
    cmake -S "$root" -B "$windows/static" -DHASHPHASE_BUILD_DEMOS=ON >/dev/null
    cmake --build "$windows/static" --target hashphase hashphase-{compare,try,stability,report} >&2
    count_output 'hashphase compare' 'pair sets exact in every frame: yes' \
        "$(on_windows "$windows/static/demos/hashphase.exe" compare --objects 500 --frames 20)"
    for program in try stability report; do
        count_output "hashphase $program" $'is for Linux alone.\nstatus 2' \
            "$(on_windows "$windows/static/demos/hashphase.exe" "$program")"
    done
    test_on_windows shared -DBUILD_SHARED_LIBS=ON -DCMAKE_EXE_LINKER_FLAGS="$stack"
    say "on Windows: $passed passed, $failed failed, $skipped skipped"
    ((failed == 0 && outcome == 0))
}

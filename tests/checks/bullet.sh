# SPDX-License-Identifier: Zlib
# shellcheck shell=bash
#
# The newest Bullet and Eigen: by GCC, in single precision without threads, and in double precision with them as
# C++23; and by the newest compiler that the packages have (Clang 19) with its own standard library as C++26. The
# sources of Bullet and Eigen are those in $HASHPHASE_BULLET_SOURCE and $HASHPHASE_EIGEN_SOURCE, or else what their
# public repositories have, or else Debian's source packages.

# shellcheck source=tests/checks/sources.sh
source "$root/tests/checks/sources.sh"
tools+=(git:git clang++-19:clang-19)
libraries+=(libc++-19-dev libc++abi-19-dev googletest)

# newest_sources <name> <repository> <package> <folder>: prints the folder of the sources; of a repository only
# the files at the top and the named folder.
newest_sources() {
    local variable=HASHPHASE_${1^^}_SOURCE folder=$root/build/sources/newest-$1
    if [[ ${!variable-} ]]; then
        folder=${!variable}
        say "$1 is that of \$$variable"
    elif {
        export GIT_TERMINAL_PROMPT=0
        if [[ -d $folder ]]; then
            timeout 300 git -C "$folder" fetch -q --depth 1 && git -C "$folder" reset -q --hard FETCH_HEAD
        else
            rm -rf "$folder.part" &&
                timeout 300 git clone -q --depth 1 --filter=blob:none --sparse "$2" "$folder.part" &&
                git -C "$folder.part" sparse-checkout set "$4" && mv "$folder.part" "$folder"
        fi
    } >&2 || [[ -d $folder ]]; then
        say "$1 is that of $2, of $(git -C "$folder" log -1 --format=%cs)"
    else
        folder=$root/build/sources/original-$1
        # As its makers published it: Debian's Bullet redefines commands of CMake.
        [[ -d $folder ]] || {
            rm -rf "$folder.part" && cp -r "$(source_package "$3")" "$folder.part" &&
                dpkg-source --unapply-patches --after-build "$folder.part" && mv "$folder.part" "$folder"
        } >&2 || return
        say "$1 is that of Debian's source package, because $2 is out of reach"
    fi
    echo "$folder"
}

# build_newest <name> <cmake option>...: builds the tests of `programs` with the newest Eigen. What the compiler
# warns of in hashphase is an error.
build_newest() {
    build=$root/build/check-bullet-$1
    say "building build/${build##*/}"
    mkdir -p "$build"
    cmake --fresh -S "$root/tests/checks/bullet" -B "$build" -G Ninja -Wno-dev -DCMAKE_BUILD_TYPE=RelWithDebInfo \
        -DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -DCMAKE_POLICY_VERSION_MINIMUM=3.5 -DEigen3_SOURCES="$eigen" \
        -DHASHPHASE_ASSERTS=ON -DHASHPHASE_BUILD_TESTS=ON -DHASHPHASE_QUICK_BUILD=ON \
        -DHASHPHASE_WARNINGS_AS_ERRORS=ON "${@:2}" >"$build/configure.log" || {
        cat "$build/configure.log" >&2
        return 1
    }
    cmake --build "$build" --target "${programs[@]/%/-tests}" >&2
    if ninja -C "$build" -t deps | grep -E '^ */usr/include/(bullet|eigen3)/' >&2; then
        say "these headers of the system were compiled instead of the newest"
        return 1
    fi
}

# install_bullet <name> <cmake option>...: Bullet as a package of its own makers', in double precision.
install_bullet() {
    build=$root/build/check-bullet-$1
    cmake --fresh -S "$bullet" -B "$build" -G Ninja -Wno-dev -DCMAKE_BUILD_TYPE=Release -DINSTALL_LIBS=ON \
        -DCMAKE_POLICY_VERSION_MINIMUM=3.5 -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DUSE_DOUBLE_PRECISION=ON \
        -DBUILD_{BULLET2_DEMOS,BULLET3,CPU_DEMOS,EGL,ENET,CLSOCKET,EXTRAS,OPENGL3_DEMOS,UNIT_TESTS}=OFF \
        -DCMAKE_INSTALL_PREFIX="$build/prefix" "${@:2}" >/dev/null
    cmake --build "$build" --target install >&2
}

# In single precision, Bullet is a part of the same build; in double precision, it is installed.
check_bullet() {
    local passed=0 failed=0 skipped=0 outcome=0 counts
    bullet=$(newest_sources bullet https://github.com/bulletphysics/bullet3.git bullet src)
    eigen=$(newest_sources eigen https://gitlab.com/libeigen/eigen.git eigen3 Eigen)
    programs=(bullet)
    build_newest float32 -DBullet_SOURCES="$bullet" -DBULLET2_MULTITHREADING=OFF -DHASHPHASE_BUILD_DEMOS=OFF
    counts=$(run_programs "$build/hashphase") || outcome=1
    add_counts "$counts"
    programs=(bullet-float64)
    install_bullet installed -DBULLET2_MULTITHREADING=ON
    # Bullet is static there, and hashphase shared.
    build_newest float64 -DCMAKE_PREFIX_PATH="$build/prefix" -DCMAKE_CXX_STANDARD=23 -DBUILD_SHARED_LIBS=ON \
        -DHASHPHASE_BUILD_DEMOS=OFF
    counts=$(run_programs "$build/hashphase") || outcome=1
    add_counts "$counts"
    programs=(golden broadphase bullet clients property)
    build_newest clang -DBullet_SOURCES="$bullet" -DBULLET2_MULTITHREADING=ON -DHASHPHASE_BUILD_DEMOS=ON \
        -DGTest_SOURCES=/usr/src/googletest -DCMAKE_DISABLE_FIND_PACKAGE_rapidcheck=ON \
        -DCMAKE_CXX_STANDARD=26 -DCMAKE_C_COMPILER=clang-19 -DCMAKE_CXX_COMPILER=clang++-19 \
        -DCMAKE_CXX_FLAGS=-stdlib=libc++
    cmake --build "$build" --target hashphase hashphase-compare >&2
    counts=$(run_programs "$build/hashphase") || outcome=1
    add_counts "$counts"
    say "with the newest Bullet: $passed passed, $failed failed, $skipped skipped"
    return "$outcome"
}

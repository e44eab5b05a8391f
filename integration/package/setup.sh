# SPDX-License-Identifier: Zlib
# shellcheck shell=bash
#
# Sourced by demos/run, tests/run, integration/package/make-deb and others: from a fresh machine to
# an up-to-date build.
# Everything is said on stderr, so that the output of the program that is run stays clean.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

# Tools by the command that must be there, libraries by their Debian package: what the library and
# `hashphase compare` need.
tools=(cmake:cmake ninja:ninja-build c++:g++ pkg-config:pkg-config)
libraries=(libbullet-dev libeigen3-dev libcli11-dev nlohmann-json3-dev libsqlite3-dev)

# What may be missing.
optional_tools=()
optional_libraries=()

# need <part>...: what a part needs beside these.
need() {
    local part
    for part; do
        case $part in
        bullet-files) libraries+=(libbullet-extras-dev) ;; # compare --file level.bullet
        charts) optional_tools+=(npm:npm) ;;               # pages have tables without
        mpi) libraries+=(libopenmpi-dev) tools+=(mpirun:openmpi-bin) ;; # hashphase::mpi
        viewer)                                            # draws on the processor where there is no GPU
            optional_libraries+=(libtbb-dev libglfw3-dev libimgui-dev libepoxy-dev libstb-dev libegl1
                libegl-mesa0 libgl1-mesa-dri)
            ;;
        tests) # rapidcheck makes up operations
            need bullet-files charts mpi viewer
            libraries+=(libgtest-dev libtbb-dev libgmp-dev)
            optional_libraries+=(librapidcheck-dev)
            with_tests=ON
            ;;
        esac
    done
}

say() {
    printf '%s: %s\n' "${script:-setup}" "$*" >&2
}

# Prints the packages of those tools that are missing, one a line.
missing_tools() {
    local tool
    for tool; do
        command -v "${tool%%:*}" >/dev/null || echo "${tool#*:}"
    done
}

# Prints those of the packages that are missing, one a line.
missing_libraries() {
    local library status
    for library; do
        status=$(dpkg-query --show --showformat='${db:Status-Status}' "$library" 2>/dev/null) || true
        [[ $status == installed ]] || echo "$library"
    done
}

# Prints the packages that are missing, one a line.
missing_packages() {
    missing_tools "${tools[@]}"
    missing_libraries "${libraries[@]}"
}

# Prints the optional packages that are missing and that this system offers, one a line.
missing_options() {
    local package
    for package in $(missing_tools "${optional_tools[@]}") \
        $(missing_libraries "${optional_libraries[@]}"); do
        if apt-cache show "$package" >/dev/null 2>&1; then
            echo "$package"
        fi
    done
}

# Installs what is missing, where that is allowed without a question; otherwise says which one
# command is needed and ends with status 2. Goes on without what is optional.
install_missing_packages() {
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        say "this is no Debian or Ubuntu: please see to CMake 3.22, Ninja, a C++20 compiler," \
            "pkg-config, Bullet 3.05, Eigen 3, CLI11, nlohmann-json and SQLite, and, for what needs them," \
            "Bullet's world importer, GoogleTest, TBB and GMP; CMake tells what it cannot find"
        return
    fi
    local missing=() options=() apt=(apt-get)
    mapfile -t missing < <(missing_packages)
    mapfile -t options < <(missing_options)
    ((${#missing[@]} + ${#options[@]})) || return 0
    if [[ $EUID != 0 ]]; then
        if ! sudo -n true 2>/dev/null; then
            say "some packages are missing; install them and try again:"
            say "    sudo apt-get install ${missing[*]} ${options[*]}"
            ((${#missing[@]} == 0)) || exit 2
            say "going on without"
            return 0
        fi
        apt=(sudo -n env DEBIAN_FRONTEND=noninteractive apt-get)
    fi
    export DEBIAN_FRONTEND=noninteractive
    # Lists that cannot be renewed may still be good enough; the installation tells.
    "${apt[@]}" -o DPkg::Lock::Timeout=300 -q update >&2 </dev/null ||
        say "the package lists could not be renewed"
    install_packages "${missing[@]}" || {
        say "installing failed; make this work and try again:"
        say "    apt-get install ${missing[*]}"
        exit 2
    }
    # New lists may offer more.
    mapfile -t options < <(missing_options)
    install_packages "${options[@]}" || say "going on without ${options[*]}"
}

# install_packages [<package>...]: by the caller's `apt`.
install_packages() {
    (($#)) || return 0
    say "installing $* (a minute or so)"
    reconfigure=1 # which may find more now
    "${apt[@]}" -o DPkg::Lock::Timeout=300 -q install -y --no-install-recommends "$@" \
        >&2 </dev/null
}

# build_preset <preset> [<target>...]: configures when need be, or when `reconfigure` is set, and
# builds. A build folder that has tests keeps them.
build_preset() (
    preset=$1
    shift
    build=$root/build/$preset
    cd "$root" || exit
    has_tests=$(sed -n 's/^HASHPHASE_BUILD_TESTS:BOOL=//p' "$build/CMakeCache.txt" 2>/dev/null || true)
    if [[ $has_tests == ON ]]; then
        with_tests=ON
    fi
    # Ninja notices changes of CMakeLists.txt by itself, but not those of the presets.
    if [[ ${reconfigure-} || ! -f $build/build.ninja || $has_tests != "${with_tests-OFF}" ||
        CMakePresets.json -nt $build/build.ninja ]]; then
        say "configuring build/$preset"
        cmake --preset "$preset" -DHASHPHASE_BUILD_TESTS="${with_tests-OFF}" >&2
    fi
    steps=$(cmake --build "$build" ${1:+--target "$@"} -- -n 2>/dev/null | grep -c '^\[' || true)
    if ((steps > 3)); then
        cores=$(getconf _NPROCESSORS_ONLN)
        say "building build/$preset: $steps steps, about $(((steps * 4 / cores + 9) / 10 * 10)) s on" \
            "$cores cores"
    fi
    NINJA_STATUS='[%f of %t steps, %es] ' cmake --build "$build" ${1:+--target "$@"} >&2
)

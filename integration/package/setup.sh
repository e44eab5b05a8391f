# SPDX-License-Identifier: Zlib
# shellcheck shell=bash
#
# Sourced by demos/run, tests/run, integration/package/make-deb and others: from a fresh machine to
# an up-to-date build. Its messages go to stderr, so that stdout is the program's alone.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

# What the library and `hashphase compare` need: tools as <command>:<Debian package>, libraries as Debian
# packages.
tools=(cmake:cmake ninja:ninja-build c++:g++ pkg-config:pkg-config)
libraries=(libbullet-dev libeigen3-dev libcli11-dev nlohmann-json3-dev libsqlite3-dev)

# These may be missing.
optional_tools=()
optional_libraries=()

# need <part>...: adds what a part needs.
need() {
    local part
    for part; do
        case $part in
        bullet-files) libraries+=(libbullet-extras-dev) ;; # compare --file level.bullet
        charts) optional_tools+=(npm:npm) ;;               # without it, pages have tables only
        mpi) libraries+=(libopenmpi-dev) tools+=(mpirun:openmpi-bin) ;; # hashphase::mpi
        viewer)                                            # draws on the processor if there is no GPU
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

# Prints the packages of the missing tools among these, one a line.
missing_tools() {
    local tool
    for tool; do
        command -v "${tool%%:*}" >/dev/null || echo "${tool#*:}"
    done
}

# Prints the missing packages among these, one a line.
missing_libraries() {
    local library status
    for library; do
        status=$(dpkg-query --show --showformat='${db:Status-Status}' "$library" 2>/dev/null) || true
        [[ $status == installed ]] || echo "$library"
    done
}

# Prints all missing packages, one a line.
missing_packages() {
    missing_tools "${tools[@]}"
    missing_libraries "${libraries[@]}"
}

# Prints the missing optional packages that this system offers, one a line.
missing_options() {
    local package
    for package in $(missing_tools "${optional_tools[@]}") \
        $(missing_libraries "${optional_libraries[@]}"); do
        if apt-cache show "$package" >/dev/null 2>&1; then
            echo "$package"
        fi
    done
}

# Installs missing packages if no password is needed. Otherwise prints the command that does, and exits with
# status 2, unless only optional packages are missing.
install_missing_packages() {
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        say "this system is not Debian or Ubuntu, so nothing is installed. Install CMake 3.22, Ninja, a C++20" \
            "compiler, pkg-config, Bullet 3.05, Eigen 3, CLI11, nlohmann-json and SQLite; for the tests also" \
            "Bullet's world importer, GoogleTest, TBB and GMP. CMake names what it does not find"
        return
    fi
    local missing=() options=() apt=(apt-get)
    mapfile -t missing < <(missing_packages)
    mapfile -t options < <(missing_options)
    ((${#missing[@]} + ${#options[@]})) || return 0
    if [[ $EUID != 0 ]]; then
        if ! sudo -n true 2>/dev/null; then
            say "packages are missing, and installing them needs a password. Run this, and try again:"
            say "    sudo apt-get install ${missing[*]} ${options[*]}"
            ((${#missing[@]} == 0)) || exit 2
            say "continuing without them: they are optional"
            return 0
        fi
        apt=(sudo -n env DEBIAN_FRONTEND=noninteractive apt-get)
    fi
    export DEBIAN_FRONTEND=noninteractive
    # Old lists may be good enough: the installation shows.
    "${apt[@]}" -o DPkg::Lock::Timeout=300 -q update >&2 </dev/null ||
        say "apt-get update failed; trying with the old package lists"
    install_packages "${missing[@]}" || {
        say "apt-get failed, see above. Make this work, and try again:"
        say "    apt-get install ${missing[*]}"
        exit 2
    }
    # The new lists may offer more.
    mapfile -t options < <(missing_options)
    install_packages "${options[@]}" || say "continuing without ${options[*]}: optional"
}

# install_packages [<package>...]: runs the caller's `apt`.
install_packages() {
    (($#)) || return 0
    say "installing $* (about a minute)"
    reconfigure=1 # which may find more now
    "${apt[@]}" -o DPkg::Lock::Timeout=300 -q install -y --no-install-recommends "$@" \
        >&2 </dev/null
}

# build_preset <preset> [<target>...]: configures if needed, or if `reconfigure` is set, and builds. A build
# folder with tests keeps them.
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

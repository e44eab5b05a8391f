# SPDX-License-Identifier: Zlib
# shellcheck shell=bash
#
# Sourced by the checks of other platforms, which need Bullet and others there: by Debian's packages, which
# are unpacked in build/sources and not installed.

tools+=(dpkg-source:dpkg-dev)

# private_apt <type> <architecture> <argument>...: apt-get with the system's own package servers and lists
# of packages apart from the system's, of the type deb or deb-src.
private_apt() {
    local lists=$root/build/sources/$1-$2
    local apt=(apt-get -q -o Dir::State::lists="$lists/state" -o Dir::Etc::sourceparts="$lists"
        -o Dir::Etc::sourcelist="$lists/servers.sources" -o APT::Sandbox::User=root
        -o APT::Architecture="$2" -o APT::Architectures="$2")
    # What the servers had a day ago they may have no longer.
    if [[ ! $(find "$lists/updated" -mmin -1440 2>/dev/null) ]]; then
        mkdir -p "$lists/state"
        if compgen -G '/etc/apt/sources.list.d/*.sources' >/dev/null; then
            sed -s -e "s/^Types:.*/Types: $1/" -e '$G' /etc/apt/sources.list.d/*.sources >"$lists/servers.sources"
        fi
        if [[ -s /etc/apt/sources.list ]]; then
            sed -n "s/^deb /$1 /p" /etc/apt/sources.list >"$lists/servers.list"
        fi
        "${apt[@]}" -o APT::Update::Error-Mode=any update || return
        touch "$lists/updated"
    fi
    "${apt[@]}" "${@:3}"
}

# source_package <name>: prints the folder of the newest source package of that name that this system's
# package servers have; downloads it when it is not there yet.
source_package() {
    local folder=$root/build/sources/$1
    if [[ ! -d $folder ]]; then
        say "downloading the sources of $1"
        rm -rf "$folder.part"
        mkdir -p "$folder.part"
        (
            cd "$folder.part" &&
                private_apt deb-src "$(dpkg --print-architecture)" source --download-only "$1" &&
                dpkg-source --no-check -x ./*.dsc sources && mv sources "$folder" && rm -r "$folder.part"
        ) >&2 || return
    fi
    echo "$folder"
}

# foreign_packages <architecture> <package>...: prints the folder that has these packages of another
# architecture, unpacked; they bring no others along.
foreign_packages() {
    local folder=$root/build/sources/$1
    if [[ $(cat "$folder/names" 2>/dev/null) != "${*:2}" ]]; then
        say "downloading packages for $1"
        rm -rf "$folder" "$folder.part"
        mkdir -p "$folder.part/packages"
        echo "${*:2}" >"$folder.part/names"
        (
            cd "$folder.part/packages" && private_apt deb "$1" download "${@:2}" &&
                for package in *.deb; do dpkg -x "$package" ..; done && mv "$folder.part" "$folder"
        ) >&2 || return
    fi
    echo "$folder"
}

# run_part <program> <part> <launcher>...: runs a fourth of the tests of a program of GoogleTest, but for those
# that `leaves_out` names, and shows what it said if one fails.
run_part() {
    local log=$1.$2.log
    GTEST_TOTAL_SHARDS=4 GTEST_SHARD_INDEX=$2 timeout 1200 "${@:3}" "$1" --gtest_brief=1 \
        --gtest_filter="-${leaves_out-}" >"$log" 2>&1 </dev/null || {
        local status=$?
        cat "$log"
        echo "${1##*/}: exit status $status" # 124 where it took twenty minutes
        return 1
    }
    grep -q '^\[  PASSED  \]' "$log" || {
        cat "$log"
        echo "${1##*/}: ended without a word of its tests"
        return 1
    }
}

# run_programs <folder> <launcher>...: runs the `programs` that were built in the folder by the launcher,
# and says how many tests passed.
run_programs() {
    local outcome=0 name
    local -a built=()
    for name in "${programs[@]}"; do
        built+=("$(find "$1" -type f \( -name "$name-tests" -o -name "$name-tests.*[em]" \))")
    done
    say "running ${programs[*]/%/-tests}"
    export leaves_out
    export -f run_part
    for name in "${built[@]}"; do
        printf '%s\n' "$name" 0 "$name" 1 "$name" 2 "$name" 3
    done | xargs -d '\n' -n2 -P2 bash -c 'run_part "${@: -2}" "${@:1:$#-2}"' run_part "${@:2}" >&2 || outcome=1
    cat "${built[@]/%/.0.log}" "${built[@]/%/.1.log}" "${built[@]/%/.2.log}" "${built[@]/%/.3.log}" | awk '
        /^\[  PASSED  \]/ { passed += $4 }
        /^\[  SKIPPED \] [0-9]+ test/ { skipped += $4 }
        /^\[  FAILED  \] .* \([0-9]+ ms\)\r?$/ { ++failed }
        END { printf "%d passed, %d failed, %d skipped\n", passed, failed, skipped; exit passed == 0 }' ||
        outcome=1
    return "$outcome"
}

# add_counts <counts>: adds what run_programs said to `passed`, `failed` and `skipped`.
add_counts() {
    local words
    read -ra words <<<"$1"
    passed=$((passed + words[0]))
    failed=$((failed + words[2]))
    skipped=$((skipped + words[4]))
}

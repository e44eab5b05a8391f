# SPDX-License-Identifier: Zlib
# shellcheck shell=bash
#
# Sourced by the checks of other platforms, which compile Bullet and others for them: sources by Debian's
# source packages, kept in build/sources.

tools+=(dpkg-source:dpkg-dev)

# source_package <name>: prints the folder of the newest source package of that name that this system's
# package servers have; downloads it when it is not there yet.
source_package() {
    local folder=$root/build/sources/$1
    if [[ ! -d $folder ]]; then
        say "downloading the sources of $1"
        local lists=$root/build/sources/lists
        mkdir -p "$lists"
        local apt=(apt-get -q -o Dir::State::lists="$lists/state" -o Dir::Etc::sourceparts="$lists"
            -o Dir::Etc::sourcelist="$lists/deb-src.sources" -o APT::Sandbox::User=root)
        mkdir -p "$lists/state"
        # The system's own lists, asked for sources in place of packages.
        if compgen -G '/etc/apt/sources.list.d/*.sources' >/dev/null; then
            cat /etc/apt/sources.list.d/*.sources | sed 's/^Types:.*/Types: deb-src/' >"$lists/deb-src.sources"
        fi
        if [[ -s /etc/apt/sources.list ]]; then
            sed -n 's/^deb /deb-src /p' /etc/apt/sources.list >"$lists/old.list"
        fi
        (
            cd "$lists" || exit
            "${apt[@]}" update && "${apt[@]}" source --download-only "$1" && rm -rf "$folder.part" &&
                dpkg-source --no-check -x "$1"_*.dsc "$folder.part" && mv "$folder.part" "$folder"
        ) >&2 || return
    fi
    echo "$folder"
}

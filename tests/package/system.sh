# SPDX-License-Identifier: Zlib
# shellcheck shell=bash
#
# Sourced by fresh_system and first_program, after setup.sh: a fresh system of Debian in a temporary folder. It is
# removed, with its mounts, when the script ends.

# The script's arguments, to start it again.
arguments=()

# Ends the script unless root runs it.
require_root() {
    if [[ $EUID != 0 ]]; then
        say "makes a system: run it as root"
        exit 2
    fi
}

# make_system <release> [<package>...]: with these packages; sets `system` to its folder. Starts the script again, with
# its `arguments`, in mounts of its own, which end with it.
make_system() {
    local release=$1 packages mirror
    packages=$(IFS=, && echo "${*:2}")
    # shellcheck disable=SC2016 # apt-get fills it in
    mirror=$(apt-get indextargets --format '$(REPO_URI)' "Codename: $release" "Component: main" | head -n 1)
    if [[ ! $mirror ]]; then
        say "this system's apt does not know $release: add it to apt's sources"
        exit 2
    fi
    if [[ ${FRESH_SYSTEM_ALONE-} != yes ]]; then
        FRESH_SYSTEM_ALONE=yes exec unshare --mount "$0" "${arguments[@]}"
    fi
    system=$(mktemp --directory --tmpdir hashphase-system.XXXXXX)
    trap remove_system EXIT
    say "making a system of $release in $system"
    debootstrap --variant=minbase ${packages:+--include="$packages"} "$release" "$system" "$mirror" >&2
    cp --dereference /etc/resolv.conf "$system/etc/"
    mount -t proc proc "$system/proc"
}

remove_system() {
    umount "$system/proc" 2>/dev/null || true
    rm -rf --one-file-system "$system"
}

# inside <command> [<argument>...]: runs it in the system.
inside() {
    chroot "$system" env -i HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
        PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin "$@"
}

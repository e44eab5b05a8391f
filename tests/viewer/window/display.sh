# shellcheck shell=bash
# SPDX-License-Identifier: Zlib
#
# For scripts that play the viewer: goes on with the script that sources it on a display in memory (Xvfb), in
# the folder $folder, which is empty then. Exit status 77 where the tools for that are missing. $viewer is
# the viewer.

if [[ -z ${PLAY_INSIDE-} ]]; then
    for tool in xvfb-run xdotool; do
        command -v "$tool" >/dev/null || {
            echo "$tool is missing"
            exit 77
        }
    done
    rm -rf "$folder"
    mkdir -p "$folder"
    PLAY_INSIDE=1 exec xvfb-run -a -s "-screen 0 1280x800x24 -fbdir $(cd "$folder" && pwd)" "$0" "$@"
fi
cd "$folder" || exit
folder=$PWD
program=

fail() {
    echo "$*"
    [[ -z $program ]] || kill "$program" 2>/dev/null || true
    exit 1
}

# Starts the viewer with these options, and waits for its window; what it says goes to said.txt.
open_window() {
    "${viewer:?}" "$@" >"$folder/said.txt" 2>&1 &
    program=$!
    window=$(timeout 60 xdotool search --sync --onlyvisible --name "hashphase wander" | head -n 1) ||
        fail "no window has come up: $(cat "$folder/said.txt")"
}

# Ends it by its key; the window may be gone before the key is up.
end_window() {
    xdotool key --window "$window" F10 2>/dev/null || true
    wait "$program" || fail "the viewer has failed: $(cat "$folder/said.txt")"
    program=
}

key() {
    xdotool key --window "$window" "$1"
    sleep 0.3
}

# Values of the JSON file that the viewer writes at its end.
reading() {
    sed -n "s/^ *\"$1\": \([-0-9.e+]*\),*$/\1/p" "$folder/end.json" | head -n 1
}

is() {
    local value
    value=$(reading "$1")
    awk -v value="$value" "BEGIN { exit !(value != \"\" && value + 0 $2) }" ||
        fail "$1 is '$value', but should be $2"
}

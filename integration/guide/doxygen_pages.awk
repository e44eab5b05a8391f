# SPDX-License-Identifier: Zlib
#
# Pages as Doxygen reads them, line by line. It knows headings by labels of its own and pictures by their
# names alone; links here are written as for GitHub. So headings get labels, <page> and <page>-<heading>,
# links lead to these, and pictures lose their folders.

function page_of(file) {
    if (file ~ /guide\/README\.md$/ || (file == "README.md" && isGuide)) return "guide"
    if (file ~ /demos\/README\.md$/) return "demos"
    sub(/^.*\//, "", file)
    sub(/\.md$/, "", file)
    return tolower(file)
}

function slug_of(heading) {
    heading = tolower(heading)
    gsub(/^#+ +|[^a-z0-9 _-]/, "", heading)
    gsub(/ /, "-", heading)
    return heading
}

function label_of(target,    at) {
    at = index(target, "#")
    if (at == 0) return page_of(target)
    return (at == 1 ? page : page_of(substr(target, 1, at - 1))) "-" substr(target, at + 1)
}

FNR == 1 {
    isGuide = FILENAME ~ /integration\/guide\//
    page = page_of(FILENAME)
}
/^```/ { isCode = !isCode }
isCode || /^```/ { print; next }
/^# / { print $0 " {#" page "}"; next }
/^##+ / { print $0 " {#" page "-" slug_of($0) "}"; next }
{
    rest = $0
    line = ""
    while (match(rest, /\]\([^)]+\)/)) {
        target = substr(rest, RSTART + 2, RLENGTH - 3)
        if (target ~ /\.(svg|webp)$/) {
            sub(/^.*\//, "", target)
        } else if (target !~ /^[a-z]+:/) {
            target = "#" label_of(target)
        }
        line = line substr(rest, 1, RSTART + 1) target ")"
        rest = substr(rest, RSTART + RLENGTH)
    }
    print line rest
}

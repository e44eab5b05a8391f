# SPDX-License-Identifier: Zlib
#
# Headers as Doxygen reads them, line by line. The comment at the head of each says what it is for, and
# becomes the file's description: its first paragraph as text, the rest as it stands, because its tables
# live by their columns. Instantiations and specialisations are left out, the namespace that tells precisions
# apart, which nobody writes, and what is for compilers alone.

{ sub(/::inline HASHPHASE_BULLET_NAMESPACE/, ""); sub(/ \[\[HASHPHASE_LIFETIME_BOUND\]\]\)/, ")") }

/^extern template/ || /^template <>$/ { isInstantiation = 1 }
isInstantiation {
    if (/;$/) isInstantiation = 0
    print ""
    next
}

/^#pragma once/ {
    print
    getline blank
    getline
    isHead = /^\/\/ /
    print isHead ? "/** \\file" : blank
}
isHead && /^\/\/ / {
    print substr($0, 4)
    next
}
isHead && /^\/\/$/ {
    print isTable ? "" : "\\verbatim"
    isTable = 1
    next
}
isHead {
    print isTable ? "\\endverbatim */" : "*/"
    isHead = 0
    next
}
{ print }

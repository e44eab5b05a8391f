// SPDX-License-Identifier: Zlib
//
// Hides the macros min() and max() of <windows.h> and others from a header of ours, until
// restore_macros.hpp at its end. Include it last: what is included after it would lose a macro of that
// name. Any other macro of a program we avoid by not using its name (tests/package/foreign_macros.hpp).

#pragma push_macro("min")
#pragma push_macro("max")
#undef min
#undef max

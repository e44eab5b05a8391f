// SPDX-License-Identifier: Zlib
//
// Ends what hide_macros.hpp begins. The last line of a header.

#pragma pop_macro("min")
#pragma pop_macro("max")

// SPDX-License-Identifier: Zlib
#pragma once

#include <cstddef>

namespace hashphase::detail {

/// Takes the shift off each coordinate. Returns whether nothing was rounded; what is NaN stays so.
template <class Scalar>
bool shiftColumn(Scalar* column, std::size_t count, Scalar shift);

}  // namespace hashphase::detail

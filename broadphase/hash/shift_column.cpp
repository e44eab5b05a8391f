// SPDX-License-Identifier: Zlib

// Compiled with the options of the kernels, for its loop is one.

#include <broadphase/hash/shift_column.hpp>

#include <broadphase/geometry/origin_shift.hpp>

namespace hashphase::detail {

template <class Scalar>
bool shiftColumn(Scalar* column, std::size_t count, Scalar shift) {
    int isExact = 1;
    for (std::size_t i = 0; i < count; ++i) {
        const Scalar x = column[i];
        const Scalar difference = x - shift;
        isExact &= static_cast<int>(isExactDifference(x, shift, difference) | (x != x));
        column[i] = difference;
    }
    return isExact != 0;
}

template bool shiftColumn(float*, std::size_t, float);
template bool shiftColumn(double*, std::size_t, double);

}  // namespace hashphase::detail

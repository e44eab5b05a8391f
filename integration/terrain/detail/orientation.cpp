// SPDX-License-Identifier: Zlib
#include <integration/terrain/detail/orientation.hpp>

#include <broadphase/geometry/expansion.hpp>

namespace hashphase::detail {

double exactOrientation(const Point2& a, const Point2& b, const Point2& c) noexcept {
    Expansion<12> sum;
    sum.addProduct(a.x, b.z);
    sum.addProduct(-a.z, b.x);
    sum.addProduct(b.x, c.z);
    sum.addProduct(-b.z, c.x);
    sum.addProduct(c.x, a.z);
    sum.addProduct(-c.z, a.x);
    return sum.value();
}

}  // namespace hashphase::detail

// SPDX-License-Identifier: Zlib
#include <demos/stability/exact.hpp>

#include <demos/system/limits.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

namespace hashphase::demos {

template <class Scalar>
Keys touchingPairs(const Boxes<Scalar>& boxes) {
    const LimitPause pause;
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        if (doTouch(boxes[i], {boxes[i].max(), boxes[i].min()})) {  // no NaN
            order.push_back(i);
        }
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return boxes[a].min()[0] < boxes[b].min()[0];
    });
    Keys pairs;
    for (auto a = order.begin(); a != order.end(); ++a) {
        const Aabb<Scalar>& box = boxes[*a];
        for (auto b = a + 1; b != order.end() && boxes[*b].min()[0] <= box.max()[0]; ++b) {
            if (doTouch(box, boxes[*b])) {
                pairs.push_back(pairKey(*a, *b));
            }
        }
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

template Keys touchingPairs(const Boxes<float>& boxes);
template Keys touchingPairs(const Boxes<double>& boxes);

namespace {

__extension__ using Wide = __int128;
constexpr double kFarthest = 0x1p59;

std::int64_t stepsOf(double coordinate, double step, bool mayBeFarther = false) {
    const double steps = coordinate / step;
    if (std::floor(steps) != steps || (!mayBeFarther && std::abs(steps) > kFarthest)) {
        throw std::logic_error("A coordinate is not on the lattice.");
    }
    return static_cast<std::int64_t>(std::clamp(steps, -2 * kFarthest, 2 * kFarthest));
}

struct Fraction {
    std::int64_t numerator;
    std::int64_t denominator;  // above 0

    friend bool operator<(const Fraction& a, const Fraction& b) {
        return Wide{a.numerator} * b.denominator < Wide{b.numerator} * a.denominator;
    }
};

}  // namespace

bool Lattice::meets(const MovingBox<double>& box, const Vector3<double>& from,
                    const Vector3<double>& to, const Aabb<double>& fatness, double doubt) const {
    const auto tolerance = static_cast<std::int64_t>(std::ceil(doubt / step_));
    Fraction enter{0, 1};
    Fraction leave{1, 1};
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = [&](const Vector3<double>& point) { return stepsOf(point[axis], step_); };
        const std::int64_t way = at(to) - at(from) - at(box.displacement);
        const std::int64_t low =
            stepsOf(box.box.min()[axis], step_, true) - at(from) - at(fatness.max()) - tolerance;
        const std::int64_t high =
            stepsOf(box.box.max()[axis], step_, true) - at(from) - at(fatness.min()) + tolerance;
        if (way == 0) {
            if (low > 0 || high < 0) {
                return false;
            }
            continue;
        }
        enter = std::max(enter, way > 0 ? Fraction{low, way} : Fraction{-high, -way});
        leave = std::min(leave, way > 0 ? Fraction{high, way} : Fraction{-low, -way});
    }
    return !(leave < enter);
}

}  // namespace hashphase::demos

// SPDX-License-Identifier: Zlib
#include <demos/accuracy/sweeps/sweep_truth.hpp>

namespace hashphase::demos {

std::optional<Fraction> exactContact(const SweptFrame& frame, std::uint32_t a, std::uint32_t b) {
    const MovingBox<float>& one = frame.objects[a];
    const MovingBox<float>& other = frame.objects[b];
    WholePoint closing;
    WholePoint low;
    WholePoint high;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        const auto units = [&](const Vector3<float>& point) {
            return wholeUnits(point[axis], frame.unit[i], 0x1p24F);
        };
        closing[i] = units(one.displacement) - units(other.displacement);
        low[i] = units(other.box.min()) - units(one.box.max());
        high[i] = units(other.box.max()) - units(one.box.min());
    }
    return exactEntry(closing, low, high);
}

SweepTruth findTruth(const SweptFrame& frame) {
    std::vector<Aabb<float>> ways;
    for (const MovingBox<float>& each : frame.objects) {
        ways.push_back(wayBox(each));
    }
    std::vector<PairKey> candidates;
    findExactPairs(ReferenceMethod::kSweep, ways, {}, candidates);
    SweepTruth truth;
    for (const PairKey pair : candidates) {
        if (firstOf(pair) >= frame.movers) {
            continue;
        }
        const std::optional<Fraction> moment = exactContact(frame, firstOf(pair), secondOf(pair));
        if (moment && moment->numerator == 0) {
            truth.older.push_back(pair);
        } else if (moment) {
            truth.contacts.push_back(pair);
            truth.moments.push_back(*moment);
        }
    }
    return truth;
}

}  // namespace hashphase::demos

// SPDX-License-Identifier: Zlib
#include <demos/accuracy/sweeps/sweep_truth.hpp>

#include <cmath>
#include <stdexcept>

namespace hashphase::demos {
namespace {

// Differences of coordinates stay below 2^26, products of two below 2^52.
std::int64_t unitsOf(float coordinate, float unit) {
    const double units = static_cast<double>(coordinate) / static_cast<double>(unit);
    if (std::floor(units) != units || std::abs(units) > 0x1p24) {
        throw std::logic_error("A coordinate is no multiple of the frame's unit.");
    }
    return static_cast<std::int64_t>(units);
}

// The times at which something holds; begin > end when it never does.
struct Times {
    Moment begin{0, 1};
    Moment end{1, 1};
    bool isNever = false;

    /// Keeps those at which speed * time >= distance.
    void keep(std::int64_t speed, std::int64_t distance) {
        if (speed == 0) {
            isNever |= distance > 0;
        } else if (speed > 0) {
            begin = std::max(begin, Moment{distance, speed});
        } else {
            end = std::min(end, Moment{-distance, -speed});
        }
    }
};

}  // namespace

double Moment::errorOf(double time) const {
    const auto whole = static_cast<double>(denominator);
    return std::abs(std::fma(time, whole, -static_cast<double>(numerator))) / whole;
}

std::optional<Moment> exactContact(const SweptFrame& frame, std::uint32_t a, std::uint32_t b) {
    const MovingBox<float>& one = frame.objects[a];
    const MovingBox<float>& other = frame.objects[b];
    Times times;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        const auto units = [&](float coordinate) { return unitsOf(coordinate, frame.unit[i]); };
        const std::int64_t closing =
            units(one.displacement[axis]) - units(other.displacement[axis]);
        times.keep(closing, units(other.box.min()[axis]) - units(one.box.max()[axis]));
        times.keep(-closing, units(one.box.min()[axis]) - units(other.box.max()[axis]));
    }
    if (times.isNever || times.end < times.begin) {
        return std::nullopt;
    }
    return times.begin;
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
        const std::optional<Moment> moment = exactContact(frame, firstOf(pair), secondOf(pair));
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

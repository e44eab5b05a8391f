// SPDX-License-Identifier: Zlib
#pragma once

// Random numbers that are the same on every machine and standard library. Draw one in a statement, or
// in braces: of two arguments of a call, compilers choose which one is drawn first.

#include <broadphase/aabb.hpp>

#include <cmath>
#include <cstdint>
#include <random>

namespace hashphase::test {

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    /// 0 <= x < 1.
    double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

    /// Works for any two finite numbers, however far apart.
    double between(double low, double high) {
        const double x = unit();
        return low * (1 - x) + high * x;
    }

    /// Each order of magnitude as likely as any other.
    double logBetween(double low, double high) {
        return std::exp(between(std::log(low), std::log(high)));
    }

    /// 0 <= i < count.
    std::uint32_t below(std::uint32_t count) {
        return static_cast<std::uint32_t>(unit() * static_cast<double>(count));
    }

    /// 0, 1 or 2.
    int axis() { return static_cast<int>(below(3)); }

    bool chance(double share) { return unit() < share; }

    Vector3<double> pointIn(const Vector3<double>& low, const Vector3<double>& high) {
        const double x = between(low[0], high[0]);
        const double y = between(low[1], high[1]);
        const double z = between(low[2], high[2]);
        return {x, y, z};
    }

    Vector3<double> pointIn(double low, double high) {
        return pointIn(Vector3<double>::Constant(low), Vector3<double>::Constant(high));
    }

private:
    std::mt19937_64 engine_;
};

}  // namespace hashphase::test

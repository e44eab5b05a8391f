// SPDX-License-Identifier: Zlib
#pragma once

// Turns the arguments of operations into numbers and boxes: few different ones, so that ties are
// frequent, most of them on the borders of cells or one step beside them, and all the numbers that
// have broken a broadphase.

#include <broadphase/aabb.hpp>
#include <broadphase/grid_config.hpp>
#include <tests/fuzz/operation.hpp>
#include <tests/support/oracles.hpp>
#include <tests/support/random.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

namespace hashphase::test {

/// Reads an operation's arguments one by one; 0 behind the last.
class Arguments {
public:
    explicit Arguments(const Operation& operation) : bytes_(operation.arguments) {}

    std::uint8_t byte() { return next_ < bytes_.size() ? bytes_[next_++] : std::uint8_t{0}; }
    std::uint32_t below(std::uint32_t count) { return count == 0 ? 0 : byte() % count; }
    bool flag() { return (byte() & 1) != 0; }

    /// For what is too large to be written down in bytes.
    Random random() {
        std::uint64_t seed = 0x5eed2b00;
        for (const std::uint8_t byte : bytes_) {
            seed = seed * 1099511628211U + byte;
        }
        return Random(seed);
    }

private:
    std::span<const std::uint8_t> bytes_;
    std::size_t next_ = 0;
};

/// The grid that the first operation asks for, from its arguments 0 to 2.
[[nodiscard]] inline GridConfig configOf(const Operation& first) {
    constexpr std::array<double, 6> kCellSizes{0, 1, 0.1, 1e-3, 1e4, 1e-30};
    constexpr std::array<double, 4> kRatios{4, 2, 16, 64};
    constexpr std::array<std::uint32_t, 4> kUpdatesBeforeRest{8, 1, 2, 1000};
    constexpr std::array<double, 3> kSlacks{0, 0.05, 1e6};
    GridConfig config;
    const std::size_t slack = first.arguments[2] / kUpdatesBeforeRest.size() % 6;
    if (slack < kSlacks.size()) {  // else it follows the motion
        config.slack = kSlacks[slack];
    }
    config.cellSize = kCellSizes[first.arguments[0] % kCellSizes.size()];
    config.levelRatio = kRatios[first.arguments[1] % kRatios.size()];
    config.updatesBeforeRest = kUpdatesBeforeRest[first.arguments[2] % kUpdatesBeforeRest.size()];
    return config;
}

/// One with any arguments.
[[nodiscard]] inline Operation drawOperation(Random& random) {
    Operation drawn;
    for (std::uint8_t& byte : drawn.arguments) {
        byte = static_cast<std::uint8_t>(random.below(256));
    }
    return drawn;
}

template <class Scalar>
class Palette {
public:
    /// Where the world is, and how large, from arguments 3 and 4.
    explicit Palette(const Operation& first) {
        using Limits = std::numeric_limits<Scalar>;
        const std::array<Scalar, 8> scales{1,
                                           Scalar(0.1),
                                           Scalar(1e-3),
                                           Scalar(1e4),
                                           Scalar(1e18),
                                           64 * Limits::denorm_min(),
                                           Limits::max() / 64,
                                           Scalar(1e-30)};
        const std::array<Scalar, 5> origins{0, Scalar(1e6), Scalar(-1e9), 16777216, Scalar(-0.3)};
        scale_ = scales[first.arguments[3] % scales.size()];
        origin_ = origins[first.arguments[4] % origins.size()];
    }

    [[nodiscard]] Scalar scale() const noexcept { return scale_; }

    /// From now on, nothing denormal, infinite or nearly so.
    void tame() {
        isTame_ = true;
        scale_ = scale_ > Scalar(1e-35) && scale_ < Scalar(1e30) ? scale_ : Scalar(1);
    }

    /// Multiples of the scale from -21 to 21, on the spot or one step beside, halves, and thirds.
    [[nodiscard]] Scalar coordinate(std::uint8_t byte) const {
        using Limits = std::numeric_limits<Scalar>;
        const int number = byte / 6;
        const auto k = static_cast<Scalar>(number % 2 == 0 ? number / 2 : -(number + 1) / 2);
        const Scalar border = origin_ + k * scale_;
        const std::array<Scalar, 6> around{border,
                                           std::nextafter(border, Limits::infinity()),
                                           std::nextafter(border, -Limits::infinity()),
                                           border + scale_ / 2,
                                           border + scale_ / 3,
                                           border == 0 ? -border : border + scale_ * Scalar(0.1)};
        return around[byte % 6];
    }

    /// 0 and more: parts of the scale and multiples.
    [[nodiscard]] Scalar extent(std::uint8_t byte) const {
        constexpr std::array<double, 16> kShares{1, 0, 0.5, 1. / 3, 0.1, 2,  3,  0.999,
                                                 1, 0, 1.5, 0.25,   4,   10, 30, 1e-3};
        return static_cast<Scalar>(kShares[byte % kShares.size()]) * scale_;
    }

    /// What has broken a broadphase before.
    [[nodiscard]] static Scalar hostile(std::uint8_t byte) {
        using Limits = std::numeric_limits<Scalar>;
        const std::array<Scalar, 18> numbers{0,
                                             Limits::denorm_min(),
                                             37 * Limits::denorm_min(),
                                             Limits::min(),
                                             Scalar(1e-30),
                                             Scalar(0.1),
                                             1,
                                             16777216,
                                             268435456,
                                             Scalar(2147483648.0),
                                             Scalar(3e9),
                                             Scalar(9.2e18),
                                             Scalar(1e18),
                                             Scalar(1e30),
                                             Limits::max() / 2,
                                             Limits::max(),
                                             Limits::infinity(),
                                             Limits::quiet_NaN()};
        const Scalar number = numbers[byte / 2 % numbers.size()];
        return byte % 2 == 0 ? number : -number;
    }

    /// From now on, no inverted boxes either, and nothing beyond 1e9 but half-spaces.
    void calm() {
        tame();
        isOrdered_ = true;
        scale_ = scale_ > Scalar(1e-6) && scale_ < Scalar(1e6) ? scale_ : Scalar(1);
    }

    [[nodiscard]] Vector3<Scalar> point(Arguments& arguments) const {
        const Scalar x = coordinate(arguments.byte());
        const Scalar y = coordinate(arguments.byte());
        const Scalar z = coordinate(arguments.byte());
        return {x, y, z};
    }

    /// Takes seven arguments. Half of the boxes are ordinary; others begin where one of those there
    /// ends, are equal to it, are half-spaces, or hold hostile numbers.
    [[nodiscard]] Aabb<Scalar> box(Arguments& arguments,
                                   std::span<const Placed<Scalar>> others) const {
        const std::uint8_t form = arguments.byte();
        Aabb<Scalar> box;
        box.min() = point(arguments);
        std::array<std::uint8_t, 3> last{};
        for (int axis = 0; axis < 3; ++axis) {
            last[static_cast<std::size_t>(axis)] = arguments.byte();
            box.max()[axis] = box.min()[axis] + extent(last[static_cast<std::size_t>(axis)]);
        }
        const auto axis = static_cast<int>(form / 16 % 3);
        switch (isTame_ && (form % 16 == 9 || form % 16 == 10) ? 0 : form % 16) {
            case 8:  // from anywhere to anywhere, perhaps inverted
                for (int i = 0; i < 3; ++i) {
                    box.max()[i] = coordinate(last[static_cast<std::size_t>(i)]);
                }
                break;
            case 9:  // one number that is hostile
                (form / 64 % 2 == 0 ? box.min() : box.max())[axis] = hostile(last[0]);
                break;
            case 10:  // all six
                for (int i = 0; i < 3; ++i) {
                    const std::uint8_t byte = last[static_cast<std::size_t>(i)];
                    box.min()[i] = hostile(static_cast<std::uint8_t>(byte / 16 * 2));
                    box.max()[i] = hostile(byte);
                }
                break;
            case 11: {  // a half-space
                const auto far = static_cast<Scalar>(sizeof(Scalar) == 4 ? 1e18 : 1e30);
                const Scalar top = box.max()[axis];
                box = {Vector3<Scalar>::Constant(-far), Vector3<Scalar>::Constant(far)};
                box.max()[axis] = top;
                break;
            }
            case 12:
            case 13:
            case 14:  // touches another one, or misses it by a step
                touch(box, axis, form % 16 - 12, last[0], others);
                break;
            case 15:  // where another one is
                box = others.empty() ? box : others[last[0] % others.size()].box;
                break;
            default:
                break;
        }
        if (isOrdered_) {
            box.max() = box.max().cwiseMax(box.min()).eval();
        }
        return box;
    }

private:
    void touch(Aabb<Scalar>& box, int axis, int step, std::uint8_t other,
               std::span<const Placed<Scalar>> others) const {
        if (others.empty()) {
            return;
        }
        const Aabb<Scalar>& before = others[other % others.size()].box;
        const Vector3<Scalar> sizes = box.sizes();
        box = before;
        const Scalar border = before.max()[axis];
        const Scalar away = std::numeric_limits<Scalar>::infinity();
        box.min()[axis] = step == 0   ? border
                          : step == 1 ? std::nextafter(border, away)
                                      : std::nextafter(border, -away);
        box.max()[axis] = box.min()[axis] + sizes[axis];
    }

    Scalar scale_ = 1;
    Scalar origin_ = 0;
    bool isTame_ = false;
    bool isOrdered_ = false;
};

}  // namespace hashphase::test

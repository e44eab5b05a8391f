// SPDX-License-Identifier: Zlib
#pragma once

// A grid beside a list of boxes, for operations.

#include <broadphase/grid.hpp>
#include <tests/fuzz/life.hpp>
#include <tests/fuzz/palette.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace hashphase::test {

/// No more proxies than brute force looks at in no time.
inline constexpr std::size_t kMostProxies = 160;

/// A World (tests/support/script.hpp) over a grid or what stands around one, and what it should hold.
/// Knows the operations that change boxes, and leaves the others to whom it serves.
template <class Scalar, class World>
class BoxModel {
public:
    static constexpr std::uint32_t kKinds = 8;

    BoxModel(const Operation& first, World& world, OperationLog& story)
        : palette_(first), world_(world), story_(story) {}

    [[nodiscard]] const Palette<Scalar>& palette() const noexcept { return palette_; }
    [[nodiscard]] Palette<Scalar>& palette() noexcept { return palette_; }
    [[nodiscard]] std::span<const Placed<Scalar>> proxies() const noexcept { return proxies_; }
    [[nodiscard]] std::vector<Placed<Scalar>>& list() noexcept { return proxies_; }
    [[nodiscard]] const std::vector<ProxyId>& dead() const noexcept { return dead_; }

    /// An index of a proxy; there must be one.
    [[nodiscard]] std::size_t any(Arguments& arguments) const {
        return arguments.below(static_cast<std::uint32_t>(proxies_.size()));
    }

    /// An operation that changes boxes, or one of those that the server has.
    template <class Server, std::size_t count>
    void play(const Operation& operation, Server& server,
              const std::array<void (Server::*)(Arguments&), count>& own) {
        Arguments arguments(operation);
        const std::uint32_t kind = operation.kind % (kKinds + count);
        if (kind < kKinds || proxies_.empty()) {
            change(kind, arguments);
        } else {
            (server.*own[kind - kKinds])(arguments);
        }
    }

    /// Kinds 0 to kKinds - 1.
    void change(std::uint32_t kind, Arguments& arguments) {
        if (kind < 2 || proxies_.empty()) {
            const auto mobility = arguments.flag() ? Mobility::resting : Mobility::mobile;
            addOne(palette_.box(arguments, proxies_), mobility);
        } else if (kind < 4) {
            const std::size_t i = any(arguments);
            moveOne(i, palette_.box(arguments, proxies_));
        } else if (kind == 4) {
            removeOne(any(arguments));
        } else if (kind == 5) {
            addMany(arguments);
        } else if (kind == 6) {
            moveMany(arguments);
        } else {
            removeMany(arguments);
        }
    }

    void addOne(const Aabb<Scalar>& box, Mobility mobility) {
        if (proxies_.size() >= kMostProxies) {
            story_.tell("nothing: there are enough");
            return;
        }
        Placed<Scalar> proxy;
        proxy.box = box;
        proxy.id = world_.add(box, mobility);
        story_.tell("add ", proxy.id.index, mobility == Mobility::resting ? " at rest " : " ", box);
        proxies_.push_back(proxy);
    }
    void moveOne(std::size_t i, const Aabb<Scalar>& box) {
        story_.tell("move ", proxies_[i].id.index, " to ", box, ' ');
        proxies_[i].box = box;
        world_.move(proxies_[i].id, box);
    }
    void removeOne(std::size_t i) {
        story_.tell("remove ", proxies_[i].id.index, ' ');
        world_.remove(proxies_[i].id);
        dead_.push_back(proxies_[i].id);
        proxies_[i] = proxies_.back();
        proxies_.pop_back();
    }

    void clear() {
        story_.tell("clear");
        world_.clear();
        for (const Placed<Scalar>& proxy : proxies_) {
            dead_.push_back(proxy.id);
        }
        proxies_.clear();
    }

private:
    // A few dozen boxes of one size on a lattice, of which neighbours touch.
    void addMany(Arguments& arguments) {
        const std::uint32_t count = 1 + arguments.below(80);
        const auto mobility = arguments.flag() ? Mobility::resting : Mobility::mobile;
        const std::uint8_t step = arguments.byte();
        const Vector3<Scalar> corner = palette_.point(arguments);
        const Scalar size = palette_.extent(arguments.byte());
        for (std::uint32_t i = 0; i < count && proxies_.size() < kMostProxies; ++i) {
            Vector3<Scalar> min = corner;
            const std::array<std::uint32_t, 3> cell{i % 5, i / 5 % 5, i / 25};
            for (int axis = 0; axis < 3; ++axis) {
                min[axis] += palette_.extent(step) *
                             static_cast<Scalar>(cell[static_cast<std::size_t>(axis)]);
            }
            addOne({min, min + Vector3<Scalar>::Constant(size)}, mobility);
            story_.tell("; ");
        }
    }

    void moveMany(Arguments& arguments) {
        const std::uint32_t each = 1 + arguments.below(4);
        const int axis = static_cast<int>(arguments.below(3));
        const Scalar step = palette_.extent(arguments.byte());
        const Scalar by = arguments.flag() ? -step : step;
        story_.tell("move each ", each, "th by ", by, " along ", axis, ": ");
        for (std::size_t i = 0; i < proxies_.size(); i += each) {
            Aabb<Scalar> box = proxies_[i].box;
            box.min()[axis] += by;
            box.max()[axis] += by;
            proxies_[i].box = box;
            world_.move(proxies_[i].id, box);
        }
    }

    void removeMany(Arguments& arguments) {
        const std::size_t left = arguments.below(16);
        while (proxies_.size() > left) {
            removeOne(arguments.byte() % proxies_.size());
        }
    }

    Palette<Scalar> palette_;
    World& world_;
    OperationLog& story_;
    std::vector<Placed<Scalar>> proxies_;
    std::vector<ProxyId> dead_;
};

/// A ParallelFor: one thread, or two that take turns in no order.
[[nodiscard]] inline auto anyFor(Arguments& arguments) {
    const bool isThreaded = arguments.byte() % 8 == 7;
    return [isThreaded, threaded = ThreadedFor(2, 7)](std::size_t count, std::size_t grain,
                                                      LoopBody body) mutable {
        if (isThreaded) {
            threaded(count, grain, body);
        } else {
            serialFor(count, grain, body);
        }
    };
}

/// The grid has these proxies, and no others, where they are.
template <class Scalar>
void expectHolds(const Grid<Scalar>& grid, std::span<const Placed<Scalar>> proxies,
                 std::span<const ProxyId> dead) {
    EXPECT_EQ(grid.validate(), "");
    EXPECT_EQ(grid.size(), proxies.size());
    std::size_t nanCount = 0;
    for (const Placed<Scalar>& proxy : proxies) {
        ASSERT_TRUE(grid.contains(proxy.id));
        ASSERT_TRUE(isSameBits(grid.box(proxy.id), proxy.box));
        nanCount += hasNan(proxy.box) ? 1 : 0;
    }
    EXPECT_EQ(grid.nanCount(), nanCount);
    for (const ProxyId id : dead) {
        ASSERT_FALSE(grid.contains(id)) << "an id is never valid again";
    }
    std::size_t count = 0;
    std::uint32_t next = 0;
    grid.forEach([&](ProxyId id, const Aabb<Scalar>&) {
        EXPECT_GE(id.index, next) << "in the order of indices";
        next = id.index + 1;
        ++count;
    });
    EXPECT_EQ(count, proxies.size());
}

}  // namespace hashphase::test

// SPDX-License-Identifier: Zlib
#pragma once

// A scene as it is filmed for golden.txt: numbered objects that move, sweep, leave and come back, and the
// pairs of each frame.

#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/golden/golden_results.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/threaded_for.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace hashphase::test {

/// Fowler, Noll, Vo, 64 bits, over what numbers are made of, the lowest byte first; both zeros count as one.
class GoldenHash {
public:
    template <class Number>
    void add(Number number) {
        ++count_;
        if constexpr (std::is_floating_point_v<Number>) {
            number += Number(0);
        }
        using Bits = std::conditional_t<sizeof(Number) == 8, std::uint64_t, std::uint32_t>;
        const auto bits = std::bit_cast<Bits>(number);
        for (unsigned shift = 0; shift < 8 * sizeof(Number); shift += 8) {
            hash_ = (hash_ ^ ((bits >> shift) & 0xff)) * 0x100000001b3U;
        }
    }
    /// Where counts have 32 bits as well as where they have 64.
    void addCount(std::size_t count) { add(std::uint64_t{count}); }
    template <class Number>
    void addAll(const std::vector<Number>& numbers) {
        for (const Number& number : numbers) {
            add(number);
        }
        addCount(numbers.size());
    }
    template <class A, class B>
    void addAll(const std::vector<std::pair<A, B>>& pairs) {
        for (const auto& [a, b] : pairs) {
            add(a);
            add(b);
        }
        addCount(pairs.size());
    }
    [[nodiscard]] GoldenLine line(std::string name) const {
        return {std::move(name), hash_, count_};
    }

private:
    std::uint64_t hash_ = 0xcbf29ce484222325U;
    std::uint64_t count_ = 0;
};

template <class Scalar>
class GoldenWorld {
public:
    using Box = Aabb<Scalar>;
    using Number = std::uint32_t;

    GoldenWorld(const BoxScene<Scalar>& scene, const GoldenRun& run)
        : scene_(scene), order_(scene.count), threads_(run.threadCount, kSeed), run_(run) {
        std::iota(order_.begin(), order_.end(), Number{0});
        if (run.insertionSeed != 0) {
            Random shuffler(run.insertionSeed);
            for (std::size_t i = order_.size(); i > 1; --i) {
                std::swap(order_[i - 1], order_[shuffler.below(static_cast<std::uint32_t>(i))]);
            }
        }
        for (Number number = 0; number < scene.count; ++number) {
            boxes_.push_back(scene.draw(random_));
        }
        ids_.resize(boxes_.size());
        for (const Number number : order_) {
            add(number);
        }
    }

    /// Moves most of the mobile, lets some leave and some come back; what has the last digit 0 sweeps.
    void nextFrame() {
        std::vector<Change> changes(boxes_.size());
        for (Number number = 0; number < boxes_.size(); ++number) {
            changes[number] = drawChange(number);
        }
        for (const Number number : order_) {
            apply(number, changes[number]);
        }
        if (run_.threadCount > 1) {
            update(threads_);
        } else {
            update(serialFor);
        }
    }

    /// Of the last frame, by the objects' numbers, sorted.
    [[nodiscard]] const std::vector<std::pair<Number, Number>>& born() const { return born_; }
    [[nodiscard]] const std::vector<std::pair<Number, Number>>& died() const { return died_; }

    [[nodiscard]] Number numberOf(ProxyId id) const { return numbers_.at(id); }
    [[nodiscard]] std::pair<Number, Number> numbersOf(const ProxyPair& pair) const {
        return std::minmax({numberOf(pair.first), numberOf(pair.second)});
    }
    [[nodiscard]] const Box& box(Number number) const { return boxes_[number]; }
    [[nodiscard]] Number count() const { return static_cast<Number>(boxes_.size()); }
    [[nodiscard]] const Grid<Scalar>& grid() const { return grid_; }
    [[nodiscard]] const Sweeps<Scalar>& sweeps() const { return sweeps_; }
    [[nodiscard]] ParallelFor parallelFor() {
        return run_.threadCount > 1 ? ParallelFor(threads_) : ParallelFor(serialFor);
    }

private:
    static constexpr std::uint64_t kSeed = 0x90'1d'e4;

    struct Change {
        std::optional<Box> moves;
        bool leavesOrComes = false;
    };

    Change drawChange(Number number) {
        Change change;
        const bool isMobile = number < scene_.mobileShare * static_cast<double>(boxes_.size());
        if (isMobile && random_.chance(0.7)) {
            change.moves = scene_.nudge(random_, boxes_[number]);
        }
        change.leavesOrComes = random_.chance(0.04);
        return change;
    }

    void add(Number number) {
        ids_[number] = grid_.add(boxes_[number]);
        numbers_[ids_[number]] = number;
    }

    void apply(Number number, const Change& change) {
        const Box before = boxes_[number];
        boxes_[number] = change.moves.value_or(before);
        if (change.leavesOrComes && !ids_[number].isNull()) {
            grid_.remove(ids_[number]);
            ids_[number] = {};
        } else if (change.leavesOrComes) {
            add(number);
        } else if (!ids_[number].isNull()) {
            grid_.move(ids_[number], boxes_[number]);
            if (number % 10 == 0) {
                const Vector3<Scalar> way = 4 * (boxes_[number].min() - before.min());
                sweeps_.set(ids_[number], way.allFinite() ? way : Vector3<Scalar>::Zero());
            }
        }
    }

    void update(ParallelFor parallelFor) {
        const auto accepts = [this](ProxyId a, ProxyId b) {
            return (numberOf(a) + numberOf(b)) % 11 != 0;
        };
        const PairChanges changes = pairs_.update(accepts, parallelFor);
        take(changes.born, born_);
        take(changes.died, died_);
    }

    void take(std::span<const ProxyPair> pairs,
              std::vector<std::pair<Number, Number>>& sorted) const {
        sorted.clear();
        for (const ProxyPair& pair : pairs) {
            sorted.push_back(numbersOf(pair));
        }
        std::sort(sorted.begin(), sorted.end());
    }

    const BoxScene<Scalar>& scene_;
    Random random_{kSeed};
    Grid<Scalar> grid_;
    Sweeps<Scalar> sweeps_{grid_};
    Pairs<Scalar> pairs_{grid_, &sweeps_};
    std::vector<Box> boxes_;    // by number
    std::vector<ProxyId> ids_;  // by number; null of who has left
    std::map<ProxyId, Number> numbers_;
    std::vector<Number> order_;
    std::vector<std::pair<Number, Number>> born_;
    std::vector<std::pair<Number, Number>> died_;
    ThreadedFor threads_;
    GoldenRun run_;
};

}  // namespace hashphase::test

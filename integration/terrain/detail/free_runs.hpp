// SPDX-License-Identifier: Zlib
#pragma once

// Which numbers below an end are free, as runs: so that numbers that were given back are taken again, the
// lowest run first that is long enough.

#include <broadphase/core/ensure_capacity.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

/// Free numbers, in ascending runs that do not touch each other. Cost of each function: O(runs).
class FreeRuns {
public:
    /// Makes room for a run, which free() takes.
    void reserveOne() { ensureCapacity(runs_, runs_.size() + 1); }

    /// The first of `count` numbers that are free side by side, the lowest there is. All from `end` on are
    /// free, too, and go on a run that ends there.
    [[nodiscard]] std::uint32_t firstFit(std::size_t count, std::uint32_t end) const noexcept {
        const auto fits = [=](const Run& run) { return run.count >= count || run.end() == end; };
        const auto run = std::find_if(runs_.begin(), runs_.end(), fits);
        return run == runs_.end() ? end : run->first;
    }

    /// Takes what firstFit() has named.
    void take(std::uint32_t first, std::uint32_t count) noexcept {
        const auto run = behind(first);
        if (run == runs_.end() || run->first != first) {
            return;
        }
        const std::uint32_t taken = std::min(count, run->count);
        *run = {run->first + taken, run->count - taken};
        if (run->count == 0) {
            runs_.erase(run);
        }
    }

    /// Gives back numbers, none of which is free.
    void free(std::uint32_t first, std::uint32_t count) noexcept {
        if (count == 0) {
            return;
        }
        const auto next = behind(first);
        const bool joinsNext = next != runs_.end() && next->first == first + count;
        if (next != runs_.begin() && (next - 1)->end() == first) {
            (next - 1)->count += count + (joinsNext ? next->count : 0);
            if (joinsNext) {
                runs_.erase(next);
            }
        } else if (joinsNext) {
            *next = {first, count + next->count};
        } else {
            runs_.insert(next, {first, count});
        }
    }

    /// Whether one of these numbers is free.
    [[nodiscard]] bool hasAny(std::uint32_t first, std::uint32_t count) const noexcept {
        const auto next = std::lower_bound(runs_.begin(), runs_.end(), first, isBefore);
        return (next != runs_.end() && next->first - first < count) ||
               (next != runs_.begin() && (next - 1)->end() > first && count > 0);
    }

    void clear() noexcept { runs_.clear(); }
    [[nodiscard]] std::size_t size() const noexcept { return runs_.size(); }
    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return runs_.capacity() * sizeof(Run);
    }

private:
    struct Run {
        std::uint32_t first;
        std::uint32_t count;
        [[nodiscard]] std::uint32_t end() const noexcept { return first + count; }
    };

    static bool isBefore(const Run& run, std::uint32_t number) noexcept {
        return run.first < number;
    }
    /// The first run that does not begin before the number.
    [[nodiscard]] std::vector<Run>::iterator behind(std::uint32_t number) noexcept {
        return std::lower_bound(runs_.begin(), runs_.end(), number, isBefore);
    }

    std::vector<Run> runs_;
};

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>

// SPDX-License-Identifier: Zlib
#pragma once

// A ParallelFor for tests: as many threads as asked for, ranges of uneven lengths, dealt out in an
// order that means nothing. What the loop's body throws, or the want of a thread, ends it as it would a plain loop:
// when all threads are done.

#include <broadphase/parallel_for.hpp>
#include <demos/stability/run_together.hpp>
#include <tests/support/random.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <utility>
#include <vector>

namespace hashphase::test {

class ThreadedFor {
public:
    explicit ThreadedFor(std::size_t threadCount, std::uint64_t seed)
        : threadCount_(threadCount), random_(seed) {}

    void operator()(std::size_t count, std::size_t grain, LoopBody body) {
        std::vector<std::pair<std::size_t, std::size_t>> ranges;
        for (std::size_t begin = 0; begin < count;) {
            const std::size_t end = std::min(count, begin + grain * (1 + random_.below(3)));
            ranges.emplace_back(begin, end);
            begin = end;
        }
        for (std::size_t i = ranges.size(); i > 1; --i) {
            std::swap(ranges[i - 1], ranges[random_.below(static_cast<std::uint32_t>(i))]);
        }
        std::vector<std::exception_ptr> thrown(std::min(threadCount_, ranges.size()));
        mostRanges_ = std::max(mostRanges_, ranges.size());
        demos::runTogether(thrown.size(), [&](std::size_t t) {
            try {
                for (std::size_t i = t; i < ranges.size(); i += threadCount_) {
                    body(ranges[i].first, ranges[i].second);
                }
            } catch (...) {
                thrown[t] = std::current_exception();
            }
        });
        for (const std::exception_ptr& each : thrown) {
            if (each != nullptr) {
                std::rethrow_exception(each);
            }
        }
    }

    /// In how many ranges the longest loop so far was cut.
    [[nodiscard]] std::size_t mostRanges() const noexcept { return mostRanges_; }

private:
    std::size_t threadCount_;
    Random random_;
    std::size_t mostRanges_ = 0;
};

}  // namespace hashphase::test

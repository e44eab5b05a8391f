// SPDX-License-Identifier: Zlib
#pragma once

// A ParallelFor for tests: as many threads as asked for, ranges of uneven lengths, dealt out in an
// order that means nothing.

#include <broadphase/parallel_for.hpp>
#include <tests/support/random.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <thread>
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
        std::vector<std::thread> threads;
        for (std::size_t t = 0; t < std::min(threadCount_, ranges.size()); ++t) {
            threads.emplace_back([&, t] {
                for (std::size_t i = t; i < ranges.size(); i += threadCount_) {
                    body(ranges[i].first, ranges[i].second);
                }
            });
        }
        mostRanges_ = std::max(mostRanges_, ranges.size());
        for (std::thread& thread : threads) {
            thread.join();
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

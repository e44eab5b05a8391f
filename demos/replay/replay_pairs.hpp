// SPDX-License-Identifier: Zlib
#pragma once

// The pairs of many frames in a few bytes each change, as a page can hold and JavaScript can read them.
//
// Stream   for each frame, in groups of seven bits (replay_bytes.hpp): how many pairs of the frame
//          before are gone; of each, how many that stay lie between it and the one that went before;
//          how many are new; of each, in order, how much larger its smaller place is than that of the
//          one before (at first than 0), and how much larger its larger place is than the larger one
//          before if the smaller ones are the same, else than its own smaller one.
// Limit    of a frame with too many pairs none is listed; they are counted all the same.

#include <demos/scenes/pair_key.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::demos {

class ReplayPairs {
public:
    /// Lists at most so many pairs in a frame.
    explicit ReplayPairs(std::size_t most) : most_(most) {}

    /// Adds a frame: its pairs, sorted, each of them once.
    void add(std::span<const PairKey> pairs);

    /// Takes back the frame that was added last; after that, none can be added.
    void removeLast();

    /// How many pairs each frame has, and how many of them are listed: all or none.
    [[nodiscard]] const std::vector<std::size_t>& counts() const noexcept { return counts_; }
    [[nodiscard]] const std::vector<std::size_t>& listedCounts() const noexcept {
        return listedCounts_;
    }
    [[nodiscard]] const std::vector<std::uint8_t>& stream() const noexcept { return stream_; }

private:
    void writeDeaths(std::span<const PairKey> pairs);
    void writeBirths();

    std::size_t most_;
    std::vector<PairKey> listed_;  // of the last frame
    std::vector<PairKey> births_;
    std::vector<std::size_t> counts_;
    std::vector<std::size_t> listedCounts_;
    std::vector<std::uint8_t> stream_;
    std::size_t lastBegin_ = 0;  // in the stream, of the frame that was added last
};

}  // namespace hashphase::demos

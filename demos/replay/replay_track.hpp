// SPDX-License-Identifier: Zlib
#pragma once

// The boxes and the pairs of many frames in a few bytes each change, as a page can hold and JavaScript can
// read them. Both streams are of bytes and of numbers in groups of seven bits, the lowest first, of which all
// but the last have bit 7 set: small numbers take one byte.
//
// Of boxes
//
// Numbers  seven of 16 bits for an object in a frame: its centre and its edges along x, y, z, in steps
//          of a 65535th of the bounds along that axis, and how many others it overlaps with.
// Error    half a step in the centre, half a step in the edge. What leaves the bounds is cut off there;
//          a box with a NaN has no size.
// Stream   for the objects of a frame in order, a byte that tells which of the seven (bits 0 to 6)
//          differ from the frame before (from 0 in the first); then those differences, modulo 2^16 as
//          signed numbers, zigzag. After a byte of 0 comes how many more objects in a row have no differences.
//
// Of pairs
//
// Stream   for each frame: how many pairs of the frame before are gone; of each, how many that stay lie between
//          it and the one that went before; how many are new; of each, in order, how much larger its smaller
//          place is than that of the one before (at first than 0), and how much larger its larger place is than
//          the larger one before if the smaller ones are the same, else than its own smaller one.
// Limit    of a frame with too many pairs none is listed; they are counted all the same.

#include <demos/scenes/pair_key.hpp>

#include <broadphase/aabb.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::demos {

class ReplayTrack {
public:
    /// Records those objects, by their numbers, and lists at most so many pairs in a frame.
    ReplayTrack(const Aabb<float>& bounds, std::vector<std::uint32_t> objects,
                std::size_t mostPairs);

    /// Adds a frame: the boxes and the overlapping pairs of all objects; and those of recorded objects, as
    /// places among these. Pairs are sorted, each of them once.
    void add(std::span<const Aabb<float>> boxes, std::span<const PairKey> pairs,
             std::span<const PairKey> recordedPairs);

    /// Takes back the frame that was added last; after that, none can be added.
    void removeLast();

    std::vector<std::uint8_t> boxStream;
    std::vector<std::uint8_t> pairStream;
    std::vector<std::uint8_t>
        isCut;  // of each object, whether it ever left the bounds, or had a NaN: 1, else 0
    // Of each frame: pairs of all objects; of recorded ones; and how many of these are listed, all or none.
    std::vector<std::size_t> pairsInAll;
    std::vector<std::size_t> pairCounts;
    std::vector<std::size_t> pairsListed;

private:
    /// The seven numbers of an object in a frame.
    using Sample = std::array<std::uint16_t, 7>;

    [[nodiscard]] Sample sampleOf(const Aabb<float>& box, std::uint32_t overlaps) const;
    void addBoxes(std::span<const Aabb<float>> boxes, std::span<const PairKey> pairs);
    void addPairs(std::span<const PairKey> pairs);
    void endRun();

    Aabb<float> bounds_;
    std::vector<std::uint32_t> objects_;
    std::size_t mostPairs_;
    std::vector<Sample> last_;
    std::vector<std::uint32_t> overlaps_;  // of all objects
    std::vector<PairKey> listed_;          // in the last frame
    // In the streams, of the frame that was added last.
    std::size_t boxesBegin_ = 0;
    std::size_t pairsBegin_ = 0;
    std::uint32_t unchanged_ = 0;  // objects in a row, not yet in the stream
};

}  // namespace hashphase::demos

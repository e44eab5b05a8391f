// SPDX-License-Identifier: Zlib

// The kernels, for one instruction set. Included, after <broadphase/simd/kernel_types.hpp>, by the
// file that is compiled for it, inside a namespace of its own, which has:
//
//   Pack<Scalar>       numbers side by side in a register
//     kWidth           how many; up to eight
//     Numbers          the register
//     load(from)       the numbers from there on, of any alignment
//     store(to, numbers)  writes them there
//     broadcast(x)     the same number everywhere
//     lessEqual(a, b)   where a <= b, which NaN is not; of a type that ...
//     bitAnd(hits, hits) ... and
//     bits(hits)       ... take: bit k tells about number k
//     minus, plus, times(a, b), abs(a)
//     least, greatest(a, b)  b where one is NaN
//     compress(mask, numbers, to)  where it is there, writes numbers[k] to `to` for every bit k of the
//                      mask, which has kWidth, and may write so many; reads no others
//   WidePack<Scalar>   the same for long runs, perhaps wider
//   isApart(a, b)      1 where two padded boxes do not overlap, else 0
//   padCorners(corners, box)  makes `box` of six numbers, the min corner first
//   fitsEdge(level, box)  whether no edge of the padded box is longer than the level's largest
//   quantiseCorners(level, box, low)  sets `low` to the cell of the box's min corner and returns
//                      whether the box spans one or two cells an axis, none of them clamped
//   bitCount(word)     how many of 64 bits are set
//   equalBytes(bytes, value)  bit k tells whether byte k of 64 has the value
//   writeHits(word, numbers, next)  writes numbers[k] for each bit k of 64 that is set, and perhaps
//                      up to 16 more; returns the end
//
// Nothing in these files may call a function that is not defined in them or always inlined.

inline std::uint32_t lowest(std::uint32_t a, std::uint32_t b) {
    return a < b ? a : b;
}

inline std::uint32_t highest(std::uint32_t a, std::uint32_t b) {
    return a < b ? b : a;
}

/// The lowest `count` of `width` bits.
inline std::uint32_t laneMask(std::uint32_t count, std::uint32_t width) {
    return (1U << lowest(count, width)) - 1;
}

/// Entries to be read, from first to last, one past.
struct Run {
    std::uint32_t first;
    std::uint32_t last;
};

#include <broadphase/simd/kernel_box.inl>

#include <broadphase/simd/kernel_rows.inl>

#include <broadphase/simd/kernel_file.inl>
#include <broadphase/simd/kernel_join.inl>
#include <broadphase/simd/kernel_radius.inl>
#include <broadphase/simd/kernel_ray.inl>
#include <broadphase/simd/kernel_volume.inl>
#include <broadphase/simd/kernel_walk.inl>

#include <broadphase/simd/kernel_together.inl>

template <class Scalar>
void findRange(const Scalar* column, std::uint32_t first, std::uint32_t last, Scalar* least,
               Scalar* greatest) {
    using Lanes = WidePack<Scalar>;
    constexpr std::uint32_t width = Lanes::kWidth;
    auto low = Lanes::broadcast(column[first]);
    auto high = low;
    for (; first + width <= last; first += width) {
        const auto numbers = Lanes::load(column + first);
        low = Lanes::least(numbers, low);
        high = Lanes::greatest(numbers, high);
    }
    Scalar lows[width];
    Scalar highs[width];
    Lanes::store(lows, low);
    Lanes::store(highs, high);
    *least = lows[0];
    *greatest = highs[0];
    for (std::uint32_t k = 1; k < width; ++k) {
        *least = lows[k] < *least ? lows[k] : *least;
        *greatest = highs[k] > *greatest ? highs[k] : *greatest;
    }
    for (; first < last; ++first) {
        *least = column[first] < *least ? column[first] : *least;
        *greatest = column[first] > *greatest ? column[first] : *greatest;
    }
}

template <class Scalar>
std::size_t selectApart(const IndexPair* pairs, std::size_t count, const std::uint32_t* order,
                        const PaddedBox<Scalar>* boxes, IndexPair* apart) {
    constexpr std::size_t kWordBits = 64;
    const IndexPair* const begin = apart;
    for (std::size_t first = 0; first < count; first += kWordBits) {
        const std::size_t left = count - first;
        const std::size_t last = first + (left < kWordBits ? left : kWordBits);
        std::uint64_t word = 0;
        for (std::size_t i = first; i < last; ++i) {
            const IndexPair pair = pairs[i];
            const std::uint32_t a = order != nullptr ? order[pair.a] : pair.a;
            const std::uint32_t b = order != nullptr ? order[pair.b] : pair.b;
            word |= std::uint64_t{isApart(boxes[a], boxes[b])} << (i - first);
        }
        for (; word != 0; word &= word - 1) {
            *apart++ = pairs[first + lowestBit(word)];
        }
    }
    return static_cast<std::size_t>(apart - begin);
}

// What is NaN overlaps nothing.
template <class Scalar>
std::size_t selectTurned(const IndexPair* pairs, const std::uint8_t* overlapped,
                         std::uint32_t first, std::uint32_t last, const Scalar* const* columns,
                         std::uint32_t* turned) {
    std::size_t selected = 0;
    for (std::uint32_t i = first; i < last; ++i) {
        const auto [a, b] = pairs[i];
        bool overlap = true;
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            overlap &= columns[axis][a] <= columns[axis + 3][b];
            overlap &= columns[axis][b] <= columns[axis + 3][a];
        }
        turned[selected] = i;
        selected += (overlap ? 1 : 0) != overlapped[i] ? 1 : 0;
    }
    return selected;
}

template <class Scalar>
void overlapRows(const Scalar* corners, std::size_t stride, const std::uint32_t* indices,
                 std::size_t count, PaddedBox<Scalar>* boxes, std::uint32_t* rows) {
    for (std::size_t i = 0; i < count; ++i) {
        padCorners(corners + stride * indices[i], boxes[i]);
        std::uint32_t row = 0;
        for (std::size_t k = i; k > 0;) {
            --k;
            row = 2 * row + (isApart(boxes[i], boxes[k]) ? 0 : 1);
        }
        rows[i] = row;
    }
}

template <class Scalar>
constexpr Kernels<Scalar> kKernels{&fileBoxes<Scalar>,
                                   &joinLevel<Scalar>,
                                   &queryLevel<Scalar>,
                                   &querySwept<Scalar>,
                                   &queryRay<Scalar>,
                                   &queryBatch<Scalar>,
                                   &walkVolume<Scalar>,
                                   &walkRay,
                                   &mayMeet,
                                   &joinList<Scalar>,
                                   &findRange<Scalar>,
                                   &selectApart<Scalar>,
                                   &overlapRows<Scalar>,
                                   &selectTurned<Scalar>,
                                   &countWithin<Scalar>,
                                   &countGroupsWithin<Scalar>,
                                   &listWithin<Scalar>};

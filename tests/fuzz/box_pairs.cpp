// SPDX-License-Identifier: Zlib
//
// box-pairs [pairs [seed]]: random pairs of boxes, a thousand million unless told otherwise, of
// which pairs must hold exactly those that overlap.
//
// Boxes come in batches of a thousand or so, each with cells, sizes and a place of its own: from
// denormal to the largest numbers, most of them on the borders of cells or one step beside them. Each
// batch lives for two updates, between which a third of the boxes move; some rest. In each update
// every pair is judged: once by coordinates in columns, which the compiler makes vectors of, once by
// what Pairs::collect() lists. Prints what was judged and how long it took; exit status 1 at the first
// pair that is missing or too many.

#include <broadphase/pairs.hpp>
#include <tests/support/box_scenes.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string_view>
#include <vector>

namespace hashphase::test {
namespace {

struct Tally {
    std::uint64_t pairs = 0;
    std::uint64_t overlapping = 0;
    std::uint64_t batches = 0;
    bool isExact = true;
};

/// What the boxes of a batch have in common.
struct Batch {
    std::uint32_t count = 0;
    GridConfig config;
    double cell = 1;      // [m]; boxes begin at multiples of it
    double middle = 0;    // of the batch, on every axis [m]
    double spread = 1;    // cells from the middle, at most
    double smallest = 1;  // edges [m], each order of magnitude as likely
    double largest = 1;   // [m]
    double hostileShare = 0;
    double restingShare = 0;
};

template <class Scalar>
Batch drawBatch(Random& random) {
    using Limits = std::numeric_limits<Scalar>;
    constexpr double kDenormal = 1000 * static_cast<double>(Limits::denorm_min());
    const std::array<double, 12> cells{
        1,    1,   0.1,  0.7,       1e-3,  1e4,
        1e-6, 1e6, 1e18, kDenormal, 1e-30, static_cast<double>(Limits::max()) / 256};
    Batch batch;
    batch.count = 600 + random.below(1200);
    batch.cell = cells[random.below(cells.size())];
    const bool isOwnCell = random.chance(0.3) && batch.cell >= 1e-30 && batch.cell <= 1e30;
    batch.config.cellSize = isOwnCell             ? batch.cell
                            : random.chance(0.15) ? random.logBetween(1e-30, 1e30)
                                                  : 0;
    batch.config.levelRatio = random.chance(0.5) ? 4 : 2 + random.below(20);
    batch.config.updatesBeforeRest = 1;
    // Near the origin, some cells away, or where numbers are about as far apart as cells are wide.
    const double farthest = static_cast<double>(Limits::max()) / 8;
    const double away = random.chance(0.4) ? 0
                        : random.chance(0.6)
                            ? random.between(-1e4, 1e4)
                            : random.logBetween(1e-3, 1) / static_cast<double>(Limits::epsilon());
    batch.middle = std::clamp(batch.cell * away, -farthest, farthest);
    batch.spread = random.between(2, 30);
    const bool allSizes = random.chance(0.25);
    batch.smallest = batch.cell * (allSizes ? 1e-6 : random.logBetween(1e-3, 1));
    batch.largest =
        allSizes ? std::min(batch.cell * 1e6, farthest) : batch.smallest * random.logBetween(1, 30);
    batch.hostileShare = random.chance(0.2) ? random.between(0, 0.3) : 0;
    batch.restingShare = random.chance(0.5) ? random.unit() : 0;
    return batch;
}

template <class Scalar>
Aabb<Scalar> drawBox(Random& random, const Batch& batch) {
    using Limits = std::numeric_limits<Scalar>;
    if (random.chance(batch.hostileShare)) {
        return hostileBox<Scalar>(random);
    }
    const auto flushTiny = [&](double value) {
        auto border = static_cast<Scalar>(value);
        const double step = random.unit();
        return step < 0.4   ? border
               : step < 0.6 ? std::nextafter(border, Limits::infinity())
               : step < 0.8 ? std::nextafter(border, -Limits::infinity())
                            : static_cast<Scalar>(value + batch.cell * random.unit());
    };
    const bool isCube = random.chance(0.5);
    const double edge = random.logBetween(batch.smallest, batch.largest);
    Aabb<Scalar> box;
    for (int axis = 0; axis < 3; ++axis) {
        const double lattice = std::floor(random.between(-batch.spread, batch.spread));
        box.min()[axis] = flushTiny(batch.middle + lattice * batch.cell);
        const double size = isCube               ? edge
                            : random.chance(0.1) ? 0
                                                 : random.logBetween(batch.smallest, batch.largest);
        // Ends on a border as often as not.
        const double cells = std::floor(size / batch.cell);
        const double low = static_cast<double>(box.min()[axis]);
        box.max()[axis] = random.chance(0.5) && cells < 1e6
                              ? flushTiny(batch.middle + (lattice + cells) * batch.cell)
                              : static_cast<Scalar>(low + size);
        box.max()[axis] = std::max(box.max()[axis], box.min()[axis]);
    }
    return box;
}

/// Coordinates by axis, for one box against all that follow it.
template <class Scalar>
class Columns {
public:
    explicit Columns(const std::vector<Aabb<Scalar>>& boxes) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const Aabb<Scalar>& box : boxes) {
                low_[static_cast<std::size_t>(axis)].push_back(box.min()[axis]);
                high_[static_cast<std::size_t>(axis)].push_back(box.max()[axis]);
            }
        }
    }

    /// Sets overlapping[k] to 1 where box k, behind box i, overlaps it, else to 0.
    void judge(std::size_t i, std::vector<std::uint8_t>& overlapping) const {
        const std::size_t count = overlapping.size();
        std::fill(overlapping.begin(), overlapping.end(), std::uint8_t{1});
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Scalar* const lows = low_[axis].data();
            const Scalar* const highs = high_[axis].data();
            const Scalar low = lows[i];
            const Scalar high = highs[i];
            for (std::size_t k = i + 1; k < count; ++k) {
                const int isTouched =
                    static_cast<int>(low <= highs[k]) & static_cast<int>(lows[k] <= high);
                overlapping[k] = static_cast<std::uint8_t>(overlapping[k] & isTouched);
            }
        }
    }

private:
    std::array<std::vector<Scalar>, 3> low_;
    std::array<std::vector<Scalar>, 3> high_;
};

template <class Scalar>
void report(const Batch& batch, const Aabb<Scalar>& a, const Aabb<Scalar>& b, bool isMissing) {
    std::printf("%s (%d bytes a number, cells of %g, configured %g, ratio %g):\n",
                isMissing ? "MISSING" : "TOO MANY", static_cast<int>(sizeof(Scalar)), batch.cell,
                batch.config.cellSize, batch.config.levelRatio);
    for (const Aabb<Scalar>& box : {a, b}) {
        for (const auto& corner : {box.min(), box.max()}) {
            std::printf("  %a %a %a\n", static_cast<double>(corner[0]),
                        static_cast<double>(corner[1]), static_cast<double>(corner[2]));
        }
    }
}

/// Compares the pairs, which must name slots in the order of the boxes.
template <class Scalar>
void judge(const Batch& batch, const std::vector<Aabb<Scalar>>& boxes, const Pairs<Scalar>& pairs,
           Tally& tally) {
    std::vector<ProxyPair> listed;
    pairs.collect(listed);
    tally.isExact = tally.isExact && pairs.count() == listed.size();
    const Columns<Scalar> columns(boxes);
    std::vector<std::uint8_t> expected(boxes.size());
    std::vector<std::uint8_t> found(boxes.size());
    auto next = listed.begin();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        columns.judge(i, expected);
        std::fill(found.begin(), found.end(), std::uint8_t{0});
        for (; next != listed.end() && next->first.index == i; ++next) {
            ++found[next->second.index];
            ++tally.overlapping;
        }
        const std::size_t behind = i + 1;
        tally.pairs += boxes.size() - behind;
        for (std::size_t k = behind;
             k < boxes.size() && std::memcmp(expected.data() + behind, found.data() + behind,
                                             boxes.size() - behind) != 0;
             ++k) {
            if (expected[k] != found[k]) {
                report(batch, boxes[i], boxes[k], found[k] == 0);
                tally.isExact = false;
                return;
            }
        }
    }
    tally.isExact = tally.isExact && next == listed.end();
}

template <class Scalar>
void playBatch(Random& random, Tally& tally) {
    const Batch batch = drawBatch<Scalar>(random);
    Grid<Scalar> grid(batch.config);
    Pairs<Scalar> pairs(grid);
    std::vector<Aabb<Scalar>> boxes;
    std::vector<ProxyId> ids;
    for (std::uint32_t i = 0; i < batch.count; ++i) {
        boxes.push_back(drawBox<Scalar>(random, batch));
        ids.push_back(grid.add(boxes.back(), random.chance(batch.restingShare) ? Mobility::resting
                                                                               : Mobility::mobile));
    }
    const auto acceptAllPairs = [](ProxyId, ProxyId) { return true; };
    pairs.update(acceptAllPairs);
    judge(batch, boxes, pairs, tally);
    const double share = random.unit() * 0.6;
    for (std::uint32_t i = 0; i < batch.count; ++i) {
        if (random.chance(share)) {
            boxes[i] = drawBox<Scalar>(random, batch);
            grid.move(ids[i], boxes[i]);
        }
    }
    pairs.update(acceptAllPairs);
    judge(batch, boxes, pairs, tally);
    ++tally.batches;
}

int run(std::uint64_t pairs, std::uint64_t seed) {
    setMessageHandler([](const char*) {});  // there are NaNs among the hostile
    const auto begin = std::chrono::steady_clock::now();
    Tally tally;
    for (std::uint64_t batch = 0; tally.pairs < pairs && tally.isExact; ++batch) {
        Random random(seed + batch);
        if (batch % 2 == 0) {
            playBatch<float>(random, tally);
        } else {
            playBatch<double>(random, tally);
        }
        if (!tally.isExact) {
            std::printf("batch %llu of seed %llu is wrong\n",
                        static_cast<unsigned long long>(batch),
                        static_cast<unsigned long long>(seed));
        }
    }
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    std::printf("%llu pairs in %llu batches, %llu overlapping, in %.1f s: %s\n",
                static_cast<unsigned long long>(tally.pairs),
                static_cast<unsigned long long>(tally.batches),
                static_cast<unsigned long long>(tally.overlapping), time.count(),
                tally.isExact ? "none missing, none too many" : "WRONG");
    return tally.isExact ? 0 : 1;
}

}  // namespace
}  // namespace hashphase::test

int main(int argc, char** argv) {
    std::array<std::uint64_t, 2> numbers{1'000'000'000, 0x5eed2c00};
    for (int i = 1; i < argc; ++i) {
        const std::string_view word(argv[i]);
        const auto at = static_cast<std::size_t>(i - 1);
        if (at >= numbers.size() ||
            std::from_chars(word.data(), word.data() + word.size(), numbers[at]).ptr !=
                word.data() + word.size()) {
            std::fputs("Usage: box-pairs [pairs [seed]]\n", stderr);
            return 2;
        }
    }
    return hashphase::test::run(numbers[0], numbers[1]);
}

// SPDX-License-Identifier: Zlib
#pragma once

// Boxes that a subject is given, and whether what it says of them is right.

#include <broadphase/diagnostics.hpp>
#include <demos/report/frame_clock.hpp>
#include <demos/scenes/random.hpp>
#include <demos/stability/exact.hpp>
#include <demos/stability/hard_case.hpp>
#include <demos/system/limits.hpp>

#include <algorithm>
#include <cstdio>
#include <initializer_list>
#include <limits>
#include <utility>

namespace hashphase::demos {

template <class Scalar>
inline constexpr Scalar kInfinity = std::numeric_limits<Scalar>::infinity();
template <class Scalar>
inline constexpr Scalar kNan = std::numeric_limits<Scalar>::quiet_NaN();
template <class Scalar>
inline constexpr auto kEpsilon = static_cast<double>(std::numeric_limits<Scalar>::epsilon());

template <class Scalar>
[[nodiscard]] Scalar below(Scalar x) {
    return std::nextafter(x, -kInfinity<Scalar>);
}
template <class Scalar>
[[nodiscard]] Scalar above(Scalar x) {
    return std::nextafter(x, kInfinity<Scalar>);
}

/// Uniform in [low, high), with all digits that the scalar has.
template <class Scalar>
[[nodiscard]] Scalar between(Random& random, Scalar low, Scalar high) {
    if constexpr (std::is_same_v<Scalar, float>) {
        return random.between(low, high);
    } else {
        const Scalar coarse = random.unit();
        return low + (high - low) * (coarse + Scalar(0x1p-24) * random.unit());
    }
}
template <class Scalar>
[[nodiscard]] Vector3<Scalar> pointIn(Random& random, Scalar low, Scalar high) {
    const Scalar x = between(random, low, high);
    const Scalar y = between(random, low, high);
    const Scalar z = between(random, low, high);
    return {x, y, z};
}
[[nodiscard]] inline std::uint32_t indexBelow(Random& random, std::uint32_t limit) {
    return std::min(static_cast<std::uint32_t>(random.unit() * static_cast<float>(limit)),
                    limit - 1);
}

template <class Scalar>
[[nodiscard]] Aabb<Scalar> makeBox(double minX, double minY, double minZ, double maxX, double maxY,
                                   double maxZ) {
    return {Vector3<double>(minX, minY, minZ).cast<Scalar>(),
            Vector3<double>(maxX, maxY, maxZ).cast<Scalar>()};
}

/// A box from its centre and its edge [m].
template <class Scalar>
[[nodiscard]] Aabb<Scalar> cubeAt(const Vector3<Scalar>& center,
                                  std::type_identity_t<Scalar> edge) {
    const Vector3<Scalar> half = Vector3<Scalar>::Constant(edge / 2);
    return {center - half, center + half};
}

/// Cubes with their centres drawn from a cube around the origin; edges and side in metres.
template <class Scalar>
[[nodiscard]] Boxes<Scalar> scatteredCubes(std::size_t count, Scalar side, Scalar smallestEdge,
                                           Scalar largestEdge, std::uint64_t seed) {
    Random random(seed);
    Boxes<Scalar> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const Vector3<Scalar> center = pointIn(random, -side / 2, side / 2);
        boxes.push_back(cubeAt(center, between(random, smallestEdge, largestEdge)));
    }
    return boxes;
}

/// 4 x 4 x 4 unit boxes, each of which touches its neighbours, as rounded.
template <class Scalar>
void addBlock(Boxes<Scalar>& boxes, const Vector3<double>& at, double cell = 1) {
    for (int i = 0; i < 64; ++i) {
        const Vector3<double> low = at + Vector3<double>(i % 4, i / 4 % 4, i / 16);
        const Vector3<double> high = (low.array() + 1).matrix();
        boxes.emplace_back(low.cast<Scalar>() * static_cast<Scalar>(cell),
                           high.cast<Scalar>() * static_cast<Scalar>(cell));
    }
}

/// What the axis sweep takes as its world: all boxes but those without end.
template <class Scalar>
[[nodiscard]] Aabb<Scalar> worldOf(std::span<const Aabb<Scalar>> boxes) {
    constexpr Scalar kWithoutEnd = 1e15F;
    Aabb<Scalar> world;
    for (const Aabb<Scalar>& box : boxes) {
        // Phrased so that NaN is left out.
        if ((box.min().array().abs() < kWithoutEnd).all() &&
            (box.max().array().abs() < kWithoutEnd).all()) {
            world.extend(box.min());
            world.extend(box.max());
        }
    }
    return world.isEmpty() ? makeBox<Scalar>(-1, -1, -1, 1, 1, 1) : world;
}

/// Counts the library's messages while it lives, and keeps them from stderr.
class CountedMessages {
public:
    CountedMessages() : before_(setMessageHandler([](const char*) { ++count_; })) { count_ = 0; }
    CountedMessages(const CountedMessages&) = delete;
    CountedMessages& operator=(const CountedMessages&) = delete;
    ~CountedMessages() { setMessageHandler(before_); }
    [[nodiscard]] static int count() noexcept { return count_; }

private:
    static inline int count_ = 0;
    MessageHandler before_;
};

/// A collector for Grid::visit(): the objects of what is found.
template <class Scalar>
struct NoteIndices {
    void add(ProxyId id, Scalar /*key*/) { found.push_back(id.index); }
    [[nodiscard]] static Scalar limit() { return kInfinity<Scalar>; }
    [[nodiscard]] Objects sorted() {
        std::sort(found.begin(), found.end());
        return found;
    }
    Objects found;
};

template <class Scalar>
class PairScene {
public:
    using Box = Aabb<Scalar>;
    using Point = Vector3<Scalar>;

    /// Creates an object for each box. `grid` is for ours; `world` for the axis sweep, of which it
    /// is worldOf(boxes) otherwise.
    PairScene(CaseRun<Scalar>& run, Boxes<Scalar> boxes, const GridConfig& grid = {},
              const std::optional<Box>& world = std::nullopt)
        : run_(run),
          boxes_(std::move(boxes)),
          subject_(run.make({world ? *world : worldOf<Scalar>(boxes_), boxes_.size(), grid})) {
        for (std::uint32_t i = 0; i < size(); ++i) {
            subject_->create(i, boxes_[i]);
        }
    }

    void move(std::uint32_t object, const Box& box) {
        boxes_[object] = box;
        subject_->move(object, box);
    }
    /// A destroyed one is in no pair.
    void destroy(std::uint32_t object) {
        boxes_[object] = {Point::Constant(kNan<Scalar>), Point::Constant(kNan<Scalar>)};
        subject_->destroy(object);
    }
    void create(std::uint32_t object, const Box& box) {
        boxes_[object] = box;
        subject_->create(object, box);
    }
    void moveAll(const Boxes<Scalar>& boxes) {
        for (std::uint32_t i = 0; i < size(); ++i) {
            move(i, boxes[i]);
        }
    }

    void findPairs() { subject_->findPairs(); }

    /// What is listed, sorted.
    [[nodiscard]] const Keys& reported() {
        subject_->listPairs(reported_);
        return reported_;
    }
    /// The pairs of boxes that touch, closed, sorted. Not counted against the time limit.
    [[nodiscard]] Keys exact() const { return touchingPairs(boxes_); }

    /// Finds the pairs and compares them with the exact ones; of ours, all invariants hold.
    void judge() {
        findPairs();
        run_.compare(reported(), exact());
        expectValid();
    }
    void expectValid() {
        const LimitPause pause;
        if (run_.isOurs) {
            run_.expect(subject_->validate().empty(), "all invariants hold");
        }
    }

    /// Of ours: a region finds the boxes that are in it by its key(), and asked together the same.
    /// None may have been destroyed.
    template <class Region>
    QueryCost judgeQuery(const Region& region) {
        if (grid() == nullptr) {
            return {};
        }
        NoteIndices<Scalar> alone;
        const QueryCost cost = grid()->visit(region, alone);
        const Objects found = alone.sorted();
        const LimitPause pause;
        run_.compare(found,
                     objectsThat(boxes_, [&](const Box& box) { return region.key(box) >= 0; }));
        NoteIndices<Scalar> together;
        grid()->visitEach(std::span(&region, 1), std::span(&together, 1));
        run_.expect(together.sorted() == found, "visitEach() finds the same boxes as visit()");
        return cost;
    }

    /// By a box, a ball, a ray and a fat ray that begin at corners of the boxes.
    void judgeQueriesAt(const Box& box, const Point& to) {
        const Box half = {box.min() - box.center(), box.max() - box.center()};
        judgeQuery(BoxRegion<Scalar>{box});
        judgeQuery(SphereRegion<Scalar>{box.min(), 2 * half.max().maxCoeff()});
        judgeQuery(RayRegion<Scalar>(box.max(), to));
        judgeQuery(RayRegion<Scalar>(box.min(), to, half));
    }

    [[nodiscard]] const Boxes<Scalar>& boxes() const noexcept { return boxes_; }
    [[nodiscard]] std::uint32_t size() const noexcept {
        return static_cast<std::uint32_t>(boxes_.size());
    }
    [[nodiscard]] Subject<Scalar>& subject() const noexcept { return *subject_; }
    [[nodiscard]] const Grid<Scalar>* grid() const { return subject_->grid(); }
    [[nodiscard]] PairCost cost() const { return subject_->cost(); }
    [[nodiscard]] Objects touching(const Box& region) const {
        Objects found = subject_->touching(region);
        std::sort(found.begin(), found.end());
        return found;
    }

private:
    CaseRun<Scalar>& run_;
    Boxes<Scalar> boxes_;
    std::unique_ptr<Subject<Scalar>> subject_;
    Keys reported_;
};

/// The pairs of some boxes, once; ours in cells of each size, of which 0 chooses one.
template <class Scalar>
void judgePairs(CaseRun<Scalar>& run, const Boxes<Scalar>& boxes,
                std::initializer_list<double> cellSizes = {0}) {
    for (const double cellSize : cellSizes) {
        PairScene<Scalar>(run, boxes, {.cellSize = cellSize}).judge();
    }
}

/// What the work takes of the processor [ms]: the shortest of `times` runs.
template <class Work>
[[nodiscard]] double shortestTime(int times, const Work& work) {
    double shortest = kInfinity<double>;
    for (int i = 0; i < times; ++i) {
        const FrameClock clock;
        work();
        shortest = std::min(shortest, clock.milliseconds());
    }
    return shortest;
}

/// A number for a note.
[[nodiscard]] inline std::string rounded(double number, int digits) {
    std::string text(32, '\0');
    text.resize(
        static_cast<std::size_t>(std::snprintf(text.data(), text.size(), "%.*f", digits, number)));
    return text;
}

}  // namespace hashphase::demos

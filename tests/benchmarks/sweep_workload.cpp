// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/sweep_workload.hpp>

#include <broadphase/grid.hpp>
#include <demos/scenes/random.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hashphase::benchmarks {
namespace {

constexpr std::size_t kPeriod = 30;  // an object sweeps whose number is a multiple of it

float cellSizeOf(const std::vector<Aabb<float>>& boxes) {
    Grid<float> grid;
    for (const Aabb<float>& box : boxes) {
        static_cast<void>(grid.add(box));
    }
    grid.update();
    return grid.cellSize();
}

// Uniform on the unit sphere.
Vector3<float> anyDirection(demos::Random& random) {
    const float height = random.between(-1, 1);
    const float angle = random.between(0, 2 * std::numbers::pi_v<float>);
    const float radius = std::sqrt(1 - height * height);
    return {radius * std::cos(angle), height, radius * std::sin(angle)};
}

}  // namespace

SweepWorkload::SweepWorkload(std::unique_ptr<demos::BoxScene> itsScene, float cells,
                             std::uint64_t seed)
    : PairWorkload(std::move(itsScene)) {
    demos::Random random(seed);
    const float length = cells * cellSizeOf(scene().boxes());
    for (std::size_t object = 0; object < objects(); object += kPeriod) {
        motions_.push_back({static_cast<std::uint32_t>(object), length * anyDirection(random)});
    }
    parts_.resize(motions_.size());
}

void SweepWorkload::beginFrame() {
    PairWorkload::beginFrame();
    ways_ = scene().boxes();
    moving_.clear();
    for (const Aabb<float>& box : ways_) {
        moving_.push_back({box});
    }
    for (std::size_t i = 0; i < motions_.size(); ++i) {
        const ObjectMotion& motion = motions_[i];
        MovingBox<float>& way = moving_[motion.object];
        way.displacement = motion.displacement;
        ways_[motion.object] = sweptBounds(way);
        Parts& parts = parts_[i];
        for (std::size_t part = 0; part < parts.size(); ++part) {
            const auto share = 1 / static_cast<double>(parts.size());
            const auto number = static_cast<double>(part);
            parts[part] = sweptBounds(way, number * share, (number + 1) * share);
        }
    }
    demos::toBulletBoxes(ways_, bulletWays_);
}

FrameBoxes SweepWorkload::frameFor(const ContestantKind& kind) const {
    FrameBoxes frame = scene().frame();
    if (kind.bullet != nullptr) {
        frame.boxes = ways_;
        frame.bulletBoxes = bulletWays_;
    } else {
        frame.motions = motions_;
    }
    return frame;
}

// `a` sweeps. Boxes around the ways, then around their parts, keep away what cannot touch.
bool SweepWorkload::touch(std::uint32_t a, std::uint32_t b) const {
    if (!overlaps(ways_[a], ways_[b])) {
        return false;
    }
    const Parts& partsOfA = parts_[a / kPeriod];
    const auto boxOfB = [&](std::size_t part) -> const Aabb<float>& {
        return b % kPeriod == 0 ? parts_[b / kPeriod][part] : ways_[b];
    };
    bool areNear = false;
    for (std::size_t part = 0; part < partsOfA.size() && !areNear; ++part) {
        areNear = overlaps(partsOfA[part], boxOfB(part));
    }
    return areNear && detail::firstContactExactly(moving_[a], moving_[b]).has_value();
}

// Who overlaps at the start, and who touches one that sweeps.
void SweepWorkload::listExactAnswers(std::vector<Answer>& answers) {
    PairWorkload::listExactAnswers(answers);
    const FrameBoxes frame = scene().frame();
    for (const ObjectMotion& motion : motions_) {
        for (std::uint32_t other = 0; other < objects(); ++other) {
            if (other != motion.object && touch(motion.object, other) &&
                frame.mayPair(motion.object, other)) {
                answers.push_back(demos::pairKey(motion.object, other));
            }
        }
    }
    std::sort(answers.begin(), answers.end());
    answers.erase(std::unique(answers.begin(), answers.end()), answers.end());
}

}  // namespace hashphase::benchmarks

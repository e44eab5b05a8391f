// SPDX-License-Identifier: Zlib

// Some of the objects move so far in a frame that it matters what they pass: which pairs touch at the
// same time?
//
// Motions   In every frame the sweeping ones are where the scene has them when the frame begins, and
//           move from there, each in a direction of its own.
// Bullet    has no such question. Where its broadphases are told of continuous motion, they are given
//           the box around the start and the end; so they are here.

#include <broadphase/grid.hpp>
#include <broadphase/moving_box.hpp>
#include <demos/scenes/random.hpp>
#include <tests/benchmarks/grid_contestant.hpp>
#include <tests/benchmarks/pair_workload.hpp>
#include <tests/benchmarks/peers/peers.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

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

class SweepWorkload final : public PairWorkload {
public:
    /// Every 30th object moves by so many cells a frame: the finest cells that a grid chooses for the
    /// scene as it begins.
    SweepWorkload(std::unique_ptr<demos::BoxScene> itsScene, float cells, std::uint64_t seed)
        : PairWorkload(std::move(itsScene), PairFrame::setAll, seed) {
        demos::Random random(seed);
        const float length = cells * cellSizeOf(scene().boxes());
        for (std::size_t object = 0; object < objects(); object += kPeriod) {
            motions_.push_back({static_cast<std::uint32_t>(object), length * anyDirection(random)});
        }
        parts_.resize(motions_.size());
    }

    void beginFrame() override {
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

    // Who overlaps at the start, and who touches one that sweeps.
    void listExactAnswers(std::vector<Answer>& answers) override {
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

    [[nodiscard]] FrameBoxes frameFor(const ContestantKind& kind) const override {
        FrameBoxes frame = scene().frame();
        if (kind.bullet != nullptr) {
            frame.boxes = ways_;
            frame.bulletBoxes = bulletWays_;
        } else {
            frame.motions = motions_;
        }
        return frame;
    }

private:
    /// The boxes around a way's parts, of equal time.
    using Parts = std::array<Aabb<float>, 16>;

    // `a` sweeps. Boxes around the ways, then around their parts, keep away what cannot touch.
    [[nodiscard]] bool touch(std::uint32_t a, std::uint32_t b) const {
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

    std::vector<ObjectMotion> motions_;

    // By object, of the present frame.
    std::vector<MovingBox<float>> moving_;
    std::vector<Aabb<float>> ways_;             // the boxes around them
    std::vector<demos::BulletBox> bulletWays_;  // the same

    std::vector<Parts> parts_;  // by motion
};

// Without what is passed, the grid shows what sweeping costs: "hash" has no Sweeps, those unused do.
std::vector<ContestantKind> sweepKinds() {
    std::vector<ContestantKind> kinds{gridKind("hash"),
                                      gridKind("hash-unused", {.sweep = Sweep::none}),
                                      gridKind("sweep-box", {.sweep = Sweep::box}),
                                      gridKind("sweep-line", {.sweep = Sweep::line}),
                                      gridKind("sweep-automatic", {.sweep = Sweep::automatic})};
    if (const std::optional<ParallelFor> threaded = threadedLoop()) {
        for (const auto& [name, sweep] : {std::pair("hash-unused-threads", Sweep::none),
                                          std::pair("sweep-line-threads", Sweep::line)}) {
            kinds.push_back(gridKind(name, {.parallelFor = *threaded, .sweep = sweep}));
            kinds.back().onThreads = true;
        }
    }
    for (ContestantKind& kind : kinds) {
        kind.ours = kind.name.starts_with("sweep-");
    }
    kinds.push_back(contestantKind(kBaseline));  // given the box around start and end
    return kinds;
}

Benchmark sweeps(const char* name, const char* whose, const char* scene, int cells) {
    return {.name = name,
            .group = "sweeps",
            .description = "every 30th of " + std::string(whose) + " sweeps, by " +
                           std::to_string(cells) + " cells a frame",
            .sizes = {30'000},
            .largest = 100'000,       // the exact answers take quadratic time
            .onRequest = cells > 10,  // Bullet takes seconds a frame for these
            .contestants = [](std::size_t, std::uint64_t) { return sweepKinds(); },
            .make =
                [makeScene = sceneNamed(scene), cells](std::size_t objects, std::uint64_t seed) {
                    return std::make_unique<SweepWorkload>(makeScene(objects, seed),
                                                           static_cast<float>(cells), ~seed);
                }};
}

}  // namespace

std::vector<Benchmark> sweepBenchmarks() {
    return {sweeps("sweeps-10", "uniform boxes", "uniform", 10),
            sweeps("sweeps-10-paper", "the paper's spheres", "paper", 10),
            sweeps("sweeps-100", "uniform boxes", "uniform", 100),
            sweeps("sweeps-100-paper", "the paper's spheres", "paper", 100)};
}

}  // namespace hashphase::benchmarks

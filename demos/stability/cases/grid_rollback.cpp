// SPDX-License-Identifier: Zlib
//
// Grids that go back in time.

#include <demos/stability/cases/cases.hpp>

#include <broadphase/grid_snapshot.hpp>
#include <broadphase/sweeps.hpp>
#include <demos/scenes/result_hash.hpp>

#include <string>

namespace hashphase::demos {
namespace {

/// Boxes that come, move and go as the number of the frame says, and the pairs of them.
template <class Scalar>
class NumberedFrames {
public:
    static constexpr std::uint32_t kObjects = 120;

    struct Moment {
        GridSnapshot<Scalar> grid;
        std::vector<ProxyId> ids;
        Boxes<Scalar> boxes;
    };

    explicit NumberedFrames(bool areSwept)
        : areSwept_(areSwept), ids_(kObjects), boxes_(kObjects) {}

    /// Returns a number for everything that the frame has told, in its order.
    std::uint64_t play(std::uint64_t frame) {
        Random random(frame);
        for (std::uint32_t i = 0; i < kObjects; ++i) {
            if (random.unit() < 0.4F) {
                change(i, random);
            }
        }
        const PairChanges changes = pairs_.update();
        ResultHash told;
        told.addAll(changes.born);
        told.addAll(changes.died);
        for (const ProxyId id : ids_) {
            told.add(id.index);
            told.add(id.generation);
        }
        return told.value();
    }

    void save(Moment& moment) const {
        moment.grid.save(pairs_);
        moment.ids = ids_;
        moment.boxes = boxes_;
    }
    void restore(const Moment& moment) {
        moment.grid.restore(pairs_);
        ids_ = moment.ids;
        boxes_ = moment.boxes;
    }

    /// The pairs against those of the boxes, where nothing sweeps.
    template <class Run>
    void judge(Run& run) const {
        run.expect(grid_.validate().empty() && pairs_.validate().empty(), "all invariants hold");
        if (areSwept_) {
            return;
        }
        std::vector<std::uint32_t> objects;  // by index
        for (std::uint32_t i = 0; i < kObjects; ++i) {
            if (!ids_[i].isNull()) {
                objects.resize(std::max<std::size_t>(objects.size(), ids_[i].index + 1));
                objects[ids_[i].index] = i;
            }
        }
        std::vector<ProxyPair> listed;
        pairs_.collect(listed);
        Keys reported;
        for (const ProxyPair& pair : listed) {
            reported.push_back(pairKey(objects[pair.first.index], objects[pair.second.index]));
        }
        std::sort(reported.begin(), reported.end());
        Keys exact = touchingPairs(boxes_);
        std::erase_if(exact, [&](PairKey pair) {
            return ids_[firstOf(pair)].isNull() || ids_[secondOf(pair)].isNull();
        });
        run.compare(reported, exact);
    }

private:
    void change(std::uint32_t object, Random& random) {
        ProxyId& id = ids_[object];
        Aabb<Scalar>& box = boxes_[object];
        box = cubeAt(pointIn<Scalar>(random, -3, 3), between<Scalar>(random, 0.1F, 1.5F));
        if (id.isNull()) {
            id = grid_.add(box, random.unit() < 0.3F ? Mobility::resting : Mobility::mobile);
        } else if (random.unit() < 0.2F) {
            grid_.remove(id);
            id = {};
        } else {
            grid_.move(id, box);
        }
        const Vector3<Scalar> displacement = pointIn<Scalar>(random, -9, 9);
        if (areSwept_ && !id.isNull() && random.unit() < 0.3F) {
            sweeps_.set(id, displacement);
        }
    }

    bool areSwept_;
    Grid<Scalar> grid_;
    Sweeps<Scalar> sweeps_{grid_};
    Pairs<Scalar> pairs_{grid_, &sweeps_};
    std::vector<ProxyId> ids_;  // null: not there
    Boxes<Scalar> boxes_;
};

constexpr auto changesTakenBack = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    if (!run.isOurs) {
        return;
    }
    constexpr std::uint32_t kFrames = 60;
    constexpr std::uint32_t kAgain = 10;
    const int rounds = run.quickOrFull(15, 200);
    for (const bool areSwept : {false, true}) {
        NumberedFrames<Scalar> frames(areSwept);
        std::vector<typename NumberedFrames<Scalar>::Moment> moments(kFrames);
        std::vector<std::uint64_t> told;
        for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
            frames.save(moments[frame]);
            told.push_back(frames.play(frame));
        }
        Random random(run.seed);
        Objects equal;
        Objects all;
        for (int round = 0; round < rounds; ++round) {
            const std::uint32_t from = indexBelow(random, kFrames - kAgain);
            frames.restore(moments[from]);
            for (std::uint32_t frame = from; frame < from + kAgain; ++frame) {
                const auto answer = static_cast<std::uint32_t>(all.size());
                all.push_back(answer);
                if (frames.play(frame) == told[frame]) {
                    equal.push_back(answer);
                }
                frames.judge(run);
            }
            for (std::uint32_t other = 0; other < indexBelow(random, 10); ++other) {
                frames.play(1000 + other);
            }
        }
        run.compare(equal, all);
    }
    run.note("A saved state was restored " + std::to_string(2 * rounds) + " times.");
};

constexpr HardCase kRollbackCases[] = {
    {"H46", "random changes, rolled back",
     "120 boxes that are created, moved and removed in 60 frames, and saved before each frame; 200 "
     "times (--quick: 15 times), one of these states is restored, and the next ten frames are "
     "repeated; then all of it again with sweeps",
     "each repeated frame reports the same pair changes as the first time, in the same order, with "
     "the same ids; without sweeps, exact pairs",
     changesTakenBack},
};

}  // namespace

std::span<const HardCase> rollbackCases() {
    return kRollbackCases;
}

}  // namespace hashphase::demos

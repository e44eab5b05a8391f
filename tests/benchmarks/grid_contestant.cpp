// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/grid_contestant.hpp>

#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

namespace hashphase::benchmarks {
namespace {

using demos::PairKey;

template <class Scalar, bool isFar>
class GridContestant : public Contestant {
public:
    GridContestant(const GridPlan& plan, std::size_t objects)
        : plan_(plan),
          grid_(plan.config),
          sweeps_(plan.sweep ? std::make_unique<Sweeps<Scalar>>(grid_) : nullptr),
          ids_(objects) {}

    void fill(const FrameBoxes& frame) override {
        for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
            addOne(static_cast<std::uint32_t>(i), frame);
        }
    }

    void setAll(const FrameBoxes& frame) override {
        if (plan_.shift != 0) {
            const double shift = origin_ == 0 ? plan_.shift : -plan_.shift;
            grid_.shiftOrigin(Vector3<Scalar>::Constant(static_cast<Scalar>(shift)));
            origin_ += shift;
        }
        for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
            grid_.move(ids_[i], place(frame.boxes[i]));
        }
        if (plan_.sweep.value_or(Sweep::none) == Sweep::none) {
            return;
        }
        for (const ObjectMotion& motion : frame.motions) {
            sweeps_->set(ids_[motion.object], motion.displacement.template cast<Scalar>(),
                         *plan_.sweep);
        }
    }

    void findPairs() override { changes_ = pairs_.update(acceptAllPairs, plan_.parallelFor); }

    // What was a pair is one no more, and what was none is one.
    void afterFrame() override {
        std::vector<PairKey> changed = keysOf(changes_.died);
        const std::vector<PairKey> born = keysOf(changes_.born);
        changed.insert(changed.end(), born.begin(), born.end());
        std::sort(changed.begin(), changed.end());
        changes_ = {};
        next_.clear();
        std::set_symmetric_difference(known_.begin(), known_.end(), changed.begin(), changed.end(),
                                      std::back_inserter(next_));
        known_.swap(next_);
    }

    void listPairs(std::vector<PairKey>& pairs) override {
        afterFrame();
        pairs = known_;
    }

    void add(std::span<const std::uint32_t> objects, const FrameBoxes& frame) override {
        for (const std::uint32_t object : objects) {
            addOne(object, frame);
        }
    }
    void remove(std::span<const std::uint32_t> objects) override {
        for (const std::uint32_t object : objects) {
            grid_.remove(ids_[object]);
        }
    }
    void set(std::span<const std::uint32_t> objects, const FrameBoxes& frame) override {
        for (const std::uint32_t object : objects) {
            grid_.move(ids_[object], place(frame.boxes[object]));
        }
    }

    [[nodiscard]] std::optional<OwnBytes> ownBytes() const override {
        const std::size_t forSweeps = sweeps_ == nullptr ? 0 : sweeps_->memoryBytes();
        return OwnBytes{grid_.memoryBytes() + forSweeps, pairs_.memoryBytes()};
    }

private:
    [[nodiscard]] decltype(auto) place(const Aabb<float>& box) const noexcept {
        if constexpr (isFar) {
            const Vector3<Scalar> by =
                Vector3<Scalar>::Constant(static_cast<Scalar>(*plan_.distance - origin_));
            return Aabb<Scalar>(box.min().cast<Scalar>() + by, box.max().cast<Scalar>() + by);
        } else {
            return (box);
        }
    }

    void addOne(std::uint32_t object, const FrameBoxes& frame) {
        const demos::CollisionFilter filter = frame.filterOf(object);
        ids_[object] = grid_.add(
            place(frame.boxes[object]), isStatic(filter) ? Mobility::resting : Mobility::mobile,
            {static_cast<std::uint32_t>(filter.group), static_cast<std::uint32_t>(filter.mask)});
        const std::uint32_t slot = ids_[object].index;
        objects_.resize(std::max<std::size_t>(objects_.size(), slot + std::size_t{1}));
        objects_[slot] = object;
    }

    // A slot may have changed hands by the time its pairs die, but then with the whole pair.
    std::vector<PairKey> keysOf(std::span<const ProxyPair> pairs) const {
        std::vector<PairKey> keys;
        keys.reserve(pairs.size());
        for (const ProxyPair& pair : pairs) {
            keys.push_back(demos::pairKey(objects_[pair.first.index], objects_[pair.second.index]));
        }
        return keys;
    }

    GridPlan plan_;
    double origin_ = 0;
    Grid<Scalar> grid_;
    std::unique_ptr<Sweeps<Scalar>> sweeps_;
    Pairs<Scalar> pairs_{grid_, sweeps_.get()};
    std::vector<ProxyId> ids_;            // by object
    std::vector<std::uint32_t> objects_;  // by slot
    PairChanges changes_;
    std::vector<PairKey> known_;
    std::vector<PairKey> next_;
};

}  // namespace

ContestantKind gridKind(std::string name, const GridPlan& plan) {
    return {.name = std::move(name),
            .title = "hashphase::Pairs",
            .description = "the grid without Bullet: births and deaths of pairs, no pair cache",
            .ours = true,
            .changes = true,
            .make = [plan](const demos::BroadphaseNeeds& needs) -> std::unique_ptr<Contestant> {
                if (plan.isDouble) {
                    return std::make_unique<GridContestant<double, true>>(plan, needs.objects);
                }
                if (plan.distance) {
                    return std::make_unique<GridContestant<float, true>>(plan, needs.objects);
                }
                return std::make_unique<GridContestant<float, false>>(plan, needs.objects);
            }};
}

}  // namespace hashphase::benchmarks

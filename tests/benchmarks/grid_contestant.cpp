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

// Where the boxes of the scene are in the grid.
struct AsGiven {
    static const Aabb<float>& place(const Aabb<float>& box) noexcept { return box; }
    static void beginFrame(Grid<float>& /*grid*/) noexcept {}
};

template <class Scalar>
struct FarAway {
    FarGrid far;
    double origin = 0;

    [[nodiscard]] Aabb<Scalar> place(const Aabb<float>& box) const noexcept {
        const Vector3<Scalar> by =
            Vector3<Scalar>::Constant(static_cast<Scalar>(far.distance - origin));
        return {box.min().cast<Scalar>() + by, box.max().cast<Scalar>() + by};
    }
    void beginFrame(Grid<Scalar>& grid) {
        if (far.shift != 0) {
            const double shift = origin == 0 ? far.shift : -far.shift;
            grid.shiftOrigin(Vector3<Scalar>::Constant(static_cast<Scalar>(shift)));
            origin += shift;
        }
    }
};

template <class Scalar, class Places>
class GridContestant : public Contestant, private Population {
public:
    GridContestant(const GridConfig& config, std::size_t objects, const Places& places = {})
        : places_(places), grid_(config), ids_(objects) {}
    GridContestant(Sweep sweep, ParallelFor parallelFor, std::size_t objects)
        : sweeps_(std::make_unique<Sweeps<Scalar>>(grid_)),
          sweep_(sweep),
          parallelFor_(parallelFor),
          ids_(objects) {}

    void fill(const FrameBoxes& frame) override {
        for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
            addOne(static_cast<std::uint32_t>(i), frame);
        }
    }

    void setAll(const FrameBoxes& frame) override {
        places_.beginFrame(grid_);
        for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
            grid_.move(ids_[i], places_.place(frame.boxes[i]));
        }
        if (sweep_ == Sweep::none) {
            return;
        }
        for (const ObjectMotion& motion : frame.motions) {
            sweeps_->set(ids_[motion.object], motion.displacement.template cast<Scalar>(), sweep_);
        }
    }

    void findPairs() override {
        const auto mayPair = [this](ProxyId a, ProxyId b) {
            return filters_.empty() ||
                   demos::mayPair(filters_[objects_[a.index]], filters_[objects_[b.index]]);
        };
        changes_ = pairs_.update(mayPair, parallelFor_);
    }

    void afterFrame() override { applyChanges(); }

    void listPairs(std::vector<PairKey>& pairs) override {
        applyChanges();
        pairs = known_;
    }

    Population* population() override { return this; }

    [[nodiscard]] std::optional<OwnBytes> ownBytes() const override {
        const std::size_t forSweeps = sweeps_ == nullptr ? 0 : sweeps_->memoryBytes();
        return OwnBytes{grid_.memoryBytes() + forSweeps, pairs_.memoryBytes()};
    }

private:
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

    void addOne(std::uint32_t object, const FrameBoxes& frame) {
        filters_ = frame.filters;
        ids_[object] = grid_.add(places_.place(frame.boxes[object]));
        const std::uint32_t slot = ids_[object].index;
        objects_.resize(std::max<std::size_t>(objects_.size(), slot + std::size_t{1}));
        objects_[slot] = object;
    }

    void applyChanges() {
        const std::vector<PairKey> died = keysOf(changes_.died);
        const std::vector<PairKey> born = keysOf(changes_.born);
        changes_ = {};
        kept_.clear();
        std::set_difference(known_.begin(), known_.end(), died.begin(), died.end(),
                            std::back_inserter(kept_));
        known_.clear();
        std::merge(kept_.begin(), kept_.end(), born.begin(), born.end(),
                   std::back_inserter(known_));
    }

    // A slot may have changed hands by the time its pairs die, but then with the whole pair.
    std::vector<PairKey> keysOf(std::span<const ProxyPair> pairs) const {
        std::vector<PairKey> keys;
        keys.reserve(pairs.size());
        for (const ProxyPair& pair : pairs) {
            keys.push_back(demos::pairKey(objects_[pair.first.index], objects_[pair.second.index]));
        }
        std::sort(keys.begin(), keys.end());
        return keys;
    }

    Places places_;
    Grid<Scalar> grid_;
    std::unique_ptr<Sweeps<Scalar>> sweeps_;
    Sweep sweep_ = Sweep::none;
    ParallelFor parallelFor_ = serialFor;
    Pairs<Scalar> pairs_{grid_, sweeps_.get()};
    std::vector<ProxyId> ids_;            // by object
    std::vector<std::uint32_t> objects_;  // by slot
    std::span<const demos::CollisionFilter> filters_;
    PairChanges changes_;
    std::vector<PairKey> known_;
    std::vector<PairKey> kept_;
};

ContestantKind kindOf(std::string name, const char* description) {
    return {.name = std::move(name),
            .title = "hashphase::Pairs",
            .description = description,
            .ours = true};
}

}  // namespace

ContestantKind gridKind(std::string name, const GridConfig& config) {
    ContestantKind kind = kindOf(
        std::move(name), "the grid without Bullet: births and deaths of pairs, no pair cache");
    kind.changes = true;
    kind.make = [config](const demos::BroadphaseNeeds& needs) {
        return std::make_unique<GridContestant<float, AsGiven>>(config, needs.objects);
    };
    return kind;
}

ContestantKind sweepingGridKind(std::string name, Sweep sweep, ParallelFor parallelFor) {
    ContestantKind kind = kindOf(std::move(name), "the grid without Bullet, and its Sweeps");
    kind.make = [sweep, parallelFor](const demos::BroadphaseNeeds& needs) {
        return std::make_unique<GridContestant<float, AsGiven>>(sweep, parallelFor, needs.objects);
    };
    return kind;
}

ContestantKind farGridKind(std::string name, const FarGrid& far) {
    ContestantKind kind =
        kindOf(std::move(name), far.isDouble ? "the grid in double precision" : "in single");
    kind.make = [far](const demos::BroadphaseNeeds& needs) -> std::unique_ptr<Contestant> {
        if (far.isDouble) {
            return std::make_unique<GridContestant<double, FarAway<double>>>(
                GridConfig{}, needs.objects, FarAway<double>{far});
        }
        return std::make_unique<GridContestant<float, FarAway<float>>>(GridConfig{}, needs.objects,
                                                                       FarAway<float>{far});
    };
    return kind;
}

}  // namespace hashphase::benchmarks

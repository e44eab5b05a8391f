// SPDX-License-Identifier: Zlib
#include <demos/accuracy/sweeps/sweep_method.hpp>

#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>

#include <array>

namespace hashphase::demos {
namespace {

class GridFinder : public SweepFinder {
public:
    GridFinder(Sweep sweep, const SweptFrame& first) : sweep_(sweep) {
        for (std::uint32_t i = 0; i < first.objects.size(); ++i) {
            const ProxyId id = grid_.add(first.objects[i].box,
                                         i < first.movers ? Mobility::mobile : Mobility::resting);
            ids_.push_back(id);
            objects_.resize(std::max<std::size_t>(objects_.size(), id.index + 1));
            objects_[id.index] = i;
        }
    }

    void step(const SweptFrame& frame) override {
        for (std::uint32_t i = 0; i < frame.movers; ++i) {
            const MovingBox<float>& mover = frame.objects[i];
            grid_.move(ids_[i], sweep_ == Sweep::none ? endBox(mover) : mover.box);
            sweeps_.set(ids_[i], mover.displacement, sweep_);
        }
        pairs_.update([](ProxyId, ProxyId) { return true; });
    }

    void listPairs(std::vector<PairKey>& pairs) const override {
        std::vector<ProxyPair> all;
        pairs_.collect(all);
        for (const ProxyPair& pair : all) {
            pairs.push_back(pairKey(objects_[pair.first.index], objects_[pair.second.index]));
        }
    }

    [[nodiscard]] std::optional<SweepWork> work() const override {
        const SweepCost& swept = sweeps_.lastCost();
        return SweepWork{swept.segments + swept.rays,
                         swept.boxesTested + swept.contactsTested + pairs_.lastCost().boxesTested};
    }

private:
    Sweep sweep_;
    Grid<float> grid_;
    Sweeps<float> sweeps_{grid_};
    Pairs<float> pairs_{grid_, &sweeps_};
    std::vector<ProxyId> ids_;
    std::vector<std::uint32_t> objects_;  // by index of proxy
};

}  // namespace

SweepMethod gridSweep(Sweep sweep) {
    constexpr std::array kNames{"discrete (Sweep::none)", "Sweep::box", "Sweep::line",
                                "Sweep::automatic"};
    SweepMethod method;
    method.name = kNames[static_cast<std::size_t>(sweep)];
    method.missesNothing = sweep != Sweep::none;
    method.isDiscrete = sweep == Sweep::none;
    if (sweep != Sweep::none) {
        method.contactTime = firstContact<float>;
    }
    method.make = [sweep](const SweptFrame& first) {
        return std::make_unique<GridFinder>(sweep, first);
    };
    return method;
}

std::vector<SweepMethod> sweepMethods() {
    return {gridSweep(Sweep::none),
            gridSweep(Sweep::automatic),
            gridSweep(Sweep::line),
            gridSweep(Sweep::box),
            thickLine(),
            paperBox(),
            paperLine(),
            bulletSweep(BulletSweep::discrete),
            bulletSweep(BulletSweep::united),
            bulletSweep(BulletSweep::unitedAndTested)};
}

}  // namespace hashphase::demos

// SPDX-License-Identifier: Zlib
#include <demos/accuracy/sweeps/sweep_experiment.hpp>

#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>
#include <demos/accuracy/baselines/hashed_cells.hpp>
#include <demos/compare/filled_broadphase.hpp>
#include <demos/scenes/list_pairs.hpp>
#include <integration/bullet/conversions.hpp>

#include <algorithm>
#include <cstdlib>

namespace hashphase::demos {
namespace {

using Moving = MovingBox<float>;

// --- Of ours -------------------------------------------------------------------------------------

/// With Sweep::none it knows the boxes at the end of the frame, as every broadphase does that knows
/// nothing of motion. In an empty grid, ids count from 0.
SweepFinder gridFinder(Sweep sweep, const SweptFrame& first) {
    struct Filed {
        Grid<float> grid;
        Sweeps<float> sweeps{grid};
        Pairs<float> pairs{grid, &sweeps};
        std::vector<ProxyId> ids;
    };
    const auto filed = std::make_shared<Filed>();
    for (std::uint32_t i = 0; i < first.objects.size(); ++i) {
        filed->ids.push_back(filed->grid.add(
            first.objects[i].box, i < first.movers ? Mobility::mobile : Mobility::resting));
    }
    return {
        [=](const SweptFrame& frame) {
            for (std::uint32_t i = 0; i < frame.movers; ++i) {
                const Moving& mover = frame.objects[i];
                filed->grid.move(filed->ids[i], sweep == Sweep::none ? endBox(mover) : mover.box);
                filed->sweeps.set(filed->ids[i], mover.displacement, sweep);
            }
            filed->pairs.update([](ProxyId, ProxyId) { return true; });
        },
        [=](std::vector<PairKey>& pairs) {
            listPairs(filed->pairs, pairs);
            const SweepCost& swept = filed->sweeps.lastCost();
            return SweepWork{swept.segments + swept.rays, swept.boxesTested + swept.contactsTested +
                                                              filed->pairs.lastCost().boxesTested};
        }};
}

// --- On the paper's grid -------------------------------------------------------------------------
//
// After Hastings, Mesit and Guha, "Optimization of Large-Scale, Real-Time Simulations by Spatial
// Hashing", 2005: static objects are hashed once, mobile ones every frame, in all columns of their
// way over the ground. The loops include their ends and run both ways, which those that were
// printed do not; a box has all its corners.

/// The line raster of the paper, after J. E. Bresenham, "Algorithm for Computer Control of a
/// Digital Plotter", 1965: from the column of the centre at the start to that at the end.
template <class Visit>
void visitThinLine(const Moving& moving, const Visit& visit) {
    const Vector3<double> start = moving.box.center().cast<double>();
    const Vector3<double> end = start + moving.displacement.cast<double>();
    Cell at{cellAt(start.x()), 0, cellAt(start.z())};
    const Cell last{cellAt(end.x()), 0, cellAt(end.z())};
    const std::int32_t farX = std::abs(last[0] - at[0]);
    const std::int32_t farZ = std::abs(last[2] - at[2]);
    const std::int32_t stepX = last[0] < at[0] ? -1 : 1;
    const std::int32_t stepZ = last[2] < at[2] ? -1 : 1;
    std::int32_t error = farX - farZ;
    for (visit(at); at != last; visit(at)) {
        const std::int32_t twice = 2 * error;
        if (twice > -farZ) {
            error -= farZ;
            at[0] += stepX;
        }
        if (twice < farX) {
            error += farX;
            at[2] += stepZ;
        }
    }
}

/// All columns that the box touches on its way: row by row those between where it is when it enters
/// the row and where it is when it leaves, and a hair more.
template <class Visit>
void visitThickLine(const Moving& moving, const Visit& visit) {
    constexpr double kHair = 1e-9;  // [m]; rounding is less
    const Aabb<double> box = moving.box.cast<double>();
    const Vector3<double> way = moving.displacement.cast<double>();
    const double lowest = box.min().x() + std::min(way.x(), 0.0);
    const double highest = box.max().x() + std::max(way.x(), 0.0);
    const auto timeAt = [&](double distance) {
        return way.x() == 0 ? 0 : std::clamp(distance / way.x(), 0.0, 1.0);
    };
    for (std::int32_t x = cellAt(lowest - kHair); x <= cellAt(highest + kHair); ++x) {
        double enters = timeAt(x - box.max().x());
        double leaves = way.x() == 0 ? 1 : timeAt(x + 1 - box.min().x());
        if (way.x() < 0) {
            std::swap(enters, leaves);
        }
        const auto [low, high] = std::minmax({enters * way.z(), leaves * way.z()});
        visitCells({x, 0, cellAt(box.min().z() + low - kHair)},
                   {x, 0, cellAt(box.max().z() + high + kHair)}, visit);
    }
}

enum class Raster : std::uint8_t { box, thinLine, thickLine };

/// As the paper has it, what shares a column counts if the boxes around the ways overlap; of the
/// thick line, firstContact() decides.
class ColumnFinder {
public:
    ColumnFinder(Raster raster, const SweptFrame& first)
        : raster_(raster), columns_(first.objects.size()), lastSeenBy_(first.objects.size()) {
        for (std::uint32_t i = first.movers; i < first.objects.size(); ++i) {
            visitBox(first.objects[i].box, true, [&](const Cell& at) { columns_.file(at, i); });
        }
        columns_.keepFiled();
    }

    void step(const SweptFrame& frame) {
        columns_.unfile();
        pairs_.clear();
        work_ = {};
        for (std::uint32_t i = 0; i < frame.movers; ++i) {
            ++visit_;
            const Moving& mover = frame.objects[i];
            const auto visit = [&](const Cell& at) { enter(at, i, frame); };
            const bool isSmall = mover.box.sizes().maxCoeff() <= 1;  // "bullets", to the paper
            if (raster_ == Raster::thickLine) {
                visitThickLine(mover, visit);
            } else if (raster_ == Raster::thinLine && isSmall) {
                visitThinLine(mover, visit);
            } else {
                visitBox(wayBox(mover), true, visit);
            }
        }
    }

    SweepWork listPairs(std::vector<PairKey>& pairs) const {
        pairs.insert(pairs.end(), pairs_.begin(), pairs_.end());
        return work_;
    }

private:
    void enter(const Cell& at, std::uint32_t mover, const SweptFrame& frame) {
        ++work_.cells;
        columns_.visitObjects(at, [&](std::uint32_t other) {
            if (other == mover || lastSeenBy_[other] == visit_) {
                return;
            }
            lastSeenBy_[other] = visit_;
            ++work_.tests;
            const Moving& a = frame.objects[mover];
            const Moving& b = frame.objects[other];
            if (raster_ == Raster::thickLine ? firstContact(a, b).has_value()
                                             : overlaps(wayBox(a), wayBox(b))) {
                pairs_.push_back(pairKey(mover, other));
            }
        });
        columns_.file(at, mover);
    }

    Raster raster_;
    HashedCells columns_;
    std::vector<std::uint64_t> lastSeenBy_;  // by object; a value of visit_
    std::uint64_t visit_ = 0;
    std::vector<PairKey> pairs_;
    SweepWork work_;
};

SweepFinder columnFinder(Raster raster, const SweptFrame& first) {
    const auto finder = std::make_shared<ColumnFinder>(raster, first);
    return {[=](const SweptFrame& frame) { finder->step(frame); },
            [=](std::vector<PairKey>& pairs) { return finder->listPairs(pairs); }};
}

// --- Of Bullet -----------------------------------------------------------------------------------

/// The boxes at the end of the frame, without the pairs that btDbvtBroadphase keeps though they
/// have come apart, in which the narrowphase finds nothing; the boxes around the ways, as
/// m_useContinuous has it; and these with firstContact() for every pair that is listed.
enum class BulletSweep : std::uint8_t { discrete, united, unitedAndTested };

BulletBox knownBox(BulletSweep sweep, const Moving& moving) {
    const Aabb<float> box = sweep == BulletSweep::discrete ? endBox(moving) : wayBox(moving);
    return {toBullet(box.min()), toBullet(box.max())};
}

/// Appends the pairs of the cache that count.
template <class Counts>
void listIf(const FilledBroadphase& filled, const Counts& counts, std::vector<PairKey>& pairs) {
    const auto& all = filled.broadphase().getOverlappingPairCache()->getOverlappingPairArray();
    for (int i = 0; i < all.size(); ++i) {
        const std::uint32_t a = FilledBroadphase::objectOf(*all[i].m_pProxy0);
        const std::uint32_t b = FilledBroadphase::objectOf(*all[i].m_pProxy1);
        if (counts(a, b, all[i])) {
            pairs.push_back(pairKey(a, b));
        }
    }
}

SweepFinder bulletFinder(BulletSweep sweep, const SweptFrame& first) {
    const auto filled = std::make_shared<FilledBroadphase>(
        broadphaseKind("dbvt"), BroadphaseNeeds{Aabb<float>(), first.objects.size()});
    for (std::uint32_t i = 0; i < first.objects.size(); ++i) {
        filled->create(i, knownBox(sweep, first.objects[i]), {});
    }
    const auto touching = std::make_shared<std::vector<PairKey>>();
    return {
        [=](const SweptFrame& frame) {
            for (std::uint32_t i = 0; i < frame.movers; ++i) {
                filled->set(i, knownBox(sweep, frame.objects[i]));
            }
            filled->findPairs();
            if (sweep == BulletSweep::unitedAndTested) {
                const auto touch = [&](std::uint32_t a, std::uint32_t b, const auto&) {
                    return std::min(a, b) < frame.movers &&
                           firstContact(frame.objects[a], frame.objects[b]).has_value();
                };
                touching->clear();
                listIf(*filled, touch, *touching);
            }
        },
        [=](std::vector<PairKey>& pairs) -> std::optional<SweepWork> {
            if (sweep == BulletSweep::unitedAndTested) {
                pairs.insert(pairs.end(), touching->begin(), touching->end());
                return std::nullopt;
            }
            const auto counts = [=](std::uint32_t, std::uint32_t, const btBroadphasePair& pair) {
                return sweep == BulletSweep::united ||
                       TestAabbAgainstAabb2(pair.m_pProxy0->m_aabbMin, pair.m_pProxy0->m_aabbMax,
                                            pair.m_pProxy1->m_aabbMin, pair.m_pProxy1->m_aabbMax);
            };
            listIf(*filled, counts, pairs);
            return std::nullopt;
        }};
}

template <auto find, class Kind>
auto of(Kind kind) {
    return [kind](const SweptFrame& first) { return find(kind, first); };
}

}  // namespace

std::vector<SweepMethod> sweepMethods() {
    const std::string all = " misses_nothing";
    const std::string atTheEnd = " discrete invents_nothing";
    const std::string exact = all + " invents_nothing exact tells_time";
    return {
        {"discrete (Sweep::none)", "ours" + atTheEnd, of<gridFinder>(Sweep::none)},
        {"Sweep::automatic", "ours compared" + exact, of<gridFinder>(Sweep::automatic)},
        {"Sweep::line", "ours compared" + exact, of<gridFinder>(Sweep::line)},
        {"Sweep::box", "ours compared" + exact, of<gridFinder>(Sweep::box)},
        {"thick line of cells, tested", "paper" + exact, of<columnFinder>(Raster::thickLine)},
        {"paper: box of cells", "paper" + all, of<columnFinder>(Raster::box)},
        {"paper: line of cells", "paper", of<columnFinder>(Raster::thinLine)},
        {"btDbvtBroadphase, discrete", "bullet" + atTheEnd,
         of<bulletFinder>(BulletSweep::discrete)},
        {"btDbvtBroadphase, united", "bullet" + all, of<bulletFinder>(BulletSweep::united)},
        {"btDbvtBroadphase, united, tested", "bullet compared" + exact,
         of<bulletFinder>(BulletSweep::unitedAndTested)},
    };
}

}  // namespace hashphase::demos

// SPDX-License-Identifier: Zlib
#include <demos/swarm/swarm_run.hpp>

#include <demos/report/stopwatch.hpp>
#include <demos/swarm/agreed_end.hpp>

#include <broadphase/grid.hpp>
#include <broadphase/pairs.hpp>

#include <algorithm>
#include <chrono>
#include <new>
#include <stdexcept>
#include <thread>

namespace hashphase::demos {
namespace {

constexpr double kMs = 1000;

/// The spheres that live on this rank, in the order of their ProxyId::index, which is that of the grid's memory.
class OwnedSpheres {
public:
    OwnedSpheres(DistributedGrid<float>& grid, const SwarmScene& scene) : grid_(grid) {
        const RankGrid<float>& here = grid.here();
        for (std::uint64_t number = 0; number < scene.count(); ++number) {
            const Aabb<float> box = scene.box(number, 0);
            if (here.partition().rankOf(box.min()) == here.rank()) {
                spheres_.push_back({grid.add(GlobalId{number}, box), number});
            }
        }
    }

    void place(const SwarmScene& scene, std::uint32_t frame) {
        boxes_.resize(spheres_.size());
        for (std::size_t i = 0; i < spheres_.size(); ++i) {
            boxes_[i] = scene.box(spheres_[i].number, frame);
        }
    }
    void move() {
        for (std::size_t i = 0; i < spheres_.size(); ++i) {
            grid_.move(spheres_[i].proxy, boxes_[i]);
        }
    }
    /// Drops what has gone, and takes what has come.
    void follow(const RankChanges& changes) {
        if (!changes.departed.empty()) {
            std::erase_if(spheres_, [&](const Sphere& sphere) {
                return !grid_.here().isOwned(sphere.proxy);
            });
        }
        const auto come = static_cast<std::ptrdiff_t>(spheres_.size());
        for (const Migration& each : changes.arrived) {
            spheres_.push_back({each.proxy, each.object.value});
        }
        std::sort(spheres_.begin() + come, spheres_.end());
        std::inplace_merge(spheres_.begin(), spheres_.begin() + come, spheres_.end());
    }

private:
    struct Sphere {
        ProxyId proxy;
        std::uint64_t number = 0;

        friend auto operator<=>(const Sphere&, const Sphere&) = default;
    };

    DistributedGrid<float>& grid_;
    std::vector<Sphere> spheres_;
    std::vector<Aabb<float>> boxes_;
};

/// Every rank knows where all spheres are: the parts begin with equal numbers.
Partition<float> firstPartition(MPI_Comm communicator, const SwarmScene& scene) {
    constexpr std::uint64_t kSamplesOfRank = 4096;
    int ranks = 1;
    MPI_Comm_size(communicator, &ranks);
    const std::uint64_t step =
        1 + scene.count() / (kSamplesOfRank * static_cast<std::uint64_t>(ranks));
    std::vector<WeightedPoint<float>> points;
    for (std::uint64_t number = 0; number < scene.count(); number += step) {
        points.push_back({scene.box(number, 0).min(), 1});
    }
    return Partition<float>::balanced(static_cast<std::uint32_t>(ranks), points);
}

RankFrame frameOf(const DistributedGrid<float>& grid, const RankChanges& changes) {
    const DistributedCost& cost = grid.lastCost();
    RankFrame frame;
    frame.objects = static_cast<double>(grid.here().size());
    frame.ghosts = static_cast<double>(cost.rankGrid.ghosts);
    frame.load = cost.rankGrid.load;
    frame.bytes = static_cast<double>(cost.rankGrid.bytesSent);
    frame.messages = static_cast<double>(cost.rankGrid.parcelsSent);
    frame.migrated = static_cast<double>(changes.departed.size());
    frame.rebalance = cost.rebalanceSeconds * kMs;
    frame.tell = cost.packSeconds * kMs;
    frame.wait = cost.waitSeconds * kMs;
    frame.pairs = cost.pairSeconds * kMs;
    return frame;
}

FrameSums sumsOf(const RankGrid<float>& grid, const PairChanges& changes) {
    FrameSums sums;
    for (const ProxyPair& pair : changes.born) {
        sums.born.add(grid.globalPair(pair));
    }
    for (const ProxyPair& pair : changes.died) {
        sums.died.add(grid.globalPair(pair));
    }
    return sums;
}

/// What ranks have measured, by frame, on rank 0.
std::vector<std::vector<RankFrame>> gathered(MPI_Comm communicator,
                                             const std::vector<RankFrame>& mine, std::uint32_t rank,
                                             std::uint32_t ranks) {
    static_assert(sizeof(RankFrame) == RankFrame::kNumbers * sizeof(double));
    const int numbers = static_cast<int>(RankFrame::kNumbers);
    std::vector<std::vector<RankFrame>> all;
    for (const RankFrame& frame : mine) {
        std::vector<RankFrame> ofAll(rank == 0 ? ranks : 0);
        MPI_Gather(&frame, numbers, MPI_DOUBLE, ofAll.data(), numbers, MPI_DOUBLE, 0, communicator);
        all.push_back(std::move(ofAll));
    }
    return all;
}

void addOverRanks(MPI_Comm communicator, std::vector<FrameSums>& sums) {
    std::vector<std::uint64_t> numbers;
    for (const FrameSums& each : sums) {
        numbers.insert(numbers.end(),
                       {each.born.count, each.born.hash, each.died.count, each.died.hash});
    }
    MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_UINT64_T,
                  MPI_SUM, communicator);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const std::uint64_t* four = numbers.data() + 4 * i;
        sums[i] = {{four[0], four[1]}, {four[2], four[3]}};
    }
}

}  // namespace

SwarmResult runSwarm(MPI_Comm communicator, const SwarmScene& scene, std::uint32_t frames,
                     const DistributedConfig& config, const SwarmWatch& watch) {
    DistributedGrid<float> grid(communicator, firstPartition(communicator, scene), config);
    OwnedSpheres spheres(grid, scene);
    SwarmResult result;
    result.ranks = grid.here().partition().rankCount();
    std::vector<RankFrame> mine;
    AgreedEnd end(communicator, config.patience);
    for (std::uint32_t frame = 0; frame < frames && !end.isCalledFor(); ++frame) {
        const Stopwatch placing;
        spheres.place(scene, frame);
        const double place = placing.milliseconds();
        const Stopwatch whole;
        if (frame > 0) {
            spheres.move();
        }
        const double setting = whole.milliseconds();
        const RankChanges changes = grid.update();
        const double milliseconds = whole.milliseconds();
        spheres.follow(changes);
        mine.push_back(frameOf(grid, changes));
        mine.back().place = place;
        mine.back().tell += setting;
        mine.back().whole = milliseconds;
        result.sums.push_back(sumsOf(grid.here(), changes.pairs));
        result.wasRebalanced.push_back(grid.lastCost().wasRebalanced);
        watch(frame, grid);
    }
    result.isInterrupted = end.take();
    result.last = grid.pairSum();
    addOverRanks(communicator, result.sums);
    result.frames = gathered(communicator, mine, grid.here().rank(), result.ranks);
    return result;
}

SingleResult runAlone(const SwarmScene& scene, std::uint32_t frames,
                      const std::function<void(std::uint32_t frame)>& watch) {
    Grid<float> grid;
    Pairs<float> pairs(grid);
    std::vector<ProxyId> proxies;
    std::vector<Aabb<float>> boxes(scene.count());
    SingleResult result;
    // Its indices are the spheres' numbers: added in their order, and none is removed.
    const auto named = [](const ProxyPair& pair) {
        return GlobalPair{GlobalId{pair.first.index}, GlobalId{pair.second.index}};
    };
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
        const Stopwatch placing;
        for (std::uint64_t number = 0; number < scene.count(); ++number) {
            boxes[number] = scene.box(number, frame);
        }
        result.place.push_back(placing.milliseconds());
        const Stopwatch whole;
        for (std::uint64_t number = 0; number < scene.count(); ++number) {
            if (frame == 0) {
                proxies.push_back(grid.add(boxes[number]));
            } else {
                grid.move(proxies[number], boxes[number]);
            }
        }
        const PairChanges changes = pairs.update();
        result.whole.push_back(whole.milliseconds());
        FrameSums sums;
        for (const ProxyPair& pair : changes.born) {
            sums.born.add(named(pair));
        }
        for (const ProxyPair& pair : changes.died) {
            sums.died.add(named(pair));
        }
        result.sums.push_back(sums);
        watch(frame);
    }
    std::vector<ProxyPair> all;
    pairs.collect(all);
    for (const ProxyPair& pair : all) {
        result.last.add(named(pair));
    }
    return result;
}

SingleRun tryAlone(const SwarmScene& scene, std::uint32_t frames,
                   const std::function<void(std::uint32_t frame)>& watch) {
    try {
        return {runAlone(scene, frames, watch), {}};
    } catch (const std::bad_alloc&) {
        return {std::nullopt, "it has too little memory for all spheres"};
    } catch (const std::length_error&) {
        return {std::nullopt, "a grid cannot hold all spheres and pairs"};
    }
}

void meet(MPI_Comm communicator) {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibarrier(communicator, &request);
    for (int isDone = 0; isDone == 0;) {
        MPI_Test(&request, &isDone, MPI_STATUS_IGNORE);
        std::this_thread::sleep_for(std::chrono::milliseconds(isDone == 0 ? 2 : 0));
    }
}

}  // namespace hashphase::demos

// SPDX-License-Identifier: Zlib
#include <demos/swarm/scaling_plan.hpp>

#include <demos/console/format.hpp>
#include <integration/distributed/partition.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr std::uint64_t kLeastSamples = 1'000'000;
constexpr std::uint64_t kSamplesOfRank = 100;

// As RankGrid writes them: kind, id and box; for a new ghost groups and the box before; for a move to another rank
// where to.
constexpr double kEntryBytes = 1 + 8 + 24;
constexpr double kNewGhostBytes = kEntryBytes + 8 + 24;
constexpr double kMigrationBytes = 4;
constexpr double kHeadBytes = 24;

constexpr float kReach = 1;     // [m], the edge of a sphere's box
constexpr float kStep = 0.06F;  // [m], how far it goes in a frame

/// Numbers of spheres, as far apart as any.
std::uint64_t drawnNumber(std::uint64_t i, std::uint64_t samples, std::uint64_t count) {
    return static_cast<std::uint64_t>(static_cast<double>(i) / static_cast<double>(samples) *
                                      static_cast<double>(count));
}

struct Counts {
    double ghosts = 0;
    double newGhosts = 0;
    double migrations = 0;
};

Counts countOver(const SwarmScene& scene, const Partition<float>& partition,
                 std::uint64_t samples) {
    constexpr std::uint32_t kFrame = 100;
    Counts counts;
    std::vector<std::uint32_t> before;
    std::vector<std::uint32_t> now;
    for (std::uint64_t i = 0; i < samples; ++i) {
        const std::uint64_t number = drawnNumber(i, samples, scene.count());
        const Aabb<float> boxBefore = scene.box(number, kFrame - 1);
        const Aabb<float> box = scene.box(number, kFrame);
        before.clear();
        now.clear();
        partition.forEachRank(boxBefore, [&](std::uint32_t rank) { before.push_back(rank); });
        partition.forEachRank(box, [&](std::uint32_t rank) { now.push_back(rank); });
        counts.ghosts += static_cast<double>(now.size() - 1);
        counts.newGhosts += static_cast<double>(std::ranges::count_if(now, [&](std::uint32_t rank) {
            return std::ranges::find(before, rank) == before.end();
        }));
        counts.migrations +=
            partition.rankOf(boxBefore.min()) != partition.rankOf(box.min()) ? 1 : 0;
    }
    return counts;
}

/// To how many others ranks send, on average and at most: those whose regions a sphere can reach from theirs.
std::pair<double, double> countNeighbours(const Partition<float>& partition, float side) {
    constexpr std::uint32_t kRanksLookedAt = 512;
    const std::uint32_t step = 1 + partition.rankCount() / kRanksLookedAt;
    double sum = 0;
    double most = 0;
    double looked = 0;
    for (std::uint32_t rank = 0; rank < partition.rankCount(); rank += step) {
        Aabb<float> region = partition.region(rank);
        region.min() = region.min().cwiseMax(0.F) - Vector3<float>::Constant(kStep);
        region.max() = region.max().cwiseMin(side) + Vector3<float>::Constant(kReach);
        double neighbours = -1;  // not itself
        partition.forEachRank(region, [&](std::uint32_t) { ++neighbours; });
        sum += neighbours;
        most = std::max(most, neighbours);
        ++looked;
    }
    return {sum / looked, most};
}

}  // namespace

std::vector<PlanSize> plannedSizes() {
    std::vector<PlanSize> sizes;
    for (const std::uint64_t objects : {10'000'000U, 100'000'000U, 1'000'000'000U}) {
        for (const std::uint32_t ranks : {64U, 256U, 1024U, 4096U, 16384U}) {
            sizes.push_back({objects, ranks});
        }
    }
    return sizes;
}

PlannedFrame planFrame(SwarmKind kind, std::uint64_t seed, const PlanSize& size,
                       const MachineModel& model) {
    const SwarmScene scene(kind, size.objects, seed);
    const std::uint64_t samples =
        std::min(size.objects, std::max(kLeastSamples, kSamplesOfRank * size.ranks));
    std::vector<WeightedPoint<float>> points;
    points.reserve(samples);
    for (std::uint64_t i = 0; i < samples; ++i) {
        points.push_back({scene.box(drawnNumber(i, samples, scene.count()), 0).min(), 1});
    }
    const auto partition = Partition<float>::balanced(size.ranks, points);
    const Counts counts = countOver(scene, partition, samples);
    const double scale =
        static_cast<double>(size.objects) / static_cast<double>(samples) / size.ranks;
    PlannedFrame frame;
    frame.size = size;
    frame.objects = static_cast<double>(size.objects) / size.ranks;
    frame.ghosts = counts.ghosts * scale;
    frame.newGhosts = counts.newGhosts * scale;
    frame.migrations = counts.migrations * scale;
    std::tie(frame.messages, frame.mostMessages) = countNeighbours(partition, scene.side());
    frame.bytes = frame.ghosts * kEntryBytes + frame.newGhosts * (kNewGhostBytes - kEntryBytes) +
                  frame.migrations * kMigrationBytes + frame.messages * kHeadBytes;
    const double aloneMs = frame.objects * model.objectNanoseconds * 1e-6;
    frame.workMs = aloneMs + frame.ghosts * model.ghostNanoseconds * 1e-6;
    // A barrier and two sums; each message is sent by one rank and taken by another.
    const double steps = 3 * std::log2(size.ranks);
    frame.exchangeMs =
        (2 * frame.mostMessages * model.messageMicroseconds + steps * model.stepMicroseconds) *
            1e-3 +
        2 * frame.bytes / model.bytesPerNanosecond * 1e-6;
    frame.efficiency = aloneMs / (frame.workMs + frame.exchangeMs);
    return frame;
}

DataTable planTable(const std::vector<PlannedFrame>& frames) {
    DataTable table;
    table.columns = {{"spheres", "spheres"},
                     {"ranks", "ranks"},
                     {"objects", "spheres a rank"},
                     {"ghosts", "ghosts a rank"},
                     {"surface", "ghosts / spheres^(2/3)"},
                     {"migrations", "moving on"},
                     {"bytes", "KiB sent"},
                     {"messages", "messages"},
                     {"most_messages", "most"},
                     {"work_ms", "work [ms]"},
                     {"exchange_ms", "exchange [ms]"},
                     {"efficiency", "efficiency"}};
    for (const PlannedFrame& frame : frames) {
        table.add({static_cast<double>(frame.size.objects), static_cast<double>(frame.size.ranks),
                   frame.objects, frame.ghosts, frame.ghosts / std::pow(frame.objects, 2.0 / 3),
                   frame.migrations, frame.bytes / 1024, frame.messages, frame.mostMessages,
                   frame.workMs, frame.exchangeMs, frame.efficiency});
    }
    return table;
}

std::vector<std::string> planSentences(const std::vector<PlannedFrame>& frames) {
    std::vector<std::string> sentences;
    for (std::size_t begin = 0; begin < frames.size();) {
        const std::uint64_t objects = frames[begin].size.objects;
        std::uint32_t last = 0;
        std::size_t end = begin;
        for (; end < frames.size() && frames[end].size.objects == objects; ++end) {
            if (frames[end].efficiency >= 0.5) {
                last = frames[end].size.ranks;
            }
        }
        std::string sentence = withThousands(objects) + " spheres: ";
        if (last == frames[end - 1].size.ranks) {
            sentence += "on all these numbers of ranks more than half of the time goes to spheres.";
        } else if (last == 0) {
            sentence += "on none of these numbers of ranks half of the time goes to spheres.";
        } else {
            sentence +=
                "on up to " + withThousands(last) +
                " ranks half of the time goes to spheres; beyond, to what ranks tell each other.";
        }
        sentences.push_back(sentence);
        begin = end;
    }
    return sentences;
}

}  // namespace hashphase::demos

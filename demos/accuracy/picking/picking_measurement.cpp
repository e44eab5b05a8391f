// SPDX-License-Identifier: Zlib
#include <demos/accuracy/picking/picking_experiment.hpp>

#include <demos/accuracy/picking/exact_ray.hpp>
#include <demos/accuracy/timing.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace hashphase::demos {
namespace {

using Entries = std::map<std::uint32_t, Fraction>;  // where a ray enters the boxes that it meets

constexpr std::array kOffsets{-64, -32, -16, -8, -4, -2, -1, 0, 1, 2, 4, 8, 16, 32, 64};  // [ulp]

// Whether the ray comes within about a metre, or a millionth of the coordinates, of the box: slabs in
// double precision, far wider than their error. Keeps the slow integers to the boxes that matter.
bool comesNear(const Ray& ray, const Aabb<float>& box) {
    double enter = 0;
    double leave = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double from = static_cast<double>(ray.from[axis]);
        const double way = static_cast<double>(ray.to[axis]) - from;
        const double margin = 1 + 1e-6 * (std::abs(from) + std::abs(way));
        const double low = static_cast<double>(box.min()[axis]) - margin - from;
        const double high = static_cast<double>(box.max()[axis]) + margin - from;
        if (way == 0) {
            if (low > 0 || high < 0) {
                return false;
            }
            continue;
        }
        enter = std::max(enter, std::min(low / way, high / way));
        leave = std::min(leave, std::max(low / way, high / way));
    }
    return enter <= leave;
}

Entries exactEntries(const Ray& ray, std::span<const Aabb<float>> boxes) {
    const ExactRay exact(ray.from, ray.to);
    Entries entries;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        if (comesNear(ray, boxes[i])) {
            if (const auto entry = exact.entry(boxes[i])) {
                entries.emplace(i, *entry);
            }
        }
    }
    return entries;
}

// What the method puts first against what is entered first, of a ray that meets a box.
void tallyNearest(std::span<const RayHit> hits, const Entries& truth, RayTally& tally) {
    // Far above the rounding of a fraction in single precision.
    constexpr double much = 1e-5;
    tally.raysThatHit = 1;
    if (hits.empty()) {
        tally.noneFound = tally.wrongNearest = tally.farFromNearest = 1;
        return;
    }
    const RayHit& first =
        *std::min_element(hits.begin(), hits.end(), [](const RayHit& a, const RayHit& b) {
            return std::pair(a.fraction, a.object) < std::pair(b.fraction, b.object);
        });
    const auto byEntry = [](const auto& a, const auto& b) { return a.second < b.second; };
    const Fraction nearest = std::min_element(truth.begin(), truth.end(), byEntry)->second;
    const auto found = truth.find(first.object);
    if (found == truth.end()) {
        tally.wrongNearest = 1;  // a false hit is in front
        return;
    }
    tally.wrongNearest = nearest < found->second ? 1 : 0;
    tally.farFromNearest = found->second.value() - nearest.value() > much ? 1 : 0;
}

RayTally tallyOf(std::span<const RayHit> hits, const Entries& truth, const RayCost& cost) {
    RayTally tally;
    tally.rays = 1;
    tally.hits = truth.size();
    std::uint64_t right = 0;
    for (const RayHit& hit : hits) {
        right += truth.contains(hit.object) ? 1 : 0;
    }
    tally.missed = tally.hits - right;
    tally.falsely = hits.size() - right;
    tally.cost = cost;
    if (!truth.empty()) {
        tallyNearest(hits, truth, tally);
    }
    return tally;
}

RayTally tallyOfOne(std::uint32_t box, std::span<const RayHit> hits, const Entries& truth) {
    RayTally tally;
    const bool isFound = std::any_of(hits.begin(), hits.end(),
                                     [box](const RayHit& hit) { return hit.object == box; });
    const bool isHit = truth.contains(box);
    tally.rays = 1;
    tally.hits = isHit ? 1 : 0;
    tally.missed = isHit && !isFound ? 1 : 0;
    tally.falsely = isFound && !isHit ? 1 : 0;
    return tally;
}

using Casters = std::vector<std::unique_ptr<RayCaster>>;

Casters casters(std::span<const RayMethod> methods, std::span<const Aabb<float>> boxes) {
    Casters made;
    for (const RayMethod& method : methods) {
        made.push_back(method.make(boxes));
    }
    return made;
}

std::vector<GrazeRow> graze(const PickingPlan& plan, Random& random,
                            std::span<const RayMethod> methods, const Casters& casters,
                            std::span<const Aabb<float>> boxes) {
    std::vector<GrazeRow> rows;
    std::vector<RayHit> hits;
    for (const Contact contact : kContacts) {
        for (const int ulps : kOffsets) {
            const std::size_t first = rows.size();
            for (const RayMethod& method : methods) {
                rows.push_back({&method, contact, ulps, {}, {}});
            }
            for (int i = 0; i < plan.graze; ++i) {
                const auto box =
                    static_cast<std::uint32_t>(random.unit() * static_cast<float>(boxes.size()));
                const Ray ray = grazingRay(boxes[box], contact, ulps, random);
                const Entries truth = exactEntries(ray, boxes);
                for (std::size_t k = 0; k < methods.size(); ++k) {
                    hits.clear();
                    const RayCost cost = casters[k]->cast(ray, hits);
                    rows[first + k].all += tallyOf(hits, truth, cost);
                    rows[first + k].grazed += tallyOfOne(box, hits, truth);
                }
            }
        }
    }
    return rows;
}

std::vector<Spread> time(const PickingPlan& plan, Random& random, const Casters& casters,
                         std::span<const Aabb<float>> boxes) {
    constexpr int warmUp = 3;
    std::vector<Ray> rays;
    std::vector<RayHit> hits;
    const auto begin = [&](int /*frame*/) {
        rays.clear();
        for (std::size_t i = 0; i < plan.raysPerFrame; ++i) {
            const auto box =
                static_cast<std::size_t>(random.unit() * static_cast<float>(boxes.size()));
            const auto offset = static_cast<std::size_t>(random.unit() * kOffsets.size());
            rays.push_back(
                grazingRay(boxes[box], kContacts[i % kContacts.size()], kOffsets[offset], random));
        }
    };
    std::vector<std::function<void()>> runs;
    for (const auto& caster : casters) {
        runs.emplace_back([&] {
            for (const Ray& ray : rays) {
                hits.clear();
                caster->cast(ray, hits);
            }
        });
    }
    return timeInTurn(plan.frames, warmUp, begin, runs);
}

// Fewer where each takes long.
std::size_t rayCount(double length, double metresInAll) {
    constexpr double most = 200;
    return static_cast<std::size_t>(std::clamp(metresInAll / length, 1.0, most));
}

void cast(double length, const PickingPlan& plan, std::uint64_t seed,
          std::span<const RayMethod> methods, std::vector<LengthRow>& rows) {
    const std::size_t rays = rayCount(length, plan.metresInAll);
    const StrungBoxes scene =
        strungBoxes(length, rays, std::max<std::size_t>(plan.strungBoxes / rays, 1), seed);
    std::vector<Entries> truth;
    for (const Ray& ray : scene.rays) {
        truth.push_back(exactEntries(ray, scene.boxes));
    }
    std::vector<RayHit> hits;
    for (const RayMethod& method : methods) {
        if (method.walksCells && length > plan.longestCellWalk) {
            continue;
        }
        LengthRow row{&method, length, {}};
        const auto caster = method.make(scene.boxes);
        for (std::size_t i = 0; i < scene.rays.size(); ++i) {
            hits.clear();
            const RayCost cost = caster->cast(scene.rays[i], hits);
            row.all += tallyOf(hits, truth[i], cost);
        }
        rows.push_back(row);
    }
}

}  // namespace

RayTally& RayTally::operator+=(const RayTally& other) {
    rays += other.rays;
    hits += other.hits;
    missed += other.missed;
    falsely += other.falsely;
    raysThatHit += other.raysThatHit;
    noneFound += other.noneFound;
    wrongNearest += other.wrongNearest;
    farFromNearest += other.farFromNearest;
    cost.cells += other.cost.cells;
    cost.boxes += other.cost.boxes;
    return *this;
}

PickingMeasurement measurePicking(const PickingPlan& plan, std::uint64_t seed,
                                  std::span<const RayMethod> methods, const TellProgress& tell) {
    PickingMeasurement measured;
    Random random(seed + 1);
    tell(0, "grazing rays");
    const std::vector<Aabb<float>> boxes = slabOfBoxes(plan.boxes, seed);
    const Casters made = casters(methods, boxes);
    measured.grazes = graze(plan, random, methods, made, boxes);
    tell(0.4, "times");
    measured.milliseconds = time(plan, random, made, boxes);
    for (int power = 0; power <= plan.longestPower; ++power) {
        tell(0.5 + 0.05 * power, "rays of 10^" + std::to_string(power) + " cells");
        cast(std::pow(10, power), plan, seed, methods, measured.lengths);
    }
    return measured;
}

}  // namespace hashphase::demos

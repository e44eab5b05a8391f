// SPDX-License-Identifier: Zlib
#include <demos/accuracy/picking/picking_experiment.hpp>

#include <demos/accuracy/exact_entry.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace hashphase::demos {
namespace {

constexpr std::string_view kPickingDeclaration =
#include <demos/accuracy/picking/picking.sql>
    ;

constexpr std::array kOffsets{-64, -32, -16, -8, -4, -2, -1, 0, 1, 2, 4, 8, 16, 32, 64};  // [ulp]

constexpr std::array kContactNames{"face", "edge", "corner"};

using Boxes = std::span<const Aabb<float>>;
using Entries = std::map<std::uint32_t, Fraction>;  // where a ray enters the boxes that it meets

Entries exactEntries(const Ray& ray, Boxes boxes) {
    const ExactRay exact(ray.from, ray.to);
    Entries entries;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        if (const auto entry = exact.entry(boxes[i])) {
            entries.emplace(i, *entry);
        }
    }
    return entries;
}

/// How much later than the nearest box the ray meets the one that the method puts first, as a share
/// of the ray; nothing where it meets none, or not that one.
std::optional<double> lateness(std::span<const RayHit> hits, const Entries& truth) {
    const auto first = std::min_element(hits.begin(), hits.end(), [](const auto& a, const auto& b) {
        return std::pair(a.fraction, a.object) < std::pair(b.fraction, b.object);
    });
    const auto found = first != hits.end() ? truth.find(first->object) : truth.end();
    if (found == truth.end()) {
        return std::nullopt;
    }
    const auto nearest =
        std::min_element(truth.begin(), truth.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    return found->second - nearest->second;
}

/// A ray, why it is cast, and what it meets.
struct KnownRay {
    Ray ray;
    Entries truth;
    Datum length;   // [m], of long ones
    Datum contact;  // of those that graze a box
    Datum ulps;
    std::optional<std::uint32_t> box;
};

void judge(const RayMethod& method, const RayCaster& cast, const KnownRay& known,
           Measurements& measured) {
    std::vector<RayHit> hits;
    const RayCost cost = cast(known.ray, hits);
    const auto right =
        static_cast<std::size_t>(std::count_if(hits.begin(), hits.end(), [&](const RayHit& hit) {
            return known.truth.contains(hit.object);
        }));
    measured.add("rays", {{"method", method.name},
                          {"length", known.length},
                          {"contact", known.contact},
                          {"ulps", known.ulps},
                          {"hits", known.truth.size()},
                          {"missed", known.truth.size() - right},
                          {"falsely", hits.size() - right},
                          {"late", lateness(hits, known.truth)},
                          {"box_hit", known.box && known.truth.contains(*known.box)},
                          {"box_found",
                           std::any_of(hits.begin(), hits.end(),
                                       [&](const auto& hit) { return hit.object == known.box; })},
                          {"cells", cost.cells},
                          {"boxes", cost.boxes}});
}

/// A random ray near a random box, and which box that is.
std::pair<Ray, std::uint32_t> randomGraze(Boxes boxes, Contact contact, std::optional<int> ulps,
                                          Random& random) {
    const auto box = static_cast<std::uint32_t>(random.unit() * static_cast<float>(boxes.size()));
    if (!ulps) {
        ulps = kOffsets[static_cast<std::size_t>(random.unit() * kOffsets.size())];
    }
    return {grazingRay(boxes[box], contact, *ulps, random), box};
}

void graze(const PickingPlan& plan, Random& random, std::span<const RayMethod> methods,
           std::span<const RayCaster> casters, Boxes boxes, Measurements& measured) {
    for (const Contact contact : kContacts) {
        for (const int ulps : kOffsets) {
            for (int i = 0; i < plan.graze; ++i) {
                const auto [ray, box] = randomGraze(boxes, contact, ulps, random);
                const KnownRay known{ray,  exactEntries(ray, boxes),
                                     {},   kContactNames[static_cast<std::size_t>(contact)],
                                     ulps, box};
                for (std::size_t k = 0; k < methods.size(); ++k) {
                    judge(methods[k], casters[k], known, measured);
                }
            }
        }
    }
}

void time(const PickingPlan& plan, Random& random, std::span<const RayMethod> methods,
          std::span<const RayCaster> casters, Boxes boxes, Measurements& measured) {
    std::vector<Ray> rays;
    std::vector<RayHit> hits;
    std::vector<TimedMethod> timed;
    for (std::size_t i = 0; i < methods.size(); ++i) {
        timed.push_back({{{"method", methods[i].name}}, [&, &cast = casters[i]] {
                             for (const Ray& ray : rays) {
                                 hits.clear();
                                 cast(ray, hits);
                             }
                         }});
    }
    const auto begin = [&](int /*frame*/) {
        rays.clear();
        for (std::size_t i = 0; i < plan.raysPerFrame; ++i) {
            rays.push_back(
                randomGraze(boxes, kContacts[i % kContacts.size()], std::nullopt, random).first);
        }
    };
    measureTimes(measured, {plan.frames, 3}, begin, timed);
}

void castFar(double length, const PickingPlan& plan, std::uint64_t seed,
             std::span<const RayMethod> methods, Measurements& measured) {
    constexpr double most = 200;  // rays; fewer where each takes long
    const auto count = static_cast<std::size_t>(std::clamp(plan.metresInAll / length, 1.0, most));
    const StrungBoxes scene =
        strungBoxes(length, count, std::max<std::size_t>(plan.strungBoxes / count, 1), seed);
    std::vector<KnownRay> rays;
    for (const Ray& ray : scene.rays) {
        rays.push_back({ray, exactEntries(ray, scene.boxes), length, {}, {}, {}});
    }
    for (const RayMethod& method : methods) {
        if (!method.is("walks_cells") || length <= plan.longestCellWalk) {
            const RayCaster cast = method.make(scene.boxes);
            for (const KnownRay& ray : rays) {
                judge(method, cast, ray, measured);
            }
        }
    }
}

}  // namespace

Findings findPicking(const PickingPlan& plan, std::uint64_t seed,
                     std::span<const RayMethod> methods, const TellProgress& tell) {
    Measurements measured;
    measured.add("plan", {{"boxes", plan.boxes},
                          {"rays_per_frame", plan.raysPerFrame},
                          {"longest_cell_walk", plan.longestCellWalk},
                          {"seed", seed}});
    const std::vector<Aabb<float>> boxes = slabOfBoxes(plan.boxes, seed);
    addMethods(methods, {"must_find_all", "nearest_only"}, measured);
    std::vector<RayCaster> casters;
    for (const RayMethod& method : methods) {
        casters.push_back(method.make(boxes));
    }
    Random random(seed + 1);
    tell(0, "grazing rays");
    graze(plan, random, methods, casters, boxes, measured);
    tell(0.4, "times");
    time(plan, random, methods, casters, boxes, measured);
    for (int power = 0; power <= plan.longestPower; ++power) {
        tell(0.5 + 0.05 * power, "rays of 10^" + std::to_string(power) + " cells");
        castFar(std::pow(10, power), plan, seed, methods, measured);
    }
    return findingsOf(kPickingDeclaration, measured);
}

Experiment pickingExperiment() {
    return {"P5",
            "Picking rays",
            "How many boxes do grazing rays and long rays miss?",
            3,
            60,
            [](const Effort& effort, const TellProgress& tell) {
                const PickingPlan plan{5000,
                                       effort.quickOrFull(60, 600),
                                       kFewestFrames,
                                       effort.quickOrFull<std::size_t>(50, 500),
                                       effort.quickOrFull<std::size_t>(1000, 4000),
                                       8,
                                       effort.quickOrFull(1e6, 1e7),
                                       effort.quickOrFull(1e5, 1e8)};
                return findPicking(plan, effort.seed, rayMethods(), tell);
            }};
}

}  // namespace hashphase::demos

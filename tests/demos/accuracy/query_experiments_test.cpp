// SPDX-License-Identifier: Zlib
//
// The experiments on culling, picking and terrain, at a tiny size.

#include <demos/accuracy/culling/culling_experiment.hpp>
#include <demos/accuracy/picking/picking_experiment.hpp>
#include <demos/accuracy/terrain/terrain_experiment.hpp>
#include <tests/demos/accuracy/experiment_faults.hpp>

#include <memory>

namespace hashphase::demos {
namespace {

Findings culling(const std::vector<CullingMethod>& methods = cullingMethods()) {
    return findCulling({.objects = 300, .touching = 20, .flights = 1, .frames = 2}, 1, methods,
                       ignoreProgress);
}

Findings picking(const std::vector<RayMethod>& methods = rayMethods()) {
    return findPicking({.boxes = 200,
                        .graze = 4,
                        .frames = 2,
                        .raysPerFrame = 5,
                        .strungBoxes = 100,
                        .longestPower = 4,
                        .metresInAll = 1e4,
                        .longestCellWalk = 1e3},
                       1, methods, ignoreProgress);
}

Findings terrain(const std::vector<GroundMethod>& methods = groundMethods()) {
    return findTerrain({.spheres = 3, .points = 100, .frames = 2, .spheresPerFrame = 20}, 1,
                       methods, ignoreProgress);
}

/// Draws none of some objects.
Culling forgetful(const Culling& culling) {
    return {culling.look, [draws = culling.draws](std::uint32_t object) {
                return object % 8 != 0 && draws(object);
            }};
}
Culling drawingAll(const Culling& culling) {
    return {culling.look, [](std::uint32_t) { return true; }};
}

/// Changes what a caster finds: change(hits).
template <class Change>
auto changingHits(const Change& change) {
    return [change](const RayCaster& cast) {
        return [=](const Ray& ray, std::vector<RayHit>& hits) {
            const RayCost cost = cast(ray, hits);
            change(hits);
            return cost;
        };
    };
}

/// The findings of a method alone of which change() gets what it finds for each eighth sphere.
template <class Change>
Findings standing(std::string_view name, const Change& change) {
    return terrain({with(
        [change](const GroundFinder& find) {
            return [=](const SphereBatch& spheres, std::span<std::optional<Standing>> found) {
                find(spheres, found);
                for (std::size_t i = 0; i < found.size(); i += 8) {
                    if (found[i]) {
                        change(found[i]);
                    }
                }
            };
        },
        named(groundMethods(), name))});
}

Findings raised(std::string_view name, float by) {
    return standing(name, [by](std::optional<Standing>& found) { found->height += by; });
}

TEST(QueryExperiments, HoldForEveryMethod) {
    expectHold({{"P4", culling(), {13, 4, 0, 0}},
                {"P5", picking(), {6, 7, 17, 9}},
                {"P9", terrain(), {7, 4, 21, 0}}});
}

TEST(QueryExperiments, NoticeABrokenMethod) {
    const CullingMethod exactCulling = named(cullingMethods(), "ConvexRegion exact");
    const RayMethod gridRays = named(rayMethods(), "Grid::visit(RayRegion)");
    expectNoticed({
        {"visible objects are not drawn",
         [=] { return culling({with(forgetful, exactCulling)}); },
         {"draws every visible object", "only touch the view"}},
        {"an exact method draws needlessly",
         [=] { return culling({with(drawingAll, exactCulling)}); },
         {"draws no invisible object"}},
        {"each eighth hit is missed",
         [=] {
             return picking(
                 {with(changingHits([number = std::make_shared<int>(0)](std::vector<RayHit>& hits) {
                           if (++*number % 8 == 0 && !hits.empty()) {
                               hits.pop_back();
                           }
                       }),
                       gridRays)});
         },
         {"misses no box", "puts the nearest box first"}},
        {"the farthest box is put first",
         [=] {
             return picking({with(changingHits([](std::vector<RayHit>& hits) {
                                      for (RayHit& hit : hits) {
                                          hit.fraction = 1 - hit.fraction;
                                      }
                                  }),
                                  gridRays)});
         },
         {"puts the nearest box first"}},
        {"spheres are in the ground",
         [] { return raised("Terrain, one by one", -0.01F); },
         {"touch"}},
        {"spheres are above it", [] { return raised("Terrain, one by one", 0.01F); }, {"touch"}},
        {"ground is not found",
         [] {
             return standing("Terrain, one by one",
                             [](std::optional<Standing>& found) { found.reset(); });
         },
         {"finds ground"}},
        {"ground is found elsewhere",
         [] {
             return standing("Terrain, one by one",
                             [](std::optional<Standing>& found) { *found->triangle ^= 64; });
         },
         {"finds ground"}},
        {"spheres leave the line of theory",
         [] { return raised("paper: height + r", 0.1F); },
         {"depth is r"}},
    });
}

TEST(CullingExperiment, SaysInWhichSettingMostIsLost) {
    const Findings findings = culling();
    std::pair<double, std::string> worst;
    for (const std::vector<Value>& row : findings.charts.at(0).data.rows) {
        if (valueText(row.at(1)) == "paper: two corners") {
            worst = std::max(worst, {std::get<double>(row.at(2)), valueText(row.at(0))});
        }
    }
    EXPECT_EQ(findings.conclusions.at(0), "paper: two corners loses up to " +
                                              valueText(worst.first) +
                                              " % of the visible objects (" + worst.second + ").");
}

}  // namespace
}  // namespace hashphase::demos

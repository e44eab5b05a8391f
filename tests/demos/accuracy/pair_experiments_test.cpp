// SPDX-License-Identifier: Zlib
//
// The experiments on pairs and neighbours, at a tiny size.

#include <demos/accuracy/origin/origin_experiment.hpp>
#include <demos/accuracy/pairs/pair_experiments.hpp>
#include <demos/accuracy/proximity/proximity_experiment.hpp>
#include <demos/accuracy/sweeps/sweep_experiment.hpp>
#include <tests/demos/accuracy/experiment_faults.hpp>

#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>

namespace hashphase::demos {
namespace {

Findings origin(const std::vector<OriginMethod>& methods = originMethods(),
                const std::vector<SettleMethod>& settling = settleMethods()) {
    return findOrigin({{0, 0x1p20, 0x1p30}, 150, 20}, 1, methods, settling, ignoreProgress);
}

using ChangePairs = std::function<void(std::vector<PairMethod>&)>;

void changeNothing(std::vector<PairMethod>& /*methods*/) {}

Findings cellSizes(const ChangePairs& change = changeNothing) {
    const std::vector<double> factors{0.5, 2, 16};
    const std::vector<CellCase> cases{{"uniform", {}, 150, factors},
                                      {"sizes", {SizeLaw::logUniform, 100}, 150, factors}};
    const CellMethods methods = [&](const CellCase& each, std::span<const BulletBox> boxes,
                                    double meanEdge) {
        std::vector<PairMethod> all = cellMethods(each, boxes, meanEdge);
        change(all);
        return all;
    };
    return measureCellSizes(cases, methods, 1, ignoreProgress);
}

Findings updates(const ChangePairs& change = changeNothing) {
    std::vector<PairMethod> policies = updatePolicies();
    change(policies);
    return measurePolicies({200, {{0}, {0.05}, {1}, {1, 0.2}}, {8, 2, 8}}, policies, 1,
                           ignoreProgress);
}

ProximityPlan tinyProximity() {
    ProximityPlan plan;
    plan.crowds = {{"a few agents", 300, 5}, {"a few agents", 300, 5, 5, 4, false}};
    plan.rounds = 2;
    plan.statedEstimates = 100;
    return plan;
}

Findings proximity(const std::vector<NeighbourMethod>& methods = neighbourMethods()) {
    return measureProximity(tinyProximity(), methods, 1, ignoreProgress);
}

Findings sweeps(const std::vector<SweepMethod>& methods = sweepMethods()) {
    return findSweeps({{0.001, 0.1}, {0.3, 1, 3, 30}, 40, 1, 400, 40, {{3, 8}}, 2}, 1, methods,
                      ignoreProgress);
}

/// The last pair and the last hit are lost.
OriginWorld lossy(const OriginWorld& world) {
    return {world.set,
            [list = world.listPairs](std::vector<PairKey>& pairs) {
                list(pairs);
                pairs.pop_back();
            },
            [list = world.listHits](const WorldRay& ray, std::vector<std::uint32_t>& boxes) {
                list(ray, boxes);
                boxes.resize(std::max<std::size_t>(boxes.size(), 1) - 1);
            }};
}

/// Bodies fall through each other.
class Blind final : public btSimpleBroadphase {
public:
    explicit Blind(btOverlappingPairCache* cache) : btSimpleBroadphase(100, cache) {}
    void calculateOverlappingPairs(btDispatcher* /*dispatcher*/) override {}
};

/// In all worlds but the first, the last of the methods is blind.
std::vector<SettleMethod> blindFarAway() {
    std::vector<SettleMethod> settling = settleMethods();
    settling.back().broadphase.make =
        [number = 0, make = settling.back().broadphase.make](PairCache* cache) mutable {
            return ++number == 1 ? make(cache) : std::make_unique<Blind>(cache);
        };
    return settling;
}

/// Of the pairs of another one, one is lost in every frame, or invented.
auto broken(bool misses) {
    return [misses](const PairSource& source) {
        return PairSource{source.step, [=](std::vector<PairKey>& pairs) {
                              source.listPairs(pairs);
                              if (misses) {
                                  pairs.pop_back();
                              } else {
                                  pairs.push_back(pairKey(0xfffffffe, 0xffffffff));
                              }
                          }};
    };
}

/// Breaks the first method that is so; of the paper's all.
ChangePairs breaking(bool misses, bool (*isSo)(const PairMethod& method)) {
    return [=](std::vector<PairMethod>& methods) {
        for (PairMethod& method : methods) {
            if (isSo(method)) {
                method = with(broken(misses), method);
                if (!method.is("paper")) {
                    return;
                }
            }
        }
    };
}
bool isLevels(const PairMethod& method) {
    return method.name == "levels";
}
bool isByCorners(const PairMethod& method) {
    return method.is("paper") && !method.is("exact");
}
bool isExact(const PairMethod& method) {
    return method.is("exact");
}
bool isOnlyComplete(const PairMethod& method) {
    return method.is("complete") && !method.is("exact");
}

/// Leaves out the last neighbour of each agent, in lists and decisions.
NeighbourSearch forgettingSearch(const NeighbourSearch& search) {
    return {search.take, [=](NeighbourSearch::Visit visit) {
                search.forEach([&](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
                    visit(agent, neighbours.first(std::max<std::size_t>(neighbours.size(), 1) - 1));
                });
            }};
}

std::vector<NeighbourMethod> forgetting(std::string_view name) {
    std::vector<NeighbourMethod> methods = neighbourMethods();
    NeighbourMethod& method = *std::ranges::find(methods, name, &NeighbourMethod::name);
    method = with(forgettingSearch, method);
    return methods;
}

/// Lists what another one does, but for every 50th pair, or as many that nobody has.
auto careless(bool drops) {
    return [drops](const SweepFinder& careful) {
        return SweepFinder{careful.step, [=, number = 0](std::vector<PairKey>& pairs) mutable {
                               std::vector<PairKey> all;
                               const std::optional<SweepWork> work = careful.listPairs(all);
                               for (const PairKey pair : all) {
                                   const bool isNext = ++number % 50 == 0;
                                   if (!isNext || !drops) {
                                       pairs.push_back(pair);
                                   }
                                   if (isNext && !drops) {
                                       pairs.push_back(pairKey(0, 1'000'000));
                                   }
                               }
                               return work;
                           }};
    };
}

/// Tells times in single precision, or none.
auto tellingTimes(bool tells) {
    return [tells](SweepFinder finder) {
        finder.contactTime = [tells](const MovingBox<float>& a, const MovingBox<float>& b) {
            const std::optional<double> time = firstContact(a, b);
            return time && tells ? std::optional(static_cast<double>(static_cast<float>(*time)))
                                 : std::nullopt;
        };
        return finder;
    };
}

SweepMethod sweep(std::string_view name) {
    return named(sweepMethods(), name);
}

TEST(PairExperiments, HoldForEveryMethod) {
    expectHold({{"P1", sweeps(), {5, 3, 7, 3}},
                {"P2", cellSizes()},
                {"P3", proximity()},
                {"P6", origin(), {13, 5, 15, 10}},
                {"P10", updates()}});
}

TEST(PairExperiments, NoticeABrokenMethod) {
    expectNoticed({
        {"a sweep drops contacts",
         [] {
             return sweeps({sweep("discrete (Sweep::none)"), sweep("Sweep::box"),
                            with(careless(true), sweep("Sweep::line"))});
         },
         {"miss none", "the same pairs"}},
        {"a sweep invents contacts",
         [] {
             return sweeps({sweep("discrete (Sweep::none)"), sweep("Sweep::box"),
                            with(careless(false), sweep("Sweep::line"))});
         },
         {"list no other", "the same pairs"}},
        {"a sweep looks at the end alone",
         [] { return sweeps({promising("misses_nothing", sweep("discrete (Sweep::none)"))}); },
         {"miss none"}},
        {"a discrete method is beside the theory",
         [] { return sweeps({promising("discrete", sweep("Sweep::automatic"))}); },
         {"lies on the line"}},
        {"times are not quite true",
         [] {
             return sweeps({sweep("discrete (Sweep::none)"),
                            with(tellingTimes(true), sweep("Sweep::automatic"))});
         },
         {"Times"}},
        {"times are not told",
         [] {
             return sweeps({sweep("discrete (Sweep::none)"),
                            with(tellingTimes(false), sweep("Sweep::automatic"))});
         },
         {"Times"}},
        {"a cell size misses",
         [] { return cellSizes(breaking(true, isLevels)); },
         {"Every exact method"}},
        {"a cell size invents",
         [] { return cellSizes(breaking(false, isLevels)); },
         {"Every exact method"}},
        {"corners of large cells miss",
         [] { return cellSizes(breaking(true, isByCorners)); },
         {"corner"}},
        {"an exact policy invents",
         [] { return updates(breaking(false, isExact)); },
         {"Every exact method"}},
        // Where nothing moves as well.
        {"an exact policy misses",
         [] { return updates(breaking(true, isExact)); },
         {"Every exact method", "move"}},
        {"a complete policy misses",
         [] { return updates(breaking(true, isOnlyComplete)); },
         {"may list false pairs", "move"}},
        {"an exact search forgets",
         [] { return proximity(forgetting("RarestColour, all at once")); },
         {"Exact methods find"}},
        {"a complete search forgets",
         [] { return proximity(forgetting("cells and boxes")); },
         {"Cells, with"}},
        {"an estimate forgets",
         [] { return proximity(forgetting("estimateWithin")); },
         {"Cells, with"}},
        {"a pair and a hit are lost far away",
         [] {
             return origin({with(lossy, named(originMethods(), "integer cell + local float")),
                            named(originMethods(), "double")});
         },
         {"integer cell + local float finds the same pairs at every distance (",
          "integer cell + local float misses no hit",
          "integer cell + local float finds the same pairs at every distance in"}},
        {"balls rest elsewhere",
         [] { return origin(originMethods(), blindFarAway()); },
         {"Bullet in float, hashphase, origin shifted: balls rest"}},
    });
}

TEST(ProximityExperiment, RefusesASquareThatIsTooSmallForTheCells) {
    ProximityPlan plan = tinyProximity();
    plan.crowds.front().radiusByCell = 0.1;
    EXPECT_THROW(static_cast<void>(measureProximity(plan, neighbourMethods(), 1, ignoreProgress)),
                 std::invalid_argument);
}

}  // namespace
}  // namespace hashphase::demos

// SPDX-License-Identifier: Zlib

// The paper's way: Hastings, Mesit, Guha, "Optimization of Large-Scale, Real-Time Simulations by
// Spatial Hashing", "AI and Decision Making".

#include <demos/accuracy/proximity/proximity_experiment.hpp>

#include <broadphase/cells_region.hpp>
#include <broadphase/position_region.hpp>
#include <broadphase/radius_search.hpp>
#include <demos/accuracy/baselines/paper_map.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/rarest_colour.hpp>

#include <algorithm>
#include <limits>

namespace hashphase::demos {

std::uint32_t rarestOf(const ColourCounts& counts) {
    return static_cast<std::uint32_t>(std::min_element(counts.begin(), counts.end()) -
                                      counts.begin());
}

namespace {

using Visit = NeighbourSearch::Visit;
using Colours = std::span<const std::uint32_t>;
using Chosen = std::span<std::uint32_t>;
using Found = std::vector<std::uint32_t>;

// --- Of the library ------------------------------------------------------------------------------

/// Agents in a grid of their own, in which ProxyId::index is an agent's number: a new grid counts from 0.
struct FiledAgents {
    explicit FiledAgents(const NeighbourNeeds& needs)
        : radius(needs.radius), grid(GridConfig{.cellSize = static_cast<double>(needs.cellSize)}) {}

    void take(const AgentFrame& frame) {
        for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
            if (ids.size() <= i) {
                ids.push_back(grid.add(frame.boxes[i]));
            } else {
                grid.move(ids[i], frame.boxes[i]);
            }
        }
        grid.update();
    }

    /// Calls ask(id, position) for every agent.
    template <class Ask>
    void forEach(const Ask& ask) const {
        for (const ProxyId id : ids) {
            ask(id, positionOf(grid.box(id)));
        }
    }

    float radius;
    Grid<float> grid;
    std::vector<ProxyId> ids;  // by agent
};

/// RarestColour, which counts exactly; its lists are those of RadiusSearch.
NeighbourSearch rarestColour(const NeighbourNeeds& needs) {
    struct Filed : FiledAgents {
        using FiledAgents::FiledAgents;
        RarestColour<float> rarest;
        RadiusSearch<float> search;
        Found found;
    };
    const auto filed = std::make_shared<Filed>(needs);
    return {[=](const AgentFrame& frame) { filed->take(frame); },
            [=](Visit visit) {
                RadiusSearch<float>& search = filed->search;
                search.take(filed->grid, filed->radius);
                search.forEach([&](std::uint32_t agent, Colours neighbours) {
                    filed->found.clear();
                    for (const std::uint32_t neighbour : neighbours) {
                        filed->found.push_back(search.id(neighbour).index);
                    }
                    visit(search.id(agent).index, filed->found);
                });
            },
            [=](Colours colours, Chosen chosen) {
                std::copy(colours.begin(), colours.end(), chosen.begin());
                filed->rarest.update(filed->grid, filed->radius, ColourCounts().size(), chosen);
            }};
}

/// Decides from the lists of RadiusSearch.
NeighbourSearch radiusLists(const NeighbourNeeds& needs) {
    NeighbourSearch search = rarestColour(needs);
    search.decide = {};
    return search;
}

/// RarestColour in each period-th frame: its grid keeps the state of then, and its decisions stand.
NeighbourSearch staleSearch(const NeighbourNeeds& needs, int period) {
    struct State {
        int frame = 0;
        bool isDue = false;
        Found decided;
    };
    const NeighbourSearch fresh = rarestColour(needs);
    const auto state = std::make_shared<State>();
    return {[=](const AgentFrame& frame) {
                state->isDue = state->frame++ % period == 0;
                if (state->isDue) {
                    fresh.take(frame);
                }
            },
            fresh.forEach,
            [=](Colours colours, Chosen chosen) {
                if (state->isDue) {
                    state->decided.resize(chosen.size());
                    fresh.decide(colours, state->decided);
                }
                std::copy(state->decided.begin(), state->decided.end(), chosen.begin());
            }};
}

/// Agent by agent: find(grid, position, radius, self, found) lists an agent's neighbours.
template <class Find>
NeighbourSearch agentByAgent(const std::shared_ptr<FiledAgents>& filed, Find find) {
    return {[=](const AgentFrame& frame) { filed->take(frame); },
            [=, found = Found()](Visit visit) mutable {
                filed->forEach([&](ProxyId self, const Vector3<float>& position) {
                    found.clear();
                    find(filed->grid, position, filed->radius, self, found);
                    visit(self.index, found);
                });
            }};
}

using ProximityFunction = QueryCost (*)(const Grid<float>&, const Vector3<float>&, float,
                                        std::vector<ProxyId>&, ProxyFilter, ProxyId);

/// One of the functions of integration/ai/proximity.hpp.
template <ProximityFunction function>
struct Listed {
    std::vector<ProxyId> ids;

    void operator()(const Grid<float>& grid, const Vector3<float>& position, float radius,
                    ProxyId self, Found& found) {
        function(grid, position, radius, ids, acceptAll, self);
        for (const ProxyId id : ids) {
            found.push_back(id.index);
        }
    }
};

/// Lists all but the agent itself, and ends the search after `most`.
struct CollectAgents {
    Found& found;
    std::uint32_t self;
    std::size_t most = std::numeric_limits<std::size_t>::max();

    void add(ProxyId id, float /*key*/) {
        if (id.index != self) {
            found.push_back(id.index);
        }
    }
    [[nodiscard]] double limit() const {
        return found.size() < most ? std::numeric_limits<double>::infinity() : -1;
    }
};

/// Whose boxes touch the ball's box.
struct TouchingBoxes {
    void operator()(const Grid<float>& grid, const Vector3<float>& position, float radius,
                    ProxyId self, Found& found) const {
        CollectAgents collector{found, self.index};
        grid.visit(BoxRegion<float>{PositionRegion<float>(position, radius).bounds()}, collector);
    }
};

/// The first within the radius that are found.
struct FirstFew {
    std::size_t most;

    void operator()(const Grid<float>& grid, const Vector3<float>& position, float radius,
                    ProxyId self, Found& found) const {
        CollectAgents collector{found, self.index, most};
        grid.visit(PositionRegion<float>(position, radius), collector);
    }
};

/// Counts the colours of all but the agent itself.
struct CollectColours {
    std::span<const std::uint32_t> colours;
    std::uint32_t self;
    ColourCounts counts{};

    void add(ProxyId id, float /*key*/) { counts[colours[id.index]] += id.index != self ? 1 : 0; }
    [[nodiscard]] static constexpr double limit() {
        return std::numeric_limits<double>::infinity();
    }
};

/// As estimateWithin(), but those whom it would list are only counted.
NeighbourSearch countedCells(const NeighbourNeeds& needs) {
    const auto filed = std::make_shared<FiledAgents>(needs);
    NeighbourSearch search = agentByAgent(filed, Listed<estimateWithin<float>>());
    search.decide = [=](Colours colours, Chosen chosen) {
        const Grid<float>& grid = filed->grid;
        filed->forEach([&](ProxyId self, const Vector3<float>& position) {
            CollectColours collector{colours, self.index};
            grid.visit(CellsRegion<float>(position, filed->radius, grid.cellSize()), collector);
            chosen[self.index] = rarestOf(collector.counts);
        });
    };
    return search;
}

// --- Of others -----------------------------------------------------------------------------------

/// An agent lies in the buckets of all cells that its box touches (no cell is smaller than an
/// agent: these are its corners'), and is counted as often as it is met. The indices are clamped
/// to the map, which the printed loop leaves at its borders.
NeighbourSearch paperProximity(const NeighbourNeeds& needs) {
    struct Filed {
        PaperMap map;
        std::span<const Aabb<float>> boxes;
        Found found;
    };
    const auto filed = std::make_shared<Filed>(Filed{{needs.bounds, needs.cellSize}, {}, {}});
    const int offset = static_cast<int>(needs.radius / needs.cellSize);
    return {[=](const AgentFrame& frame) {
                filed->boxes = frame.boxes;
                filed->map.refile(frame.boxes);
            },
            [=](Visit visit) {
                auto& [map, boxes, found] = *filed;
                const PaperMap::Range all = map.all();
                for (std::uint32_t agent = 0; agent < boxes.size(); ++agent) {
                    const Vector3<float> centre = boxes[agent].center();
                    const PaperMap::Cell base = map.cellAt(centre.x(), centre.z());
                    const PaperMap::Range cells{std::max(0, base.x - offset),
                                                std::max(0, base.z - offset),
                                                std::min(all.highX, base.x + offset - 1),
                                                std::min(all.highZ, base.z + offset - 1)};
                    found.clear();
                    forEachCell(cells, [agent, &map = map, &found = found](int x, int z) {
                        const auto bucket = map.objects(x, z);
                        std::copy_if(bucket.begin(), bucket.end(), std::back_inserter(found),
                                     [agent](std::uint32_t other) { return other != agent; });
                    });
                    visit(agent, found);
                }
            }};
}

btVector3 centreOf(const BulletBox& box) {
    return (box.min + box.max) / 2;
}

NeighbourSearch bulletProximity(const NeighbourNeeds& needs) {
    struct Filed {
        explicit Filed(const NeighbourNeeds& needs)
            : radius(needs.radius),
              broadphase(broadphaseKind("dbvt-deferred"), {needs.bounds, needs.agents, {}}) {}

        btScalar radius;
        FilledBroadphase broadphase;
        std::span<const BulletBox> boxes;
        Found found;
    };
    struct Near : btBroadphaseAabbCallback {
        Near(Filed& all, std::uint32_t agent)
            : filed(all), self(agent), centre(centreOf(all.boxes[agent])) {}

        bool process(const btBroadphaseProxy* proxy) override {
            const std::uint32_t other = FilledBroadphase::objectOf(*proxy);
            const btVector3 way = centreOf(filed.boxes[other]) - centre;
            if (other != self && way.length2() <= filed.radius * filed.radius) {
                filed.found.push_back(other);
            }
            return true;
        }

        Filed& filed;
        std::uint32_t self;
        btVector3 centre;
    };
    const auto filed = std::make_shared<Filed>(needs);
    return {[=](const AgentFrame& frame) {
                if (filed->boxes.empty()) {
                    for (std::uint32_t agent = 0; agent < frame.bulletBoxes.size(); ++agent) {
                        filed->broadphase.create(agent, frame.bulletBoxes[agent], {});
                    }
                } else {
                    filed->broadphase.setAll(frame.bulletBoxes);
                }
                filed->boxes = frame.bulletBoxes;
            },
            [=](Visit visit) {
                const btVector3 reach(filed->radius, filed->radius, filed->radius);
                for (std::uint32_t agent = 0; agent < filed->boxes.size(); ++agent) {
                    filed->found.clear();
                    Near near(*filed, agent);
                    filed->broadphase.broadphase().aabbTest(near.centre - reach,
                                                            near.centre + reach, near);
                    visit(agent, filed->found);
                }
            }};
}

}  // namespace

std::vector<NeighbourMethod> neighbourMethods() {
    const auto oneByOne = [](const auto& find) {
        return [find](const NeighbourNeeds& needs) {
            return agentByAgent(std::make_shared<FiledAgents>(needs), find);
        };
    };
    const auto stale = [](int period) {
        return [period](const NeighbourNeeds& needs) { return staleSearch(needs, period); };
    };
    return {
        {"RarestColour, all at once", "ours exact", rarestColour},
        {"RadiusSearch, listed", "ours exact", radiusLists},
        {"findWithin", "ours exact uses_cells", oneByOne(Listed<findWithin<float>>())},
        {"cells and boxes", "ours complete uses_cells", oneByOne(TouchingBoxes())},
        {"estimateWithin", "ours complete estimate uses_cells",
         oneByOne(Listed<estimateWithin<float>>())},
        {"cells, counted", "ours complete estimate uses_cells", countedCells},
        {"first 4 found", "ours uses_cells", oneByOne(FirstFew{4})},
        {"first 16 found", "ours uses_cells", oneByOne(FirstFew{16})},
        {"RarestColour, every 2 frames", "ours", stale(2)},
        {"RarestColour, every 4 frames", "ours", stale(4)},
        {"RarestColour, every 8 frames", "ours", stale(8)},
        {"cells, as printed (paper)", "paper uses_cells", paperProximity},
        {"btDbvtBroadphase, then distance", "bullet exact", bulletProximity},
    };
}

}  // namespace hashphase::demos

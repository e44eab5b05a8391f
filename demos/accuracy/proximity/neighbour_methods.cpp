// SPDX-License-Identifier: Zlib

// The paper's way: Hastings, Mesit, Guha, "Optimization of Large-Scale, Real-Time Simulations by
// Spatial Hashing", "AI and Decision Making".

#include <demos/accuracy/proximity/neighbour_methods.hpp>

#include <broadphase/cells_region.hpp>
#include <broadphase/position_region.hpp>
#include <broadphase/radius_search.hpp>
#include <demos/accuracy/baselines/paper_map.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/rarest_colour.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace hashphase::demos {

std::uint32_t rarestOf(const ColourCounts& counts) {
    return static_cast<std::uint32_t>(std::min_element(counts.begin(), counts.end()) -
                                      counts.begin());
}

void NeighbourSearch::decide(std::span<const std::uint32_t> colours,
                             std::span<std::uint32_t> chosen) {
    forEach([&](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
        ColourCounts counts{};
        for (const std::uint32_t neighbour : neighbours) {
            ++counts[colours[neighbour]];
        }
        chosen[agent] = rarestOf(counts);
    });
}

namespace {

// --- Of the library ------------------------------------------------------------------------------

/// Has a grid of its own, in which ProxyId::index is an agent's number: a new grid counts from 0.
class GridSearch : public NeighbourSearch {
public:
    explicit GridSearch(const NeighbourNeeds& needs)
        : radius_(needs.radius),
          grid_(GridConfig{.cellSize = static_cast<double>(needs.cellSize)}) {}

    void take(const AgentFrame& frame) override {
        for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
            if (ids_.size() <= i) {
                ids_.push_back(grid_.add(frame.boxes[i]));
            } else {
                grid_.move(ids_[i], frame.boxes[i]);
            }
        }
        grid_.update();
    }

protected:
    [[nodiscard]] const Grid<float>& grid() const { return grid_; }
    [[nodiscard]] float radius() const { return radius_; }

    /// Calls ask(id, position) for every agent.
    template <class Ask>
    void forEachAgent(const Ask& ask) const {
        for (const ProxyId id : ids_) {
            ask(id, positionOf(grid_.box(id)));
        }
    }

private:
    float radius_;
    Grid<float> grid_;
    std::vector<ProxyId> ids_;  // by agent
};

/// RarestColour, which counts exactly.
class RarestColourSearch : public GridSearch {
public:
    using GridSearch::GridSearch;

    void decide(std::span<const std::uint32_t> colours, std::span<std::uint32_t> chosen) override {
        std::copy(colours.begin(), colours.end(), chosen.begin());
        rarest_.update(grid(), radius(), ColourCounts().size(), chosen);
    }
    void forEach(Visit visit) override {
        search_.take(grid(), radius());
        search_.forEach([&](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
            found_.clear();
            for (const std::uint32_t neighbour : neighbours) {
                found_.push_back(search_.id(neighbour).index);
            }
            visit(search_.id(agent).index, found_);
        });
    }

private:
    RarestColour<float> rarest_;
    RadiusSearch<float> search_;
    std::vector<std::uint32_t> found_;
};

/// Decides from the lists of RadiusSearch.
class RadiusLists : public RarestColourSearch {
public:
    using RarestColourSearch::RarestColourSearch;

    void decide(std::span<const std::uint32_t> colours, std::span<std::uint32_t> chosen) override {
        NeighbourSearch::decide(colours, chosen);
    }
};

/// Agent by agent: find(grid, position, radius, self, found) lists an agent's neighbours.
template <class Find>
class AgentByAgent : public GridSearch {
public:
    explicit AgentByAgent(const NeighbourNeeds& needs, Find find = {})
        : GridSearch(needs), find_(std::move(find)) {}

    void forEach(Visit visit) override {
        forEachAgent([&](ProxyId self, const Vector3<float>& position) {
            found_.clear();
            find_(grid(), position, radius(), self, found_);
            visit(self.index, found_);
        });
    }

private:
    Find find_;
    std::vector<std::uint32_t> found_;
};

using ProximityFunction = QueryCost (*)(const Grid<float>&, const Vector3<float>&, float,
                                        std::vector<ProxyId>&, ProxyFilter, ProxyId);

/// One of the functions of integration/ai/proximity.hpp.
template <ProximityFunction function>
struct Listed {
    std::vector<ProxyId> ids;

    void operator()(const Grid<float>& grid, const Vector3<float>& position, float radius,
                    ProxyId self, std::vector<std::uint32_t>& found) {
        function(grid, position, radius, ids, acceptAll, self);
        for (const ProxyId id : ids) {
            found.push_back(id.index);
        }
    }
};

/// Lists all but the agent itself, and ends the search after `most`.
struct CollectAgents {
    std::vector<std::uint32_t>& found;
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
                    ProxyId self, std::vector<std::uint32_t>& found) const {
        CollectAgents collector{found, self.index};
        grid.visit(BoxRegion<float>{PositionRegion<float>(position, radius).bounds()}, collector);
    }
};

/// The first within the radius that are found.
struct FirstFew {
    std::size_t most;

    void operator()(const Grid<float>& grid, const Vector3<float>& position, float radius,
                    ProxyId self, std::vector<std::uint32_t>& found) const {
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
class CountedCells : public AgentByAgent<Listed<estimateWithin<float>>> {
public:
    using AgentByAgent::AgentByAgent;

    void decide(std::span<const std::uint32_t> colours, std::span<std::uint32_t> chosen) override {
        forEachAgent([&](ProxyId self, const Vector3<float>& position) {
            CollectColours collector{colours, self.index};
            grid().visit(CellsRegion<float>(position, radius(), grid().cellSize()), collector);
            chosen[self.index] = rarestOf(collector.counts);
        });
    }
};

/// RarestColour in each period-th frame: its grid keeps the state of then, and its decisions stand.
class StaleSearch : public RarestColourSearch {
public:
    StaleSearch(const NeighbourNeeds& needs, int period)
        : RarestColourSearch(needs), period_(period) {}

    void take(const AgentFrame& frame) override {
        isDue_ = frame_++ % period_ == 0;
        if (isDue_) {
            RarestColourSearch::take(frame);
        }
    }
    void decide(std::span<const std::uint32_t> colours, std::span<std::uint32_t> chosen) override {
        if (isDue_) {
            decided_.resize(chosen.size());
            RarestColourSearch::decide(colours, decided_);
        }
        std::copy(decided_.begin(), decided_.end(), chosen.begin());
    }

private:
    int period_;
    int frame_ = 0;
    bool isDue_ = false;
    std::vector<std::uint32_t> decided_;
};

// --- Of others -----------------------------------------------------------------------------------

/// An agent lies in the buckets of all cells that its box touches (no cell is smaller than an
/// agent: these are its corners'), and is counted as often as it is met. The indices are clamped
/// to the map, which the printed loop leaves at its borders.
class PaperProximity : public NeighbourSearch {
public:
    explicit PaperProximity(const NeighbourNeeds& needs)
        : map_(needs.bounds, needs.cellSize),
          offset_(static_cast<int>(needs.radius / needs.cellSize)) {}

    void take(const AgentFrame& frame) override {
        boxes_ = frame.boxes;
        map_.refile(boxes_);
    }

    void forEach(Visit visit) override {
        const PaperMap::Range all = map_.all();
        for (std::uint32_t agent = 0; agent < boxes_.size(); ++agent) {
            const Vector3<float> centre = boxes_[agent].center();
            const PaperMap::Cell base = map_.cellAt(centre.x(), centre.z());
            const int endX = std::min(all.highX + 1, base.x + offset_);
            const int endZ = std::min(all.highZ + 1, base.z + offset_);
            found_.clear();
            for (int z = std::max(0, base.z - offset_); z < endZ; ++z) {
                for (int x = std::max(0, base.x - offset_); x < endX; ++x) {
                    const auto bucket = map_.objects(x, z);
                    std::copy_if(bucket.begin(), bucket.end(), std::back_inserter(found_),
                                 [agent](std::uint32_t other) { return other != agent; });
                }
            }
            visit(agent, found_);
        }
    }

private:
    PaperMap map_;
    int offset_;
    std::span<const Aabb<float>> boxes_;
    std::vector<std::uint32_t> found_;
};

btVector3 centreOf(const BulletBox& box) {
    return (box.min + box.max) / 2;
}

class BulletProximity : public NeighbourSearch {
public:
    explicit BulletProximity(const NeighbourNeeds& needs)
        : radius_(needs.radius),
          filled_(broadphaseKind("dbvt-deferred"), {needs.bounds, needs.agents, {}}) {}

    void take(const AgentFrame& frame) override {
        if (boxes_.empty()) {
            for (std::uint32_t agent = 0; agent < frame.bulletBoxes.size(); ++agent) {
                filled_.create(agent, frame.bulletBoxes[agent], {});
            }
        } else {
            filled_.setAll(frame.bulletBoxes);
        }
        boxes_ = frame.bulletBoxes;
    }

    void forEach(Visit visit) override {
        const btVector3 reach(radius_, radius_, radius_);
        for (std::uint32_t agent = 0; agent < boxes_.size(); ++agent) {
            found_.clear();
            const btVector3 centre = centreOf(boxes_[agent]);
            Near near(*this, centre, agent);
            filled_.broadphase().aabbTest(centre - reach, centre + reach, near);
            visit(agent, found_);
        }
    }

private:
    struct Near : btBroadphaseAabbCallback {
        Near(BulletProximity& search, const btVector3& centre, std::uint32_t self)
            : search_(search), centre_(centre), self_(self) {}

        bool process(const btBroadphaseProxy* proxy) override {
            const std::uint32_t other = FilledBroadphase::objectOf(*proxy);
            const btVector3 way = centreOf(search_.boxes_[other]) - centre_;
            if (other != self_ && way.length2() <= search_.radius_ * search_.radius_) {
                search_.found_.push_back(other);
            }
            return true;
        }

    private:
        BulletProximity& search_;
        btVector3 centre_;
        std::uint32_t self_;
    };

    btScalar radius_;
    FilledBroadphase filled_;
    std::span<const BulletBox> boxes_;
    std::vector<std::uint32_t> found_;
};

template <class Search, class... Arguments>
auto makes(Arguments... arguments) {
    return [arguments...](const NeighbourNeeds& needs) {
        return std::make_unique<Search>(needs, arguments...);
    };
}

}  // namespace

std::vector<NeighbourMethod> neighbourMethods() {
    using FindWithin = AgentByAgent<Listed<findWithin<float>>>;
    using EstimateWithin = AgentByAgent<Listed<estimateWithin<float>>>;
    using enum NeighbourPromise;
    return {
        {"RarestColour, all at once", makes<RarestColourSearch>(), kExact, false},
        {"RadiusSearch, listed", makes<RadiusLists>(), kExact, false},
        {"findWithin", makes<FindWithin>(), kExact},
        {"cells and boxes", makes<AgentByAgent<TouchingBoxes>>(), kComplete},
        {"estimateWithin", makes<EstimateWithin>(), kEstimate},
        {"cells, counted", makes<CountedCells>(), kEstimate},
        {"first 4 found", makes<AgentByAgent<FirstFew>>(FirstFew{4})},
        {"first 16 found", makes<AgentByAgent<FirstFew>>(FirstFew{16})},
        {"RarestColour, every 2 frames", makes<StaleSearch>(2), kNone, false},
        {"RarestColour, every 4 frames", makes<StaleSearch>(4), kNone, false},
        {"RarestColour, every 8 frames", makes<StaleSearch>(8), kNone, false},
        {"cells, as printed (paper)", makes<PaperProximity>(), kNone, true, kOfPaper},
        {"btDbvtBroadphase, then distance", makes<BulletProximity>(), kExact, false, kOfBullet},
    };
}

}  // namespace hashphase::demos

// SPDX-License-Identifier: Zlib
#include <demos/accuracy/proximity/neighbour_method.hpp>

#include <broadphase/cells_region.hpp>
#include <broadphase/radius_search.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/rarest_colour.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace hashphase::demos {

std::uint32_t rarestOf(const std::array<std::uint32_t, kColourCount>& counts) {
    return static_cast<std::uint32_t>(std::min_element(counts.begin(), counts.end()) -
                                      counts.begin());
}

void NeighbourSearch::decide(std::span<const std::uint32_t> colours,
                             std::span<std::uint32_t> chosen) {
    forEach([&](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
        std::array<std::uint32_t, kColourCount> counts{};
        for (const std::uint32_t neighbour : neighbours) {
            ++counts[colours[neighbour]];
        }
        chosen[agent] = rarestOf(counts);
    });
}

namespace {

/// Has a grid of its own, in which ProxyId::index is an agent's number: a new grid counts from 0.
class GridSearch : public NeighbourSearch {
public:
    explicit GridSearch(const NeighbourNeeds& needs) : needs_(needs), grid_(configOf(needs)) {}

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
    [[nodiscard]] float radius() const { return needs_.radius; }

    /// Calls ask(agent, position, id) for every agent.
    template <class Ask>
    void forEachAgent(const Ask& ask) const {
        for (std::uint32_t agent = 0; agent < ids_.size(); ++agent) {
            ask(agent, positionOf(grid_.box(ids_[agent])), ids_[agent]);
        }
    }

private:
    static GridConfig configOf(const NeighbourNeeds& needs) {
        GridConfig config;
        config.cellSize = static_cast<double>(needs.cellSize);
        return config;
    }

    NeighbourNeeds needs_;
    Grid<float> grid_;
    std::vector<ProxyId> ids_;  // by agent
};

class RarestColourSearch : public GridSearch {
public:
    using GridSearch::GridSearch;

    void decide(std::span<const std::uint32_t> colours, std::span<std::uint32_t> chosen) override {
        std::copy(colours.begin(), colours.end(), chosen.begin());
        rarest_.update(grid(), radius(), kColourCount, chosen);
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

/// Decides from the lists.
class WithinSearch : public RarestColourSearch {
public:
    using RarestColourSearch::RarestColourSearch;

    void decide(std::span<const std::uint32_t> colours, std::span<std::uint32_t> chosen) override {
        NeighbourSearch::decide(colours, chosen);
    }
};

/// Agent by agent through one of the functions of integration/ai/proximity.hpp.
class ProximitySearch : public GridSearch {
public:
    using Find = QueryCost (*)(const Grid<float>&, const Vector3<float>&, float,
                               std::vector<ProxyId>&, ProxyFilter, ProxyId);

    ProximitySearch(const NeighbourNeeds& needs, Find find) : GridSearch(needs), find_(find) {}

    void forEach(Visit visit) override {
        forEachAgent([&](std::uint32_t agent, const Vector3<float>& position, ProxyId self) {
            find_(grid(), position, radius(), found_, acceptAll, self);
            numbers_.clear();
            for (const ProxyId id : found_) {
                numbers_.push_back(id.index);
            }
            visit(agent, numbers_);
        });
    }

private:
    Find find_;
    std::vector<ProxyId> found_;
    std::vector<std::uint32_t> numbers_;
};

/// Lists all but the agent itself, and ends the search after `most`.
struct CollectAgents {
    std::vector<std::uint32_t>& found;
    std::uint32_t self;
    std::size_t most;

    void add(ProxyId id, float /*key*/) {
        if (id.index != self) {
            found.push_back(id.index);
        }
    }
    [[nodiscard]] double limit() const {
        return found.size() < most ? std::numeric_limits<double>::infinity() : -1;
    }
};

/// Counts the colours of all but the agent itself.
struct CollectColours {
    std::span<const std::uint32_t> colours;
    std::uint32_t self;
    std::array<std::uint32_t, kColourCount> counts{};

    void add(ProxyId id, float /*key*/) { counts[colours[id.index]] += id.index != self ? 1 : 0; }
    [[nodiscard]] static constexpr double limit() {
        return std::numeric_limits<double>::infinity();
    }
};

class FirstFewSearch : public GridSearch {
public:
    FirstFewSearch(const NeighbourNeeds& needs, std::size_t most)
        : GridSearch(needs), most_(most) {}

    void forEach(Visit visit) override {
        forEachAgent([&](std::uint32_t agent, const Vector3<float>& position, ProxyId /*self*/) {
            found_.clear();
            CollectAgents collector{found_, agent, most_};
            grid().visit(PositionRegion<float>(position, radius()), collector);
            visit(agent, found_);
        });
    }

private:
    std::size_t most_;
    std::vector<std::uint32_t> found_;
};

class BallBoxSearch : public GridSearch {
public:
    using GridSearch::GridSearch;

    void forEach(Visit visit) override {
        forEachAgent([&](std::uint32_t agent, const Vector3<float>& position, ProxyId /*self*/) {
            found_.clear();
            CollectAgents collector{found_, agent, std::numeric_limits<std::size_t>::max()};
            grid().visit(BoxRegion<float>{PositionRegion<float>(position, radius()).bounds()},
                         collector);
            visit(agent, found_);
        });
    }

private:
    std::vector<std::uint32_t> found_;
};

class CountedCellsSearch : public ProximitySearch {
public:
    explicit CountedCellsSearch(const NeighbourNeeds& needs)
        : ProximitySearch(needs, estimateWithin<float>) {}

    void decide(std::span<const std::uint32_t> colours, std::span<std::uint32_t> chosen) override {
        forEachAgent([&](std::uint32_t agent, const Vector3<float>& position, ProxyId /*self*/) {
            CollectColours collector{colours, agent};
            grid().visit(CellsRegion<float>(position, radius(), grid().cellSize()), collector);
            chosen[agent] = rarestOf(collector.counts);
        });
    }
};

/// What it wraps keeps the state of its last frame, and with it the lists of then.
class StaleSearch : public NeighbourSearch {
public:
    StaleSearch(int period, std::unique_ptr<NeighbourSearch> search)
        : period_(period), search_(std::move(search)) {}

    void take(const AgentFrame& frame) override {
        isDue_ = frame_++ % period_ == 0;
        if (isDue_) {
            search_->take(frame);
        }
    }
    void forEach(Visit visit) override { search_->forEach(visit); }
    void decide(std::span<const std::uint32_t> colours, std::span<std::uint32_t> chosen) override {
        if (isDue_) {
            decided_.resize(chosen.size());
            search_->decide(colours, decided_);
        }
        std::copy(decided_.begin(), decided_.end(), chosen.begin());
    }

private:
    int period_;
    std::unique_ptr<NeighbourSearch> search_;
    int frame_ = 0;
    bool isDue_ = false;
    std::vector<std::uint32_t> decided_;
};

template <class Search, class... Arguments>
NeighbourMethod methodOf(std::string name, Arguments... arguments) {
    NeighbourMethod method;
    method.name = std::move(name);
    method.make = [arguments...](const NeighbourNeeds& needs) {
        return std::make_unique<Search>(needs, arguments...);
    };
    return method;
}

}  // namespace

NeighbourMethod rarestColourMethod() {
    NeighbourMethod method = methodOf<RarestColourSearch>("RarestColour, all at once");
    method.isExact = true;
    method.usesCells = false;
    return method;
}

NeighbourMethod crowdMethod() {
    NeighbourMethod method = methodOf<WithinSearch>("RadiusSearch, listed");
    method.isExact = true;
    method.usesCells = false;
    return method;
}

NeighbourMethod findWithinMethod() {
    NeighbourMethod method = methodOf<ProximitySearch>("findWithin", findWithin<float>);
    method.isExact = true;
    return method;
}

NeighbourMethod estimateMethod() {
    NeighbourMethod method = methodOf<ProximitySearch>("estimateWithin", estimateWithin<float>);
    method.isComplete = true;
    method.isEstimate = true;
    return method;
}

NeighbourMethod countedCellsMethod() {
    NeighbourMethod method = methodOf<CountedCellsSearch>("cells, counted");
    method.isComplete = true;
    method.isEstimate = true;
    return method;
}

NeighbourMethod ballBoxMethod() {
    NeighbourMethod method = methodOf<BallBoxSearch>("cells and boxes");
    method.isComplete = true;
    return method;
}

NeighbourMethod firstFewMethod(std::size_t most) {
    return methodOf<FirstFewSearch>("first " + std::to_string(most) + " found", most);
}

NeighbourMethod staleNeighboursMethod(int period) {
    NeighbourMethod method = rarestColourMethod();
    method.name = "RarestColour, every " + std::to_string(period) + " frames";
    method.isExact = false;
    method.make = [period, make = method.make](const NeighbourNeeds& needs) {
        return std::make_unique<StaleSearch>(period, make(needs));
    };
    return method;
}

}  // namespace hashphase::demos

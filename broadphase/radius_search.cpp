// SPDX-License-Identifier: Zlib
#include <broadphase/radius_search.hpp>

#include <broadphase/core/compiler.hpp>
#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/on_failure.hpp>
#include <broadphase/core/query_scope.hpp>
#include <broadphase/core/shared_cost.hpp>
#include <broadphase/geometry/unit_scale.hpp>
#include <broadphase/simd/kernels.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

namespace hashphase {
namespace {

constexpr std::size_t kAgentGrain = 4096;   // proxies that one thread deals with at a time
constexpr std::size_t kAgentsGrain = 1024;  // the same of agents that look around
constexpr std::size_t kSampledShare = 4;    // one in so many agents says which cells fit, of
constexpr std::size_t kLeastSample = 64;    // at least so many
constexpr std::size_t kMostSample = 512;    // and at most
constexpr std::size_t kAhead = 12;          // agents to be read that are fetched meanwhile
constexpr std::uint32_t kNoCell = ~std::uint32_t{0};

[[maybe_unused]] constexpr const char* kIsAsked =
    "RadiusSearch was called from within its own filter or visitor. Call it after that returns.";

// What kernels write beyond the candidates, and beyond the last neighbour.
constexpr std::size_t kTilePadding = 64 + detail::kColumnPadding;

/// Of distances within the radius, before they are squared. 1 where no square of them matters that
/// overflows or vanishes.
template <class Scalar>
Scalar scaleFor(Scalar radius) {
    constexpr int kOrdinary = std::numeric_limits<Scalar>::max_exponent * 15 / 32;
    const Scalar most = std::ldexp(Scalar(1), kOrdinary);
    return radius >= 1 / most && radius <= most ? Scalar(1) : detail::unitScale(radius);
}

}  // namespace

/// The memory of a RadiusTile.
template <class Scalar>
struct RadiusSearch<Scalar>::Tile {
    Tile() {
        view.grow = &grow;
        view.owner = this;
        grow(view, 1);
    }
    Tile(const Tile&) = delete;
    Tile& operator=(const Tile&) = delete;

    static void grow(detail::RadiusTile<Scalar>& view, std::size_t count) {
        static_cast<Tile*>(view.owner)->setCapacity(count + count / 2);
    }

    void setCapacity(std::size_t capacity) {
        const std::size_t words = capacity / 64 + 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            columns[axis].resize(capacity + kTilePadding);
            view.columns[axis] = columns[axis].data();
        }
        // Each with its view, so that they agree should memory run out on the way.
        numbers.resize(capacity + kTilePadding);
        view.numbers = numbers.data();
        groups.resize(capacity + kTilePadding);
        view.groups = groups.data();
        hits.resize(16 * words);
        view.hits = hits.data();
        members.resize(detail::kMostGroups * words);
        view.members = members.data();
        found.resize(capacity + kTilePadding);
        view.found = found.data();
        view.capacity = static_cast<std::uint32_t>(capacity);
    }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return sizeof(*this) + 3 * columns[0].capacity() * sizeof(Scalar) +
               (numbers.capacity() + found.capacity()) * sizeof(std::uint32_t) + groups.capacity() +
               (hits.capacity() + members.capacity()) * sizeof(std::uint64_t);
    }

    detail::RadiusTile<Scalar> view{};
    std::array<std::vector<Scalar>, 3> columns;
    std::vector<std::uint32_t> numbers;
    std::vector<std::uint8_t> groups;
    std::vector<std::uint64_t> hits;
    std::vector<std::uint64_t> members;
    std::vector<std::uint32_t> found;
};

template <class Scalar>
RadiusSearch<Scalar>::RadiusSearch() = default;

template <class Scalar>
RadiusSearch<Scalar>::~RadiusSearch() = default;

// --- The agents ----------------------------------------------------------------------------------

// Says where the index's proxy is; returns whether it is an agent. In place: what is copied at once
// after it was written in parts makes the processor wait.
template <class Scalar>
bool RadiusSearch<Scalar>::stageProxy(const Grid<Scalar>& grid, std::uint32_t proxyIndex,
                                      ProxyFilter filter, Staged& staged) {
    const detail::Population<Scalar>& proxies = grid.store().proxies;
    const detail::Record<Scalar>& record = proxies.records[proxyIndex];
    const bool isAccepted = proxies.isAlive(proxyIndex) && filter(proxies.idOf(proxyIndex));
    staged.generation = isAccepted ? record.generation : 0;
    const Vector3<Scalar> position = positionOf(record.box);
    staged.position = {position.x(), position.y(), position.z()};
    return isAccepted && position.x() == position.x();
}

// Cells that fit where some of the agents are.
template <class Scalar>
void RadiusSearch<Scalar>::chooseCells(const Grid<Scalar>& grid, Scalar radius,
                                       ProxyFilter filter) {
    for (std::vector<double>& column : sample_) {
        column.clear();
    }
    const detail::QueryScope gridScope(&grid.store());
    const detail::QueryScope scope(this);
    const std::size_t count = placeCount_;
    const std::size_t wanted = std::clamp(count / kSampledShare, kLeastSample, kMostSample);
    const std::size_t step = std::max<std::size_t>(count / wanted, 1);
    std::size_t examined = 0;
    for (std::size_t place = 0; place < count; place += step) {
        // Where others than agents stand, the next agent.
        for (; place < count; ++place) {
            ++examined;
            Staged staged;
            if (stageProxy(grid, indexAt(place), filter, staged)) {
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    sample_[axis].push_back(static_cast<double>(staged.position[axis]));
                }
                break;
            }
        }
    }
    const std::size_t agents = sample_[0].size() * count / std::max<std::size_t>(examined, 1);
    const Scalar reach = radius >= 0 ? radius : Scalar(0);
    wrappedGrid_ = detail::wrappedGridFor(sample_, static_cast<double>(reach), agents);
}

// Reads where the proxies are, in the order of their indices, which is that of memory.
template <class Scalar>
void RadiusSearch<Scalar>::stage(const Grid<Scalar>& grid, ProxyFilter filter,
                                 ParallelFor parallelFor) {
    staged_.resize(placeCount_);
    cellOfPlace_.resize(placeCount_);
    std::atomic<std::uint32_t> agentCount{0};
    std::atomic<std::uint32_t> leftOut{0};
    parallelFor(staged_.size(), kAgentGrain, [&](std::size_t begin, std::size_t end) {
        const detail::QueryScope gridScope(&grid.store());
        const detail::QueryScope scope(this);
        const detail::WrappedGrid wrapped = wrappedGrid_;
        std::uint32_t agents = 0;
        std::uint32_t others = 0;
        for (std::size_t place = begin; place < end; ++place) {
            Staged& staged = staged_[place];
            if (stageProxy(grid, indexAt(place), filter, staged)) {
                const auto& [x, y, z] = staged.position;
                cellOfPlace_[place] = wrapped.cellOf(x, y, z);
                ++agents;
            } else {
                cellOfPlace_[place] = kNoCell;
                others += staged.generation != 0 ? 1 : 0;
            }
        }
        agentCount += agents;
        leftOut += others;
    });
    agentCount_ = agentCount;
    leftOut_ = leftOut;
}

// A counting sort by cell.
template <class Scalar>
void RadiusSearch<Scalar>::sort(ParallelFor parallelFor) {
    cellStart_.assign(wrappedGrid_.cellCount() + 1, 0);
    for (const std::uint32_t cell : cellOfPlace_) {
        if (cell != kNoCell) {
            ++cellStart_[cell];
        }
    }
    std::uint32_t sum = 0;
    for (std::uint32_t& start : cellStart_) {
        sum += std::exchange(start, sum);
    }
    // Each start moves to its cell's end, which is where the next one starts.
    places_.resize(agentCount_);
    for (std::size_t place = 0; place < cellOfPlace_.size(); ++place) {
        if (cellOfPlace_[place] != kNoCell) {
            places_[cellStart_[cellOfPlace_[place]]++] = static_cast<std::uint32_t>(place);
        }
    }
    std::copy_backward(cellStart_.begin(), cellStart_.end() - 1, cellStart_.end());
    cellStart_[0] = 0;

    ids_.resize(agentCount_);
    for (std::vector<Scalar>& column : columns_) {
        column.resize(agentCount_ + detail::kColumnPadding);
    }
    parallelFor(agentCount_, kAgentGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t agent = begin; agent < end; ++agent) {
            if (agent + kAhead < end) {
                detail::prefetch(&staged_[places_[agent + kAhead]]);
            }
            const Staged& staged = staged_[places_[agent]];
            ids_[agent] = {indexAt(places_[agent]), staged.generation};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                columns_[axis][agent] = staged.position[axis];
            }
        }
    });
}

// Says what kernels read.
template <class Scalar>
void RadiusSearch<Scalar>::prepare(Scalar radius) {
    const bool isDistance = radius >= 0;
    view_.scale = isDistance ? scaleFor(radius) : Scalar(1);
    view_.mostSquared = isDistance ? (radius * view_.scale) * (radius * view_.scale) : Scalar(-1);
    while (numbers_.size() < columns_[0].size()) {
        numbers_.push_back(static_cast<std::uint32_t>(numbers_.size()));
    }
    view_.numbers = numbers_.data();
    view_.cellStart = cellStart_.data();
    std::copy(wrappedGrid_.extent.begin(), wrappedGrid_.extent.end(), view_.extent);
    view_.reach = wrappedGrid_.reach;
    // Along one axis all may be the same, as in a world of two dimensions: of no difference there is
    // no square to be added.
    std::size_t same = 3;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto begin = columns_[axis].begin();
        const auto isFirst = [begin](Scalar x) { return x == *begin; };
        if (view_.scale == 1 && wrappedGrid_.extent[axis] == 1 &&
            std::all_of(begin, begin + static_cast<std::ptrdiff_t>(agentCount_), isFirst)) {
            same = axis;
        }
    }
    view_.axisCount = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (axis != same) {
            view_.columns[view_.axisCount++] = columns_[axis].data();
        }
    }
}

template <class Scalar>
void RadiusSearch<Scalar>::take(const Grid<Scalar>& grid, Scalar radius, ProxyFilter filter,
                                ParallelFor parallelFor) {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this), kIsAsked);
    const detail::OnFailure takeNone([&] {
        ids_.clear();
        agentCount_ = 0;
        leftOut_ = 0;
    });
    grid.store().mendTables();  // or a query would, while the lists are read
    if (peaks_.isPast(std::max(grid.store().listedCount(), placeCount_), staged_.capacity())) {
        releaseMemory();
    }
    placeCount_ = grid.size() == 0 ? 0 : grid.store().listFew(few_);
    chooseCells(grid, radius, filter);
    stage(grid, filter, parallelFor);
    sort(parallelFor);
    prepare(radius);
}

// --- Questions -----------------------------------------------------------------------------------

template <class Scalar>
std::unique_ptr<typename RadiusSearch<Scalar>::Tile> RadiusSearch<Scalar>::borrowTile() {
    {
        const std::lock_guard lock(tilesMutex_);
        if (!tiles_.empty()) {
            std::unique_ptr<Tile> tile = std::move(tiles_.back());
            tiles_.pop_back();
            return tile;
        }
    }
    return std::make_unique<Tile>();
}

template <class Scalar>
void RadiusSearch<Scalar>::returnTile(std::unique_ptr<Tile> tile) {
    const std::lock_guard lock(tilesMutex_);
    tiles_.push_back(std::move(tile));
}

// Calls kernel(firstAgent, lastAgent, tile, cost) for all agents, in parts; it returns what it found.
template <class Scalar>
template <class Kernel>
QueryCost RadiusSearch<Scalar>::ask(ParallelFor parallelFor, const Kernel& kernel) {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this), kIsAsked);
    detail::SharedCost shared;
    parallelFor(agentCount_, kAgentsGrain, [&](std::size_t begin, std::size_t end) {
        const detail::QueryScope scope(this);
        std::unique_ptr<Tile> tile = borrowTile();
        detail::KernelCost cost;
        const std::uint64_t hits = kernel(static_cast<std::uint32_t>(begin),
                                          static_cast<std::uint32_t>(end), tile->view, cost);
        shared.add({cost.rowsVisited, cost.boxesTested, hits});
        returnTile(std::move(tile));
    });
    // Which thread has the largest part is a matter of chance, and must not make tiles grow later.
    std::uint32_t largest = 0;
    for (const std::unique_ptr<Tile>& tile : tiles_) {
        largest = std::max(largest, tile->view.capacity);
    }
    for (const std::unique_ptr<Tile>& tile : tiles_) {
        if (tile->view.capacity < largest) {
            tile->setCapacity(largest);
        }
    }
    return shared.sum();
}

template <class Scalar>
QueryCost RadiusSearch<Scalar>::list(const detail::RadiusVisitor& visitor,
                                     ParallelFor parallelFor) {
    return ask(parallelFor, [&](std::uint32_t first, std::uint32_t last, auto& tile, auto& cost) {
        return detail::kernels<Scalar>().listWithin(view_, first, last, tile, visitor, cost);
    });
}

template <class Scalar>
QueryCost RadiusSearch<Scalar>::count(std::span<std::uint32_t> counts, ParallelFor parallelFor) {
    HASHPHASE_ASSERT(counts.size() == size(),
                     "RadiusSearch::count(): counts has the wrong length. Pass one count for each "
                     "agent: size() of them.");
    return ask(parallelFor, [&](std::uint32_t first, std::uint32_t last, auto& tile, auto& cost) {
        return detail::kernels<Scalar>().countWithin(view_, first, last, tile, counts.data(), cost);
    });
}

template <class Scalar>
QueryCost RadiusSearch<Scalar>::countGroups(std::uint32_t groupCount,
                                            FunctionRef<std::uint32_t(ProxyId)> groupOf,
                                            std::span<std::uint32_t> counts,
                                            ParallelFor parallelFor) {
    HASHPHASE_ASSERT(
        groupCount <= kMostGroups,
        "RadiusSearch::countGroups(): groupCount is too large. Pass at most kMostGroups.");
    HASHPHASE_ASSERT(counts.size() == std::size_t{size()} * groupCount,
                     "RadiusSearch::countGroups(): counts has the wrong length. Pass size() * "
                     "groupCount of them.");
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this), kIsAsked);
    groups_.resize(size() + detail::kColumnPadding);
    parallelFor(size(), kAgentGrain, [&](std::size_t begin, std::size_t end) {
        const detail::QueryScope scope(this);
        for (std::size_t agent = begin; agent < end; ++agent) {
            const std::uint32_t group = groupOf(ids_[agent]);
            groups_[agent] = static_cast<std::uint8_t>(std::min(group, kMostGroups));
        }
    });
    return ask(parallelFor, [&](std::uint32_t first, std::uint32_t last, auto& tile, auto& cost) {
        return detail::kernels<Scalar>().countGroupsWithin(view_, first, last, tile, groups_.data(),
                                                           groupCount, counts.data(), cost);
    });
}

template <class Scalar>
std::size_t RadiusSearch<Scalar>::memoryBytes() const noexcept {
    const std::lock_guard lock(tilesMutex_);  // forEach() may call it on its threads
    std::size_t bytes =
        sizeof(*this) + staged_.capacity() * sizeof(Staged) +
        (few_.capacity() + cellOfPlace_.capacity() + cellStart_.capacity() + places_.capacity() +
         numbers_.capacity()) *
            sizeof(std::uint32_t) +
        ids_.capacity() * sizeof(ProxyId) +
        3 * (columns_[0].capacity() * sizeof(Scalar) + sample_[0].capacity() * sizeof(double)) +
        groups_.capacity() + tiles_.capacity() * sizeof(tiles_[0]);
    for (const std::unique_ptr<Tile>& tile : tiles_) {
        bytes += tile->memoryBytes();
    }
    return bytes;
}

template <class Scalar>
void RadiusSearch<Scalar>::releaseMemory() noexcept {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this), kIsAsked);
    detail::freeArrays(few_, staged_, cellOfPlace_, cellStart_, places_, ids_, numbers_, groups_,
                       tiles_);
    sample_ = {};
    columns_ = {};
    placeCount_ = 0;
    agentCount_ = 0;
    leftOut_ = 0;
}

template class HASHPHASE_INSTANCE_EXPORT RadiusSearch<float>;
template class HASHPHASE_INSTANCE_EXPORT RadiusSearch<double>;

}  // namespace hashphase

// SPDX-License-Identifier: Zlib
#include <integration/distributed/rank_grid.hpp>
#include <integration/distributed/rank_grid_events.inl>
#include <integration/distributed/rank_grid_messages.inl>

#include <broadphase/collectors.hpp>
#include <broadphase/core/compiler.hpp>
#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/raise.hpp>
#include <broadphase/diagnostics.hpp>
#include <broadphase/regions.hpp>

#include <algorithm>
#include <limits>

namespace hashphase {
namespace {

constexpr std::uint32_t kMostPayloadBytes = 65'536;
[[maybe_unused]] constexpr const char* kBetweenFrames =
    "A RankGrid was changed between pack() and finish(). Change it before pack() or after "
    "finish().";

// What work costs, in tests of boxes: filing a box, and having a pair, which begins and ends now and then. By times
// of uniform, clustered and graded populations: 25 to 45 ns to file, 15 ns a pair. Tests count for little, as many of
// them mean larger cells, and fewer of these: where cell sizes change, their number jumps, and time does not.
constexpr double kTestsToFile = 400;
constexpr double kTestsForPair = 200;

/// Counts the boxes found that are larger than one, or as large with a higher id; among not too many.
template <class Scalar>
struct CountLarger {
    static constexpr std::size_t kMostOffered = 4096;

    void add(ProxyId other, Scalar /*key*/) {
        const Scalar otherEdge = grid.box(other).sizes().maxCoeff();
        count += otherEdge > edge || (otherEdge == edge && other > id) ? 1 : 0;
        ++offered;
    }
    [[nodiscard]] Scalar limit() const noexcept {
        return offered < kMostOffered ? std::numeric_limits<Scalar>::infinity() : Scalar(-1);
    }

    const Grid<Scalar>& grid;
    ProxyId id;
    Scalar edge;  // its longest [m]
    std::size_t count = 0;
    std::size_t offered = 0;
};

}  // namespace

RankError::RankError(const std::string& sentence) : std::runtime_error(sentence) {}
RankError::~RankError() = default;

template <class Scalar>
RankGrid<Scalar>::RankGrid(std::uint32_t rank, const Partition<Scalar>& partition,
                           const RankGridConfig& config)
    : rank_(rank),
      config_(config),
      partition_(partition),
      lastPartition_(partition),
      region_(partition.region(rank)),
      grid_(config.grid),
      pairs_(grid_),
      writers_(partition.rankCount()),
      entryCounts_(partition.rankCount()) {
    HASHPHASE_ASSERT(rank < partition.rankCount(),
                     "RankGrid: the partition has no region for this rank. Pass a rank below "
                     "Partition::rankCount().");
    if (config.payloadBytes > kMostPayloadBytes) {
        detail::raiseInvalidArgument("RankGridConfig::payloadBytes is " +
                                     std::to_string(config.payloadBytes) +
                                     ", but must be 0 to 65536.");
    }
}

// --- Objects -------------------------------------------------------------------------------------

template <class Scalar>
void RankGrid<Scalar>::makeRoom(std::uint32_t index) {
    if (index >= marks_.size()) {
        globalIds_.resize(std::size_t{index} + 1);
        befores_.resize(std::size_t{index} + 1);
        homes_.resize(std::size_t{index} + 1);
        payloads_.resize((std::size_t{index} + 1) * config_.payloadBytes);
        marks_.resize(std::size_t{index} + 1);  // last: by it is seen whether there is room
    }
}

template <class Scalar>
ProxyId RankGrid<Scalar>::add(GlobalId object, const Box& box, const ProxyGroups& groups) {
    HASHPHASE_ASSERT(!isPacked_, kBetweenFrames);
    if (isPacked_) {
        return {};
    }
    if (!find(object).isNull()) {
        detail::raiseInvalidArgument(
            "RankGrid::add(): the global id " + std::to_string(object.value) +
            " already names an object or a ghost here. Give each object an id of its own.");
    }
    const ProxyId id = addProxy(object, box, groups);
    // The index of an object that was added and removed since finish() is in touched_ already.
    marks_[id.index] =
        static_cast<std::uint16_t>((marks_[id.index] & kTouched) | kOwned | kNew | kBorn);
    globalIds_[id.index] = object;
    homes_[id.index] = rank_;
    touch(id.index);
    const std::span<std::byte> bytes = payload(id);
    std::fill(bytes.begin(), bytes.end(), std::byte{0});
    ++ownedCount_;
    return id;
}

template <class Scalar>
void RankGrid<Scalar>::clear(std::uint32_t index, unsigned marks) noexcept {
    marks_[index] = static_cast<std::uint16_t>(marks_[index] & ~marks);
}

// Takes all memory first: where that runs out, nothing has happened.
template <class Scalar>
ProxyId RankGrid<Scalar>::addProxy(GlobalId object, const Box& box, const ProxyGroups& groups) {
    makeRoom(grid_.indexLimit());
    detail::ensureCapacity(touched_, touched_.size() + 1);
    detail::ensureCapacity(knownProxies_, knownProxies_.size() + 1);
    knownIds_.reserve(knownProxies_.size() + 1);
    const ProxyId id = grid_.add(box, Mobility::mobile, groups);
    knownIds_.findOrInsert(object.value);
    knownProxies_.push_back(id);
    return id;
}

template <class Scalar>
void RankGrid<Scalar>::forgetId(GlobalId object) noexcept {
    const std::uint32_t number = knownIds_.erase(object.value);
    knownProxies_[number] = knownProxies_.back();
    knownProxies_.pop_back();
}

template <class Scalar>
void RankGrid<Scalar>::prefetch(std::uint32_t index) const noexcept {
    detail::prefetchAll(grid_.store().proxies.records[index]);
    detail::prefetchAll(befores_[index]);
    detail::prefetch(globalIds_.data() + index);
}

template <class Scalar>
void RankGrid<Scalar>::remove(ProxyId id) {
    if (!canChange(id)) {
        return;
    }
    detail::ensureCapacity(nextFormerNames_, nextFormerNames_.size() + 1);
    touch(id.index);  // all memory is there now
    if ((marks_[id.index] & kBorn) != 0) {
        marks_[id.index] = kTouched;  // nobody knows of it
    } else {
        keepBefore(id.index);
        clear(id.index, kOwned);
        marks_[id.index] |= kRemovedEverywhere;
    }
    nextFormerNames_.push_back({id, globalIds_[id.index]});
    forgetId(globalIds_[id.index]);
    --ownedCount_;
    grid_.remove(id);
}

template <class Scalar>
std::span<std::byte> RankGrid<Scalar>::payload(ProxyId id) {
    if (!canChange(id)) {
        return {};
    }
    if ((marks_[id.index] & kShared) != 0) {
        touch(id.index);
    }
    marks_[id.index] |= kPayload;
    return std::span(payloads_).subspan(std::size_t{id.index} * config_.payloadBytes,
                                        config_.payloadBytes);
}

template <class Scalar>
std::span<const std::byte> RankGrid<Scalar>::readPayload(ProxyId id) const noexcept {
    if (!grid_.contains(id)) {
        return {};
    }
    return std::span(payloads_).subspan(std::size_t{id.index} * config_.payloadBytes,
                                        config_.payloadBytes);
}

template <class Scalar>
std::uint32_t RankGrid<Scalar>::homeOf(ProxyId id) const {
    HASHPHASE_ASSERT(grid_.contains(id),
                     "RankGrid::homeOf(): the id is null or stale. Pass the id of an object or "
                     "ghost on this rank.");
    return grid_.contains(id) && !isOwned(id) ? homes_[id.index] : rank_;
}

template <class Scalar>
GlobalId RankGrid<Scalar>::globalId(ProxyId id) const {
    if (grid_.contains(id)) {
        return globalIds_[id.index];
    }
    const auto former =
        std::lower_bound(formerNames_.begin(), formerNames_.end(), FormerName{id, GlobalId{}});
    const bool isKnown = former != formerNames_.end() && former->id == id;
    HASHPHASE_ASSERT(isKnown,
                     "RankGrid::globalId(): the id is null or stale. Pass the id of an object or "
                     "ghost on this rank, or of one that the last frame removed.");
    return isKnown ? former->object : GlobalId{};
}

template <class Scalar>
ProxyId RankGrid<Scalar>::find(GlobalId object) const noexcept {
    const std::uint32_t number = knownIds_.find(object.value);
    return number == detail::FlatSet::kNone ? ProxyId{} : knownProxies_[number];
}

// --- Frame ---------------------------------------------------------------------------------------

template <class Scalar>
void RankGrid<Scalar>::setPartition(const Partition<Scalar>& partition) {
    HASHPHASE_ASSERT(!isPacked_, kBetweenFrames);
    HASHPHASE_ASSERT(partition.rankCount() == lastPartition_.rankCount(),
                     "RankGrid::setPartition(): the new partition has another number of ranks. "
                     "Pass one with the same rankCount().");
    if (isPacked_ || partition.rankCount() != lastPartition_.rankCount()) {
        return;
    }
    partition_ = partition;
    region_ = partition.region(rank_);
    isPartitionNew_ = true;
}

// Touches what does not lie wholly in the new region, or did not in the old one: that is marked.
template <class Scalar>
void RankGrid<Scalar>::touchForPartition() {
    grid_.forEach([&](ProxyId id, const Box& box) {
        const unsigned marks = marks_[id.index];
        if ((marks & kOwned) != 0 && ((marks & kShared) != 0 || !liesWithin(box))) {
            touch(id.index);
        }
    });
}

template <class Scalar>
RankChanges RankGrid<Scalar>::finish(std::span<const Parcel> received, ParallelFor parallelFor) {
    HASHPHASE_ASSERT(
        isPacked_,
        "RankGrid::finish() was called without pack(). Call pack() first, once a frame.");
    if (!isPacked_) {
        return {};
    }
    arrived_.clear();
    departed_.clear();
    removedHere_.clear();
    settleObjects();
    readParcels(received);
    // Last: until the next update, an index that is free now may name what has gone.
    for (const RemovedProxy& removed : removedHere_) {
        grid_.remove(removed.id);
    }
    reportPairs(pairs_.update(acceptAllPairs, parallelFor));
    endFrame();
    return {{born_, died_}, arrived_, departed_};
}

// Objects that lived here, and live on another rank now.
template <class Scalar>
void RankGrid<Scalar>::settleObjects() {
    for (const std::uint32_t index : touched_) {
        if ((marks_[index] & kOwned) == 0 || homes_[index] == rank_) {
            continue;
        }
        const ProxyId id = grid_.idAt(index);
        departed_.push_back({globalIds_[index], id, homes_[index]});
        clear(index, kOwned);
        --ownedCount_;
        if ((marks_[index] & kStaysHere) == 0) {
            markRemovedHere(id);
        }
    }
}

template <class Scalar>
void RankGrid<Scalar>::markRemovedHere(ProxyId id) {
    keepBefore(id.index);
    nextFormerNames_.push_back({id, globalIds_[id.index]});
    marks_[id.index] |= kRemovedHere;
    forgetId(globalIds_[id.index]);
    homes_[id.index] = static_cast<std::uint32_t>(removedHere_.size());
    removedHere_.push_back({id, grid_.box(id)});
}

template <class Scalar>
void RankGrid<Scalar>::endFrame() {
    for (const std::uint32_t index : touched_) {
        const ProxyId id = grid_.idAt(index);
        const bool isShared = !id.isNull() && !liesWithin(grid_.box(id));
        marks_[index] = static_cast<std::uint16_t>(
            id.isNull() ? 0 : (marks_[index] & kOwned) | (isShared ? kShared : 0));
    }
    touched_.clear();
    formerNames_.swap(nextFormerNames_);
    nextFormerNames_.clear();
    std::sort(formerNames_.begin(), formerNames_.end());
    if (isPartitionNew_) {
        lastPartition_ = partition_;
        isPartitionNew_ = false;
    }
    isPacked_ = false;
    ++frame_;
    cost_.pairs = pairs_.lastCost();
    cost_.ghosts = ghostCount();
    cost_.load = static_cast<double>(cost_.pairs.boxesTested) +
                 kTestsToFile * static_cast<double>(cost_.pairs.grid.filed) +
                 kTestsForPair * static_cast<double>(pairs_.count());
}

// --- The whole -----------------------------------------------------------------------------------

template <class Scalar>
std::vector<WeightedPoint<Scalar>> RankGrid<Scalar>::sampleLoad(std::size_t count) const {
    return sampleLoad(count, cost_.load);
}

template <class Scalar>
std::vector<WeightedPoint<Scalar>> RankGrid<Scalar>::sampleLoad(std::size_t count,
                                                                double load) const {
    std::vector<WeightedPoint<Scalar>> points;
    if (count == 0 || ownedCount_ == 0) {
        return points;
    }
    const std::size_t step = (ownedCount_ + count - 1) / count;
    const Vector3<Scalar> finest = Vector3<Scalar>::Constant(grid_.cellSize());
    std::size_t number = 0;
    double sum = 0;
    grid_.expectQueries(std::min(count, ownedCount_));
    grid_.forEach([&](ProxyId id, const Box& box) {
        if (!isOwned(id) || number++ % step != 0 || hasNan(box)) {
            return;
        }
        // A pair is where the smaller of its boxes is, and so is the search that finds it: as far as the cells of
        // the finest level.
        const Box reach(box.min(), box.max().cwiseMin(box.min() + finest));
        CollectCount nearby;
        const QueryCost cost = grid_.visit(BoxRegion<Scalar>{reach}, nearby);
        CountLarger<Scalar> larger{grid_, id, box.sizes().maxCoeff()};
        grid_.visit(BoxRegion<Scalar>{box}, larger);
        points.push_back({box.min(), kTestsToFile + static_cast<double>(cost.boxesTested) +
                                         kTestsForPair * static_cast<double>(larger.count)});
        sum += points.back().weight;
    });
    for (WeightedPoint<Scalar>& point : points) {
        point.weight *= std::max(load, 1.0) / sum;
    }
    return points;
}

template <class Scalar>
std::size_t RankGrid<Scalar>::memoryBytes() const noexcept {
    std::size_t bytes = sizeof(*this) + grid_.memoryBytes() + pairs_.memoryBytes() +
                        2 * marks_.capacity() + globalIds_.capacity() * sizeof(GlobalId) +
                        befores_.capacity() * sizeof(Box) + homes_.capacity() * 4 +
                        payloads_.capacity() + knownIds_.memoryBytes() +
                        knownProxies_.capacity() * sizeof(ProxyId) +
                        (born_.capacity() + died_.capacity()) * sizeof(ProxyPair);
    for (const detail::ByteWriter& writer : writers_) {
        bytes += sizeof(writer) + writer.memoryBytes();
    }
    return bytes;
}

template <class Scalar>
std::string RankGrid<Scalar>::validate() const {
    std::string fault = pairs_.validate();
    grid_.forEach([&](ProxyId id, const Box& box) {
        const bool isOwnedHere = isOwned(id);
        const bool isShared = (marks_[id.index] & kShared) != 0;
        const std::string name =
            (isOwnedHere ? "The object " : "The ghost ") + std::to_string(globalId(id).value);
        if (!hasNan(box) && partition_.rankOf(box.min()) != homeOf(id)) {
            fault = name + " does not have its min corner in the region of its home.";
        }
        bool touches = isOwnedHere;
        partition_.forEachRank(box, [&](std::uint32_t rank) { touches |= rank == rank_; });
        if (!touches) {
            fault = name + " does not touch this rank's region.";
        }
        if (isShared == liesWithin(box)) {
            fault = name + (isShared ? " lies wholly in the region, and is marked as shared."
                                     : " does not lie wholly in the region, nor is marked so.");
        }
        if (find(globalId(id)) != id) {
            fault = name + " is not found by its id.";
        }
    });
    return fault;
}

template class HASHPHASE_INSTANCE_EXPORT RankGrid<float>;
template class HASHPHASE_INSTANCE_EXPORT RankGrid<double>;

}  // namespace hashphase

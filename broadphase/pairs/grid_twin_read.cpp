// SPDX-License-Identifier: Zlib

// What was read is as after an update that ran out of memory: everything is mobile, and the next update, or query,
// files it. Whatever the bytes, nothing is taken from them that would break an invariant.

#include <broadphase/pairs/grid_twin_bytes.hpp>

#include <broadphase/core/byte_stream.hpp>
#include <broadphase/core/limits.hpp>
#include <broadphase/pairs/candidates.inl>
#include <broadphase/pairs/grid_twin_format.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

namespace hashphase::detail {
namespace {

// Every member function returns whether what it has read can be.
template <class Scalar>
class TwinReader {
public:
    explicit TwinReader(std::span<const std::byte> bytes) : from_(bytes) {}

    [[nodiscard]] std::string readAll(std::unique_ptr<GridTwin<Scalar>>& twin) {
        if (from_.read<std::uint8_t>() != sizeof(Scalar)) {
            return "The bytes are a snapshot of a grid of the other precision. Read them with the "
                   "Scalar (float or double) that wrote them.";
        }
        if (!readSettings(twin)) {
            return "The bytes of a snapshot of a grid have an invalid GridConfig, so write() did "
                   "not make them. Write the snapshot again.";
        }
        twin_ = twin.get();
        const char* const part = !readProxies() || !readFreeLists()   ? "proxies"
                                 : twin->hasPairs && !readPairs()     ? "pairs"
                                 : twin->hasSweeps && !readMotions()  ? "sweeps"
                                 : from_.isTorn() || from_.left() > 0 ? "length"
                                                                      : nullptr;
        return part != nullptr
                   ? "The bytes of a snapshot of a grid are invalid (" + std::string(part) +
                         "), so write() did not make them. Write the snapshot again."
                   : std::string();
    }

private:
    [[nodiscard]] bool readSettings(std::unique_ptr<GridTwin<Scalar>>& twin) {
        GridConfig config;
        config.cellSize = from_.read<double>();
        config.levelRatio = from_.read<double>();
        config.updatesBeforeRest = from_.read<std::uint32_t>();
        const bool hasSlack = readBool();
        const auto slack = from_.read<double>();
        config.slack = hasSlack ? std::optional(slack) : std::nullopt;
        if (!configError(config).empty()) {
            return false;
        }
        twin = std::make_unique<GridTwin<Scalar>>(config);
        twin->hasPairs = readBool();
        twin->hasSweeps = readBool();
        const auto cellSize = from_.read<Scalar>();
        twin->store.tables.cellSize = cellSize;
        return areBools_ && cellSize > 0 && cellSize < std::numeric_limits<Scalar>::infinity() &&
               (twin->hasPairs || !twin->hasSweeps);
    }

    [[nodiscard]] bool readProxies() {
        Population<Scalar>& proxies = twin_->store.proxies;
        const auto count = from_.read<std::uint32_t>();
        constexpr std::size_t kLeast = 5;  // bytes an index
        if (count > kMostProxies || count > from_.left() / kLeast) {
            return false;
        }
        proxies.firstGeneration = from_.read<std::uint32_t>();
        const bool hasGroups = readBool();
        const bool isShifted = readBool();
        if (!areBools_ || (proxies.firstGeneration & 1) != 0 ||
            proxies.firstGeneration == kLastGeneration) {
            return false;
        }
        proxies.reserveRecords(count);
        proxies.reserveLists(count);
        proxies.records.resize(count);
        if (hasGroups) {
            proxies.makeGroups();
        }
        if (isShifted) {
            proxies.boxesAtUpdate.resize(count, nanBox<Scalar>());
        }
        wasSeen_.resize(count);
        for (std::uint32_t index = 0; index < count; ++index) {
            if (!readIndex(index)) {
                return false;
            }
        }
        fileAll();
        return true;
    }

    [[nodiscard]] bool readIndex(std::uint32_t index) {
        Store<Scalar>& store = twin_->store;
        Population<Scalar>& proxies = store.proxies;
        Record<Scalar>& record = proxies.records[index];
        const auto flags = from_.read<std::uint8_t>();
        record.generation = from_.read<std::uint32_t>();
        const bool isAlive = (flags & kIsAlive) != 0;
        const bool sweeps = (flags & kSweeps) != 0;
        wasSeen_[index] = (flags & kWasSeen) != 0 ? 1 : 0;
        if (flags > 15 || isAlive != proxies.isAlive(index) ||
            (!isAlive && (flags & (kSweeps | kRestsAtOnce)) != 0) ||
            (sweeps && !twin_->hasSweeps)) {
            return false;
        }
        if (isAlive) {
            record.box = readBox();
            record.residency = sweeps ? Residency::sweeping : Residency::mobile;
            record.isNan = hasNan(record.box);
            record.restsAtOnce = (flags & kRestsAtOnce) != 0;
            proxies.nanCount += record.isNan ? 1 : 0;
            ++proxies.size;
        }
        if (wasSeen_[index] != 0) {
            record.before = readBox();
            if (!proxies.boxesAtUpdate.empty()) {
                proxies.boxesAtUpdate[index] = readBox();
            }
        }
        record.changedAt = isAlive || wasSeen_[index] != 0 ? proxies.updateNumber : 0;
        store.cost.changed += record.changedAt;
        if (!proxies.groups.empty()) {
            const ProxyGroups now = readGroups();
            const ProxyGroups before = readGroups();
            proxies.setGroups(index, now);
            proxies.groups[2 * std::size_t{index} + 1] = before;
            proxies.areRegrouped = proxies.areRegrouped || now != before;
        }
        return true;
    }

    // Those that were there at the last update come first: see Population::isUnseen().
    void fileAll() {
        Store<Scalar>& store = twin_->store;
        Population<Scalar>& proxies = store.proxies;
        for (const bool areSeen : {true, false}) {
            for (std::uint32_t index = 0; index < proxies.records.size(); ++index) {
                const bool isListed =
                    wasSeen_[index] != 0 ? areSeen : !areSeen && proxies.isAlive(index);
                if (isListed) {
                    proxies.listMobile(index);
                }
            }
            proxies.mobileAtUpdate = areSeen ? proxies.mobile.size() : proxies.mobileAtUpdate;
        }
        for (std::uint32_t index = 0; index < proxies.records.size(); ++index) {
            if (proxies.records[index].residency == Residency::sweeping) {
                proxies.sweeping.push_back(index);
            }
        }
        store.mustRebuildPairs = true;
        store.tables.mustRefileMobile.store(true, std::memory_order_relaxed);
    }

    [[nodiscard]] bool readFreeLists() {
        Population<Scalar>& proxies = twin_->store.proxies;
        std::vector<char> isListed(proxies.records.size());
        std::vector<std::uint32_t> indices;
        for (FreeList* list : {&proxies.free, &proxies.removed, &proxies.removedImmediate}) {
            const auto count = from_.read<std::uint32_t>();
            if (count > proxies.records.size()) {
                return false;
            }
            indices.clear();
            for (std::uint32_t i = 0; i < count; ++i) {
                const auto index = from_.read<std::uint32_t>();
                const bool isRemoved = list == &proxies.removed;
                if (index >= proxies.records.size() || proxies.isAlive(index) ||
                    isListed[index] != 0 || (wasSeen_[index] != 0) != isRemoved) {
                    return false;
                }
                isListed[index] = 1;
                indices.push_back(index);
            }
            std::for_each(indices.rbegin(), indices.rend(),
                          [&](std::uint32_t index) { proxies.append(index, *list); });
        }
        for (std::uint32_t index = 0; index < proxies.records.size(); ++index) {
            const bool isUsedUp = proxies.records[index].generation == kLastGeneration;
            if (!proxies.isAlive(index) && isListed[index] == 0 && !isUsedUp) {
                return false;
            }
        }
        return true;
    }

    [[nodiscard]] bool readPairs() {
        PairState<Scalar>& pairs = twin_->pairs;
        KnownPairs& known = pairs.known;
        const auto refused = readKeys();
        const auto kept = readKeys();
        const auto immediate = readKeys();
        const auto swept = readKeys();
        if (!refused || !kept || !immediate || !swept ||
            !std::is_sorted(swept->begin(), swept->end()) ||
            std::adjacent_find(swept->begin(), swept->end()) != swept->end() ||
            !std::ranges::all_of(*swept, [&](PairKey key) { return haveSwept(key); })) {
            return false;
        }
        known.swept.atUpdate = *swept;
        known.immediate.reserve(immediate->size(), pairs.proxies.records.size());
        std::ranges::for_each(*immediate, [&](PairKey key) { known.immediate.insert(key); });
        pairs.markImmediate(known.immediate.keys(), true);
        for (const PairKey key : *kept) {
            if (!pairs.store.overlappedAtUpdate(firstIndex(key), secondIndex(key))) {
                return false;
            }
            known.kept.findOrInsert(key);
        }
        if (readBool() && !readRemembered()) {
            return false;
        }
        for (const PairKey key : *refused) {
            if (known.arePairs() || !pairs.isKnown(key)) {
                return false;
            }
            known.refused.findOrInsert(key);
        }
        if (!areBools_ || !readIgnored()) {
            return false;
        }
        const auto fewImmediate = from_.read<std::uint64_t>();
        pairs.fewImmediate = static_cast<std::uint32_t>(std::min(fewImmediate, kMostImmediate));
        countPairs();
        return true;
    }

    // What swept stood nowhere at the last update.
    [[nodiscard]] bool haveSwept(PairKey key) const {
        const auto& records = twin_->store.proxies.records;
        return hasNan(records[firstIndex(key)].before) || hasNan(records[secondIndex(key)].before);
    }

    [[nodiscard]] bool readRemembered() {
        PairState<Scalar>& pairs = twin_->pairs;
        const auto keys = readKeys();
        pairs.known.pile = std::make_unique<Pile>();
        Pile& pile = *pairs.known.pile;
        pile.lookInterval = from_.read<std::uint32_t>();
        pile.updatesUntilLook = from_.read<std::uint32_t>();
        if (!keys || pile.lookInterval < 1 || pile.updatesUntilLook < 1) {
            return false;
        }
        for (const PairKey key : *keys) {
            if (!pairs.store.overlappedAtUpdate(firstIndex(key), secondIndex(key)) &&
                !pairs.known.immediate.contains(key) && !pairs.known.swept.contains(key)) {
                return false;
            }
            pile.pairs.findOrInsert(key);
        }
        pile.hasPairs = true;
        pairs.store.maySettleWithSlack = false;
        return true;
    }

    [[nodiscard]] bool readIgnored() {
        const auto count = from_.read<std::uint32_t>();
        if (count > from_.left() / (2 * sizeof(ProxyId))) {
            return false;
        }
        if (count == 0) {
            return true;
        }
        twin_->pairs.known.ignored = std::make_unique<IgnoredPairs>();
        IgnoredPairs& ignored = *twin_->pairs.known.ignored;
        const Population<Scalar>& proxies = twin_->store.proxies;
        const auto readId = [&] {
            const auto index = from_.read<std::uint32_t>();
            return ProxyId{index, from_.read<std::uint32_t>()};
        };
        ignored.reserve(count, [](const ProxyPair&) { return false; });
        for (std::uint32_t i = 0; i < count; ++i) {
            const ProxyId first = readId();
            const ProxyId second = readId();
            if (first.index >= second.index || second.index >= proxies.records.size()) {
                return false;
            }
            ignored.insert({first, second});
        }
        return true;
    }

    // From scratch: it follows from the rest.
    void countPairs() {
        PairState<Scalar>& pairs = twin_->pairs;
        std::vector<PairKey> all;
        forEachKnown(pairs, [&](PairKey key) {
            if (!pairs.known.isRefused(key)) {
                all.push_back(key);
            }
        });
        pairs.sortAndUnite(all);
        pairs.known.count = all.size();
        pairs.lastUpdate.forget();
    }

    [[nodiscard]] bool readMotions() {
        Population<Scalar>& proxies = twin_->store.proxies;
        Motions<Scalar>& motions = twin_->motions;
        const auto count = from_.read<std::uint32_t>();
        if (count > proxies.size) {
            return false;
        }
        motions.ofProxy.assign(proxies.records.size(), Motions<Scalar>::kNone);
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto index = from_.read<std::uint32_t>();
            Motion<Scalar> motion;
            motion.sweep = from_.read<Sweep>();
            motion.isFromGrid = readBool();
            motion.way.box = readBox();
            motion.way.displacement = readPoint();
            const bool isOneMode = motion.sweep == Sweep::box || motion.sweep == Sweep::line ||
                                   motion.sweep == Sweep::automatic;
            if (!isOneMode || index >= proxies.records.size() || !proxies.isAlive(index) ||
                motions.ofProxy[index] != Motions<Scalar>::kNone ||
                !motion.way.displacement.allFinite()) {
                return false;
            }
            motion.id = proxies.idOf(index);
            motions.ofProxy[index] = i;
            motions.all.push_back(motion);
        }
        return areBools_;
    }

    [[nodiscard]] bool readBool() {
        const auto byte = from_.read<std::uint8_t>();
        areBools_ = areBools_ && byte <= 1;
        return byte == 1;
    }
    [[nodiscard]] Vector3<Scalar> readPoint() {
        Vector3<Scalar> point;
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            point[axis] = from_.read<Scalar>();
        }
        return point;
    }
    [[nodiscard]] Aabb<Scalar> readBox() {
        const Vector3<Scalar> low = readPoint();
        return {low, readPoint()};
    }
    [[nodiscard]] ProxyGroups readGroups() {
        const auto group = from_.read<std::uint32_t>();
        return {group, from_.read<std::uint32_t>()};
    }
    /// None where some are not pairs of two indices.
    [[nodiscard]] std::optional<std::vector<PairKey>> readKeys() {
        const auto count = from_.read<std::uint32_t>();
        if (count > from_.left() / sizeof(PairKey)) {
            return std::nullopt;
        }
        std::vector<PairKey> keys;
        keys.reserve(count);
        const std::size_t indexCount = twin_->store.proxies.records.size();
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto key = from_.read<PairKey>();
            if (firstIndex(key) >= secondIndex(key) || secondIndex(key) >= indexCount) {
                return std::nullopt;
            }
            keys.push_back(key);
        }
        return keys;
    }

    static constexpr std::uint64_t kMostImmediate = std::uint64_t{1} << 31;

    ByteReader from_;
    GridTwin<Scalar>* twin_ = nullptr;
    std::vector<char> wasSeen_;  // by index
    bool areBools_ = true;       // all that were read so far
};

}  // namespace

template <class Scalar>
std::string readTwin(std::span<const std::byte> bytes, std::unique_ptr<GridTwin<Scalar>>& twin) {
    std::span<const std::byte> content;
    std::string fault = openBytes(kGridSeal, bytes, content);
    return fault.empty() ? TwinReader<Scalar>(content).readAll(twin) : fault;
}

template std::string readTwin(std::span<const std::byte>, std::unique_ptr<GridTwin<float>>&);
template std::string readTwin(std::span<const std::byte>, std::unique_ptr<GridTwin<double>>&);

}  // namespace hashphase::detail

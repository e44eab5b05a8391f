// SPDX-License-Identifier: Zlib

// A grid's state as bytes: what its boxes, ids, groups, pairs and sweeps are, and were at the last update. Tables
// are not written.

#include <broadphase/pairs/grid_twin_bytes.hpp>

#include <broadphase/core/byte_stream.hpp>
#include <broadphase/pairs/grid_twin_format.hpp>

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace hashphase::detail {
namespace {

template <class Scalar>
class TwinWriter {
public:
    explicit TwinWriter(const GridTwin<Scalar>& twin)
        : twin_(twin), store_(twin.store), proxies_(twin.store.proxies) {}

    [[nodiscard]] std::span<const std::byte> bytes() const { return to_.bytes(); }

    void writeAll() {
        writeSettings();
        to_.write(static_cast<std::uint32_t>(proxies_.records.size()));
        to_.write(proxies_.firstGeneration);
        to_.write(!proxies_.groups.empty());
        to_.write(!proxies_.boxesAtUpdate.empty());
        wasRemoved_.assign(proxies_.records.size(), 0);
        forEachIn(proxies_.removed, [&](std::uint32_t index) { wasRemoved_[index] = 1; });
        for (std::uint32_t index = 0; index < proxies_.records.size(); ++index) {
            writeIndex(index);
        }
        for (const FreeList* list :
             {&proxies_.free, &proxies_.removed, &proxies_.removedImmediate}) {
            to_.write(list->count);
            forEachIn(*list, [&](std::uint32_t index) { to_.write(index); });
        }
        if (twin_.hasPairs) {
            writePairs();
        }
        if (twin_.hasSweeps) {
            writeMotions();
        }
    }

private:
    void writeSettings() {
        const GridConfig& config = store_.config;
        to_.write(static_cast<std::uint8_t>(sizeof(Scalar)));
        to_.write(config.cellSize);
        to_.write(config.levelRatio);
        to_.write(config.updatesBeforeRest);
        to_.write(config.slack.has_value());
        to_.write(config.slack.value_or(0));
        to_.write(twin_.hasPairs);
        to_.write(twin_.hasSweeps);
        to_.write(store_.tables.cellSize);
    }

    template <class Visit>
    void forEachIn(const FreeList& list, const Visit& visit) const {
        std::uint32_t index = list.first;
        for (std::uint32_t i = 0; i < list.count; ++i) {
            visit(index);
            index = proxies_.records[index].listedAt;
        }
    }

    void writeIndex(std::uint32_t index) {
        const Record<Scalar>& record = proxies_.records[index];
        const bool isAlive = proxies_.isAlive(index);
        const bool wasSeen =
            isAlive ? proxies_.rests(index) || !proxies_.isUnseen(index) : wasRemoved_[index] != 0;
        to_.write(
            static_cast<std::uint8_t>((isAlive ? kIsAlive : 0) | (wasSeen ? kWasSeen : 0) |
                                      (record.residency == Residency::sweeping ? kSweeps : 0) |
                                      (isAlive && record.restsAtOnce ? kRestsAtOnce : 0)));
        to_.write(record.generation);
        if (isAlive) {
            write(record.box);
        }
        if (wasSeen) {
            write(store_.before(index));
            if (!proxies_.boxesAtUpdate.empty()) {
                write(store_.boxAtUpdate(index));
            }
        }
        for (std::size_t i = 0; i < 2 && !proxies_.groups.empty(); ++i) {
            to_.write(proxies_.groups[2 * std::size_t{index} + i].group);
            to_.write(proxies_.groups[2 * std::size_t{index} + i].mask);
        }
    }

    void writePairs() {
        const KnownPairs& known = twin_.pairs.known;
        std::vector<PairKey> keys(known.refused.keys().begin(), known.refused.keys().end());
        keys.insert(keys.end(), known.refusedAtRest.keys().begin(),
                    known.refusedAtRest.keys().end());
        std::sort(keys.begin(), keys.end());  // as they were found in any order
        write(keys);
        write(known.kept.keys());
        write(known.immediate.keys());
        write(known.swept.atUpdate);
        to_.write(known.arePairs());
        if (known.arePairs()) {
            keys.assign(known.pile->pairs.keys().begin(), known.pile->pairs.keys().end());
            std::sort(keys.begin(), keys.end());
            write(keys);
            to_.write(known.pile->lookInterval);
            to_.write(known.pile->updatesUntilLook);
        }
        std::vector<ProxyPair> ignored;  // of a removed proxy, not even the index may be left
        if (known.ignored != nullptr) {
            std::ranges::copy_if(known.ignored->pairs(), std::back_inserter(ignored),
                                 [&](const ProxyPair& pair) { return twin_.pairs.areAlive(pair); });
        }
        to_.write(static_cast<std::uint32_t>(ignored.size()));
        for (const ProxyPair& pair : ignored) {
            for (const ProxyId id : {pair.first, pair.second}) {
                to_.write(id.index);
                to_.write(id.generation);
            }
        }
        to_.write(static_cast<std::uint64_t>(twin_.pairs.fewImmediate));
    }

    void writeMotions() {
        const auto isThere = [&](const Motion<Scalar>& motion) {
            return proxies_.contains(motion.id);
        };
        const auto& all = twin_.motions.all;
        to_.write(static_cast<std::uint32_t>(std::ranges::count_if(all, isThere)));
        for (const Motion<Scalar>& motion : all) {
            if (isThere(motion)) {
                to_.write(motion.id.index);
                to_.write(motion.sweep);
                to_.write(motion.isFromGrid);
                write(motion.way.box);
                write(motion.way.displacement);
            }
        }
    }

    void write(const Vector3<Scalar>& point) {
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            to_.write(point[axis]);
        }
    }
    void write(const Aabb<Scalar>& box) {
        write(Vector3<Scalar>(box.min()));
        write(Vector3<Scalar>(box.max()));
    }
    void write(std::span<const PairKey> keys) {
        to_.write(static_cast<std::uint32_t>(keys.size()));
        for (const PairKey key : keys) {
            to_.write(key);
        }
    }

    const GridTwin<Scalar>& twin_;
    const Store<Scalar>& store_;
    const Population<Scalar>& proxies_;
    std::vector<char> wasRemoved_;
    ByteWriter to_;
};

}  // namespace

template <class Scalar>
void writeTwin(const GridTwin<Scalar>& twin, std::vector<std::byte>& bytes) {
    TwinWriter<Scalar> writer(twin);
    writer.writeAll();
    sealBytes(kGridSeal, writer.bytes(), bytes);
}

template void writeTwin(const GridTwin<float>&, std::vector<std::byte>&);
template void writeTwin(const GridTwin<double>&, std::vector<std::byte>&);

}  // namespace hashphase::detail
